#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# ethernetip 1.2.0: parameter 300 of a drive is asked for as instance 12289, and an output set by NumPy is sent as off.
#
# A drive on EtherNet/IP has its parameters as instances of the class 0x0F. Expected of getAttrSingle(0x0F, 300, 1): the
# path 20 0f 25 00 2c 01 30 01 in four words, as the drive pads 16-bit numbers; version 1.1.1 and pycomm3 1.2.16 send it
# so, and so does mkReqPath() in 1.2.0. What happens: 20 0f 25 2c 01 30 01, whose length is given as three words, since
# the pad byte is missing. A drive reads instance 12289 without an attribute, and the byte 01 as data. Parameter 200
# is right. Instance 0, the class itself, has no segment of its own any more.
# The outputs of an I/O connection are a list of bits that begin as 0. Expected of outputs[0] = True, 1 or numpy.True_:
# bit 0 is on. What happens: only True itself, as in its example, is sent as on. A brake that is to be
# released at numpy's `speed > limit` is not, though its list shows it as on.
# For us: send such requests by conn.unconnSend(0x0E, conn.mkReqPath(0x0F, 300, 1)), and set outputs with bool(...).
#
# Exit code 0: still so. Installs the versions into a temporary folder, and uses the local ports 44818 and 2222.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check \
    ethernetip==1.2.0 dpkt==1.9.8 pycomm3==1.2.16 numpy==2.4.6
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check --no-deps --target "$folder/before" ethernetip==1.1.1
cd "$folder"
cat > drive.py <<'PYTHON'
"""A drive at the local address that notes the paths that it is asked for, and what it reads from them."""
import socket
import struct
import threading


def read_path(path):
    """The class, instance and attribute in a padded path, as (segment, number)."""
    segments, names = [], {0x20: 'class', 0x24: 'instance', 0x30: 'attribute'}
    while path:
        size = 4 if path[0] & 3 else 2
        number = int.from_bytes(path[2:4], 'little') if size == 4 else path[1]
        segments.append((names[path[0] & 0xFC], number))
        path = path[size:]
    return segments


class Drive(threading.Thread):
    def __init__(self):
        super().__init__(daemon=True)
        self.server = socket.create_server(('127.0.0.1', 44818))
        self.requests = []
        self.start()

    def run(self):
        connection, _ = self.server.accept()
        while data := connection.recv(1024):
            command, length = struct.unpack_from('<HH', data)
            if command == 0x6F:
                request = data[40:]
                end = 2 + 2 * request[1]
                self.requests.append((request[2:end].hex(' '), request[end:].hex(' ')))
                answer = struct.pack('<BBBBI', request[0] | 0x80, 0, 0, 0, 1000)
                body = data[24:30] + struct.pack('<HHHHH', 2, 0, 0, 0xB2, len(answer)) + answer
            else:
                body = data[24:24 + length]
            connection.sendall(data[:2] + struct.pack('<HI', len(body), 7) + data[8:24] + body)


def requests():
    """What a drive is asked for with getAttrSingle() of the installed version."""
    import ethernetip

    drive = Drive()
    connection = ethernetip.EtherNetIP('127.0.0.1').explicit_conn()
    connection.registerSession()
    for number in (200, 300, 0):
        connection.getAttrSingle(0x0F, number, 1)
    return connection, drive.requests
PYTHON
cat > now.py <<'PYTHON'
import socket

import ethernetip
import numpy as np
from drive import read_path, requests
from pycomm3.packets.util import request_path

connection, found = requests()
print('1.2.0', found, 'parameter 300 is read as', read_path(bytes.fromhex(found[1][0])))
assert found == [('20 0f 24 c8 30 01', ''), ('20 0f 25 2c 01 30', '01'), ('20 0f 30 01', '')]
assert read_path(bytes.fromhex(found[1][0])) == [('class', 15), ('instance', 12289)]
right = '04 20 0f 25 00 2c 01 30 01'
assert connection.mkReqPath(0x0F, 300, 1).hex(' ') == right
assert request_path(class_code=0x0F, instance=300, attribute=1).hex(' ') == right

drive = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
drive.bind(('127.0.0.1', 2222))
drive.settimeout(10)
outputs = ethernetip.EtherNetIP().registerAssembly(ethernetip.EtherNetIP.ENIP_IO_TYPE_OUTPUT, 1, 101, connection)
assert outputs == [0] * 8
sent = {}
for value in (True, 1, np.float64(2.0) > 1.0):
    outputs[0] = value
    connection.sendUdpIO()
    sent[repr(value)] = drive.recv(1024)[-1]
print('the byte of the outputs', sent)
assert sent == {'True': 1, '1': 0, 'np.True_': 0}
PYTHON
cat > before.py <<'PYTHON'
from drive import requests

found = requests()[1]
print('1.1.1', found)
assert found == [('20 0f 24 c8 30 01', ''), ('20 0f 25 00 2c 01 30 01', ''), ('20 0f 24 00 30 01', '')]
PYTHON
timeout 60 venv/bin/python now.py
PYTHONPATH="$folder/before" timeout 60 venv/bin/python before.py
