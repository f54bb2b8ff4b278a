#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# @dimforge/rapier3d-compat 0.21.0 (npm): a joint from -1 to 5 rad that is sent to 4 rad stands at its stop at -1 rad.
#
# A revolute joint without gravity; its motor has 100 N·m/rad and 20 N·m·s/rad for each kg·m². Expected of
# configureMotorPosition(4): 4 rad, as 3 rad is reached; with limits beyond ±π also 10 rad. What happens: the goal is
# taken within half a turn, so that 4 rad is reached at -2.28 rad, and with limits of -1 and 5 rad, between which the
# joint can be pushed to 5 rad by a torque, it is driven to -1 rad and held there. Sent to 10 rad it never stops
# turning. Limits of -4 and 4 rad have no effect at all. The documentation names no range of goals or limits; issue 499
# of Rapier, which is open, is about limits beyond π.
# For us: simulate only goals within ±π in this way; turn a rotor by configureMotorVelocity() and a controller of its
# own.
#
# Exit code 0: still so. Needs node; installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm install --silent --no-audit --no-fund --ignore-scripts @dimforge/rapier3d-compat@0.21.0
cat > goals.mjs <<'JAVASCRIPT'
import assert from 'node:assert';
import RAPIER from '@dimforge/rapier3d-compat';

await RAPIER.init();
const [zero, inertia] = [{ x: 0, y: 0, z: 0 }, { x: 0.1, y: 0.1, z: 0.1 }];

/** The angle in rad and the speed in rad/s of the joint after 10 s. */
function turned({ goal, limits, torque = 0 }) {
  const world = new RAPIER.World(zero);
  world.timestep = 0.001;
  const base = world.createRigidBody(RAPIER.RigidBodyDesc.fixed());
  const shape = RAPIER.RigidBodyDesc.dynamic().setAdditionalMassProperties(1, zero, inertia, { ...zero, w: 1 });
  const arm = world.createRigidBody(shape);
  const joint = world.createImpulseJoint(RAPIER.JointData.revolute(zero, zero, { x: 0, y: 0, z: 1 }), base, arm, true);
  if (limits) {
    joint.setLimits(...limits);
  }
  if (goal !== undefined) {
    joint.configureMotorPosition(goal, 100, 20);
  }
  arm.addTorque({ x: 0, y: 0, z: torque }, true);
  let angle = 0;
  for (let step = 0; step < 10_000; step++) {
    world.step();
    angle += arm.angvel().z * world.timestep;
  }
  console.log({ goal, limits, torque }, 'angle', angle, 'rad, speed', arm.angvel().z, 'rad/s');
  return [angle, arm.angvel().z];
}

const stands = ([angle, speed], expected) => Math.abs(angle - expected) < 0.05 && Math.abs(speed) < 0.01;
const limits = [-1, 5];
assert.ok(stands(turned({ goal: 3 }), 3) && stands(turned({ goal: 3, limits }), 3));
assert.ok(stands(turned({ limits, torque: 0.1 }), 5));
assert.ok(stands(turned({ goal: 4 }), 4 - 2 * Math.PI));
assert.ok(stands(turned({ goal: 4, limits }), -1));
assert.ok(turned({ goal: 10 })[0] > 50);
assert.ok(turned({ limits: [-4, 4], torque: 0.1 })[0] > 40);
JAVASCRIPT
timeout 60 node goals.mjs
