#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# jolt-physics 1.1.0 (npm): a gear of 20 divides the speed but not the torque, and one whose output turns the same way
# is at NaN.
#
# A GearConstraint joins a rotor and an output of 0.1 kg·m² each, with 1 and 20 teeth; its documentation has the
# Jacobian (a, r b). Expected: 1 N·m at the output turns the rotor by -0.25 rad in a second, and 0.05 N·m at the rotor
# hold it. What happens: -4.77 rad, as the same torque acts on both; 1 N·m at the rotor holds it. Expected of a ratio of
# -20, "Gear1Rotation = -ratio * Gear2Rotation", and 0.1 N·m at the rotor: both turn the same way. What happens: both
# are at NaN. Speeds and a ratio of 1 are right, and the position motor of a hinge that is sent to 4 rad turns back to
# -2.28 rad.
# For us: simulate a gear as one body with the reflected inertia and the reflected torque.
#
# Exit code 0: still so. Needs node; installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm install --silent --no-audit --no-fund --ignore-scripts jolt-physics@1.1.0
cat > gear.mjs <<'JAVASCRIPT'
import assert from 'node:assert';
import initialize from 'jolt-physics/wasm-compat';

const Jolt = await initialize();
const settings = new Jolt.JoltSettings();
const phases = new Jolt.BroadPhaseLayerInterfaceTable(1, 1);
phases.MapObjectToBroadPhaseLayer(0, new Jolt.BroadPhaseLayer(0));
const pairs = new Jolt.ObjectLayerPairFilterTable(1);
settings.mObjectLayerPairFilter = pairs;
settings.mBroadPhaseLayerInterface = phases;
settings.mObjectVsBroadPhaseLayerFilter = new Jolt.ObjectVsBroadPhaseLayerFilterTable(phases, 1, pairs, 1);
const jolt = new Jolt.JoltInterface(settings);
const system = jolt.GetPhysicsSystem();
const bodies = system.GetBodyInterface();
system.SetGravity(new Jolt.Vec3(0, 0, 0));
const axis = () => new Jolt.Vec3(0, 0, 1);

/** A solid ball of 1 kg and an inertia of 0.1 kg·m², or a base that does not move. */
function ball(x, motion) {
  const place = new Jolt.RVec3(x, 0, 0);
  const ball = new Jolt.BodyCreationSettings(new Jolt.SphereShape(0.5), place, new Jolt.Quat(0, 0, 0, 1), motion, 0);
  ball.mAngularDamping = 0;
  ball.mAllowSleeping = false;
  ball.mOverrideMassProperties = Jolt.EOverrideMassProperties_CalculateInertia;
  ball.mMassPropertiesOverride.mMass = 1;
  const body = bodies.CreateBody(ball);
  bodies.AddBody(body.GetID(), Jolt.EActivation_Activate);
  return body;
}

function hinge(base, body, x) {
  const hinge = new Jolt.HingeConstraintSettings();
  for (const side of ['1', '2']) {
    hinge['mPoint' + side] = new Jolt.RVec3(x, 0, 0);
    hinge['mHingeAxis' + side] = axis();
    hinge['mNormalAxis' + side] = new Jolt.Vec3(1, 0, 0);
  }
  const joint = Jolt.castObject(hinge.Create(base, body), Jolt.HingeConstraint);
  system.AddConstraint(joint);
  return joint;
}

/** The angles in rad by which rotor and output turn under these torques in N·m, by default in a second. */
function turned({ ratio, rotorTorque = 0, outputTorque = 0, goal, steps = 1000 }) {
  const base = ball(-50, Jolt.EMotionType_Static);
  const [rotor, output] = [ball(0, Jolt.EMotionType_Dynamic), ball(5, Jolt.EMotionType_Dynamic)];
  const joints = [hinge(base, rotor, 0), hinge(base, output, 5)];
  const gear = new Jolt.GearConstraintSettings();
  gear.mHingeAxis1 = axis();
  gear.mHingeAxis2 = axis();
  gear.mRatio = ratio;
  const constraint = Jolt.castObject(gear.Create(rotor, output), Jolt.GearConstraint);
  constraint.SetConstraints(...joints);
  system.AddConstraint(constraint);
  if (goal !== undefined) {
    joints[0].SetMotorState(Jolt.EMotorState_Position);
    joints[0].SetTargetAngle(goal);
  }
  const angles = [0, 0];
  for (let step = 0; step < steps; step++) {
    rotor.AddTorque(new Jolt.Vec3(0, 0, rotorTorque));
    output.AddTorque(new Jolt.Vec3(0, 0, outputTorque));
    jolt.Step(0.001, 1);
    [rotor, output].forEach((body, index) => { angles[index] += body.GetAngularVelocity().GetZ() * 0.001; });
  }
  console.log({ ratio, rotorTorque, outputTorque, goal }, 'rotor and output at', angles, 'rad');
  [...joints, constraint].forEach((part) => system.RemoveConstraint(part));
  [base, rotor, output].forEach((body) => { bodies.RemoveBody(body.GetID()); bodies.DestroyBody(body.GetID()); });
  return angles;
}

const close = (values, expected) => values.every((value, index) => Math.abs(value - expected[index]) < 0.01);
assert.ok(close(turned({ ratio: 1, rotorTorque: 0.1 }), [0.25, -0.25]));
assert.ok(close(turned({ ratio: 20, outputTorque: 1 }), [-4.767, 0.238]));
assert.ok(turned({ ratio: 20, rotorTorque: 0.05, outputTorque: 1 })[0] < -4);
assert.ok(close(turned({ ratio: 20, rotorTorque: 1, outputTorque: 1 }), [0, 0]));
assert.ok(close(turned({ ratio: 20, goal: 3, steps: 5000 }), [3, -3 / 20]));
assert.ok(close(turned({ ratio: 20, goal: 4, steps: 5000 }), [4 - 2 * Math.PI, (2 * Math.PI - 4) / 20]));
assert.ok(turned({ ratio: -20, rotorTorque: 0.1 }).every(Number.isNaN));
JAVASCRIPT
timeout 100 node gear.mjs
