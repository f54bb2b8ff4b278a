#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# step-driver-g071-api 1.1: a stepper that is sent to 70 000 steps goes to 70 001, and to 655 350 it goes ten steps too
# far.
#
# The driver takes a position in two Modbus registers of 16 bits. Expected of move_to_pos(70000): 70 000 is sent. What
# happens: the position is divided by 65 535 instead of 65 536, so that one step is added for each 65 535: 65 535 is
# sent as 65 536, and 655 350 as 655 360. The position is read back right, so that the move ends with "not in set
# position" in the log, and no exception. Up to 65 534 steps all is right; 65 535, 131 071 and so on cannot be reached
# at all.
# For us: give p - p // 65536 instead of the position p.
#
# A pseudo-terminal answers as the driver does, and is where it is sent. Exit code 0: still so. Installs into a
# temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check step-driver-g071-api==1.1 pymodbus==3.0.2 pyserial==3.5
cat > "$folder/stepper.py" <<'PYTHON'
import os
import pty
import struct
import threading
import tty

from step_driver_g071_api import StepDriver

stands = 0


def with_checksum(frame):
    value = 0xFFFF
    for byte in frame:
        value ^= byte
        for _ in range(8):
            value = value >> 1 ^ 0xA001 if value & 1 else value >> 1
    return frame + struct.pack('<H', value)


def answer(terminal):
    global stands
    pending = b''
    while True:
        pending += os.read(terminal, 64)
        while len(pending) >= 8:
            function = pending[1]
            length = 8 if function == 3 else 9 + pending[6]
            if len(pending) < length:
                break
            frame, pending = pending[:length], pending[length:]
            if function == 3:  # status and position, the low word first
                content = struct.pack('>BBBHHH', frame[0], 3, 6, 0, stands & 0xFFFF, stands >> 16)
            else:
                low, high = struct.unpack_from('>HH', frame, 7 + 6)
                stands = low + (high << 16)
                content = frame[:6]
            os.write(terminal, with_checksum(content))


bus, host = pty.openpty()
tty.setraw(bus)
tty.setraw(host)
threading.Thread(target=answer, args=(bus,), daemon=True).start()
driver = StepDriver(port=os.ttyname(host), modbus_address=4)
for position, reached in ((100, 100), (65534, 65534), (65535, 65536), (70000, 70001), (655350, 655360)):
    driver.move_to_pos(position=position, speed=2000)
    print('sent to', position, 'the motor stands at', stands)
    assert stands == reached
PYTHON
timeout 100 "$folder/venv/bin/python" "$folder/stepper.py"
