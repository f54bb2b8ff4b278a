#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# PIPython 2.11.0.6: of a move of 0.8 s that is to be recorded as a whole, the first 0.41 s are recorded.
#
# A C-867.262 of PI records 8192 values at multiples of its servo cycle of 50 µs. Expected of rectimemax, which is
# documented to set the sample time to record for this time with the greatest number of points: at 0.8 s two cycles, for
# 0.82 s. What happens: one cycle is sent to the controller, for 0.41 s, as 1.95 cycles are cut to 1; for 20 s it is
# 19.66 s. Likewise a sample time of 0.3 ms, six cycles, becomes 0.25 ms, as 0.3 ms / 50 µs is 5.999999999999999.
# The documentation of PIPython sets 1 kHz by "drec.samplefrequ = 1000". Expected: 20 cycles. What happens: nothing is
# sent, as the property is named samplefreq and any other name is taken without an error.
# A socket that answers as the controller does takes its place here.
# For us: set samplerate to the number of cycles, rounded up, and look at rectime before the move.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check PIPython==2.11.0.6 pyusb==1.3.1 pyserial==3.5
cat > "$folder/record.py" <<'PYTHON'
import os
import socket
import threading

from pipython import GCSDevice, datarectools
from pipython.interfaces.pisocket import PISocket

ANSWERS = {
    '*IDN?': '(c)2016 Physik Instrumente (PI) GmbH & Co. KG, C-867.262, 123456789, 1.000\n', 'CSV?': '2.0\n',
    'ERR?': '0\n', 'HLP?': 'The following commands are valid: \nRTR set the record rate \nRTR? get it \nend of help\n',
}
cycles = [1]


def controller(server):
    connection, _ = server.accept()
    with connection, connection.makefile('r') as lines:
        for line in lines:
            command = line.strip()
            if command.startswith('RTR '):
                cycles.append(int(command.split()[1]))
            answer = f'{cycles[-1]}\n' if command == 'RTR?' else ANSWERS.get(command)
            if answer:
                connection.sendall(answer.encode())


server = socket.create_server(('127.0.0.1', 0))
threading.Thread(target=controller, args=(server,), daemon=True).start()
device = GCSDevice(gateway=PISocket('127.0.0.1', server.getsockname()[1]))
recorder = datarectools.Datarecorder(device)
assert device.devname == 'C-867.262' and recorder.servotime == 50e-6 and recorder.maxnumvalues == 8192

for seconds, right, sent in (0.8, 2, 1), (20, 49, 48), (13.1072, 32, 32):
    recorder.rectimemax = seconds
    print(f'rectimemax {seconds} s: {cycles[-1]} cycles, recorded for {recorder.rectime:.4f} s')
    assert cycles[-1] == sent and right * 50e-6 * 8192 >= seconds * (1 - 1e-9)
    assert (recorder.rectime < seconds * (1 - 1e-9)) == (sent < right)

for seconds, sent in (0.3e-3, 5), (0.4e-3, 8):
    recorder.sampletime = seconds
    print(f'sampletime {seconds} s: {cycles[-1]} cycles')
    assert cycles[-1] == sent

before = list(cycles)
recorder.samplefrequ = 1000
assert cycles == before and round(recorder.samplefreq) == 2500
recorder.samplefreq = 1000
print('samplefreq 1000 Hz:', cycles[-1], 'cycles')
assert cycles[-1] == 20
os._exit(0)
PYTHON
timeout 60 "$folder/venv/bin/python" -u "$folder/record.py"
