#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# robokinematics 1.0.2: an arm of 500 mm whose parameters are named in another order has 0 mm and stands 500 mm high,
# without an error.
#
# A link is given by name: frame_name, joint_type, link_length, twist, offset and theta. Expected: the order of the
# names does not matter; at 30° the tip is at (0.433, 0.25, 0.1) m. What happens: the names are checked, but the values
# are taken by their place. With the order theta, offset, link_length, twist, the tip is at (0, 0, 0.5) m, tilted by
# 0.1°, as the 0.1 m of the offset are taken as the twist.
# For us: name the parameters in exactly the order above.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check robokinematics==1.0.2 numpy==2.4.6 scipy==1.17.1
cd "$folder"
export MPLBACKEND=Agg
timeout 90 venv/bin/python - <<'PYTHON'
import numpy as np
from RoboKinematics.src.RoboKinematics import CreateKinematicModel

VALUES = {'frame_name': 'tip', 'joint_type': 'r', 'link_length': 0.5, 'twist': 0.0, 'offset': 0.1, 'theta': 0.0}
OTHER = ('frame_name', 'joint_type', 'theta', 'offset', 'link_length', 'twist')


def tip(order):
    arm = CreateKinematicModel([{name: VALUES[name] for name in order}], 'arm')
    pose = np.array(arm.f_kin([30.0])[0], float)
    print(order, 'tip at', pose[:3, 3], 'tilted by', np.degrees(np.arccos(pose[2, 2])), '°')
    return pose


assert np.allclose(tip(tuple(VALUES))[:3, 3], [0.5 * np.cos(np.pi / 6), 0.25, 0.1])
other = tip(OTHER)
assert np.allclose(other[:3, 3], [0, 0, 0.5], atol=1e-3)
assert abs(np.degrees(np.arccos(other[2, 2])) - 0.1) < 1e-3
PYTHON
