#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# PyRoboteq 0.1.2: an encoder at 12345 counts is read as 12 if the answer comes in two pieces, later ones are exchanged.
#
# A Roboteq drive echoes a query and answers with a line that ends with a carriage return: "C=12345". At 115200 baud
# each character takes 87 µs. Expected of read_value(READ_ABSCNTR, 1): the whole line. What happens: what has arrived
# when the first bytes are there is taken as the answer. If its second piece comes later, "C=12" is returned, without an
# error. The rest is not thrown away, so that each later query is answered by what came before it: the next one by an
# empty text, then a temperature is read as "C=12345" and a position as "T=40", as long as the program runs here, though
# all later answers come in one piece. A pseudo-terminal answers here as a drive does; once, it makes a pause of 0.1 s
# between two pieces of an answer. The queries are 0.5 s apart.
# For us: send by send_raw_command() and read from .ser up to the carriage return yourself.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check PyRoboteq==0.1.2 pyserial==3.5
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import os
import pty
import threading
import time
import tty

from PyRoboteq import RoboteqHandler
from PyRoboteq import roboteq_commands as commands

device, host = pty.openpty()
tty.setraw(device)
tty.setraw(host)
pieces = []


def drive():
    while True:
        query = b''
        while not query.endswith(b'\r'):
            query += os.read(device, 1)
        answer = {b'?C': b'C=12345\r', b'?T': b'T=40\r'}[query[:2]]
        whole = query + answer
        start = 0
        for end in [*pieces, len(whole)]:
            os.write(device, whole[start:end])
            start = end
            time.sleep(0.1)


threading.Thread(target=drive, daemon=True).start()
controller = RoboteqHandler()
assert controller.connect(os.ttyname(host))


def read(query):
    found = controller.read_value(query, 1)
    time.sleep(0.5)
    print(query, '->', repr(found))
    return found


whole = [read(commands.READ_ABSCNTR), read(commands.READ_TEMP)]
assert whole == ['C=12345', 'T=40']
pieces.append(len('?C [1]+\rC=12'))
cut = [read(commands.READ_ABSCNTR)]
pieces.clear()
cut += [read(query) for query in 2 * [commands.READ_ABSCNTR, commands.READ_TEMP] + [commands.READ_ABSCNTR]]
assert cut == ['C=12', '', 'C=12345', 'T=40', 'C=12345', 'T=40']
PYTHON
