#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# Brax 0.14.2: of an MJCF, a gear ratio and a friction have no effect in any pipeline, an armature and a damping in one
# alone.
#
# A motor gives 0.01 N·m to a rotor of 0.01 kg·m². Expected after a second, as in MuJoCo 4.0.0: 0.5 rad/s with an output
# of 4 kg·m² on a joint equality of -0.05, with a friction of 0.005 N·m, or with an armature of 0.01 kg·m²; 0.632 rad/s
# with a damping of 0.01. What happens: 1 rad/s with equality and friction in the pipelines generalized, positional and
# spring, without a warning about them, though other elements are refused with an error. Armature and damping are right
# in generalized, and have no effect in the other two. Their angle jumps from half a turn to minus half a turn.
# For us: simulate a gear with MuJoCo's own MJX, which is right in each case.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check brax==0.14.2 mujoco==4.0.0 jax==0.10.2 numpy==2.4.6
cat > "$folder/gear.py" <<'PYTHON'
import math

import jax
import mujoco
from brax.generalized import pipeline as generalized
from brax.io import mjcf
from brax.positional import pipeline as positional
from brax.spring import pipeline as spring

MJCF = '''
<mujoco>
  <option gravity="0 0 0" timestep="0.002"/>
  <worldbody>
    <body><joint name="motor" axis="0 0 1" {}/><inertial pos="0 0 0" mass="1" diaginertia=".01 .01 .01"/>
      <geom size=".1" contype="0" conaffinity="0"/></body>
    <body pos="1 0 0"><joint name="output" axis="0 0 1"/><inertial pos="0 0 0" mass="1" diaginertia="4 4 4"/>
      <geom size=".1" contype="0" conaffinity="0"/></body>
  </worldbody>
  {}
  <actuator><motor joint="motor" gear="{}"/></actuator>
</mujoco>'''
EQUALITY = '<equality><joint joint1="output" joint2="motor" polycoef="0 -0.05 0 0 0"/></equality>'
PIPELINES = generalized, positional, spring


def in_mujoco(text):
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    data.ctrl[0] = 0.01
    mujoco.mj_step(model, data, 500)
    return data.qpos[0], data.qvel[0]


def in_brax(text, pipeline):
    system = mjcf.loads(text)
    state = pipeline.init(system, system.init_q, jax.numpy.zeros(system.qd_size()))
    control = jax.numpy.array([0.01])
    state, _ = jax.lax.scan(lambda now, _: (pipeline.step(system, now, control), None), state, None, length=500)
    return float(state.q[0]), float(state.qd[0])


for name, text, right, found in (
    ('equality', MJCF.format('', EQUALITY, 1), 0.5, (1, 1, 1)),
    ('friction', MJCF.format('frictionloss="0.005"', '', 1), 0.5, (1, 1, 1)),
    ('armature', MJCF.format('armature="0.01"', '', 1), 0.5, (0.5, 1, 1)),
    ('damping', MJCF.format('damping="0.01"', '', 1), 1 - math.exp(-1), (1 - math.exp(-1), 1, 1)),
):
    speeds = [in_brax(text, pipeline)[1] for pipeline in PIPELINES]
    reference = in_mujoco(text)[1]
    print(name, 'MuJoCo', round(reference, 4), 'Brax', [round(speed, 4) for speed in speeds], 'rad/s')
    assert abs(reference - right) < 0.01
    assert all(abs(speed - expected) < 0.01 for speed, expected in zip(speeds, found, strict=True))
text = MJCF.format('', '', 10)
angles = [in_brax(text, pipeline)[0] for pipeline in PIPELINES]
print('angle after 5 rad: MuJoCo', in_mujoco(text)[0], 'Brax', angles)
assert abs(in_mujoco(text)[0] - 5) < 0.02 and abs(angles[0] - 5) < 0.02
assert all(abs(angle - (5 - 2 * math.pi)) < 0.1 for angle in angles[1:])
PYTHON
timeout 300 "$folder/venv/bin/python" "$folder/gear.py" 2> "$folder/log" || { cat "$folder/log"; exit 1; }
if grep -iE 'equality|friction|armature|damping' "$folder/log"; then exit 1; fi
