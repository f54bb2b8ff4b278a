#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# dm_control 1.0.50: a gear in radians that is attached to an arm in degrees makes ±90 rad of the arm's limits of ±90°.
#
# MJCF has angles in degrees unless its compiler says otherwise. An arm that leaves this default out has a joint from
# -90 to 90 degrees. A gear with angle="radian" is attached to it: the arm takes over the gear's setting, nothing is
# converted, and MuJoCo 4.0.0 reads ±90 rad from what dm_control writes, which is no limit any more. MuJoCo's own
# MjSpec.attach() converts. Only an arm that states angle="degree" itself is refused as a conflict.
# For us: state the unit of angle in every MJCF that is to be combined; that of `gearkin mjcf` is in radians.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check dm_control==1.0.50 mujoco==4.0.0
timeout 90 "$folder/venv/bin/python" - 2> "$folder/log" <<'PYTHON' || { cat "$folder/log"; exit 1; }
import math

import mujoco
from dm_control import mjcf

MODEL = """
<mujoco model="{0}">{1}<worldbody><body name="{0}"><geom size="0.1"/>
  <joint name="{0}" limited="true" range="{2}"/></body></worldbody></mujoco>
"""
ARM, GEAR = MODEL.format('arm', '', '-90 90'), MODEL.format('gear', '<compiler angle="radian"/>', '-1 1')
STATED = MODEL.format('arm', '<compiler angle="degree"/>', '-90 90')


def attach(arm):
    root = mjcf.from_xml_string(arm)
    root.worldbody.add('site').attach(mjcf.from_xml_string(GEAR))
    return mujoco.MjModel.from_xml_string(root.to_xml_string()).jnt_range


spec, gear = mujoco.MjSpec.from_string(ARM), mujoco.MjSpec.from_string(GEAR)
spec.attach(gear, prefix='gear/', frame=spec.worldbody.add_frame())
by_control, by_mujoco = attach(ARM), spec.compile().jnt_range
try:
    refusal = f'{attach(STATED)}'
except ValueError as error:
    refusal = str(error)
print('dm_control', by_control.tolist(), 'MjSpec', by_mujoco.tolist(), 'where it is stated:', refusal)
assert by_control.tolist() == [[-90.0, 90.0], [-1.0, 1.0]]
assert abs(by_mujoco[0][1] - math.pi / 2) < 1e-9 and abs(by_mujoco[1][1] - 1.0) < 1e-9
assert 'onflict' in refusal
PYTHON
