#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# fins 1.0.5: once a PLC has answered late, each word that is read is the one that was asked for before.
#
# Expected: an answer belongs to its question, by its service identifier, which FINS has for this. What happens over
# UDP: all commands have the same identifier, and none is compared. A read that is not answered within a second raises
# an error; its answer, which arrives a little later, is then taken for that of the next read, and so on for good:
# D300 is read as D200, D400 as D300. Only to take out what has arrived ends it. A server on this machine answers here
# as a PLC does.
# For us: after each error, read from `fins_socket` until it times out, and only then the next word.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check fins==1.0.5
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import socket
import threading
import time

from fins.udp import UDPFinsConnection

memory = {100: 1, 200: 2, 300: 3, 400: 4}
server = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
server.bind(('127.0.0.1', 0))
read, identifiers = [], []


def answer():
    while True:
        request, address = server.recvfrom(2048)
        word = int.from_bytes(request[13:15], 'big')
        identifiers.append(request[9])
        if word == 200 and identifiers.count(request[9]) == 2:
            time.sleep(1.5)
        header = b'\xc0' + request[1:3] + request[6:9] + request[3:6] + request[9:10]
        server.sendto(header + request[10:12] + b'\x00\x00' + memory[word].to_bytes(2, 'big'), address)


threading.Thread(target=answer, daemon=True).start()
plc = UDPFinsConnection()
plc.connect('127.0.0.1', server.getsockname()[1], bind_port=0)
for word in (100, 200, 300, 400, 100):
    try:
        read.append(plc.read('d', word, 'i'))
    except TimeoutError as error:
        read.append(str(error))
        time.sleep(1.0)
print('in D100, D200, D300, D400, D100:', read, 'service identifiers', identifiers)
assert read == [1, 'timed out', 2, 3, 4] and len(set(identifiers)) == 1
try:
    while True:
        plc.fins_socket.recvfrom(2048)
except TimeoutError:
    assert plc.read('d', 300, 'i') == 3
PYTHON
