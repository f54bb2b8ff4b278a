#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# pymcprotocol 0.3.0: in ASCII, X10 of a Q PLC is read from X16, and W1F from W31; in binary both are right.
#
# X, Y, B and W are numbered in hexadecimal. Frames in ASCII have the number as it is written, by the reference manual
# of the MELSEC communication protocol: X*000010. aslmp 0.2.0 does so too. What happens: the number is converted to
# decimal, X*000016, which the PLC takes as X16. From X10 on, each limit switch is another one, and an output that is
# set is another one, without an error; D and M, which are numbered in decimal, are right. A server on this machine
# answers here as the PLC does.
# For us: keep the default, commtype='binary'.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check pymcprotocol==0.3.0
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import socket
import threading

from pymcprotocol import Type3E

words = {('X', 0x10): 0x10, ('X', 0x16): 0x16, ('W', 0x1F): 0x1F, ('W', 0x31): 0x31, ('D', 100): 100}
BINARY = {0x9C: 'X', 0xB4: 'W', 0xA8: 'D'}
server = socket.create_server(('127.0.0.1', 0))


def answer():
    """Answer reads of one word, each of which holds its own number, in ASCII or in binary."""
    for _ in range(2):
        connection, _ = server.accept()
        with connection:
            while request := connection.recv(64):
                if request.startswith(b'5000'):
                    name = chr(request[30])
                    word = words[name, int(request[32:38], 10 if name == 'D' else 16)]
                    connection.sendall(b'D00000FF03FF0000080000%04X' % word)
                else:
                    word = words[BINARY[request[18]], int.from_bytes(request[15:18], 'little')]
                    connection.sendall(bytes.fromhex('D00000FFFF030004000000') + word.to_bytes(2, 'little'))


threading.Thread(target=answer, daemon=True).start()
found = {}
for form in 'ascii', 'binary':
    plc = Type3E()
    plc.setaccessopt(commtype=form)
    plc.connect('127.0.0.1', server.getsockname()[1])
    found[form] = [plc.batchread_wordunits(name, 1)[0] for name in ('X10', 'W1F', 'D100')]
    plc.close()
    print(form, 'X10 is read from X%X, W1F from W%X, D100 from D%d' % tuple(found[form]))
assert found == {'ascii': [0x16, 0x31, 100], 'binary': [0x10, 0x1F, 100]}
PYTHON
