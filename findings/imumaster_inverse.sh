#!/usr/bin/env bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# imumaster 0.0.2: the inverse of a turn by 90° about x, in the order of ROS, is a turn by -90° about z.
#
# Expected of Quaternion(False, [x, y, z, w]).inv, "the inverse of the quaternion": the opposite turn, so that the
# product of both is the quaternion 0, 0, 0, 1. For 90° about x, which is 0.707, 0, 0, 0.707, that is -0.707, 0, 0,
# 0.707. What happens: 0, 0, -0.707, 0.707, as the four numbers are put in the opposite order; the product is a turn by
# 120°. conj of the same object and the static inverse(scalar_first=False) are right, and inv with scalar_first=True is.
# For us: take conj of a quaternion of length 1, or the static inverse().
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check imumaster==0.0.2 numpy==2.4.6
cd "$folder"
timeout 60 venv/bin/python - <<'PYTHON'
import numpy as np
from imumaster.math import Quaternion

half = np.sqrt(0.5)
turn = Quaternion(False, [half, 0.0, 0.0, half])
left = Quaternion.multiply(turn.value, turn.inv, scalar_first=False)
print('turn', turn.value, 'inverse', turn.inv, 'product', left, np.degrees(2 * np.arccos(left[3])), '°')
assert np.allclose(turn.inv, [0, 0, -half, half])
assert abs(np.degrees(2 * np.arccos(left[3])) - 120) < 1e-6
assert np.allclose(turn.conj, [-half, 0, 0, half])
assert np.allclose(Quaternion.inverse(turn.value, scalar_first=False), [-half, 0, 0, half])
assert np.allclose(Quaternion(True, [half, half, 0.0, 0.0]).inv, [half, -half, 0, 0])
PYTHON
