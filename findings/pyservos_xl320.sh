#!/usr/bin/env bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# pyservos 2.1.0: an XL-320 with the number 4, without any error, is read as number 253 with the error "Overheating".
#
# A status packet of protocol 2.0 is FF FF FD 00, the number of the servo, two bytes of length, 55, the error, the
# values and two bytes of CRC. Expected of processStatusPacket() of an XL320: number 4, error 0 and the position 511 as
# FF 01. What happens: the packet is read as one of protocol 1.0, so that the number is always 253, the error is the
# number of the servo, and the values begin with the length: a servo 4 that is well is too hot, one that is overloaded
# is as well, and a servo 128 never has an error. makeReadPacket(4, 37, 2), which is to ask for two bytes at 37, asks
# for those at 549, without a number, as both are sent in one byte. The same calls of an AX12 are right.
# For us: take the number from packet[4], the error from packet[8] and the values from packet[9:-2].
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check pyservos==2.1.0
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
from pyservos.ax12 import AX12
from pyservos.xl320 import XL320

servo = XL320()
OVERLOAD = 32


def status(number, error):
    """Return what is read from a servo that stands at 511, as the packet is found in what the port received."""
    packet = [0xFF, 0xFF, 0xFD, 0, number, 6, 0, 0x55, error, 0xFF, 0x01]
    crc = servo.check_sum(packet)
    found, = servo.decodePacket([*packet, crc & 0xFF, crc >> 8])
    read = servo.processStatusPacket(found)
    return read['id'], read['error str'], read['params'][:6]


read = {(number, error): status(number, error) for number, error in ((4, 0), (4, OVERLOAD), (128, OVERLOAD))}
for key, values in read.items():
    print('number and error', key, 'are read as', *values)
assert read == {
    (4, 0): (253, 'Overheating', [6, 0, 0x55, 0, 0xFF, 0x01]),
    (4, OVERLOAD): (253, 'Overheating', [6, 0, 0x55, OVERLOAD, 0xFF, 0x01]),
    (128, OVERLOAD): (253, 'None', [6, 0, 0x55, OVERLOAD, 0xFF, 0x01]),
}, read
asked = servo.makeReadPacket(4, 37, 2)[8:-2]
print('asks for the register', int.from_bytes(asked[:2], 'little'), 'and the bytes', asked[2:])
assert asked == [37, 2]

other = AX12()
body = [4, 4, 0, 0xFF, 0x01]
found, = other.decodePacket([0xFF, 0xFF, *body, other.check_sum(body)])
well = other.processStatusPacket(found)
assert (well['id'], well['error str'], well['params']) == (4, 'None', [0xFF, 0x01]), well
PYTHON
