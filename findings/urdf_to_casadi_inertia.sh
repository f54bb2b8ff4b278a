#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# urdf-to-casadi 0.1.1: a shaft whose inertia in a URDF is given in turned axes has 400 times its inertia.
#
# The shaft has 0.01 kg·m² about its long axis, which is z of its <inertial> and, by rpy="0 1.5708 0" of the <origin> of
# it, the axis x of the joint. Expected: an inertia of 0.01 kg·m² at the joint, as in MuJoCo 4.0.0. What happens: it is
# 4 kg·m², as rpy is left out. A joint without an <origin>, which a URDF may leave out, is an AttributeError, and so is
# each call of get_friction_matrices().
# For us: turn the inertias into the axes of their links before; CAD exporters often give their principal axes.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check \
    urdf-to-casadi==0.1.1 casadi==3.8.2 mujoco==4.0.0 numpy==2.4.6
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import mujoco
import numpy as np
from urdf_to_casadi.urdfparser import URDFparser

URDF = """
<robot name="gear">
  <link name="stator"/>
  <link name="shaft"><inertial><origin xyz="0 0 0" rpy="0 1.5707963267948966 0"/><mass value="1"/>
    <inertia ixx="4" iyy="4" izz=".01" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="joint" type="revolute"><parent link="stator"/><child link="shaft"/>{}<axis xyz="1 0 0"/>
    <limit lower="-3" upper="3" effort="90" velocity="2"/><dynamics damping="0.1" friction="0.2"/></joint>
</robot>"""
ORIGIN = '<origin xyz="0 0 0" rpy="0 0 0"/>'


def parser_of(origin):
    parser = URDFparser(func_opts={})
    parser.from_string(URDF.format(origin))
    return parser


def is_attribute_error(call):
    try:
        call('stator', 'shaft')
    except AttributeError as error:
        print(error)
        return True
    return False


inertia = float(parser_of(ORIGIN).get_inertia_matrix_crba('stator', 'shaft')(np.zeros(1)))
model = mujoco.MjModel.from_xml_string(URDF.format(ORIGIN))
data, right = mujoco.MjData(model), np.zeros((1, 1))
mujoco.mj_forward(model, data)
mujoco.mj_fullM(model, data, right)
print('inertia', inertia, 'MuJoCo', right)
assert abs(inertia - 4) < 1e-9
assert abs(right[0, 0] - 0.01) < 1e-6
assert is_attribute_error(parser_of('').get_inertia_matrix_crba)
assert is_attribute_error(parser_of(ORIGIN).get_friction_matrices)
PYTHON
