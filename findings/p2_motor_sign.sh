#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# p2-es 1.2.3 (npm): a motor set to 1 rad/s turns its joint at -1 rad/s, against the angle and the limits of this joint.
#
# A RevoluteConstraint joins a fixed body and an arm. Expected: a motor with a positive motorSpeed makes the `angle` of
# the joint greater, up to the upper one of its limits. What happens: the angle and setLimits() count the arm less the
# fixed body, the motor of the same joint the opposite: at a speed of 1 rad/s the angle is -3 rad after 3 s, and in a
# range from 0 to 2 rad the arm stays at 0 for ever. The documentation gives no sign for either.
# For us: give the motor the negative speed.
#
# Exit code 0: still so. Needs npm; installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm install --silent --no-audit --no-fund p2-es@1.2.3
cat > motor.mjs <<'JS'
import assert from 'node:assert'
import { Body, Circle, RevoluteConstraint, World } from 'p2-es'

/** The angle of the joint after its motor has run for 3 s. */
function turned(speed, limits) {
  const world = new World({ gravity: [0, 0] })
  const fixed = new Body()
  const arm = new Body({ mass: 1 })
  arm.addShape(new Circle({ radius: 1 }))
  world.addBody(fixed)
  world.addBody(arm)
  const joint = new RevoluteConstraint(fixed, arm, { worldPivot: [0, 0] })
  world.addConstraint(joint)
  joint.motorEnabled = true
  joint.motorSpeed = speed
  joint.motorMaxForce = 10
  if (limits) joint.setLimits(...limits)
  for (let step = 0; step < 3000; step++) world.step(0.001)
  assert(Math.abs(joint.angle - (arm.angle - fixed.angle)) < 0.01)
  return joint.angle
}

const [free, held, negative] = [turned(1), turned(1, [0, 2]), turned(-1, [0, 2])]
console.log('at 1 rad/s', free, 'in a range from 0 to 2', held, 'at -1 rad/s in it', negative)
assert(Math.abs(free + 3) < 0.1 && Math.abs(held) < 0.01 && Math.abs(negative - 2) < 0.01)
JS
timeout 60 node motor.mjs
