#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# MuJoCo 4.0.0: a joint with a friction of 1 N·m turns by 30° a second under 0.5 N·m.
#
# frictionloss is a soft constraint: below the friction a joint does not stick, but creeps with a constant speed that
# grows with the torque and falls with the inertia. A rotor of 1e-3 kg·m² with a frictionloss of 1 N·m turns by 0.52
# rad/s under 0.5 N·m, one of 1e-2 kg·m² by 0.05 rad/s. Above the friction it is right. A gear that holds its load by
# friction therefore sinks in the simulation. With solreffriction="0.002 1" the speed is a tenth.
# For us: compare a creep with another solreffriction before it is called one of the mechanism.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check mujoco==4.0.0
timeout 90 "$folder/venv/bin/python" - <<'PYTHON'
import mujoco

MJCF = """
<mujoco>
  <option gravity="0 0 0" timestep="0.001"/>
  <worldbody>
    <body>
      <joint name="rotor" axis="0 0 1" frictionloss="1" solreffriction="{} 1"/>
      <inertial pos="0 0 0" mass="1" diaginertia="{} {} {}"/>
    </body>
  </worldbody>
</mujoco>
"""


def motion(torque, inertia, time_constant=0.02):
    model = mujoco.MjModel.from_xml_string(MJCF.format(time_constant, *[inertia] * 3))
    data = mujoco.MjData(model)
    data.qfrc_applied[0] = torque
    speeds = []
    for _ in range(2):
        mujoco.mj_step(model, data, 1000)
        speeds.append(data.qvel[0])
    return speeds


for values, speed in (((0.5, 1e-3), 0.526), ((0.9, 1e-3), 0.947), ((0.5, 1e-2), 0.0526), ((0.5, 1e-3, 0.002), 0.0526)):
    found = motion(*values)
    print('torque, inertia, time constant', values, 'rad/s after 1 and 2 s', found)
    assert all(abs(one / speed - 1) < 0.05 for one in found)
beyond = motion(1.5, 1e-3)
print('beyond the friction', beyond)
assert abs((beyond[1] - beyond[0]) / 500 - 1) < 1e-3
PYTHON
