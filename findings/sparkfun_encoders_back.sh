#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# sparkfun-qwiic-twist 2.0.0, -dual-encoder-reader 0.0.2: an encoder that turns back by 5 counts from 0 is at 65531.
#
# Expected of the count of an encoder that has turned back by 5 from 0: -5, as the firmware counts in a signed word of
# 16 bits. What happens in QwiicTwist: count and get_diff() give 65531 for -5, so that an axis of 24 counts a turn is
# 2730 turns away. QwiicDualEncoderReader gives count1 and count2 with their signs, but get_diff(), the way since the
# last reading, without: a count1 of -5 and a difference of 65531 stand side by side. No error, no warning.
# A simulated board takes the place of the bus.
# For us: take off 65536 from a count or a difference above 32767.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check sparkfun-qwiic-twist==2.0.0 \
    sparkfun-qwiic-dual-encoder-reader==0.0.2 sparkfun-qwiic-i2c==2.0.0 smbus2==0.6.1
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import struct

from qwiic_dual_encoder_reader import QwiicDualEncoderReader
from qwiic_twist import QwiicTwist

COUNT, DIFFERENCE = 0x05, 0x07  # of the first or the only encoder, in both boards


class Board:
    """A board whose encoder has turned back by 5 counts from 0."""

    def __init__(self):
        self.registers = bytearray(64)
        for register in COUNT, DIFFERENCE:
            struct.pack_into('<h', self.registers, register, -5)

    def readWord(self, address, register):
        return int.from_bytes(self.registers[register : register + 2], 'little')


twist, reader = QwiicTwist(i2c_driver=Board()), QwiicDualEncoderReader(i2c_driver=Board())
print('QwiicTwist: count', twist.count, 'difference', twist.get_diff())
print('QwiicDualEncoderReader: count', reader.count1, 'difference', reader.get_diff())
assert (twist.count, twist.get_diff()) == (65531, 65531)
assert (reader.count1, reader.get_diff()) == (-5, 65531)
PYTHON
