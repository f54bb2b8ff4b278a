#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# basicmicro 2.0.10: a motor that turns back at 100 counts/s is read at 4294967196 counts/s, with 49152 as its PWM.
#
# The motor of a RoboClaw turns back at -100 counts/s, with a PWM of -16384, which is -50 %, and a current of -150,
# which is -1.5 A. Expected of GetStatus(): these numbers, as ReadPWMs() and ReadCurrents() give them of the same motor,
# and as the maker's library for Arduino reads PWM and current of this status, as int16. What happens: GetStatus() gives
# 49152 and 65386 for PWM and current, and 4294967196 for the speed and its setpoint; GetISpeeds() gives 4294967196 as
# well. All of these are read as words without a sign, while the types of words with a sign are there, and while goals
# are sent with their signs. No other value of these two tells the direction. A terminal that answers with these words,
# as two's complements, takes the place of the controller here.
# For us: take off 2^16 or 2^32 from values from 2^15 or 2^31 on.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check basicmicro==2.0.10 pyserial==3.5
cat > "$folder/status.py" <<'PYTHON'
import binascii
import os
import pty
import struct
import threading
import tty

from basicmicro import Basicmicro

PWM, CURRENT, SPEED = -16384, -150, -100
ANSWERS = {
    48: struct.pack('>2h', PWM, 0), 49: struct.pack('>2h', CURRENT, 0), 79: struct.pack('>2i', SPEED, 0),
    73: struct.pack('>2I4H4h6i4h', 1, 0, 300, 300, 240, 50, PWM, 0, CURRENT, 0, 1000, 0, SPEED, 0, SPEED, 0,
                    0, 0, 0, 0),
}


def controller(terminal):
    while True:
        request = os.read(terminal, 1)
        request += os.read(terminal, 1)
        answer = ANSWERS[request[1]]
        os.write(terminal, answer + struct.pack('>H', binascii.crc_hqx(request + answer, 0)))


terminal, name = pty.openpty()
tty.setraw(name)
threading.Thread(target=controller, args=(terminal,), daemon=True).start()
motor = Basicmicro(os.ttyname(name), 38400, timeout=1)
assert motor.Open()
assert motor.ReadPWMs(0x80) == (True, PWM, 0) and motor.ReadCurrents(0x80) == (True, CURRENT, 0)
done, *status = motor.GetStatus(0x80)
assert done
found = dict(zip(('pwm', 'current', 'encoder', 'setpoint', 'speed'), status[6::2]))
speeds = motor.GetISpeeds(0x80)
print('GetStatus:', found, 'GetISpeeds:', speeds)
assert found == {
    'pwm': 49152, 'current': 65386, 'encoder': 1000, 'setpoint': 4294967196, 'speed': 4294967196,
}
assert list(speeds) == [True, 4294967196, 0]
os._exit(0)
PYTHON
timeout 60 "$folder/venv/bin/python" -u "$folder/status.py"
