#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# pymodbus 3.16.1: the fault of a drive, bit 3 of its status word, is found at index 11, and a halt is sent as bit 0.
#
# A drive of CiA 402 over Modbus/TCP has its status word in one register: bit 3 is a fault, bit 11 an internal limit.
# Expected of convert_from_registers(registers, DATATYPE.BITS): bit n of the register at index n, as it is for coils.
# What happens: the two bytes are exchanged, so that the bits 8 to 15 come first. A drive that has a fault seems to be
# at a limit, and one at a limit seems to have a fault. convert_to_registers() exchanges them as well: bit 8 of a
# control word, a halt, is sent as bit 0, and a list of fewer than 16 bits comes back with 16, as it is filled up in
# place. A round trip by both shows nothing. The maintainer has called it an error (issue 2623, 2025). A server of
# pymodbus answers here.
# For us: take the number of the register apart, as registers[0] >> 3 & 1.
#
# Exit code 0: still so. Installs the version into a temporary folder; the server is on the loopback address.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check pymodbus==3.16.1
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import asyncio
import socket

from pymodbus.client import AsyncModbusTcpClient as Client
from pymodbus.server import ModbusTcpServer
from pymodbus.simulator import DataType, SimData, SimDevice

READY, FAULT, LIMIT, HALT = 0x0237, 1 << 3, 1 << 11, 1 << 8
STATUS, CONTROL = 0x6041, 0x6040


async def drive():
    with socket.create_server(('127.0.0.1', 0)) as free:
        port = free.getsockname()[1]
    words = [SimData(CONTROL, values=[0, READY | LIMIT], datatype=DataType.REGISTERS)]
    server = ModbusTcpServer(SimDevice(1, simdata=words), address=('127.0.0.1', port))
    await server.serve_forever(background=True)
    client = Client('127.0.0.1', port=port)
    await client.connect()
    status = (await client.read_holding_registers(STATUS, count=1, device_id=1)).registers
    bits = client.convert_from_registers(status, Client.DATATYPE.BITS)
    command = [bool(0x000F >> n & 1) for n in range(8)] + [True]  # enabled, and bit 8: halt
    await client.write_registers(CONTROL, client.convert_to_registers(command, Client.DATATYPE.BITS), device_id=1)
    control = (await client.read_holding_registers(CONTROL, count=1, device_id=1)).registers
    client.close()
    await server.shutdown()
    return status[0], bits, command, control[0]


status, bits, command, control = asyncio.run(drive())
print(f'status word 0x{status:04X}, at a limit: fault', bits[3], ', limit', bits[11])
print(f'control word 0x{control:04X} in place of 0x{0x000F | HALT:04X};', len(command), 'bits in the list')
assert status == READY | LIMIT and status & FAULT == 0 and bits[3] and not bits[11]
assert bits == [bool(status >> n & 1) for n in (*range(8, 16), *range(8))]
assert control == 0x0F01 and len(command) == 16
faulty = Client.convert_from_registers([FAULT], Client.DATATYPE.BITS)
assert faulty.index(True) == 11
assert Client.convert_to_registers(faulty, Client.DATATYPE.BITS) == [FAULT]
PYTHON
