#!/usr/bin/env bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# PyXGT 1.1: writing a byte to an LS PLC sends no value, which its refusal does not tell, and -5 is read as 65531.
#
# In the XGT protocol of LS Electric, a write has the size and the value of each variable behind their names: 01 00 14
# for the byte 20. Expected of the example of its documentation, command('XGB', 'write', 'byte', 'D100', '20'): these
# bytes, or an exception where the PLC refuses a write. What happens: 20 00, which is a size of 32, without any value.
# A PLC answers this with the status ffff and a code, as the manual has it, and command() returns as after a write that
# was done. A word has its value. A word is documented as int16, and -5 is read as 65531; a dword of -5, documented as
# int32, as 4294967291. A server that answers as the manual has it stands in for the PLC.
# For us: take another client; word - 65536 * (word > 32767) is the angle of a word.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check PyXGT==1.1
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import socket
import struct
import threading

from PyXGT.LS import plc_ls

values = {'%DW100': struct.pack('<h', -5), '%DD50': struct.pack('<i', -5)}
written, answers = [], []


def answer(request):
    """Return the answer of an XGT to a request for one variable; a write without its value is refused."""
    command, kind, _, _, size = struct.unpack_from('<5H', request, 20)
    name, data = request[30:30 + size].decode(), request[30 + size:]
    if command == 0x54:
        body = struct.pack('<6H', 0x55, kind, 0, 0, 1, len(values[name])) + values[name]
    else:
        written.append(data.hex(' '))
        sound = len(data) - 2 == {1: 1, 2: 2}[kind]
        body = struct.pack('<5H', 0x59, kind, 0, 0 if sound else 0xFFFF, 1 if sound else 0x21)
    return b'LSIS-XGT' + bytes(4) + b'\xa0\x11' + request[14:16] + struct.pack('<HBB', len(body), 0, 0) + body


def serve(server):
    link, _ = server.accept()
    while head := link.recv(20, socket.MSG_WAITALL):
        answers.append(answer(head + link.recv(struct.unpack_from('<H', head, 16)[0], socket.MSG_WAITALL)))
        link.sendall(answers[-1])


server = socket.create_server(('127.0.0.1', 0))
threading.Thread(target=serve, args=(server,), daemon=True).start()
plc = plc_ls(*server.getsockname())

read = plc.command('XGB', 'read', 'word', 'D100'), plc.command('XGB', 'read', 'dword', 'D50')
print('a word and a dword of -5 are read as', read)
assert read == ([65531], [4294967291]), read
returned = [plc.command('XGB', 'write', kind, 'D100', '20') for kind in ('byte', 'word')]
status = [packet[26:28].hex() for packet in answers[2:]]
print('20 as a byte and as a word:', written, 'status:', status, 'returned:', returned)
assert written == ['20 00', '20 00 14 00'] and status == ['ffff', '0000'] and returned == [None, None]
PYTHON
