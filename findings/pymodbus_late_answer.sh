#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# pymodbus 3.16.1: once a drive on a serial line has answered late, its temperature is read as its position, without an
# error.
#
# A program reads in turn the position, 1000 counts, and the temperature, 25 °C, of a simulated drive that speaks Modbus
# RTU, and that answers once after 1.5 s where the timeout is 1 s. Expected: the right values, or an error. By the
# maintainer (pull request 2636, 2025) the late answer is taken for that to the repetition of the request, of which
# there are up to three by default, and the answer to the repetition is discarded. What happens: it is not, so that each
# read has the answer to the request before it, without an error. On a serial line, with and without asyncio, the reads
# are shifted as long as they follow one another, and right with pauses of 0.6 s; RTU through a TCP gateway is shifted
# with these pauses too. With retries=0 one read is an error, and those after it are shifted. Modbus TCP, which numbers
# its answers, is right.
# For us: read all that is needed of a drive in one request, give it a timeout that it never needs, set retries=0 and,
# after an error, close the client and connect again once the late answer must have come.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check pymodbus==3.16.1 pyserial==3.5
timeout 120 "$folder/venv/bin/python" - 2> /dev/null <<'PYTHON'
import asyncio
import os
import pty
import socket
import struct
import threading
import time
import tty

from pymodbus import FramerType, ModbusException
from pymodbus.client import AsyncModbusSerialClient, ModbusSerialClient, ModbusTcpClient

REGISTERS = {0: 1000, 1: 25}


def checksum(frame):
    value = 0xFFFF
    for byte in frame:
        value ^= byte
        for _ in range(8):
            value = (value >> 1) ^ 0xA001 if value & 1 else value >> 1
    return struct.pack('<H', value)


def drive(read, write, numbered):
    """Answer each request for one register, the second one late."""
    pauses = [0.0, 1.5]
    size = 12 if numbered else 8
    while True:
        request = b''
        while len(request) < size:
            part = read(size - len(request))
            if not part:
                return
            request += part
        unit, function, register, _ = struct.unpack('>BBHH', request[6:12] if numbered else request[:6])
        body = struct.pack('>BBBH', unit, function, 2, REGISTERS[register])
        time.sleep(pauses.pop(0) if pauses else 0.2)
        write(request[:2] + struct.pack('>HH', 0, len(body)) + body if numbered else body + checksum(body))


def serial_port():
    ours, theirs = pty.openpty()
    tty.setraw(ours)
    tty.setraw(theirs)
    parts = (lambda size: os.read(ours, size), lambda data: os.write(ours, data), False)
    threading.Thread(target=drive, args=parts, daemon=True).start()
    return os.ttyname(theirs)


def tcp_port(numbered):
    server = socket.create_server(('127.0.0.1', 0))

    def serve():
        line, _ = server.accept()
        drive(line.recv, line.sendall, numbered)

    threading.Thread(target=serve, daemon=True).start()
    return server.getsockname()[1]


def value(answer):
    return 'error' if answer.isError() else answer.registers[0]


def read(client, pause=0.0):
    client.connect()
    found = []
    for count in range(6):
        try:
            found.append(value(client.read_holding_registers(count % 2, count=1, device_id=1)))
        except ModbusException:
            found.append('error')
        time.sleep(pause)
    client.close()
    return found


async def read_async():
    client = AsyncModbusSerialClient(serial_port(), timeout=1)
    await client.connect()
    found = [value(await client.read_holding_registers(count % 2, count=1, device_id=1)) for count in range(6)]
    client.close()
    return found


client = {'timeout': 1}
gateway = client | {'framer': FramerType.RTU}
right, shifted = [1000, 25] * 3, [1000, 25, 25, 1000, 25, 1000]
cases = {
    'serial': (read(ModbusSerialClient(serial_port(), **client)), shifted),
    'serial, asyncio': (asyncio.run(read_async()), shifted),
    'serial, pauses': (read(ModbusSerialClient(serial_port(), **client), 0.6), right),
    'serial, retries=0': (read(ModbusSerialClient(serial_port(), retries=0, **client)), [1000, 'error', *shifted[2:]]),
    'RTU by TCP': (read(ModbusTcpClient('127.0.0.1', port=tcp_port(False), **gateway)), shifted),
    'RTU by TCP, pauses': (read(ModbusTcpClient('127.0.0.1', port=tcp_port(False), **gateway), 0.6), shifted),
    'TCP': (read(ModbusTcpClient('127.0.0.1', port=tcp_port(True), **client)), right),
}
for name, (found, _) in cases.items():
    print(f'{name}: {found}')
assert all(found == expected for found, expected in cases.values())
PYTHON
