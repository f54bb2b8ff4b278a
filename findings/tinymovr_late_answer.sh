#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# tinymovr 3.2.0: once a motor has answered late, each value that is read is the one of the read before.
#
# Expected: after a read that raised an error because no answer came within a second, the next one gives what the
# motor answers to it. What happens: the answer that arrives late stays in the channel's queue, and the next read of
# the same value takes it, whose own answer then waits for the read after it, and so on for good. A controller that
# reads the position of a moving joint gets that of its previous cycle, or of minutes ago where it reads now and then.
# A fake motor on a virtual bus answers here, with the identifiers of the requests: it moves by 1000 ticks between two
# reads.
# For us: after an error, clear `motor._channel.queue` and `motor._channel.evt` before each read.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check tinymovr==3.2.0 avlos==0.9.3 python-can==4.6.1
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import pathlib
import struct
import threading
import time

import can
import tinymovr
import yaml
from avlos.deserializer import deserialize
from tinymovr.bus_router import destroy_router, init_router
from tinymovr.channel import ResponseError
from tinymovr.config import create_device_with_hash_msg

specification = pathlib.Path(tinymovr.__file__).parent / 'specs' / 'tinymovr_3_1_x.yaml'
version = deserialize(yaml.safe_load(specification.read_text())).hash_uint32
bus = can.Bus('motor', interface='virtual')
position = 1000


def answer():
    for frame in bus:
        if frame.is_remote_frame:
            data = struct.pack('<f', position)
            if position == 2000:
                time.sleep(1.5)
            bus.send(can.Message(arbitration_id=frame.arbitration_id, is_extended_id=True, data=data))


threading.Thread(target=answer, daemon=True).start()
init_router(can.Bus, {'interface': 'virtual', 'channel': 'motor'})
motor = create_device_with_hash_msg(can.Message(arbitration_id=0x701, data=struct.pack('<I', version)))
read = []
for position in range(1000, 7000, 1000):
    if position == 6000:
        motor._channel.queue.clear()
        motor._channel.evt.clear()
    try:
        read.append(motor.sensors.user_frame.position_estimate.magnitude)
    except ResponseError as error:
        read.append(str(error))
        time.sleep(1.5)
    time.sleep(0.2)
destroy_router()
print('at 1000, 2000, ... 6000, the last after clearing the queue:', read)
assert read == [1000, 'Node 1 did not respond', 2000, 3000, 4000, 6000]
PYTHON
