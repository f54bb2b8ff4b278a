#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# mjcf-urdf-simple-converter 0.7.3: a joint without limits can no longer move in the URDF.
#
# A hinge without a range turns freely in MuJoCo. The converter writes it as revolute with limits of 0.0 and 0.0, where
# URDF has continuous joints. Pinocchio 4.1.0, with which angles are drawn within the limits, finds 0 alone. A hinge
# with a range of ±90° is right; damping, friction and couplings of joints (equality) are left out, without a word.
# For us: take the URDF from `gearkin urdf`, not from a conversion of `gearkin mjcf`.
#
# Exit code 0: still so. Installs the packages into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check mjcf-urdf-simple-converter==0.7.3 mujoco==3.11.0
python3 -m venv "$folder/pinocchio"
"$folder/pinocchio/bin/pip" install --quiet --disable-pip-version-check pin==4.1.0
cd "$folder"
cat > gear.xml <<'MJCF'
<mujoco><worldbody>
  <body name="rotor"><joint name="motor" damping="0.1"/><geom size="0.1"/></body>
  <body name="shaft"><joint name="output" range="-90 90"/><geom size="0.1"/></body>
</worldbody><equality><joint joint1="output" joint2="motor" polycoef="0 -0.05 0 0 0"/></equality></mujoco>
MJCF
venv/bin/python - <<'PYTHON'
import mjcf_urdf_simple_converter
import mujoco

model = mujoco.MjModel.from_xml_path('gear.xml')
assert model.jnt_limited.tolist() == [False, True]
mjcf_urdf_simple_converter.convert('gear.xml', 'gear.urdf')
PYTHON
if grep -E 'mimic|damping|continuous' gear.urdf; then exit 1; fi
pinocchio/bin/python - <<'PYTHON'
import pinocchio

model = pinocchio.buildModelFromUrdf('gear.urdf')
limits = list(zip(model.lowerPositionLimit.round(4).tolist(), model.upperPositionLimit.round(4).tolist()))
drawn = {float(pinocchio.randomConfiguration(model)[0]) for _ in range(100)}
print('limits', limits, 'of the motor drawn', drawn)
assert limits == [(0.0, 0.0), (-1.5708, 1.5708)]
assert drawn == {0.0}
PYTHON
