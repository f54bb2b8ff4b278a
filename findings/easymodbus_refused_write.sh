#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# easymodbus 2.1.6: a goal that a busy drive refuses counts as written, and -5 in two registers is read as 4294967291.
#
# Expected of write_single_register() that a drive answers with the exception 6, "server device busy", or a gateway with
# 11, "target device failed to respond": an exception, as for 1 to 4. What happens: it returns True, as it does for a
# goal that was taken. The same holds for the codes 5, 8 and 10, and for all functions that write.
# Expected of convert_registers_to_double(), which makes a "32 Bit long value" of two registers: -5 for the two that
# convert_double_to_two_registers(-5) has made. What happens: 4294967291. A drive is simulated.
# For us: read goals back after they were written, and subtract 2^32 from 2^31 on.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check easymodbus==2.1.6
cat > "$folder/drive.py" <<'PYTHON'
import os
import socketserver
import struct
import threading

from easymodbus.modbus_client import ModbusClient, convert_double_to_two_registers, convert_registers_to_double
from easymodbus.modbus_exception import ModbusException


class Drive(socketserver.BaseRequestHandler):
    """A drive that answers each request with an exception."""

    code = 1

    def handle(self):
        while request := self.request.recv(256):
            self.request.sendall(request[:4] + struct.pack('>HBBB', 3, request[6], request[7] | 0x80, self.code))


server = socketserver.ThreadingTCPServer(('127.0.0.1', 0), Drive)
server.daemon_threads = True
threading.Thread(target=server.serve_forever, daemon=True).start()
client = ModbusClient(*server.server_address)
client.connect()


def written(code):
    """What each way to write returns if it is refused with a code, or None for an exception."""
    Drive.code = code
    results = []
    for write, value in (
        (client.write_single_register, 2000),
        (client.write_multiple_registers, [2000, 0]),
        (client.write_single_coil, True),
        (client.write_multiple_coils, [True, False]),
    ):
        try:
            results.append(write(0, value))
        except ModbusException:
            results.append(None)
    return results


for code in (1, 2, 3, 4, 5, 6, 8, 10, 11):
    results = written(code)
    print(f'refused with {code}: {results}')
    assert results == [None if code <= 4 else True] * 4

back = convert_registers_to_double(convert_double_to_two_registers(-5))
print('-5 in two registers:', back, flush=True)
assert back == 4294967291
os._exit(0)  # A thread of the client would go on.
PYTHON
timeout 60 "$folder/venv/bin/python" "$folder/drive.py"
