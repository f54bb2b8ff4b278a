#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# jaxsim 0.9.0: a rotor that turns at 120 rad/s can neither be driven nor braked, and the dissipation of a joint's upper
# stop drives the joint instead of damping it.
#
# A rotor in an SDFormat file has a damping of 0.01 N·m·s/rad and is braked with 0.1 N·m. Expected of all torques at 90
# and 120 rad/s: -1.0 and -1.3 N·m. What happens: -1.0 N·m and 0, as the sum of all torques is 0 beyond 100 rad/s, a
# default of the model that the file does not have. A stop with 100 N·m/rad and a dissipation is entered by 0.01 rad at
# 1 rad/s. Expected: more than 1 N·m on the way in, and less on the way out. What happens: at the lower stop 1.5 and 0.5
# N·m, at the upper one 0.5 and 1.5 N·m, so that a joint leaves it faster than it came. A stop whose stiffness is left
# out is none, where that of SDFormat is 1e8, and a limit of the effort of 0.5 N·m lets 2 N·m pass.
# For us: give the model ActuationParams(torque_max, omega_th, omega_max) of the motor, and stops without dissipation.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check jaxsim==0.9.0 rod==0.5.0 jax==0.10.2 numpy==2.4.6
cat > "$folder/rotor.py" <<'PYTHON'
import jax
import jax.numpy as jnp
import jaxsim.api as js
from jaxsim.api.actuation_model import compute_resultant_torques
from jaxsim.rbda.actuation import ActuationParams

jax.config.update('jax_enable_x64', True)
SDF = """<sdf version="1.10"><model name="motor">
  <link name="stator"><inertial><mass>1</mass>
    <inertia><ixx>1</ixx><iyy>1</iyy><izz>1</izz></inertia></inertial></link>
  <link name="rotor"><inertial><mass>1</mass>
    <inertia><ixx>0.01</ixx><iyy>0.01</iyy><izz>0.01</izz></inertia></inertial></link>
  <joint name="ground" type="fixed"><parent>world</parent><child>stator</child></joint>
  <joint name="shaft" type="revolute"><parent>stator</parent><child>rotor</child>
    <axis><xyz>0 0 1</xyz><limit>{}</limit><dynamics><damping>{}</damping>
    <spring_reference>0</spring_reference><spring_stiffness>0</spring_stiffness></dynamics></axis></joint>
</model></sdf>"""
FREE = '<lower>-1e9</lower><upper>1e9</upper><effort>0.5</effort>'
STOPS = '<lower>-0.01</lower><upper>0.01</upper>'
DAMPED = STOPS + '<stiffness>100</stiffness><dissipation>0.5</dissipation>'


def built(limit, damping, **parameters):
    """A model, and its data at an angle in rad and a speed in rad/s."""
    model = js.model.JaxSimModel.build_from_model_description(
        SDF.format(limit, damping), time_step=1e-4, gravity=0.0, **parameters
    )
    return model, lambda angle, speed: js.data.JaxSimModelData.build(
        model, joint_positions=jnp.array([angle]), joint_velocities=jnp.array([speed])
    )


def torque(made, angle, speed, reference=0.0):
    model, data = made
    return float(compute_resultant_torques(model, data(angle, speed), joint_force_references=jnp.array([reference]))[0])


def check(name, found, expected):
    print(name, round(found, 3))
    assert abs(found - expected) < 0.02 * max(1, abs(expected))


fast = ActuationParams(torque_max=10.0, omega_th=500.0, omega_max=600.0)
usual, faster = built(FREE, 0.01), built(FREE, 0.01, actuation_params=fast)
check('-0.1 N·m less a damping of 0.01 at 90 rad/s, N·m', torque(usual, 0.0, 90.0, -0.1), -1.0)
check('-0.1 N·m less a damping of 0.01 at 120 rad/s, N·m', torque(usual, 0.0, 120.0, -0.1), 0.0)
check('the same with a motor of 600 rad/s, N·m', torque(faster, 0.0, 120.0, -0.1), -1.3)
check('2 N·m with an effort of 0.5 N·m becomes N·m', torque(usual, 0.0, 0.0, 2.0), 2.0)
check('0.01 rad beyond a stop without stiffness, N·m', torque(built(STOPS, 0.0), 0.02, 0.0), 0.0)
stopped = built(DAMPED, 0.0)
for side, angle, inwards, outwards in ('upper', 0.02, -0.5, -1.5), ('lower', -0.02, 1.5, 0.5):
    into, back = (1.0, -1.0) if side == 'upper' else (-1.0, 1.0)
    check(f'{side} stop, as the joint goes in at 1 rad/s, N·m', torque(stopped, angle, into), inwards)
    check(f'{side} stop, as it comes back at 1 rad/s, N·m', torque(stopped, angle, back), outwards)
PYTHON
timeout 250 "$folder/venv/bin/python" -W ignore "$folder/rotor.py"
