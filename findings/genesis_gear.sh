#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# genesis-world 1.4.5: behind a gear of 20, an MJCF's servo has a twentieth of its stiffness and damping at the joint,
# and a motor with a limit of 1 N·m gives the joint 1 N·m instead of 20 N·m.
#
# A gear of MuJoCo acts twice on a servo: the motor's angle is 20 times that of the joint, and the joint's torque 20
# times that of the motor. Expected of a position actuator with kp="1" and kv="0.1": a stiffness of 400 N·m/rad and a
# damping of 40 N·m·s/rad at the joint, which MuJoCo 4.0.0 has. What happens: Genesis, which reads the model by MuJoCo,
# multiplies the gain, the stiffness and the damping by 20 once: the joint has 20 N·m/rad and 2 N·m·s/rad. A goal is
# one of the joint, so that the goal of 20 rad, which brings the joint to 1 rad in MuJoCo, brings it to 20 rad. Of the
# limits of a motor, ctrlrange is rightly multiplied by the gear, but forcerange, also a limit of the motor, is not.
# There is no warning. With a gear of 1 all of this is right.
# For us: give Genesis a gear of 1, kp and kv times the square of the gear, and limits and goals of the joint.
#
# Exit code 0: still so. Installs the packages into a temporary folder, without torch, which the reader of MJCF does not
# use: a stand-in takes the place of each package that is missing. The numbers that are read are those of the engine,
# which gives a joint gain·goal + bias0 + bias1·angle + bias2·speed, within force_range.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --no-compile --disable-pip-version-check mujoco==4.0.0 numpy==2.4.6 \
  scipy==1.17.1 numba==0.68.1 pydantic==2.14.4 trimesh==5.2.0 lxml==6.1.3 networkx==3.6.1 pillow==11.3.0 psutil==7.2.2 \
  frozendict==2.5.1
"$folder/venv/bin/pip" install --quiet --no-compile --disable-pip-version-check --no-deps genesis-world==1.4.5
cat > "$folder/gear.py" <<'PYTHON'
import importlib.machinery
import sys
import types
from unittest.mock import MagicMock

MISSING = """torch quadrants cpuinfo pyglet pygel3d coacd igl Imath OpenEXR tetgen xacro DracoPy pygltflib z3
    fast_simplification skimage matplotlib av zstandard freetype""".split()


class StandIn:
    """Finds an empty module for each package that is not installed."""

    def find_spec(self, name, path=None, target=None):
        known = name.split('.')[0] in MISSING
        return importlib.machinery.ModuleSpec(name, self, is_package=True) if known else None

    def create_module(self, spec):
        module = MagicMock()
        module.__path__, module.__spec__, module.__name__, module.__version__ = [], spec, spec.name, '2.9.0'
        module.torch_version = types.SimpleNamespace(TorchVersion=lambda text: tuple(map(int, text.split('.'))))
        module.Tensor = type('Tensor', (), {})
        return module

    def exec_module(self, module):
        """Leave the module empty."""


sys.meta_path.append(StandIn())
import genesis
import mujoco
import numpy as np
from genesis.utils import mjcf

genesis.np_float = np.float64
MJCF = """<mujoco><worldbody><body><joint name="joint" axis="0 0 1"/>
  <inertial pos="0 0 0" mass="1" diaginertia="1 1 1"/></body></worldbody><actuator>{}</actuator></mujoco>"""


def torques(actuator, goal, angle=0.0, speed=0.0):
    """The torque at the joint in MuJoCo, and that of what Genesis reads of the same model, in N·m."""
    model = mujoco.MjModel.from_xml_string(MJCF.format(actuator))
    data = mujoco.MjData(model)
    data.ctrl[0], data.qpos[0], data.qvel[0] = goal, angle, speed
    mujoco.mj_forward(model, data)
    joint = mjcf.parse_link(model, 1, 1.0)[1][0]
    bias = joint['dofs_act_bias'][0] @ (1.0, angle, speed)
    return data.qfrc_actuator[0], np.clip(joint['dofs_act_gain'][0] * goal + bias, *joint['dofs_force_range'][0])


SERVO = '<position joint="joint" gear="{}" kp="{}" kv="{}"/>'
for name, found, expected in (
    ('servo at its goal', torques(SERVO.format(20, 1, 0.1), 20.0, 1.0), (0, 380)),
    ('servo, with the joint at 20 rad', torques(SERVO.format(20, 1, 0.1), 20.0, 20.0), (-7600, 0)),
    ('servo, for its damping, at 1 rad/s', torques(SERVO.format(20, 1, 0.1), 0.0, 0.0, 1.0), (-40, -2)),
    ('servo at its goal, gear of 1', torques(SERVO.format(1, 400, 40), 1.0, 1.0, 1.0), (-40, -40)),
    ('motor, ctrlrange', torques('<motor joint="joint" gear="20" ctrlrange="-1 1"/>', 1.0), (20, 20)),
    ('motor, forcerange', torques('<motor joint="joint" gear="20" forcerange="-1 1"/>', 1.0), (20, 1)),
    ('motor, forcerange, gear of 1', torques('<motor joint="joint" forcerange="-1 1"/>', 2.0), (1, 1)),
):
    print(f'{name}: MuJoCo {found[0]:.6g} N·m, Genesis {found[1]:.6g} N·m')
    assert np.allclose(found, expected)
PYTHON
timeout 200 "$folder/venv/bin/python" -W ignore "$folder/gear.py"
