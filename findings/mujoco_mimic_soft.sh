#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# MuJoCo 4.0.0: a mimic joint gives way under load, by 1.05 rad at a rotor that bears 0.53 N·m.
#
# MuJoCo makes an equality of two joints of a mimic in a URDF. Such an equality is a spring and damper whose stiffness
# goes with the inertias: for a rotor of 1e-5 kg·m² that mimics an output with -19, it is 0.5 N·m/rad at the rotor,
# which is 180 N·m/rad at the output. A load of 10 N·m at the output, held by 10/19 N·m at the rotor, turns it by 60°
# against its ratio. With `eq_solref` (0.004, 1), two time steps, instead of (0.02, 1) it is 2.4°.
# For us: a winding that a simulation shows is that of the solver; make one joint of a gear, with `gear` and `armature`.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check mujoco==4.0.0
timeout 90 "$folder/venv/bin/python" - <<'PYTHON'
import mujoco

URDF = """
<robot name="gear">
  <link name="stator"/>
  <link name="arm">
    <inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
  </link>
  <link name="rotor">
    <inertial><mass value="0.1"/><inertia ixx="1e-5" iyy="1e-5" izz="1e-5" ixy="0" ixz="0" iyz="0"/></inertial>
  </link>
  <joint name="output" type="continuous"><parent link="stator"/><child link="arm"/><axis xyz="0 0 1"/></joint>
  <joint name="rotor" type="continuous">
    <parent link="stator"/><child link="rotor"/><axis xyz="0 0 1"/><mimic joint="output" multiplier="-19"/>
  </joint>
</robot>
"""


def winding(load, time_constant=0.02):
    model = mujoco.MjModel.from_xml_string(URDF)
    assert model.neq == 1 and model.eq_data[0, 1] == -19
    assert model.eq_solref[0, 0] == 0.02
    model.eq_solref[0, 0] = time_constant
    data = mujoco.MjData(model)
    data.qfrc_applied[:] = load, load / 19
    for _ in range(5000):
        mujoco.mj_step(model, data)
    assert abs(data.qvel).max() < 1e-3
    return data.qpos[1] + 19 * data.qpos[0]


found = winding(0), winding(5), winding(10), winding(10, 0.004)
print('rotor against its ratio, rad: unloaded, 5 N·m, 10 N·m, 10 N·m with another solref', found)
assert abs(found[0]) < 1e-9
assert abs(found[1] - 0.526) < 1e-2 and abs(found[2] - 1.053) < 1e-2
assert abs(found[3] - 0.042) < 2e-3
PYTHON
