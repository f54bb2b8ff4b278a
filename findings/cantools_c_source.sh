#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# cantools 45.1.0: the C code that it makes of a DBC sends a torque of -0.3 N·m as -0.2 N·m, Python as -0.3 N·m.
#
# A drive's position is in steps of 0.001 rad and its torque in steps of 0.1 N·m. Expected: the functions that
# `cantools generate_c_source` makes for a value encode it as Database.encode_message() does, to the nearest step. What
# happens: they divide by the step and cut off, and a division such as 0.29 / 0.01 is a little below the whole number
# that is meant. So 1297 of the 10 000 positions from 0 to 9.999 rad, and 66 of the 201 torques from -10 to 10 N·m, are
# sent as one step less than they are, although the DBC can hold them exactly. A value between two steps is always sent
# as the one nearer to zero.
# For us: add half a step, with the sign of the value, before a value is given to such a function.
#
# Exit code 0: still so. Needs a C compiler; installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check cantools==45.1.0
cd "$folder"
cat > drive.dbc <<'DBC'
VERSION ""
NS_ :
BS_:
BU_: Drive
BO_ 257 Joint: 8 Drive
 SG_ Position : 0|32@1- (0.001,0) [-100|100] "rad" Drive
 SG_ Torque : 32|16@1- (0.1,0) [-100|100] "Nm" Drive
DBC
venv/bin/python -m cantools generate_c_source drive.dbc --database-name drive > /dev/null
cat > encode.c <<'C'
#include <stdio.h>
#include "drive.h"

int main(void)
{
    char signal;
    double value;
    while (scanf(" %c %lf", &signal, &value) == 2)
        printf("%d\n", signal == 'p' ? (int)drive_joint_position_encode(value) : (int)drive_joint_torque_encode(value));
    return 0;
}
C
cc -o encode encode.c drive.c
timeout 60 venv/bin/python - <<'PYTHON'
import subprocess

import cantools

message = cantools.database.load_file('drive.dbc').get_message_by_name('Joint')


def by_c(signal, values):
    lines = ''.join(f'{signal} {value!r}\n' for value in values)
    done = subprocess.run('./encode', input=lines, text=True, check=True, stdout=subprocess.PIPE)
    return [int(line) for line in done.stdout.split()]


def by_python(signal, values):
    def counts(value):
        data = message.encode({'Position': 0.0, 'Torque': 0.0} | {signal: value})
        return int.from_bytes(data[:4] if signal == 'Position' else data[4:6], 'little', signed=True)

    return [counts(value) for value in values]


wrong = {}
for signal, step, steps in (('Position', 1000, range(10_000)), ('Torque', 10, range(-100, 101))):
    values = [count / step for count in steps]
    assert by_python(signal, values) == list(steps)
    wrong[signal] = sum(sent != count for sent, count in zip(by_c(signal[0].lower(), values), steps))
torque = by_c('t', [-0.3])[0], by_python('Torque', [-0.3])[0]
between = by_c('p', [0.0018, -0.0018]), by_python('Position', [0.0018, -0.0018])
print('Wrong of 10 000 positions and 201 torques:', wrong)
print('-0.3 N·m by C and by Python:', torque, 'tenths; 0.0018 and -0.0018 rad:', between, 'thousandths')
assert wrong == {'Position': 1297, 'Torque': 66}
assert torque == (-2, -3) and between == ([1, -1], [2, -2])
PYTHON
