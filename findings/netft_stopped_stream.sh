#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# NetFT 2.0.1: once a stream of an ATI sensor has been stopped, each torque is one of up to 100 readings ago.
#
# A Net F/T box streams 1000 readings a second of a sensor without load. The stream is stopped, and 1 s later a torque
# of 5000 counts acts. Expected of getTorque(), which requests a single measurement from the sensor: 5000. What happens:
# 0 for up to the next 100 calls, and after each later change of the torque again, for as many calls: stopStreaming()
# ends the thread that receives, waits for 0.1 s and only then tells the box to stop. What came in between stays in the
# buffer of the socket, and each call takes the oldest reading out of it and requests a new one. No error tells of it,
# as the numbers of the readings, which the box sends along, are not looked at.
# A socket takes the place of the box here: it streams after a request of 0 readings, and sends n after a request of n.
# For us: open a new Sensor after stopStreaming() and tare it again, or let the stream run and take measurement().
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check NetFT==2.0.1
cat > "$folder/torque.py" <<'PYTHON'
import os
import socket
import struct
import threading
import time

import NetFT

ADDRESS = '127.0.0.77'
torque = 0
streams = threading.Event()
box = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
box.bind((ADDRESS, 49152))
host = None


def reading():
    return struct.pack('!IIIiiiiii', 0, 0, 0, 0, 0, 0, 0, 0, torque)


def answer():
    global host
    while True:
        request, host = box.recvfrom(64)
        header, command, count = struct.unpack('!HHI', request)
        assert header == 0x1234
        if command == 0:
            streams.clear()
        elif count == 0:
            streams.set()
        for _ in range(count if command == 2 else 0):
            box.sendto(reading(), host)


def stream():
    while True:
        streams.wait()
        box.sendto(reading(), host)
        time.sleep(0.001)


for task in answer, stream:
    threading.Thread(target=task, daemon=True).start()


def late(sensor, value):
    """Give how many calls return another torque before the one that acts is returned."""
    global torque
    torque = value
    for calls in range(1000):
        if sensor.getTorque()[2] == value:
            return calls
        time.sleep(0.01)  # In this time, the box answers.


sensor = NetFT.Sensor(ADDRESS)
assert [late(sensor, value) for value in (1000, -1000)] == [0, 0]
torque = 0
sensor.startStreaming()
time.sleep(0.5)
assert sensor.torque()[2] == 0
sensor.stopStreaming()
time.sleep(1)
assert not streams.is_set()
found = [late(sensor, value) for value in (5000, 0, 7000)]
print('calls that return an old torque after a change of it:', found)
assert min(found) > 10 and max(found) - min(found) <= 5
other = NetFT.Sensor(ADDRESS)
assert [late(other, value) for value in (5000, 0)] == [0, 0]
os._exit(0)
PYTHON
timeout 60 "$folder/venv/bin/python" -u "$folder/torque.py"
