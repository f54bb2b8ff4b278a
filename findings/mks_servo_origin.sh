#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# mks-servo 1.0.0: a stepper that is to stay at its soft origin of 90° turns by -180°, and one that is to turn by 1° by
# -179°.
#
# set_origin(soft=True) keeps the encoder's counts as the zero without writing to the drive. Expected: read() is 0
# there, and write(0) leaves the motor where it is. What happens: read() subtracts the counts of the origin, and write()
# subtracts them too instead of adding them, so that the shaft turns back by twice the origin. move_relative() does the
# same, and limits of ±5° do not stop it, as they are compared with the angle that was asked for. set_origin() without
# soft is right, since the origin is then 0. A bus answers here as a drive does that is at its goal at once.
# For us: use set_origin() without soft=True, and keep an offset of your own in degrees.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check mks-servo==1.0.0
cd "$folder"
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
from mks_servo.motor import Motor
from mks_servo.profile import DriverSection, Profile
from mks_servo.raw import RawDriver

COUNTS = 16384


class Bus:
    """Answer as a drive that stands at 90° and reaches each goal at once."""

    _ser = object()
    counts = COUNTS // 4

    def transact(self, addr, code, data=b'', **_):
        if code == 0xF5:
            self.counts = int.from_bytes(data[3:], 'big', signed=True)
        if code == 0x31:
            return addr, code, self.counts.to_bytes(6, 'big', signed=True)
        return addr, code, b'\x01'


def moved(soft, move):
    bus = Bus()
    profile = Profile(id='joint', driver=DriverSection())
    profile.limits.position.min_deg, profile.limits.position.max_deg = -5.0, 5.0
    motor = Motor(profile, raw=RawDriver(transport=bus))
    motor.attach()
    motor.set_origin(soft=soft)
    if not soft:
        bus.counts = 0
    start, before = motor.read(), bus.counts
    move(motor)
    return start, (bus.counts - before) * 360 / COUNTS, motor.read()


for name, move, turned in (('write(0)', lambda m: m.write(0), 0), ('move_relative(1)', lambda m: m.move_relative(1), 1)):
    hard, soft = moved(False, move), moved(True, move)
    print(f'{name}: read before, turned by, read after, in degrees: origin in the drive {hard}, soft origin {soft}')
    assert hard[0] == soft[0] == 0
    assert abs(hard[1] - turned) < 0.03
    assert abs(soft[1] - (turned - 180)) < 0.03 and abs(soft[2] - (turned - 180)) < 0.03
PYTHON
