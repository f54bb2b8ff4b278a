#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# canopen 2.4.1: a drive whose state is set to 'DISABLE VOLTAGE' is enabled, and a second homing is done before it
# begins.
#
# BaseNode402.state is documented to take 'DISABLE VOLTAGE' as a command. Expected: a control word of 0, after which no
# drive has a torque. What happens: it is looked up as a state to be reached, and as no transition leads to it, the way
# to OPERATION ENABLED is taken. A drive without voltage, or one that is ready or switched on, is enabled, and one that
# is enabled stays so. Then comes a ValueError.
# The second one: homing() sends the control word 0x1F, whose bit 4 starts a homing when it changes from 0 to 1, and
# leaves it so. A second homing() sends 0x1F again, which is no change for a drive of CiA 402, reads that the first one
# is done, and returns True. An output that was moved to 500 counts by hand is not homed.
# A drive with the state machine and the homing of CiA 402, on a virtual bus, answers the SDO.
# Output: 'DISABLE VOLTAGE' in READY TO SWITCH ON: OPERATION ENABLED; in SWITCHED ON: OPERATION ENABLED; in OPERATION
#         ENABLED: OPERATION ENABLED; 'SWITCH ON DISABLED' in all three: SWITCH ON DISABLED
#         homings: True, started 1, at 0 counts; True, started 1, at 500 counts; after 0x0F: True, started 2, at 0
#         counts
# For us: set the state to 'SWITCH ON DISABLED', and the control word to 0x0F before each homing.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check canopen==2.4.1 python-can==4.6.1
timeout 60 "$folder/venv/bin/python" - 2> /dev/null <<'PYTHON'
import time

import canopen
from canopen.objectdictionary import ObjectDictionary, ODVariable, datatypes
from canopen.profiles.p402 import BaseNode402

CONTROL, STATUS, MODE, MODE_SHOWN, MODES = 0x6040, 0x6041, 0x6060, 0x6061, 0x6502
HOMING, POSITION_MODE, HOMING_TIME = 6, 1, 0.2
DISABLED, READY, SWITCHED_ON, ENABLED = 0x0040, 0x0021, 0x0023, 0x0027
ATTAINED, REACHED, START = 1 << 12, 1 << 10, 1 << 4


def dictionary():
    entries = ObjectDictionary()
    for index, kind in ((CONTROL, 'UNSIGNED16'), (STATUS, 'UNSIGNED16'), (MODE, 'INTEGER8'), (MODE_SHOWN, 'INTEGER8'),
                        (MODES, 'UNSIGNED32')):
        entry = ODVariable(f'Object {index:X}', index)
        entry.data_type = getattr(datatypes, kind)
        entries.add_object(entry)
    return entries


class Drive:
    """The state machine of CiA 402, and a homing that is started by a rising bit 4 of the control word."""

    def __init__(self, network):
        self.state, self.homings, self.begun, self.control, self.position = DISABLED, 0, None, 0, 500
        self.node = canopen.LocalNode(1, dictionary())
        network.add_node(self.node)
        self.node.sdo[MODES].raw = 1 << 5 | 1
        self.node.sdo[MODE_SHOWN].raw = POSITION_MODE
        self.node.add_write_callback(self.written)
        self.node.add_read_callback(self.read)

    def written(self, index, data, **_):
        if index == MODE:
            self.node.sdo[MODE_SHOWN].raw = data[0]
        if index == CONTROL:
            word = int.from_bytes(data, 'little')
            self.move(word)
            if word & START > self.control & START and self.state == ENABLED:
                self.homings, self.begun = self.homings + 1, time.monotonic()
            self.control = word

    def move(self, word):
        if word & 0x02 == 0:
            self.state = DISABLED
        elif word & 0x07 == 0x06:
            self.state = READY
        elif word & 0x0F == 0x07:
            self.state = DISABLED if self.state == DISABLED else SWITCHED_ON
        elif word & 0x0F == 0x0F:
            self.state = {DISABLED: DISABLED, READY: SWITCHED_ON}.get(self.state, ENABLED)

    def read(self, index, **_):
        if index != STATUS:
            return None
        done = self.begun is not None and time.monotonic() > self.begun + HOMING_TIME
        if done and self.begun:
            self.position, self.begun = 0, 0.0
        return self.state | (ATTAINED | REACHED if done else 0)


buses = [canopen.Network() for _ in range(2)]
for bus in buses:
    bus.connect(interface='virtual', channel='canopen_402_disable')
drive = Drive(buses[0])
master = BaseNode402(1, dictionary())
buses[1].add_node(master)


def after(start, command):
    drive.state = start
    try:
        master.state = command
    except ValueError:
        assert command == 'DISABLE VOLTAGE'
    return master.state


names = {READY: 'READY TO SWITCH ON', SWITCHED_ON: 'SWITCHED ON', ENABLED: 'OPERATION ENABLED'}
ends = {name: after(start, 'DISABLE VOLTAGE') for start, name in names.items()}
plain = {after(start, 'SWITCH ON DISABLED') for start in names}
print("'DISABLE VOLTAGE' in " + '; in '.join(f'{name}: {end}' for name, end in ends.items()) + ';',
      "'SWITCH ON DISABLED' in all three:", *plain)
assert set(ends.values()) == {'OPERATION ENABLED'} and plain == {'SWITCH ON DISABLED'}
assert after(DISABLED, 'DISABLE VOLTAGE') == 'OPERATION ENABLED'

homings = []
for reset in (False, False, True):
    drive.position = 500
    if reset:
        master.controlword = 0x0F
    homings.append((master.homing(timeout=5), drive.homings, drive.position))
shown = ['{}, started {}, at {} counts'.format(*homing) for homing in homings]
print(f'homings: {shown[0]}; {shown[1]}; after 0x0F: {shown[2]}')
assert homings == [(True, 1, 0), (True, 1, 500), (True, 2, 0)]
for bus in buses:
    bus.disconnect()
PYTHON
