#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# iqmotion 0.30.0: a motor at 50 rad/s that is to be stopped within 20 ms turns on, and the ramp is said to be done.
#
# Expected of ramp_velocity(0, 0.02) at 50 rad/s: the last speed that is sent is 0, as its documentation says: "ramps
# velocity of the module up to a target". What happens: the only speed that is sent is 50 rad/s, where the motor is
# already, and below 10 ms none is sent. The answer is 1, which is "the ramp was successful". ramp_volts() and
# ramp_volts_slew() do the same: 5 V that are to fall by 250 V/s stay at 5 V.
# Expected of time_steps=200, the "num of velocity increments": 200 small steps. What happens: it is the time of a step
# in ms, and within 1 s the motor gets five speeds, 12.5 rad/s apart. With 1 it gets a thousand.
# A Vertiq servo module is replaced by a stub, which answers with its speed and keeps the messages that it is sent.
# For us: send the last speed or voltage once more by set(), and give the milliseconds of a step as time_steps.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check iqmotion==0.30.0 numpy==2.3.5
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import struct
from unittest import mock

from iqmotion.iq_devices.servo_module import ServoModule


def sent(ramp, *arguments, now, **keywords):
    line = mock.MagicMock()
    motor = ServoModule(line)
    motor.get_retry = lambda client, entry, **_: now
    answer = getattr(motor, ramp)(*arguments, **keywords)
    messages = [bytes(call.args[0]) for call in line.send_message.call_args_list]
    return answer, [round(struct.unpack('<f', message[-4:])[0], 2) for message in messages]


whole = sent('ramp_velocity', 0, 0.2, now=50)
print('to 0 rad/s within 200 ms:', whole)
assert whole[0] == 1 and len(whole[1]) == 10 and whole[1][-1] == 0
short = sent('ramp_velocity', 0, 0.02, now=50)
shortest = sent('ramp_velocity', 0, 0.009, now=50)
volts = sent('ramp_volts_slew', 0, 250, now=5)
print('within 20 ms:', short, '- within 9 ms:', shortest, '- 5 V by 250 V/s to 0:', volts)
assert short == (1, [50]) and shortest == (1, []) and volts == (1, [5])
steps = sent('ramp_velocity', 0, 1, now=50, time_steps=200)
print('with time_steps=200 within 1 s:', steps[1])
assert steps[1] == [50, 37.5, 25, 12.5, 0]
PYTHON
