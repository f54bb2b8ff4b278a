#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# cannon-es 0.20.0 (npm): a motor limited to 0.01 N·m has 10 N·m at 1000 steps a second, and a cylinder has 1.33 times
# its inertia.
#
# A hinge about y joins a base and a cylindrical rotor of 20 kg and a radius of 0.1 m. Expected: an inertia of 0.1
# kg·m². What happens: 0.133 kg·m², that of a box round the cylinder. Expected of setMotorMaxForce(0.01): after 5 ms the
# rotor has 0.0005 rad/s. What happens: 0.375 rad/s, as after 5 steps of 20 ms: the limit is one of the impulse of each
# step, so that the motor has 0.01 N·m·s divided by the step. Expected of setMotorSpeed(1) of a rotor on its base: +1
# rad/s about the axis of the hinge. What happens: -1 rad/s if the base is the first body of the hinge.
# For us: set inertia and invInertia by hand, give the greatest torque times the step, and the rotor as the first body.
#
# Exit code 0: still so. Needs node; installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm install --silent --no-audit --no-fund --ignore-scripts cannon-es@0.20.0
cat > hinge.mjs <<'JAVASCRIPT'
import assert from 'node:assert';
import { Body, Cylinder, HingeConstraint, Vec3, World } from 'cannon-es';

/** The rotor after so many steps in s without gravity, under a motor with a speed of 1 rad/s. */
function turned({ step, steps, torque = 1e6, rotorFirst = false }) {
  const world = new World({ gravity: new Vec3(0, 0, 0) });
  const base = new Body({ mass: 0 });
  const shape = new Cylinder(0.1, 0.1, 0.05, 64);
  const rotor = new Body({ mass: 20, shape, angularDamping: 0, collisionFilterMask: 0 });
  world.addBody(base);
  world.addBody(rotor);
  const axes = { axisA: new Vec3(0, 1, 0), axisB: new Vec3(0, 1, 0) };
  const hinge = rotorFirst ? new HingeConstraint(rotor, base, axes) : new HingeConstraint(base, rotor, axes);
  world.addConstraint(hinge);
  hinge.enableMotor();
  hinge.setMotorSpeed(1);
  hinge.setMotorMaxForce(torque);
  for (let count = 0; count < steps; count++) {
    world.step(step);
  }
  return rotor;
}

const close = (value, expected) => Math.abs(value - expected) < 1e-6;
const speed = (motion) => turned(motion).angularVelocity.y;
const inertia = turned({ step: 0.001, steps: 0 }).inertia.y;
console.log('inertia of the rotor', inertia, 'kg·m² instead of', 20 * 0.1 ** 2 / 2, 'kg·m²');
assert.ok(close(inertia, 0.4 / 3));
const fine = speed({ step: 0.001, steps: 5, torque: 0.01 });
const coarse = speed({ step: 0.02, steps: 5, torque: 0.01 });
console.log('0.01 N·m: after 5 steps of 1 ms', fine, 'rad/s, after 5 steps of 20 ms', coarse, 'rad/s');
assert.ok(close(Math.abs(fine), 0.375) && close(Math.abs(coarse), 0.375));
const [baseFirst, rotorFirst] = [false, true].map((first) => speed({ step: 0.001, steps: 100, rotorFirst: first }));
console.log('speed 1 rad/s: base first', baseFirst, 'rad/s, rotor first', rotorFirst, 'rad/s');
assert.ok(close(baseFirst, -1) && close(rotorFirst, 1));
JAVASCRIPT
timeout 60 node hinge.mjs
