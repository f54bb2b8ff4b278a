#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# RTAPlusL5 0.0.6: checking the communication with a drive sets its position to 0.
#
# Expected of check_communication(), which "checks communication with serial device": the drive is asked something, and
# stays as it is. What happens: it is sent RA, the command of absolute_pos_reset(), which "resets absolute position". A
# drive at 1234 steps is at 0 after the check, without a message.
# Expected of absolute_pos_set(-5): the command SA with -5. What happens: SA,--005 is sent.
# A stub takes the place of the serial line; it does what the package says of its commands RA, QA and SA.
# For us: the zero of a joint is lost. Check the communication by absolute_pos_get().
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check RTAPlusL5==0.0.6 pyserial==3.5
cd "$folder"
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import logging

import serial.rs485


class Drive:
    position, sent, answer = 1234, [], b''

    def __init__(self, *arguments, **keywords):
        pass

    def write(self, command):
        self.sent.append(command)
        if command == b'01RA\r':
            Drive.position = 0
        self.answer = f'01QA,{self.position:+05d}\r'.encode() if command == b'01QA\r' else b'01Y\r'

    def read(self, count=1):
        first, self.answer = self.answer[:count], self.answer[count:]
        return first

    def read_until(self, *arguments, **keywords):
        return self.read(len(self.answer))

    readline = read_until

    def flush(self):
        pass


serial.rs485.RS485 = Drive
logging.disable()
from RTAPlusL5.RTAPlusL5 import RTAPlusL5  # noqa: E402

drive = RTAPlusL5('drive', 1)
before = drive.absolute_pos_get()
drive.check_communication()
after = drive.absolute_pos_get()
print('position before the check:', before, '- after it:', after, '- sent:', Drive.sent)
assert (before, after) == (1234, 0) and Drive.sent == [b'01QA\r', b'01RA\r', b'01QA\r']
drive.absolute_pos_reset()
assert Drive.sent[-1] == Drive.sent[1]
drive.absolute_pos_set(-5)
print('absolute_pos_set(-5):', Drive.sent[-1])
assert Drive.sent[-1] == b'01SA,--005\r'
PYTHON
