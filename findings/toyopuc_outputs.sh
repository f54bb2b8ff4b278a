#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# toyopuc-10gx 0.1.4 (Python): output Y0 of a TOYOPUC, as a brake, is written to Y400, and Y400 sets the relay M0.
#
# The package takes the relays X, Y and M from 0 to 7FF each, 2048 bits, with the addresses of the manual of the
# TOYOPUC-Nano 2ET, chapter 3.4.2. X begins at 681000 and M at 681800, so that there is room for X alone. That X and Y
# are one range there shows plc-comm-toyopuc 4.2.0, which cites the same chapter: it has 681000 for P1-X000 and for
# P1-Y000. Expected of bit_write('P1-Y000', 1): a write to 681000.
# What happens: it goes to 681400, which is X400 in the package itself and Y400 in the PLC. Y400 to Y7FF go to M000 to
# M3FF, the relays of the program, and are read from there. One item is returned as written. GY and EY are shifted into
# GX and EX in the same way. X and M are right. A server on this machine takes the frames (command C5) as a PLC does.
# For us: name outputs with X (P1-X000 for Y000), and do not use Y, EY and GY.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
for package in toyopuc-10gx==0.1.4 plc-comm-toyopuc==4.2.0; do
    python3 -m venv "$folder/${package%==*}"
    "$folder/${package%==*}/bin/pip" install --quiet --disable-pip-version-check "$package"
done
timeout 60 "$folder/plc-comm-toyopuc/bin/python" - <<'PYTHON' > "$folder/reference"
import toyopuc

for name in ('P1-X000', 'P1-X400', 'P1-Y000', 'P1-Y400', 'P1-M000'):
    print(name, f'{toyopuc.resolve_device(name, profile="toyopuc:nano-10gx:native").addr32:x}')
PYTHON
timeout 60 "$folder/toyopuc-10gx/bin/python" - "$folder/reference" <<'PYTHON'
import socket
import struct
import sys
import threading

import toyopuc

with open(sys.argv[1]) as lines:
    reference = dict(line.split() for line in lines)
requests = []


def serve():
    connection, _ = listener.accept()
    with connection:
        while head := connection.recv(4, socket.MSG_WAITALL):
            request = connection.recv(struct.unpack('<HH', head)[1], socket.MSG_WAITALL)
            requests.append(request)
            connection.sendall(struct.pack('<BBHB', 0x80, 0, 1, request[0]))


listener = socket.create_server(('127.0.0.1', 0))
threading.Thread(target=serve, daemon=True).start()
plc = toyopuc.connect('127.0.0.1', listener.getsockname()[1])
written = {}
for name in reference:
    assert plc.bit_write(name, 1) == 1
    command, bits, address = struct.unpack_from('<BB3xI', requests[-1])
    assert (command, bits) == (0xC5, 1)
    written[name] = f'{address:x}'
plc.close()
print('plc-comm-toyopuc:', reference)
print('toyopuc-10gx:    ', written)
same = {'P1-X000': '681000', 'P1-X400': '681400', 'P1-M000': '681800'}
assert reference == same | {'P1-Y000': '681000', 'P1-Y400': '681400'}
assert written == same | {'P1-Y000': '681400', 'P1-Y400': '681800'}
PYTHON
