#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# can-j1939 2.0.12: a drive without faults has one, or still has its old ones, and a request to clear one of its faults
# names another.
#
# Two nodes of the package are on a virtual bus. A drive has the faults with the SPN 190 and 520198; the second is one
# of the numbers for manufacturers. Expected of DM1 at the other node: both, and none once they are gone. What happens:
# both, but a list without faults is sent with two bytes instead of the eight of SAE J1939-73, which the package itself
# takes as too short: it logs so, and calls its subscribers with the faults of before, again and again. Where a drive of
# another maker says that it has no fault, with zeros for SPN and FMI, as the standard has it, a fault of SPN 0 is
# reported. The request of DM22 to clear 520198, 0x7F006, lacks the upper three bits, so that it is for 61446, 0xF006.
# For us: take a fault of SPN 0 and FMI 0 for none, drop lists whose `Dm1.data` has two bytes, and send DM22 by hand.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check can-j1939==2.0.12 python-can==4.6.1 numpy==2.4.6
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import logging
import os
import time

import can
import j1939

logging.disable(logging.CRITICAL)


def node(address):
    unit = j1939.ElectronicControlUnit()
    unit.connect(interface='virtual', channel='vehicle')
    fields = ('industry_group', 'vehicle_system_instance', 'vehicle_system', 'function', 'function_instance')
    rest = dict.fromkeys((*fields, 'arbitrary_address_capable', 'ecu_instance', 'manufacturer_code'), 0)
    application = j1939.ControllerApplication(j1939.Name(identity_number=address, **rest), address)
    unit.add_ca(controller_application=application)
    application.start()
    return application


def heard(seconds=1.5):
    """The last list of faults that was reported within this time."""
    reports.clear()
    time.sleep(seconds)
    return [(fault['spn'], fault['fmi']) for fault in reports[-1]]


drive, master = node(0x10), node(0x20)
bus = can.Bus(interface='virtual', channel='vehicle')
time.sleep(1)
faults, reports = [{'spn': 190, 'fmi': 0, 'oc': 1}, {'spn': 520198, 'fmi': 3, 'oc': 1}], []
receiver, sender = j1939.Dm1(master), j1939.Dm1(drive)
receiver.subscribe(lambda source, lamps, found, stamp: reports.append(found))
sender.start_send(lambda: ({'pl': 0, 'awl': 1, 'rsl': 0, 'mil': 0}, [dict(fault) for fault in faults]), 0.2)
present = heard()
faults.clear()
time.sleep(0.5)
gone, times, size = heard(), len(reports), len(receiver.data)
while bus.recv(0):
    pass
j1939.Dm22(master).request_clear_act_dtc(0x10, 520198, 3)
time.sleep(0.5)
(cleared,) = [frame.data for frame in iter(lambda: bus.recv(0), None) if frame.arbitration_id == 0x18C31020]
number = cleared[5] | cleared[6] << 8 | (cleared[7] & 0xE0) << 11
drive.stop()
time.sleep(0.5)
reports.clear()
bus.send(can.Message(arbitration_id=0x18FECA30, data=b'\x00\xff\x00\x00\x00\x00\xff\xff'))
time.sleep(0.5)
other = [(fault['spn'], fault['fmi']) for fault in reports[0]]
print('Faults:', present, 'once they are gone:', gone, times, 'times; of a drive without faults:', other, flush=True)
print('Number of the fault to be cleared:', number, flush=True)
assert present == gone == [(190, 0), (520198, 3)] and times > 1 and size == 2
assert other == [(0, 0)] and number == 61446 == 520198 & 0xFFFF
os._exit(0)  # the threads of the nodes go on
PYTHON
