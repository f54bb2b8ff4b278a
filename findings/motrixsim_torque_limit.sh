#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# MotrixSim 0.10.1: the torque limit of a joint in an MJCF has no effect, and no warning says so.
#
# actuatorfrcrange="-0.005 0.005" limits what all motors together give a joint. With a command of 0.01 N·m, a rotor of
# 0.01 kg·m² has 0.5 rad/s after a second in MuJoCo 4.0.0, and 1 rad/s in MotrixSim, which warns of other elements that
# it does not know, such as a tendon. Its forcerange and ctrlrange of a motor, friction, armature and joint equality are
# right.
# For us: give the limit as forcerange of the motor: that of the joint divided by the gear.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check motrixsim==0.10.1 mujoco==4.0.0 numpy==2.4.6
cat > "$folder/limit.py" <<'PYTHON'
import motrixsim
import mujoco
import numpy as np

MJCF = '''
<mujoco>
  <option gravity="0 0 0" timestep="0.002"/>
  <worldbody><body>
    <joint name="motor" axis="0 0 1" {}/><inertial pos="0 0 0" mass="1" diaginertia=".01 .01 .01"/>
  </body></worldbody>
  <actuator><motor joint="motor" gear="{}" {}/></actuator>
</mujoco>'''


def in_mujoco(text):
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    data.ctrl[0] = 0.01
    mujoco.mj_step(model, data, 500)
    return data.qvel[0]


def in_motrixsim(text):
    model = motrixsim.load_mjcf_str(text)
    data = motrixsim.SceneData(model)
    for _ in range(500):
        data.actuator_ctrls = np.array([0.01], dtype=np.float32)
        motrixsim.step(model, data)
    return data.dof_vel[0]


LIMIT = 'actuatorfrcrange="-0.005 0.005"'
for name, text, right, found in (
    ('no limit', MJCF.format('', 1, ''), 1, 1),
    ('limit of the joint', MJCF.format(LIMIT, 1, ''), 0.5, 1),
    ('limit of the joint, gear of 19', MJCF.format(LIMIT, 19, ''), 0.5, 19),
    ('limit of the motor', MJCF.format('', 1, 'forcerange="-0.005 0.005"'), 0.5, 0.5),
    ('limit of the motor, gear of 19', MJCF.format('', 19, 'forcerange="-0.005 0.005"'), 9.5, 9.5),
):
    speeds = in_mujoco(text), in_motrixsim(text)
    print(name, 'MuJoCo and MotrixSim', speeds, 'rad/s')
    assert np.allclose(speeds, (right, found), atol=0.01)
PYTHON
timeout 60 "$folder/venv/bin/python" "$folder/limit.py" > "$folder/log" 2>&1 || { cat "$folder/log"; exit 1; }
if grep -E 'WARN|frcrange' "$folder/log"; then exit 1; fi
grep MotrixSim "$folder/log"
