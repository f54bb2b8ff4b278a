#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# modbuslink 1.5.2: an angle of 1.5 rad in the order DCBA of a drive is read as -2.98 rad, as "little" does nothing.
#
# A float or a whole number of 32 or 64 bits is in two or four registers, and the client takes its byte_order and
# word_order. By the documentation of its coder, "little" and "low" is the order DCBA on the wire, and "little" and
# "high" is BADC. Expected: a drive with such an order is read right by them. What happens: each register's bytes are
# exchanged twice, so that "little" is the same as "big": these two read ABCD and CDAB, and an angle of 1.5 rad in DCBA
# or BADC is read as -2.98 rad or as 7e-41 rad by each of the four settings. A goal that is written is sent just as
# wrong, so that reading it back does not show it. A Modbus TCP server answers here with the bytes of 1.5 rad.
# For us: read the registers, exchange their bytes by ((r & 255) << 8) | r >> 8, and decode them as "big".
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check modbuslink==1.5.2
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import socket
import socketserver
import struct
import threading

from modbuslink import SyncModbusClient, SyncTcpTransport

ORDERS = {'ABCD': (0, 1, 2, 3), 'CDAB': (2, 3, 0, 1), 'DCBA': (3, 2, 1, 0), 'BADC': (1, 0, 3, 2)}
SETTINGS = {('big', 'high'): 'ABCD', ('big', 'low'): 'CDAB', ('little', 'low'): 'DCBA', ('little', 'high'): 'BADC'}
memory = bytearray(4)


class Drive(socketserver.BaseRequestHandler):
    """Two holding registers from 0 on."""

    def handle(self):
        while head := self.request.recv(7, socket.MSG_WAITALL):
            transaction, _, length, unit = struct.unpack('>HHHB', head)
            request = self.request.recv(length - 1, socket.MSG_WAITALL)
            if request[0] == 3:
                answer = bytes([3, 4]) + memory
            else:
                memory[:] = request[6:10]
                answer = request[:5]
            self.request.sendall(struct.pack('>HHHB', transaction, 0, len(answer) + 1, unit) + answer)


server = socketserver.ThreadingTCPServer(('127.0.0.1', 0), Drive)
server.daemon_threads = True
threading.Thread(target=server.serve_forever, daemon=True).start()
angle = struct.pack('>f', 1.5)
right = []
with SyncModbusClient(SyncTcpTransport('127.0.0.1', server.server_address[1])) as client:
    for order, places in ORDERS.items():
        memory[:] = bytes(angle[place] for place in places)
        for setting in SETTINGS:
            found = client.read_float32(1, 0, *setting)
            print(f'1.5 rad in {order}, read as {" and ".join(setting)} ({SETTINGS[setting]}): {found:.4g} rad')
            if found == 1.5:
                right.append((order, setting))
    sent = {}
    for setting in SETTINGS:
        client.write_float32(1, 0, 1.5, *setting)
        sent[setting] = bytes(memory)
        assert client.read_float32(1, 0, *setting) == 1.5
words = ('ABCD', 'high'), ('CDAB', 'low')
assert right == [(order, (kind, word)) for order, word in words for kind in ('big', 'little')]
assert sent['little', 'high'] == sent['big', 'high'] == angle and sent['little', 'low'] == sent['big', 'low']
server.shutdown()
PYTHON
