#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# MuJoCo 4.0.0: a model that is saved as XML has numbers of six digits, and so another gear ratio.
#
# Two joints are coupled by the ratio -1/19. mj_saveLastXML and MjSpec.to_xml write -0.0526316, and 1.23457 for a
# position of 1.23456789 m. After 1000 turns of the motor the output of the saved model is 0.45′ from that of the
# original. A binary model, by mj_saveModel, keeps all digits.
# For us: change the file of `gearkin mjcf` by its options or in an editor, not by loading and saving it.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check mujoco==4.0.0
cd "$folder"
venv/bin/python - <<'PYTHON'
import math

import mujoco

RATIO = -1 / 19
spec = mujoco.MjSpec.from_string(f"""<mujoco><worldbody>
<body><joint name="motor"/><geom size="0.1"/></body>
<body pos="1.23456789 0 0"><joint name="output"/><geom size="0.1"/></body>
</worldbody><equality><joint joint1="output" joint2="motor" polycoef="0 {RATIO!r} 0 0 0"/></equality></mujoco>""")
model = spec.compile()
mujoco.mj_saveModel(model, 'model.mjb')
models = {
    'original': model,
    'to_xml': mujoco.MjModel.from_xml_string(spec.to_xml()),
    'mj_saveModel': mujoco.MjModel.from_binary_path('model.mjb'),
}
for name, each in models.items():
    angle = math.degrees(1000 * math.tau * (each.eq_data[0][1] - RATIO)) * 60
    print(f"{name}: {angle:.4f}' after 1000 turns, position {each.body_pos[2][0]!r}")
    assert abs(angle + (0.4547 if name == 'to_xml' else 0.0)) < 1e-3
assert models['to_xml'].body_pos[2][0] == 1.23457
PYTHON
