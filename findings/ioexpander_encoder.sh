#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# pimoroni-ioexpander 1.0.1: of an encoder that turns by 64 counts between two readings, each whole 256 counts are lost.
#
# The encoders of the IO Expander count in 8 bits, of which the driver makes a long count. Expected of count(): right as
# long as a shaft turns by less than 128 counts between two readings, of which the shorter way is the true one. What
# happens: a count has wrapped only if it was beyond 64 before and is beyond -64 after. At 80 counts a reading, as of a
# motor at 20 000 rpm with 12 counts a turn that is read 50 times a second, three of five wraps are missed: the shaft
# goes back by 176 instead of on by 80. At 64 counts all wraps are missed, so that the count stays within 8 bits; at 63
# none is.
# The Super IO Expander, as of the Inventor HAT Mini, counts in 16 bits. Expected of its read_rotary_encoders(1, 2), for
# encoders at 1000 and -5: these. What happens: it takes the two bytes of the first for both, 232 and 3. count() is
# right there. No error, no warning.
# For us: read so often that no two readings are more than 63 counts apart, and each encoder by count().
#
# Exit code 0: still so. Installs the versions into a temporary folder; a simulated board takes the place of the bus.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check pimoroni-ioexpander==1.0.1 smbus2==0.6.1
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import struct

import ioexpander
from ioexpander.encoder import Encoder

READ = 1  # the flag of a message that is read


class Board:
    """The registers of the board, on the bus that its driver opens."""

    def __init__(self, bus):
        self.registers, self.place = bytearray(256), 0

    def i2c_rdwr(self, *messages):
        for message in messages:
            if message.flags & READ:
                for index in range(message.len):
                    message.buf[index] = bytes([self.registers[self.place + index]])
            else:
                self.place, *values = list(message)
                self.registers[self.place : self.place + len(values)] = bytes(values)


ioexpander.SMBus = Board


def lost(step, readings=160):
    """The counts that are lost if the shaft turns by so many between two readings."""
    board = ioexpander.IOE(skip_chip_id_check=True)
    encoder = Encoder(board, 1, (3, 4), counts_per_rev=600, count_microsteps=True)
    for reading in range(1, readings + 1):
        board._i2c_dev.registers[board.REG_ENC_1_COUNT] = reading * step % 256
        count = encoder.count()
    return step * readings - count


losses = {step: lost(step) for step in (1, -40, 63, 64, 80, -80)}
print('counts lost in 160 readings, by the counts between two readings', losses)
assert losses[1] == losses[-40] == losses[63] == 0
assert losses[64] == 160 * 64 and losses[80] == -losses[-80] == 160 * 80 * 3 // 5

board = ioexpander.SuperIOE(skip_chip_id_check=True)
struct.pack_into('<hh', board._i2c_dev.registers, board.REG_ENC_1_COUNT, 1000, -5)
single = [board.read_rotary_encoder(channel) for channel in (1, 2)]
both = board.read_rotary_encoders(1, 2)
print('two encoders one by one', single, 'and at once', both)
assert single == [1000, -5] and both == [232, 3]
PYTHON
