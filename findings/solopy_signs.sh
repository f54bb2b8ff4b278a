#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# SoloPy 4.1.0: over CAN, a motor that has turned back by 5 counts is read at 4294967291 counts, over UART at -5.
#
# The package of the maker of the SOLO motor controllers reads position, speed and goal over UART and over CANopen.
# Expected of a motor at -5 counts: -5 over both. What happens: over UART the four bytes are read as a signed number,
# over CANopen as an unsigned one, by SDO and by PDO alike, with the error "no error detected". A goal of -2000, which
# is sent rightly, is read back as 4294965296.
# Expected of the answer to an SDO request: that to this request, as each answer names its object. What happens: the
# first answer of the controller is taken. Once one has come after more than 10 ms, when its request has failed, each
# value that is read is that of the request before: the speed of 120 rpm is the position, and the other way round.
# A controller on a virtual CAN bus answers here by the object dictionary of the package.
# Output: position 4294967291, speed 4294967196, goal -2000 read as 4294965296, position by PDO 4294967291
#         late speed: Error.GENERAL_ERROR, then position 120, speed 5000, position 120
# For us: subtract 2**32 from a value of 2**31 or more, and open the connection again after an error.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check solopy==4.1.0 python-can==4.6.1 pyserial==3.5 \
    python-interface==1.6.1 wrapt==1.17.3 packaging==26.4 typing-extensions==4.16.0
cd "$folder"
cat > signs.py <<'PYTHON'
import struct
import threading
import time

import can
from SoloPy.SOLOMotorControllersCanopen import (CanCommunicationInterface, PdoParameterName,
                                                SoloMotorControllersCanopen)
from SoloPy.SOLOMotorControllersUtils import DataType, convert_from_data

GOAL, SPEED, POSITION = 0x301B, 0x3036, 0x3037
READ, READ_ANSWER, WRITE_ANSWER = 0x40, 0x43, 0x60
POSITION_PDO = 0x281
objects = {GOAL: 0, SPEED: -100, POSITION: -5}
delay = 0.0
bus = can.Bus(interface='virtual', channel='solo')


def send(identifier, data):
    bus.send(can.Message(arbitration_id=identifier, is_extended_id=False, data=data))


def answer_requests():
    while True:
        request = bus.recv(1.0)
        if request is None or request.arbitration_id != 0x601:
            continue
        command, index, subindex = struct.unpack_from('<BHB', request.data)
        time.sleep(delay)
        if command == READ:
            send(0x581, struct.pack('<BHBi', READ_ANSWER, index, subindex, objects[index]))
        else:
            objects[index] = struct.unpack_from('<i', request.data, 4)[0]
            send(0x581, struct.pack('<BHBi', WRITE_ANSWER, index, subindex, 0))


threading.Thread(target=answer_requests, daemon=True).start()
solo = SoloMotorControllersCanopen(address=1, interface=CanCommunicationInterface.CANABLE, bustype='virtual',
                                   channel='solo')


def read(function):
    value, error = function()
    assert error.name == 'NO_ERROR_DETECTED', error
    return value


# What the package does with the same bytes over UART:
assert convert_from_data(list((-5).to_bytes(4, 'big', signed=True)), DataType.INT32) == -5

assert solo.set_position_reference(-2000)[0] and objects[GOAL] == -2000
seen = [read(solo.get_position_counts_feedback), read(solo.get_speed_feedback), read(solo.get_position_reference)]
solo.pdoParameterCobIdByPdoParameterName[PdoParameterName.POSITION_COUNTS_FEEDBACK.value] = POSITION_PDO
send(POSITION_PDO, struct.pack('<i', -5))
seen.append(read(solo.get_pdo_position_counts_feedback))
print('position {}, speed {}, goal -2000 read as {}, position by PDO {}'.format(*seen))
assert seen == [2 ** 32 - 5, 2 ** 32 - 100, 2 ** 32 - 2000, 2 ** 32 - 5]

objects.update({SPEED: 120, POSITION: 5000})
assert [read(solo.get_speed_feedback), read(solo.get_position_counts_feedback)] == [120, 5000]
delay = 0.05
_, late = solo.get_speed_feedback()
time.sleep(0.3)
delay = 0.0
seen = [read(solo.get_position_counts_feedback), read(solo.get_speed_feedback), read(solo.get_position_counts_feedback)]
print('late speed: {}, then position {}, speed {}, position {}'.format(late, *seen))
assert late.name == 'GENERAL_ERROR' and seen == [120, 5000, 120]
PYTHON
timeout 60 "$folder/venv/bin/python" -W ignore signs.py
