#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# python-can 4.6.1, dbckit 1.1.1: all frames of an .asc whose times are relative get the same time.
#
# The head of a CANalyzer log says `timestamps absolute`, from the start of the measurement, or `timestamps relative`,
# each from the event before it. Three frames of a drive, one every 10 ms. Expected: 0.01, 0.02, 0.03 s. What happens:
# both take all times as absolute, python-can after it has read the word: 0.01, 0.01, 0.01 s. A speed by differences is
# then infinite.
# For us: save such a log with absolute times, or sum its times up before it is decoded.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check python-can==4.6.1 dbckit==1.1.1
cd "$folder"
timeout 60 venv/bin/python - <<'PYTHON'
import can
import dbckit

database = dbckit.parse_string(
    'VERSION ""\nNS_ :\nBS_:\nBU_: A\n'
    'BO_ 100 Drive: 2 A\n SG_ Position : 0|16@1- (0.001,0) [0|0] "rad" A\n'
)
for form, times in (('absolute', (0.01, 0.02, 0.03)), ('relative', (0.01, 0.01, 0.01))):
    frames = [f'   {time:.6f} 1  64             Rx   d 2 0{n} 00\n' for n, time in enumerate(times)]
    with open('bus.asc', 'w') as file:
        file.write(f'date Sat Nov 28 04:00:00.000 am 2026\nbase hex  timestamps {form}\n')
        file.writelines(['internal events logged\n', *frames])
    with can.ASCReader('bus.asc') as reader:
        read = [message.timestamp for message in reader]
    decoded = [frame.timestamp for frame in dbckit.decode_log(database, 'bus.asc')]
    print(form, 'python-can', read, 'dbckit', decoded)
    assert read == decoded == list(times)
PYTHON
