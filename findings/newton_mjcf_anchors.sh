#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# Newton 1.8.0: of two joints of one body in an MJCF, the second one turns about the anchor of the first one.
#
# A hand tilts about y at its origin and turns about z at a point 100 mm in front of it, as a wrist whose axes do not
# meet. Expected of add_mjcf(): the origin of the hand is at (100, -100, 0) mm when it has turned by 90°, as in MuJoCo
# 3.17.0. What happens: it stays at (0, 0, 0), as both joints become one Newton joint at the `pos` of the first. In the
# opposite order, with the anchor in front at the first joint, it is right for the first and wrong for the second. There
# is no warning, also with verbose=True. Where the two anchors are the same, or each joint has a body of its own, all is
# right. It is documented that joints of one body become one; not that their anchors do.
# For us: give each joint of an MJCF a body of its own, with a tiny mass between them, before Newton reads it.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check newton==1.8.0 mujoco==3.17.0 mujoco-warp==3.17.0 \
  warp-lang==1.19.0 numpy==2.4.6
cat > "$folder/anchors.py" <<'PYTHON'
import mujoco
import newton
import numpy as np

MODEL = """<mujoco><compiler angle="radian"/><worldbody>
  <body name="wrist"><inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/><joint name="tilt" axis="0 1 0" pos="{} 0 0"/>
  {}<inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/><joint name="turn" axis="0 0 1" pos="{} 0 0"/></body>
  {}</worldbody></mujoco>"""


def pose(first, second, own, angles):
    text = MODEL.format(first, '<body name="hand">' if own else '', second, '</body>' if own else '')
    if not own:
        text = text.replace('<inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/>', '', 1)
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    data.qpos[:] = angles
    mujoco.mj_kinematics(model, data)
    builder = newton.ModelBuilder()
    builder.add_mjcf(text, verbose=True)
    model = builder.finalize(device='cpu')
    state = model.state()
    model.joint_q.assign(angles)
    newton.eval_fk(model, model.joint_q, model.joint_qd, state)
    return data.xpos[-1], state.body_q.numpy()[-1][:3]


TURNED = 0, np.pi / 2
for first, second, own, angles, right, found in (
    (0, 0.1, False, TURNED, (0.1, -0.1, 0), (0, 0, 0)),
    (0, 0.1, True, TURNED, (0.1, -0.1, 0), (0.1, -0.1, 0)),
    (0.1, 0.1, False, TURNED, (0.1, -0.1, 0), (0.1, -0.1, 0)),
    (0.1, 0, False, TURNED, (0, 0, 0), (0.1, -0.1, 0)),
    (0.1, 0, False, (np.pi / 2, 0), (0.1, 0, 0.1), (0.1, 0, 0.1)),
):
    expected, other = pose(first, second, own, angles)
    print(f'anchors at {first} and {second} m, bodies of their own: {own}, tilt {np.rad2deg(angles[0]):.0f}°, turn '
          f'{np.rad2deg(angles[1]):.0f}°: MuJoCo {np.round(expected, 3) + 0}, Newton {np.round(other, 3) + 0}')
    assert np.allclose(expected, right, atol=1e-4) and np.allclose(other, found, atol=1e-4)
PYTHON
export OMP_NUM_THREADS=1 WARP_CACHE_PATH="$folder/cache"
timeout 580 "$folder/venv/bin/python" "$folder/anchors.py" > "$folder/log" 2>&1 || { cat "$folder/log"; exit 1; }
grep MuJoCo "$folder/log"
if grep -i warning "$folder/log" | grep -vi cuda; then exit 1; fi
