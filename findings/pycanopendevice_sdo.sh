#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# PyCanOpenDevice 1.3: a simulated drive, given a target position of 1000, answers it as -402456576.
#
# Expected: an answer to an SDO carries the value in CANopen's order of bytes, the lowest first, as the request did
# and as the package sends PDOs. What happens: values arrive rightly, and are answered with the highest byte first, so
# that a master reads other values, also small ones: 1 is read as 16777216. The package canopen reads here, over a
# virtual bus, from a drive that keeps the object 0x607A.
# For us: reverse the bytes of a value before the drive's function returns it.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check PyCanOpenDevice==1.3 canopen==2.4.1 python-can==4.6.1
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import threading
import time

import can
import canopen
from PyCanOpenDevice import CanOpen_Codes as codes
from PyCanOpenDevice.CanOpen_Device import Device, SDO_Structure
from PyCanOpenDevice.CanOpen_Runtime import CanOpen_Runtime

TARGET, REVERSED = 0x607A, 0x607B
kept = {}


def target(domain, value):
    if domain == codes.READ_SLAVE:
        return codes.SLAVE_SUCCESSFUL_READ_RESPONSE, kept['target']
    kept['target'] = value
    return codes.SLAVE_SUCCESSFUL_WRITE_RESPONSE, 0


def reversed_target(domain, value):
    answer, value = target(domain, value)
    return answer, int.from_bytes(value.to_bytes(4, 'little'), 'big')


runtime = CanOpen_Runtime(can.Bus('drive', interface='virtual'))
drive = Device(5)
drive.add_sdo(SDO_Structure(TARGET, 0, target))
drive.add_sdo(SDO_Structure(REVERSED, 0, reversed_target))
runtime.callbacks.add_service(drive)
threading.Thread(target=runtime.receiver.recv_loop, daemon=True).start()

network = canopen.Network()
network.connect(interface='virtual', channel='drive')
node = network.add_node(5, canopen.ObjectDictionary())
pdos = []
network.subscribe(0x185, lambda identifier, data, time: pdos.append(int.from_bytes(data, 'little')))
read = {}
for position in (1000, 1, -1000):
    node.sdo.download(TARGET, 0, position.to_bytes(4, 'little', signed=True))
    read[position] = [int.from_bytes(node.sdo.upload(index, 0), 'little', signed=True) for index in (TARGET, REVERSED)]
drive.set_pdo_data(1, 1000)
drive.send_pdo(1)
time.sleep(0.5)
network.disconnect()
print('read, and read with reversed bytes:', read, 'PDO of 1000:', pdos)
assert read == {1000: [-402456576, 1000], 1: [16777216, 1], -1000: [419233791, -1000]} and pdos == [1000]
PYTHON
