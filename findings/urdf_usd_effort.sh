#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# urdf-usd-converter 0.3.4, Newton 1.8.0: a joint's torque limit of 10 N·m in a URDF is 1 000 000 N·m after the way over
# USD.
#
# Both are of one project, and Newton reads the URDF and the USD file that the converter makes of it. Expected: the same
# joints. What happens: limits of angle and speed, damping, friction and mimic are the same, but the effort of 10 N·m is
# written as an attribute that Newton does not read. The same happens with actuatorfrcrange="-2 2" of an MJCF that
# mujoco-usd-converter 0.8.0 converts. A joint that must not bear 10 N·m then never reaches its limit.
# For us: give Newton the URDF or the MJCF itself, or set `joint_effort_limit` after add_usd().
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check urdf-usd-converter==0.3.4 mujoco-usd-converter==0.8.0
python3 -m venv "$folder/newton"
"$folder/newton/bin/pip" install --quiet --disable-pip-version-check newton==1.8.0 newton-usd-schemas==0.6.0 usd-core==26.11 warp-lang==1.19.0
cd "$folder"
cat > gear.urdf <<'URDF'
<robot name="gear">
  <link name="stator"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <link name="rotor"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="motor" type="revolute"><parent link="stator"/><child link="rotor"/><axis xyz="0 0 1"/>
    <limit lower="-3" upper="3" effort="10" velocity="6"/><dynamics damping="0.1" friction="0.02"/></joint>
</robot>
URDF
cat > gear.xml <<'MJCF'
<mujoco model="gear">
  <compiler angle="radian"/>
  <worldbody><body name="rotor">
    <joint name="motor" axis="0 0 1" damping="0.1" frictionloss="0.02" range="-3 3" actuatorfrcrange="-2 2"/>
    <geom size=".1"/>
  </body></worldbody>
</mujoco>
MJCF
cat > convert.py <<'PYTHON'
import mujoco_usd_converter
import urdf_usd_converter

urdf_usd_converter.Converter().convert('gear.urdf', 'from_urdf')
mujoco_usd_converter.Converter().convert('gear.xml', 'from_mjcf')
PYTHON
cat > read.py <<'PYTHON'
import newton

NAMES = 'joint_limit_upper', 'joint_damping', 'joint_friction', 'joint_effort_limit'


def read(reader, path):
    builder = newton.ModelBuilder()
    getattr(builder, reader)(path)
    model = builder.finalize(device='cpu')
    values = [round(float(getattr(model, name).numpy()[-1]), 6) for name in NAMES]
    print(path, dict(zip(NAMES, values, strict=True)))
    return values


for reader, path, usd, effort in (
    ('add_urdf', 'gear.urdf', 'from_urdf/gear.usda', 10),
    ('add_mjcf', 'gear.xml', 'from_mjcf/gear.usda', 2),
):
    assert read(reader, path) == [3, 0.1, 0.02, effort]
    assert read('add_usd', usd) == [3, 0.1, 0.02, 1e6]
PYTHON
timeout 60 venv/bin/python convert.py > log 2>&1 || { cat log; exit 1; }
WARP_CACHE_PATH="$folder/cache" timeout 200 newton/bin/python read.py > log 2>&1 || { cat log; exit 1; }
grep joint_effort log
