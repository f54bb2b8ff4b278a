#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# acrome-joint 0.0.2: where a time is given for a turn, it is planned with 20 rad/s², although the limit is 1 rad/s².
#
# Ramp(vmax=1, amax=1), by which the library's program moves a joint, is to plan a turn of 0.2 rad in 0.25 s, which is
# too short. Expected: a turn that keeps both limits and takes longer, as it does where the speed does not allow the
# time (1 rad in 0.5 s takes 2 s). What happens: where only the acceleration does not allow it, the time is kept and
# the limit is not, although an acceleration of 1 rad/s² is given as well. With a time of 0.5 s it is 3.2 rad/s².
# For us: give no time to plan(), or one of at least 2 * sqrt(angle / acceleration).
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check --no-deps acrome-joint==0.0.2
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
from gui.ramp_trajectory import Ramp


def planned(angle, time):
    """The duration and the greatest acceleration of a planned turn, from its angles each millisecond."""
    ramp = Ramp(dt=1e-3, vmax=1.0, amax=1.0)
    ramp.plan(0.0, angle, t_des=time, a_des=1.0)
    angles = [ramp.step() for _ in range(3000)]
    assert abs(angles[-1] - angle) < 1e-9
    seconds = zip(angles, angles[1:], angles[2:], strict=False)
    greatest = max(abs(after - 2 * now + before) for before, now, after in seconds) / 1e-6
    return round(ramp.tp, 3), round(greatest, 2)


found = {case: planned(*case) for case in ((0.2, 0.0), (0.2, 0.5), (0.2, 0.25), (1.0, 0.5))}
for (angle, time), (duration, greatest) in found.items():
    print(f'{angle} rad in {time} s: takes {duration} s with {greatest} rad/s²')
assert found == {(0.2, 0.0): (0.894, 1.0), (0.2, 0.5): (0.5, 3.2), (0.2, 0.25): (0.25, 20.0), (1.0, 0.5): (2.0, 1.0)}
PYTHON
