#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# sparkfun-qwiic-twist 2.0.0, sparkfun-qwiic-dual-encoder-reader 0.0.2: an encoder that turned back by 6 has turned by
# 65530.
#
# The counters of both boards have 16 bits with a sign, and their words are read without one. The reader of two encoders
# of motors corrects it in get_count1() and get_count2(), but not in get_diff(), which so contradicts them; the knob
# corrects neither get_count() nor get_diff(). A bus answers here as the boards do.
# For us: subtract 65536 from 32768 on; a difference of 65530 is otherwise a speed of thousands of turns a second.
#
# Exit code 0: still so. Installs the packages into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check sparkfun-qwiic-twist==2.0.0 \
    sparkfun-qwiic-dual-encoder-reader==0.0.2 sparkfun-qwiic-i2c==2.0.0 smbus2==0.6.1
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import struct

import smbus2


class Bus:
    def __init__(self, number):
        pass

    def write_quick(self, address):
        pass

    def read_word_data(self, address, register):
        return struct.unpack('<H', struct.pack('<h', -6))[0]


smbus2.SMBus = Bus
import qwiic_dual_encoder_reader
import qwiic_twist

reader = qwiic_dual_encoder_reader.QwiicDualEncoderReader()
knob = qwiic_twist.QwiicTwist()
print('motor', reader.get_count1(), reader.get_count2(), reader.get_diff(), 'knob', knob.get_count(), knob.get_diff())
assert (reader.get_count1(), reader.get_count2(), reader.get_diff()) == (-6, -6, 65530)
assert (knob.get_count(), knob.get_diff()) == (65530, 65530)
PYTHON
