#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# MuJoCo 4.0.0: an arm that stands at its goal of 1 rad is drawn to 0.14 rad first if the rate of its goal is limited.
#
# The actuators pid and dcmotor have slewmax, the greatest rate at which their goal may change. An arm stands at 1 rad,
# set by qpos or by a keyframe, and its goal is 1 rad as well. Expected with slewmax of 0.5 rad/s: it stays there, as
# without slewmax. What happens: the limited goal is a state that begins at 0 with each reset, wherever the joint is, so
# that the arm is thrown back towards 0 with the whole gain, down to 0.14 rad, and then comes to 1 rad at 0.5 rad/s. The
# documentation says that the state holds "the effective setpoint", not where it begins. Behind a gear of 20 it is the
# same. With data.act at the angle of the rotor, or with act in the keyframe, the arm stays at 1 rad.
# For us: after each reset, set data.act of such an actuator to its length, data.actuator_length after mj_forward().
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check mujoco==4.0.0
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import mujoco

MODEL = """
<mujoco>
  <option gravity="0 0 0" timestep="0.001" integrator="implicitfast"/>
  <worldbody><body>
    <joint name="arm" axis="0 0 1"/><inertial pos="0 0 0" mass="1" diaginertia="0.01 0.01 0.01"/>
  </body></worldbody>
  <actuator>{actuator}</actuator>
  <keyframe><key qpos="1" ctrl="{goal}"/></keyframe>
</mujoco>"""
PID = '<pid joint="arm" input="pos" kp="{gain}" kv="{damping}" gear="{gear}" {slew}/>'
MOTOR = """<dcmotor joint="arm" motorconst="0.5" resistance="1" input="pos" gear="{gear}"
    controller="{gain} 0 {damping} {slew}"/>"""


def least(actuator, slew, gear=1, at_rotor=False):
    """Return the least angle of the arm within 3 s, in rad, and its angle after them."""
    text = actuator.format(gear=gear, gain=10 / gear**2, damping=1 / gear**2, slew=slew)
    model = mujoco.MjModel.from_xml_string(MODEL.format(actuator=text, goal=gear))
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    if at_rotor:
        mujoco.mj_forward(model, data)
        data.act[:] = data.actuator_length
    angles = []
    while data.time < 3:
        mujoco.mj_step(model, data)
        angles.append(float(data.qpos[0]))
    print(text.split()[0], 'slewmax', slew or 0, 'gear', gear, 'least angle', min(angles), 'last', angles[-1], 'rad')
    return min(angles), angles[-1]


for actuator, none, limited in ((PID, '', 'slewmax="{}"'), (MOTOR, 0, '{}')):
    assert min(least(actuator, none)) > 0.999
    lowest, last = least(actuator, limited.format(0.5))
    assert 0.1 < lowest < 0.2 and abs(last - 1) < 0.01
    lowest, last = least(actuator, limited.format(20 * 0.5), gear=20)
    assert 0.1 < lowest < 0.2 and abs(last - 1) < 0.01
    assert min(least(actuator, limited.format(0.5), at_rotor=True)) > 0.999
PYTHON
