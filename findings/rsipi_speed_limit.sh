#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# RSIPI 0.3.0: a joint of a KUKA whose speed is limited to 10°/s turns at 25°/s or 100°/s, where its waypoints are few.
#
# Expected of generate_velocity_profile() and execute_profiled_trajectory(): "profiles that respect velocity and
# acceleration limits", however many waypoints a straight move has. What happens: no segment between two waypoints lasts
# longer than 1 s, and none shorter than one cycle of 4 ms. A turn of 100° at a limit of 10°/s therefore goes at 100°/s
# from one segment, at 25°/s from four, and at 10°/s from ten. From a thousand segments with limits of 100°/s and
# 100°/s² it takes 4.2 s instead of 2 s. The limit of acceleration has no effect on the profile 's-curve' at all: it is
# the same for 1 and for 1000°/s². A client that keeps what is sent in each cycle stands in for the robot.
# For us: give a waypoint for each degree or so, at most as many as the move has cycles, and look at the corrections
# first.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check RSIPI==0.3.0
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import numpy
from RSIPI.motion_api import MotionAPI


class Robot:
    rsi_mode, cycle_time = 'absolute', 0.004

    def __init__(self):
        self.send_variables = {'ASPos': {'A1': 0.0}, 'AIPos': {'A1': 0.0}}
        self.receive_variables = {'AKorr': {'A1': 0.0}}
        self.angles = [0.0]

    def publish_corrections(self, corrections):
        self.angles.append(corrections['AKorr']['A1'])
        return len(self.angles)

    def wait_correction_applied(self, sequence):
        return True


def turn(segments, speed, acceleration, profile='trapezoidal'):
    robot = Robot()
    motion = MotionAPI(robot)
    points = [{'A1': 100.0 * k / segments} for k in range(segments + 1)]
    motion.execute_profiled_trajectory(
        motion.generate_velocity_profile(points, speed, acceleration, profile), space='joint')
    speeds = numpy.diff(robot.angles) / robot.cycle_time
    seconds = (len(robot.angles) - 1) * robot.cycle_time
    print(f'{segments} segments, {speed}°/s, {acceleration}°/s², {profile}: {speeds.max():.1f}°/s, {seconds:.2f} s')
    return speeds.max(), seconds


fastest = [turn(segments, 10.0, 20.0)[0] for segments in (1, 4, 10)]
assert numpy.allclose(fastest, [100.0, 25.0, 10.0]), fastest
speed, seconds = turn(1000, 100.0, 100.0)
assert speed < 26.0 and 4.0 < seconds < 4.5, (speed, seconds)
assert turn(100, 10.0, 1.0, 's-curve') == turn(100, 10.0, 1000.0, 's-curve')
PYTHON
