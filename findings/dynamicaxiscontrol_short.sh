#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# DynamicAxisControl 1.0.2: a move of 100 mm goes to 50 mm and back to 33 mm, and its motor is given 40 000 turns/s
# instead of 25.
#
# With 1 m/s and 1 m/s² a move needs 1000 mm to reach its speed. Expected of SyncLinearAxes() and LinearMotion(): a
# shorter one ends where it is to end, with a lower speed in its middle. What happens: it brakes after a quarter of its
# way, but for as long as if it had reached the middle, turns round at 50 % and ends at 33 % of its way, moving back at
# 0.19 m/s. The time is right, and so is a long move, and the shorter axis of SyncLinearAxes(). Both take metres for the
# speeds and mm for the ways. The speed of the motor in turns, at 40 mm a turn, is multiplied by 40 by SyncLinearAxes(),
# instead of divided.
# For us: take only the times, or use ruckig.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check DynamicAxisControl==1.0.2 scipy==1.17.1 matplotlib==3.11.2
cd "$folder"
MPLBACKEND=Agg timeout 100 "$folder/venv/bin/python" - <<'PYTHON'
import contextlib
import io

from DynamicAxisControl.DynamicAxisControl import ProfileGenerator

SPEED, ACCELERATION, MM_PER_TURN = 1.0, 1.0, 40


def planned(method, way, other):
    generator = ProfileGenerator(ACCELERATION, SPEED, ACCELERATION, SPEED, MM_PER_TURN, 1)
    with contextlib.redirect_stdout(io.StringIO()):
        plan = getattr(generator, method)(0, 0, way, other, Graph=False)
    position, time = plan['XAxisPositionTrajectory'], plan['XAxisTimeTrajectory']
    velocity = (position[-1] - position[-2]) / (time[-1] - time[-2])
    print(f'{method} {way} mm: greatest {max(position):.2f} mm, end {position[-1]:.2f} mm at {velocity:.0f} mm/s after {time[-1]:.3f} s')
    return max(position), position[-1], velocity, time[-1], plan['AxisXMaxSpeed_Revolution']


for method in ('SyncLinearAxes', 'LinearMotion'):
    greatest, end, velocity, duration, _ = planned(method, 100, 50)
    assert abs(greatest - 50) < 0.1 and abs(end - 32.84) < 0.1 and abs(velocity + 185) < 50
    assert abs(duration - 2 * 0.1**0.5) < 1e-6
    assert abs(planned(method, 1200, 600)[1] - 1200) < 1e-6
turns = planned('SyncLinearAxes', 1200, 600)[4]
print('greatest speed of the motor', turns, 'instead of', 1000 * SPEED / MM_PER_TURN, 'turns/s')
assert turns == 40000
PYTHON
