#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# durand 0.5.0: a TPDO for each tenth SYNC is sent with each SYNC from the tenth on, and one of type 254 is never sent.
#
# Expected: as CiA 301 has it, a TPDO of the transmission type n from 1 to 240 is sent with each n-th SYNC, and the
# types 254 and 255 are both event-driven. What happens: a simulated drive counts SYNCs and never begins anew, so that a
# type of 10 gives 91 positions in 100 SYNCs instead of 10, and loads the bus ninefold. With the type 254, which many
# EDS files of drives have, a position that changes is not sent at all; with 255 it is. A network that keeps what is
# sent stands in for the bus.
# For us: set the type 255, or 1, for a position; do not measure the load of a bus with this drive.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check durand==0.5.0 python-can==4.6.1
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
from durand import Node, Variable
from durand.datatypes import DatatypeEnum
from durand.network import NetworkABC


class Bus(NetworkABC):
    def __init__(self):
        self.subscriptions, self.sent = {}, []

    def add_subscription(self, cob_id, callback):
        self.subscriptions[cob_id] = callback

    def remove_subscription(self, cob_id, callback=None):
        self.subscriptions.pop(cob_id, None)

    def send(self, cob_id, msg):
        self.sent.append(cob_id)


def sent(transmission_type):
    bus = Bus()
    drive = Node(bus, 1)
    drive.object_dictionary[0x6064] = Variable(DatatypeEnum.INTEGER32, 'ro', 0, name='Position actual value')
    drive.tpdo[0].mapping = [(0x6064, 0)]
    drive.tpdo[0].transmission_type = transmission_type
    drive.tpdo[0].enable = True
    bus.subscriptions[0](0, b'\x01\x01')
    bus.sent.clear()
    for count in range(1, 101):
        drive.object_dictionary.write(0x6064, 0, count)
        bus.subscriptions[0x80](0x80, b'')
    return bus.sent.count(0x181)


found = {kind: sent(kind) for kind in (1, 2, 10, 240, 254, 255)}
print('positions in 100 SYNCs, with as many changes, by transmission type:', found)
assert found == {1: 100, 2: 99, 10: 91, 240: 0, 254: 0, 255: 100}
PYTHON
