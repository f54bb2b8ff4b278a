#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# st-spin 0.0.22.4: a motor that turns forward is reported as "Reverse", and one that brakes as at constant speed.
#
# `getPrettyStatus()`, which the package recommends for finding faults, puts the status of an L6470 into words. By its
# own constants, as by the data sheet, the direction is bit 4, and bits 5 and 6 are 1 for a motor that accelerates, 2
# for one that decelerates and 3 for a constant speed. Expected of each: its own words.
# What happens: the direction is taken from bit 0, which says whether the bridges are off (HiZ): a motor under power is
# always "Reverse", and a motor that has been released is "Forward", whichever way it last turned. The two bits are not
# compared but tested for any common bit, so that a motor that accelerates or brakes is at "Constant Speed".
# Output: forward, accelerating: Motor: Constant Speed, Direction: Reverse
#         forward, constant speed: Motor: Constant Speed, Direction: Reverse
#         forward, braking: Motor: Constant Speed, Direction: Reverse
#         reverse, released: Motor: Stopped, Direction: Forward
# For us: take the direction from `status & Status.Dir` and the motion from `status >> 5 & 3` of `getStatus()`.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check st-spin==0.0.22.4 typing-extensions==4.16.0
cd "$folder"
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
from stspin import SpinChain, utility
from stspin.constants import MotorStatus, Status

NO_FAULT = (Status.NotUndervoltage | Status.NotThermalWarning | Status.NotThermalShutdown | Status.NotOvercurrent
            | Status.NotStepLossA | Status.NotStepLossB | Status.SwitchFlag)
assert [Status.Dir, MotorStatus.Accelerating, MotorStatus.Decelerating, MotorStatus.ConstantSpeed] == [16, 32, 64, 96]


def reported(status):
    """The words for a status that a simulated L6470 answers: the command first, then its two bytes."""
    answer = [0, status >> 8, status & 0xFF]
    motor = SpinChain(total_devices=1, spi_transfer=lambda buffer: [answer.pop(0)]).create(0)
    assert (read := motor.getStatus()) == status
    lines = utility.getPrettyStatus(read).splitlines()
    return ', '.join(line for line in lines if line.startswith(('Motor', 'Direction')))


turning = 'Motor: Constant Speed, Direction: Reverse'
for name, bits, seen in (
    ('forward, accelerating', Status.Dir | MotorStatus.Accelerating, turning),
    ('forward, constant speed', Status.Dir | MotorStatus.ConstantSpeed, turning),
    ('forward, braking', Status.Dir | MotorStatus.Decelerating, turning),
    ('reverse, released', Status.HiZ | Status.NotBusy, 'Motor: Stopped, Direction: Forward'),
):
    words = reported(NO_FAULT | bits)
    print(f'{name}: {words}')
    assert words == seen, words
PYTHON
