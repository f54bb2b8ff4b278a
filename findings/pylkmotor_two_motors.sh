#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# pylkmotor 1.0.6: of two motors on one bus, each is read at the angle of the other or at 0°, and an encoder at 270° is
# at -90°.
#
# Expected: read_multi_turn_angle() of a motor returns what this motor answers, and read_encoder_data() the number
# without a sign (uint16_t) that its docstring names. What happens: each LKMotor opens the bus for itself and takes
# the next frame as its answer, whatever its identifier is. The requests to the other motor and its answers wait there
# first. Of motors that stand still at 90° and 270° and are read in turn, the second is read at 0° (the request to the
# first) and then at 90° (its answer), and the first at 90° and then at 0°. An encoder of 16 bits at 49152 (270°) is
# read as -16384. The motors answer here with the identifier of the request, as in the CAN protocol of LK motors
# (0x140 + number).
# For us: give each LKMotor can_filters with its identifier alone, which is right here; take the encoder modulo 65536.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check pylkmotor==1.0.6 python-can==4.6.1
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import threading

import can
from pylkmotor import LKMotor

ANGLES = {0x141: 9000, 0x142: 27000}  # in 0.01 degree
ENCODER = 49152
stopped = threading.Event()


def motors(bus):
    while not stopped.is_set():
        request = bus.recv(timeout=0.05)
        if request is None:
            continue
        if request.data[0] == 0x92:
            data = bytes([0x92]) + ANGLES[request.arbitration_id].to_bytes(7, 'little')
        else:
            data = bytes([0x90, 0]) + ENCODER.to_bytes(2, 'little') * 2 + bytes(2)
        bus.send(can.Message(arbitration_id=request.arbitration_id, data=data, is_extended_id=False))


with can.Bus(interface='virtual', channel='joints') as bus:
    answering = threading.Thread(target=motors, args=(bus,))
    answering.start()
    alone = LKMotor('virtual', 'joints', 1)
    try:
        right = [alone.read_multi_turn_angle() for _ in range(3)]
        encoder = alone.read_encoder_data()[0]
        alone.bus.shutdown()
        first, second = LKMotor('virtual', 'joints', 1), LKMotor('virtual', 'joints', 2)
        read = [(first.read_multi_turn_angle() / 100, second.read_multi_turn_angle() / 100) for _ in range(4)]
        first.bus.shutdown()
        second.bus.shutdown()
        filtered = [
            LKMotor('virtual', 'joints', number, can_filters=[{'can_id': 0x140 + number, 'can_mask': 0x7FF}])
            for number in (1, 2)
        ]
        mended = [tuple(motor.read_multi_turn_angle() / 100 for motor in filtered) for _ in range(4)]
        for motor in filtered:
            motor.bus.shutdown()
    finally:
        stopped.set()
        answering.join()
print('alone', right, 'encoder', encoder, 'of two motors', read, 'with filters', mended)
assert right == [9000] * 3
assert encoder == ENCODER - 65536
assert read[0] == (90.0, 0.0) and read[1] == (0.0, 90.0)
assert mended == [(90.0, 270.0)] * 4
PYTHON
