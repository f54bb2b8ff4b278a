#!/usr/bin/env bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# urdf-validator 1.6.0: a shoulder that bears 19.6 N·m passes with a motor of 1 N·m, if its origin is turned.
#
# The axis of a joint in a URDF is given in the frame of the joint, so that the rpy of its origin turns it. An arm of 5
# kg, 0.4 m off a horizontal axis, needs 5 kg · 9.81 m/s² · 0.4 m = 19.6 N·m at its shoulder, whose effort is 1 N·m.
# Expected of the check of gravity torques: FAIL. What happens where the axis is written as (0, 0, 1) behind a roll of
# 90°, as CAD exporters do: 0 N·m, PASS and the exit code 0. The same arm with the axis (0, -1, 0) and no rpy: FAIL with
# 19.6 N·m. The rpy of the joint's own origin is left out of the axis; those of the joints before it are not.
# For us: compute gravity torques with Pinocchio, or write each axis with an rpy of 0 before this check.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check urdf-validator==1.6.0
cd "$folder"
write() {
    cat > "$1.urdf" <<URDF
<robot name="arm"><link name="base"/>
  <link name="upper"><inertial><origin xyz="0.4 0 0"/><mass value="5"/>
    <inertia ixx="0.1" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="shoulder" type="revolute"><origin xyz="0 0 1" rpy="$2"/><parent link="base"/><child link="upper"/>
    <axis xyz="$3"/><limit lower="-1" upper="1" effort="1" velocity="2"/></joint></robot>
URDF
    mkdir "$1"
    local code=0
    venv/bin/urdf_validate "$1.urdf" --robot-type arm_only --output-dir "$1" > "$1.txt" 2>&1 || code=$?
    echo "$code" > "$1.code"
}
write turned "1.57079632679 0 0" "0 0 1"
write straight "0 0 0" "0 -1 0"
venv/bin/python - <<'PYTHON'
import json
import pathlib

found = {}
for name in ('turned', 'straight'):
    report = json.loads(next(pathlib.Path(name).glob('*.json')).read_text())
    joint = report['statics']['joints'][0]
    code = pathlib.Path(f'{name}.code').read_text().strip()
    found[name] = round(joint['required_torque_gravity'], 2), joint['status'], code != '0'
    print(f'{name}: {found[name][0]} N·m, {found[name][1]}, exit code {code}')
assert found['turned'] == (0.0, 'PASS', False)
assert found['straight'] == (19.62, 'FAIL', True)
PYTHON
