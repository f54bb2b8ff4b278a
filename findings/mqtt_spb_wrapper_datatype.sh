#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# mqtt-spb-wrapper 2.1.2: an angle that a device sends by Sparkplug B as 2.5 rad is still read at 1 rad, its first one.
#
# A device tells the type of its angle in its DBIRTH, and sends later angles in DDATA with their name, stamp and value,
# but without the type: by Sparkplug 3.0 the type should not be in DDATA. Expected: each angle that is sent, with the
# type of the DBIRTH. What happens: a value without a type is left out, without an error or a callback, so that the
# entity keeps the angle and the stamp of the DBIRTH for ever. With the type in DDATA as well, as this library itself
# sends it, the angle is read right. The application of the library reads DBIRTH and DDATA by these two functions.
# Output: DBIRTH 1.0, DDATA without a type 1.0, with the type 2.5; callbacks: [2.5]
# For us: have devices send the type in DDATA too, or take the bytes of DDATA apart with the protobuf classes.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check mqtt-spb-wrapper==2.1.2 paho-mqtt==1.6.1
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
from mqtt_spb_wrapper import MetricDataType
from mqtt_spb_wrapper.spb_base import SpbEntity
from mqtt_spb_wrapper.spb_protobuf.sparkplug_b_pb2 import Payload

START = 1_700_000_000_000


def message(name, angle, second, typed):
    payload = Payload(timestamp=START + 1000 * second, seq=second)
    metric = payload.metrics.add(name=name, timestamp=payload.timestamp, double_value=angle)
    if typed:
        metric.datatype = MetricDataType.Double
    return payload.SerializeToString()


received = []
device = SpbEntity('bench', 'node', 'gear')
device.deserialize_payload_birth(message('DATA/angle', 1.0, 0, typed=True))
device.data.set_callback('angle', received.append)
found = [(device.data.get_value('angle'), device.data.get_value_timestamp('angle') - START)]
for second, typed in ((1, False), (2, True)):
    device.deserialize_payload_data(message('angle', 2.5, second, typed))
    found.append((device.data.get_value('angle'), device.data.get_value_timestamp('angle') - START))
birth, without, with_type = (angle for angle, _ in found)
print(f'DBIRTH {birth}, DDATA without a type {without}, with the type {with_type}; callbacks:', received)
assert found == [(1.0, 0), (1.0, 0), (2.5, 2000)] and received == [2.5]
PYTHON
