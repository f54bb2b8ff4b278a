#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# uModbus 1.0.4, async-modbus 0.2.3: once a drive has answered late over TCP, its position is read as its temperature.
#
# Modbus over TCP gives each request a transaction identifier, which the answer repeats, so that a late answer can be
# told from the one that is waited for. Expected after a timeout: the late answer is skipped or refused, as the
# identifier is not the one that was asked for. What happens: neither the identifier nor the unit of an answer is looked
# at (by `parse_response_adu()`, for RTU neither). The late answer is taken for that of the next request, and from then
# on each answer for that of the request after it, as long as the connection lives; no error is raised.
# Output: uModbus: position: timeout, temperature: 1500 (is 42), position: 42 (is 1500)
#         async-modbus: position: timeout, temperature: 1500 (is 42), position: 42 (is 1500)
#         an answer of unit 9 to a request to unit 1: 1500
# For us: after a timeout, close the connection and open a new one.
#
# Exit code 0: still so. Installs the versions into a temporary folder, and simulates the drive on this machine.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check uModbus==1.0.4 async-modbus==0.2.3 numpy==2.4.6 \
    connio==0.2.0 pyserial==3.5 serialio==2.4.0
cd "$folder"
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import asyncio
import socket
import struct
import threading
import time

from umodbus.client import tcp

POSITION, TEMPERATURE = 0, 100
REGISTERS = {POSITION: 1500, TEMPERATURE: 42}


def drive(late=0.0, unit=None):
    """The address of a drive that answers its first request after a delay, each with its own identifier."""
    server = socket.create_server(('127.0.0.1', 0))

    def serve():
        connection, _ = server.accept()
        wait = late
        with connection, server, connection.makefile('rb') as requests:
            while len(request := requests.read(12)) == 12:
                identifier, _, _, asked, function, register, count = struct.unpack('>HHHBBHH', request)
                assert (asked, function, count) == (1, 3, 1)
                time.sleep(wait)
                wait = 0
                connection.sendall(struct.pack('>HHHBBBH', identifier, 0, 5, unit or asked, function, 2,
                                               REGISTERS[register]))

    threading.Thread(target=serve, daemon=True).start()
    return server.getsockname()


def simple():
    with socket.create_connection(drive(late=0.5)) as connection:
        connection.settimeout(0.1)
        try:
            tcp.send_message(tcp.read_holding_registers(1, POSITION, 1), connection)
        except TimeoutError:
            connection.settimeout(5)
        return [tcp.send_message(tcp.read_holding_registers(1, register, 1), connection)[0]
                for register in (TEMPERATURE, POSITION)]


async def asynchronous():
    from async_modbus import AsyncTCPClient

    reader, writer = await asyncio.open_connection(*drive(late=0.5))
    client = AsyncTCPClient((reader, writer))
    try:
        await asyncio.wait_for(client.read_holding_registers(1, POSITION, 1), 0.1)
    except asyncio.TimeoutError:
        pass
    found = [int((await client.read_holding_registers(1, register, 1))[0]) for register in (TEMPERATURE, POSITION)]
    writer.close()
    return found


for name, found in (('uModbus', simple()), ('async-modbus', asyncio.run(asynchronous()))):
    print(f'{name}: position: timeout, temperature: {found[0]} (is 42), position: {found[1]} (is 1500)')
    assert found == [1500, 42], found

with socket.create_connection(drive(unit=9)) as connection:
    found = tcp.send_message(tcp.read_holding_registers(1, POSITION, 1), connection)
print(f'an answer of unit 9 to a request to unit 1: {found[0]}')
assert found[0] == 1500
PYTHON
