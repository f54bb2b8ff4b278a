#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# thorlabs-apt-protocol 29.0.0: the fourth input of a motor controller is never seen, and the third is taken for it.
#
# Expected of dig_ins, the four digital inputs in the status of a motor controller, bits 20 to 23 of its word: one for
# each input, in order. What happens: the mask of the third is that of the first two together, and the mask of the
# fourth that of the third. A switch at the first or the second input also shows at the third; one at the third shows
# at the fourth alone; one at the fourth shows nowhere. dig_outs, which says what the four outputs of a rack are set to,
# has the same masks: with output 3 on, as for a brake, it says that output 4 is, and output 4 on is none.
# Unpacker gives the messages without an error.
# For us: take the bits of the status word from the bytes of the message.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check thorlabs-apt-protocol==29.0.0
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import struct

from thorlabs_apt_protocol import Unpacker

HOST, CONTROLLER, LONG = 0x01, 0x50, 0x80
seen, outputs = {}, {}
for number in range(1, 5):
    status = 1 << 19 + number | 1 << 31  # this input, and that the channel is enabled
    body = struct.pack('<HllL', 1, -1234, 0, status)
    unpacker = Unpacker(on_error='raise')
    unpacker.feed(struct.pack('<HHBB', 0x0481, len(body), HOST | LONG, CONTROLLER) + body)
    message = next(unpacker)
    assert message.msg == 'mot_get_statusupdate' and message.position == -1234 and message.channel_enabled
    seen[number] = [place for place, on in enumerate(message.dig_ins, 1) if on]
    unpacker.feed(struct.pack('<HBBBB', 0x0230, 1 << number - 1, 0, HOST, CONTROLLER))
    outputs[number] = [place for place, on in enumerate(next(unpacker).dig_outs, 1) if on]
print('input that is on: inputs that are read as on', seen)
print('output that is on: outputs that are read as on', outputs)
assert seen == outputs == {1: [1, 3], 2: [2, 3], 3: [4], 4: []}
PYTHON
