#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# dryve-d1 0.3.0: a relative move that has arrived ends as a timeout, or counts as arrived before it has begun.
#
# Its readme names moves to absolute and relative positions; the latter are in the class ProfilePosition of
# dryve_d1.motion, while DryveD1 itself has only absolute ones. Expected of move_to(1000, relative=True) of that class
# from 5000: that it returns once the drive stands at 6000. What happens: the drive arrives there and reports "target
# reached", but its actual position is compared with 1000, the way, instead of 6000, so that move_to() ends in a
# TimeoutError. Expected of a relative move by 5000 from 5000: that it returns at 10000. What happens: it returns at
# 5000, since the drive still reports the target of its last move as reached, which the comparison is there to reject.
# The absolute moves to 6000 and to 10000 return when the drive is there. The drive here is a stand-in for the object
# dictionary, which after a new set-point holds bit 10 of the statusword for 100 ms, as the package says of its drive.
# For us: with it, add the actual position to a relative goal, and move to the sum.
#
# Exit code 0: still so. Installs the version into a temporary folder; it asks for Python 3.12, but runs on 3.11.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check --ignore-requires-python dryve-d1==0.3.0
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import asyncio
import time
from dryve_d1.motion import ProfilePosition, ProfilePositionConfig


class Drive:
    def __init__(self, position):
        self.start = self.goal = position
        self.begun, self.control, self.objects = -10., 0, {}

    def position(self):
        part = min(max(time.monotonic() - self.begun - 0.1, 0) / 0.4, 1)
        return round(self.start + part * (self.goal - self.start))

    async def read_u16(self, index, subindex=0):
        assert index == 0x6041
        moving = 0.1 < time.monotonic() - self.begun < 0.5
        return 0x0237 | (0 if moving else 1 << 10) | (1 << 12 if self.control & 1 << 4 else 0)

    async def read_i8(self, index, subindex=0):
        assert index == 0x6061
        return self.objects[0x6060]

    async def read_i32(self, index, subindex=0):
        return self.position() if index == 0x6064 else self.objects[index]

    async def write(self, index, value, subindex=0):
        if index == 0x6040:
            if value & ~self.control & 1 << 4:
                self.start = self.position()
                self.goal = self.objects[0x607A] + (self.start if value & 1 << 6 else 0)
                self.begun = time.monotonic()
            self.control = value
        self.objects[index] = value

    write_u8 = write_u16 = write_u32 = write_i32 = write


async def move(goal, relative):
    drive = Drive(5000)
    config = ProfilePositionConfig(poll_interval_s=0.01, mode_settle_s=0.01, move_timeout_s=2)
    try:
        await ProfilePosition(drive, config=config).move_to(goal, relative=relative)
        end = 'reached'
    except TimeoutError:
        end = 'timeout'
    return end, drive.position(), drive.goal


for goal, relative in ((6000, False), (10000, False), (1000, True), (5000, True)):
    end, position, commanded = asyncio.run(move(goal, relative))
    kind = 'relative' if relative else 'absolute'
    print(f'{kind} {goal} from 5000: {end} at {position}, the drive goes to {commanded}')
    if not relative:
        assert end == 'reached' and commanded == goal and abs(position - goal) <= 100
    elif goal == 1000:
        assert (end, position, commanded) == ('timeout', 6000, 6000)
    else:
        assert (end, position, commanded) == ('reached', 5000, 10000)
PYTHON
