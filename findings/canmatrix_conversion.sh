#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# canmatrix 1.3.3: converting a .dbc to .sym, .xls or .arxml loses floats, signs or factors of signals.
#
# A motor sends its angle in steps of 0.01° as a signed number of 16 bits, and its position as a float. canconvert
# writes the matrix in other formats without a warning. What canmatrix itself then reads of the same bytes:
#
#              angle             position
#     .dbc     -12.34            -2.5
#     .kcd     -12.34            -2.5
#     .sym     -12.34            -1071644672    the float has become an integer
#     .xls     643.02            3223322624     both have become unsigned integers
#     .arxml   64302.0           -2.5           unsigned, and the factor 0.01 is written as 0.0
#
# For us: decode recordings of a CAN bus with the database of the vendor, or convert it to .kcd.
#
# Exit code 0: still so. Installs canmatrix into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check 'canmatrix[arxml,kcd,xls]==1.3.3'
cd "$folder"
cat > motor.dbc <<'DBC'
VERSION ""
BS_:
BU_: host
BO_ 385 State: 8 host
 SG_ angle : 0|16@1- (0.01,0) [-327.68|327.67] "deg" host
 SG_ position : 32|32@1- (1,0) [-1000|1000] "turn" host
SIG_VALTYPE_ 385 position : 1;
DBC
cat > decode.py <<'PYTHON'
import struct
import sys

import canmatrix
import canmatrix.formats

message = struct.pack('<hhf', -1234, 0, -2.5)
[matrix] = canmatrix.formats.loadp(sys.argv[1]).values()
decoded = matrix.frame_by_id(canmatrix.ArbitrationId(385)).decode(message)
values = [float(decoded[name].phys_value) for name in ('angle', 'position')]
print(sys.argv[1], *values)
assert values == [float(value) for value in sys.argv[2:]]
PYTHON
for format in kcd sym xls arxml; do
    venv/bin/canconvert motor.dbc "motor.$format" > log 2>&1
    if grep -i warn log; then exit 1; fi
done
venv/bin/python decode.py motor.dbc -12.34 -2.5
venv/bin/python decode.py motor.kcd -12.34 -2.5
venv/bin/python decode.py motor.sym -12.34 -1071644672
venv/bin/python decode.py motor.xls 643.02 3223322624
venv/bin/python decode.py motor.arxml 64302 -2.5
if grep -q '<V>0.01</V>' motor.arxml; then exit 1; fi
