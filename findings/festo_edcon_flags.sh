#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# festo-edcon 1.0.3: over Modbus, each flag and unsigned byte of a drive is read as None, also that its homing is valid.
#
# Expected of read_pnu(): True for the flag "Actual referencing is valid", and 1 for the byte "Active gear factor
# index". What happens: a Modbus register has two bytes, and the library keeps both; after it has taken the first it
# unpacks the value once more from the two, which fails, so that it gives None. This concerns the 846 of the 3548
# parameters in its table that are of the types BOOL and USINT. An error is logged, but None counts as false in an `if`,
# so that a drive that is homed is homed again. A signed byte and a torque of 16 bits are read right. A stub takes the
# place of the Modbus client, with the registers of its mailbox.
# For us: read flags and bytes by read_pnu_raw()[0].
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check festo-edcon==1.0.3
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import struct
import threading
from types import SimpleNamespace

from edcon.edrive import com_modbus
from edcon.edrive.parameter_mapping import PnuMap

HOMED, GEAR, TORQUE = 2422, 4955, 314
values = {HOMED: b'\x01', GEAR: b'\x01', TORQUE: struct.pack('<h', -250)}


class Client:
    def __init__(self):
        self.registers = {}

    def write_register(self, address, value):
        self.registers[address] = value
        if address != com_modbus.REG_PNU_MAILBOX_EXEC:
            return
        data = values[self.registers[com_modbus.REG_PNU_MAILBOX_PNU]]
        self.registers[com_modbus.REG_PNU_MAILBOX_DATA_LEN] = len(data)
        self.registers[com_modbus.REG_PNU_MAILBOX_DATA] = int.from_bytes(data, 'little')
        self.registers[address] = com_modbus.PNU_MAILBOX_EXEC_DONE

    def read_holding_registers(self, address, count):
        return SimpleNamespace(registers=[self.registers[address + k] for k in range(count)])


drive = object.__new__(com_modbus.ComModbus)
drive.lock, drive.modbus_client = threading.Lock(), Client()
drive.shutdown = lambda: None
for number in values:
    print(PnuMap()[number].name, '=', drive.read_pnu(number), 'of', drive.read_pnu_raw(number))
assert [drive.read_pnu(number) for number in values] == [None, None, -250]
assert drive.read_pnu_raw(HOMED) == b'\x01\x00'
PYTHON
