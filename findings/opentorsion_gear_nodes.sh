#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# openTorsion 0.3.2: behind a gear, a torque acts one node further on than where it is given.
#
# A pinion at node 1 drives a wheel at node 2, 20 times as large, whose shaft leads to a disk at node 3. Slowly
# alternating, 1 N·m at the wheel should twist the shaft behind it by nothing, and that before the pinion by 0.05 N·m.
# An excitation for the four nodes is refused, because the matrices have three rows. One of three rows is accepted, and
# 1 N·m at node 2 twists the shaft behind the wheel by 1 N·m: each gear pair removes a node, and the nodes behind it
# move up.
# For us: give the excitation for all nodes, and multiply it by the transpose of `T(E())` of the assembly.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check opentorsion==0.3.2
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import numpy as np
from opentorsion import Assembly, Disk, Gear, PeriodicExcitation, Shaft

pinion = Gear(1, I=1e-3, R=10)
wheel = Gear(2, I=1e-3, R=200, parent=pinion)
shafts, disks = [Shaft(0, 1, k=1e3), Shaft(2, 3, k=1e5)], [Disk(0, 1e9), Disk(3, 0.1)]
assembly = Assembly(shafts, disks, [pinion, wheel])


def excitation(nodes, node):
    made = PeriodicExcitation(nodes, [1.0])
    made.add_sines(node, [1.0], [1.0], [0.0])
    return made


def torques(made):
    before, behind = assembly.vibratory_torque(made)[1]
    print('shaft before the pinion', before, 'behind the wheel', behind, 'N·m')
    return before, behind


assert (assembly.dofs, len(assembly.M)) == (4, 3)
try:
    torques(excitation(4, 2))
except ValueError as error:
    print(error)
else:
    raise SystemExit('an excitation of four nodes is accepted')
assert np.allclose(torques(excitation(3, 2)), (0.05, 1), atol=1e-4)
right = excitation(4, 2)
right.U = assembly.T(assembly.E()).T @ right.U
assert np.allclose(torques(right), (0.05, 0), atol=1e-4)
PYTHON
