#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# closed-chain-ik 0.0.3 (npm): the quaternion of a joint at 90° is that of 1.57°.
#
# A hinge about z is set to 90°, in radians as all angles of the solver. Expected of getDoFQuaternion(): a turn by 90°,
# as its transform has it. What happens: a turn by 1.57°, as the angle in radians is passed on as one in degrees. The
# quaternions of the rest pose and of the target, getRestPoseQuaternion() and getTargetQuaternion(), are made likewise.
# The maintainer has mended it in the repository since this version, the newest that npm has.
# Output: set to 90.00°: by the transform 90.00°, by getDoFEuler() 90.00°, by getDoFQuaternion() 1.57°
#         a target of 90.00° by getTargetQuaternion() 1.57°, a rest pose of 90.00° by getRestPoseQuaternion() 1.57°
# For us: take the angle by getDoFValue(), and make the quaternion yourself.
#
# Exit code 0: still so. Needs node and npm; installs the version into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm init --yes > /dev/null
npm install --silent --no-audit --no-fund closed-chain-ik@0.0.3 > install.log 2>&1 || { cat install.log; exit 1; }
cat > hinge.mjs <<'JS'
import assert from 'node:assert';
import { DOF, Joint } from 'closed-chain-ik/src/core/index.js';

const degrees = (angle) => ((angle * 180) / Math.PI).toFixed(2);
const turn = ([, , z, w]) => degrees(2 * Math.atan2(z, w));

const joint = new Joint();
joint.setDoF(DOF.EZ);
joint.setDoFValues(Math.PI / 2);
joint.setTargetValues(Math.PI / 2);
joint.setRestPoseValues(Math.PI / 2);
joint.updateMatrixWorld();
const [quaternion, target, rest, euler] = [[], [], [], []];
joint.getDoFQuaternion(quaternion);
joint.getTargetQuaternion(target);
joint.getRestPoseQuaternion(rest);
joint.getDoFEuler(euler);
const transform = degrees(Math.atan2(joint.matrixDoF[1], joint.matrixDoF[0]));
console.log(
  `set to ${degrees(joint.getDoFValue(DOF.EZ))}°: by the transform ${transform}°, by getDoFEuler() ` +
  `${degrees(euler[2])}°, by getDoFQuaternion() ${turn(quaternion)}°`,
);
console.log(
  `a target of ${degrees(joint.getTargetValue(DOF.EZ))}° by getTargetQuaternion() ${turn(target)}°, ` +
  `a rest pose of ${degrees(joint.getRestPoseValue(DOF.EZ))}° by getRestPoseQuaternion() ${turn(rest)}°`,
);
assert.strictEqual(transform, '90.00');
assert.deepStrictEqual([quaternion, target, rest].map(turn), ['1.57', '1.57', '1.57']);
JS
timeout 60 node hinge.mjs
