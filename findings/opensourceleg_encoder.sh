#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# opensourceleg 3.5.0: a joint whose angle is read three times turns by two turns, and at a wrap it has -1255 rad/s.
#
# Expected: abs_ang of an AS5048B is the angle with its turns, as often as it is read. What happens: the property
# counts a turn when it is read, so that behind the wrap at half a turn each further reading before the next update()
# adds 2π. velocity takes the difference of the counts from 0 to 16383 without their wrap, so that 2 rad/s over the
# zero are -1255 rad/s at 200 Hz. A bus answers here as an AS5048B does.
# For us: read `position`, which is right within a turn, once after each update, and let gearkin count the turns.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check opensourceleg==3.5.0 python-can==4.6.1 smbus2==0.6.1
cd "$folder"
timeout 60 venv/bin/python - 2> log <<'PYTHON'
import math

from opensourceleg.sensors import encoder


class Bus:
    counts = 0

    def __init__(self, path):
        pass

    def read_i2c_block_data(self, address, register, length):
        return [0, 1, 0, 0, self.counts >> 6, self.counts & 63] if register == 0xFA else [0, 0]

    def close(self):
        pass


nanoseconds = 0
encoder.SMBus = Bus
encoder.time.monotonic_ns = lambda: nanoseconds
joint = encoder.AS5048B()
joint.start()


def turned_to(counts):
    global nanoseconds
    nanoseconds += 5_000_000
    Bus.counts = counts % 16384
    joint.update()


for counts in (16370, 16374):
    turned_to(counts)
before = joint.velocity
turned_to(16400)
across = joint.velocity
for counts in (24500, 24700):
    turned_to(counts)
angles = [joint.abs_ang for _ in range(3)]
print('velocity', before, across, 'rad/s; angles', angles, 'of', 24700 % 16384 * math.tau / 16384)
assert abs(before - 4 * math.tau / 16384 / 0.005) < 1e-6
assert abs(across - (16 - 16374) * math.tau / 16384 / 0.005) < 1e-6
assert [round((angle - angles[0]) / math.tau) for angle in angles] == [0, 1, 2]
PYTHON
