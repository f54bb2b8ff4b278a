#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# MuJoCo 3.13.0: a torque sensor reads twice the torque that a weld of sites bears.
#
# A free body is welded to the world and pulled by 1 N and 1 N·m, until it rests. The sensor of force
# reads 1.000 N in 3.13.0 and in 3.14.0; the sensor of torque reads 2.000 N·m in 3.13.0 and 1.000 N·m
# in 3.14.0. The weld has the default torquescale of 1; the body does not move in either.
# Seen by statics: at rest, a weld bears what is applied, whatever the library says.
# For us: compare sensors at a weld with statics, or measure with MuJoCo 3.14 or newer.
#
# Exit code 0: still so. Installs both versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cat > "$folder/weld.py" <<'PYTHON'
import sys

import mujoco

model = mujoco.MjModel.from_xml_string("""
<mujoco>
  <option gravity="0 0 0"/>
  <worldbody>
    <site name="world"/>
    <body>
      <freejoint/>
      <geom size="0.1" mass="1"/>
      <body><geom size="0.01" mass="0.001"/><site name="welded"/></body>
    </body>
  </worldbody>
  <equality><weld site1="welded" site2="world" solref="0.004 1"/></equality>
  <sensor><force site="welded"/><torque site="welded"/></sensor>
</mujoco>
""")
data = mujoco.MjData(model)
data.xfrc_applied[1] = 1, 0, 0, 0, 0, 1
for _ in range(5000):
    mujoco.mj_step(model, data)
force, torque = data.sensordata[0:3], data.sensordata[3:6]
print(mujoco.__version__, 'force', force, 'torque', torque, 'velocity', abs(data.qvel).max())
assert abs(data.qvel).max() < 1e-6
assert abs(force[0] ** 2 + force[1] ** 2 - 1) < 1e-3
assert abs(torque[2] - float(sys.argv[1])) < 1e-3
PYTHON
for pair in 3.13.0:2 3.14.0:1; do
    python3 -m venv "$folder/${pair%:*}"
    "$folder/${pair%:*}/bin/pip" install --quiet --disable-pip-version-check "mujoco==${pair%:*}"
    "$folder/${pair%:*}/bin/python" "$folder/weld.py" "${pair#*:}"
done
