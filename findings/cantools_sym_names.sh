#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# cantools 45.1.0: a DBC that is saved as SYM gives all signals of one name the type and factor of one of them.
#
# Expected: two drives' messages, each with its signal "position", stay what they are, or an error, as signals of a SYM
# file have no message of their own. What happens: the first definition is written once for all, without a warning. A
# position of 4.56 in steps of 0.01 is read as 45.6 by the first drive's steps of 0.1, and a float of 1.5 as 106954752.
# KCD, and a DBC that is saved again, keep each.
# For us: convert no database of several drives to SYM; read them by their DBC.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check cantools==45.1.0
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import cantools

source = '''VERSION ""
NS_ :
BS_:
BU_: Drive
BO_ 257 Shoulder: 8 Drive
 SG_ position : 0|32@1- (0.1,0) [0|0] "deg" Drive
BO_ 258 Elbow: 8 Drive
 SG_ position : 0|32@1- (1,0) [0|0] "rad" Drive
BO_ 259 Wrist: 8 Drive
 SG_ position : 0|32@1- (0.01,0) [0|0] "deg" Drive
SIG_VALTYPE_ 258 position : 1;
'''
database = cantools.database.load_string(source, 'dbc')
sent = {'Shoulder': 12.3, 'Elbow': 1.5, 'Wrist': 4.56}
frames = {name: database.encode_message(name, {'position': position}) for name, position in sent.items()}
for kind in ('dbc', 'kcd', 'sym'):
    saved = getattr(database, f'as_{kind}_string')()
    read = cantools.database.load_string(saved, kind)
    positions = {name: round(read.decode_message(name, frame)['position'], 3) for name, frame in frames.items()}
    print(kind, positions)
    assert (positions == sent) == (kind != 'sym')
PYTHON
