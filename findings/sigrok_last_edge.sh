#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# pysigrok-libsigrokdecode 0.0.2: the last edge of an encoder and the last step of a motor are never in the position.
#
# An encoder of 400 edges makes one turn at 60 rpm and stands still for 1 s then; the capture begins 0.1 ms before its
# first edge. Expected of the decoder graycode with edges=400: rates of 60 rpm, a count of 400 and one turn at the end.
# What happens: each count is given only when the next edge comes, so that the last one is 399, and the turn is never
# given, however long the shaft stands. And the first rate is 1500 rpm, as the time since the capture began is
# taken for the time between two edges.
# A motor makes five steps, then two steps back, and stands still for 1 s. Expected of the decoder stepper_motor: a last
# position of 3. What happens: 4, for the same reason; and the steps back have the same speed as those forward.
# The decoders are those of the sigrok project; sigrok-cli 0.7.2 with libsigrokdecode 0.5.3 of Debian 12 gives the same.
# For us: count the edges of a .sr or .vcd file by a program of one's own, as a decoder loses the place of the stop.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check \
    pysigrok==0.4.2 pysigrok-libsigrokdecode==0.0.2 pyserial==3.5
cd "$folder"
cat > captures.py <<'PYTHON'
import zipfile


def save(name, channels, samples):
    """Write two channels, bits 0 and 1 of each sample, as a file of sigrok at 100 kHz."""
    metadata = '\n'.join((
        '[global]', 'sigrok version=0.5.2', '[device 1]', 'capturefile=logic-1', 'total probes=2',
        'samplerate=100 kHz', 'total analog=0', f'probe1={channels[0]}', f'probe2={channels[1]}', 'unitsize=1', '',
    ))
    with zipfile.ZipFile(name, 'w') as file:
        file.writestr('version', '2')
        file.writestr('metadata', metadata)
        file.writestr('logic-1-1', bytes(samples))


STATES = 0b00, 0b01, 0b11, 0b10
turn = [STATES[0]] * 10
for edge in range(1, 401):
    turn += [STATES[edge % 4]] * 250
save('encoder.sr', 'AB', turn + [STATES[0]] * 100_000)
steps = ([0b10] * 50 + [0b11] * 50) * 5 + [0b00] * 200 + ([0b00] * 50 + [0b01] * 50) * 2
save('motor.sr', ('step', 'dir'), steps + [0b00] * 100_000)
PYTHON
"$folder/venv/bin/python" captures.py
timeout 120 "$folder/venv/bin/pysigrok-cli" -i encoder.sr -P graycode:d0=A:d1=B:edges=400 > encoder.txt
timeout 120 "$folder/venv/bin/pysigrok-cli" -i motor.sr -P stepper_motor:step=step:dir=dir > motor.txt
cat > check.py <<'PYTHON'
import re

lines = open('encoder.txt', encoding='utf-8').read().splitlines()
rates = [line for line in lines if line.endswith('rpm')]
count = max(int(line) for line in lines if re.fullmatch(r'\d+', line))
turns = {line for line in lines if re.fullmatch(r'[+-]\d+', line)}
print('encoder: rates', rates[:3], 'last count', count, 'turns', turns)
assert turns == {'+0'}
assert rates[0] == '1.50 krpm' and set(rates[1:]) == {'60.0 rpm'} and len(rates) == 400 and count == 399

lines = open('motor.txt', encoding='utf-8').read().splitlines()
positions = [line for line in lines if line.endswith(' steps')]
print('motor: positions', positions, 'speeds', [line for line in lines if line.endswith(' steps/s')])
assert positions == [f'{position} steps' for position in (1, 2, 3, 4, 5, 4)]
assert not any(line.startswith('-') for line in lines)
PYTHON
"$folder/venv/bin/python" check.py
