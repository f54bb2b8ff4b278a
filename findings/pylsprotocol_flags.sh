#!/usr/bin/env bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# pylsprotocol 0.1.4: a limit switch that is on is read as 0 after each write to an LS PLC, and of three flags the last.
#
# The XGT protocol of LS Electric answers each request, a write too: the answer to a read ends with the size and the
# value of each flag, that to a write with the number of flags. Expected of plc_comm(..., 'read', 'bit', 'M750'): 1
# while the switch is on, and of 'M750,M751,M752', as in its example, three values. What happens: the answer to a write
# stays in the socket, so that the next read takes it as its own, and each read after it gets the answer of the one
# before: a switch that is on is read as 0 after the brake was released, one that is off then as 1. Of three flags only
# the last is returned. A server that answers after 10 ms as the manual of XGT has it stands in for the PLC; a fifth of
# a second lies between all requests.
# For us: read and drop the answer after each write, conn.conn_class.recv(1024), and read one flag at a time.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check pylsprotocol==0.1.4
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import socket
import struct
import threading
import time

from pylsprotocol.lsprotocol import conn_plpc

flags = {'%MX750': 1, '%MX751': 1, '%MX752': 0, '%MX700': 0}


def answer(request):
    """Return the answer of an XGT to a request, and carry out a write."""
    command, kind, _, count = struct.unpack('<4H', request[20:28])
    place, names = 28, []
    for _ in range(count):
        size = struct.unpack_from('<H', request, place)[0]
        names.append(request[place + 2:place + 2 + size].decode())
        place += 2 + size
    body = struct.pack('<5H', command + 1, kind, 0, 0, count)
    for name in names:
        if command == 0x54:
            body += struct.pack('<HB', 1, flags[name])
        else:
            flags[name], place = request[place + 2], place + 3
    return b'LSIS-XGT' + bytes(4) + b'\xa0\x11' + request[14:16] + struct.pack('<HBB', len(body), 0, 0) + body


def serve(server):
    link, _ = server.accept()
    while head := link.recv(20, socket.MSG_WAITALL):
        time.sleep(0.01)
        link.sendall(answer(head + link.recv(struct.unpack('<H', head[16:18])[0], socket.MSG_WAITALL)))


server = socket.create_server(('127.0.0.1', 0))
threading.Thread(target=serve, args=(server,), daemon=True).start()
plc = conn_plpc(*server.getsockname())


def read(names):
    time.sleep(0.2)
    return plc.plc_comm('XGT', 'read', 'bit', names)


before = read('M750'), read('M752')
three = read('M750,M751,M752')
plc.plc_comm('XGT', 'write', 'bit', 'M700', '1')
after = read('M750'), read('M752'), read('M750')
print('M750 is on, M752 is off:', before, 'are read; M750, M751 and M752 at once:', three)
print('M700 is written as', flags['%MX700'], 'and then M750, M752, M750 are read as', after)
assert (before, three, flags['%MX700'], after) == ((1, 0), 0, 1, (0, 1, 0))
PYTHON
