#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# asammdf 8.8.28, can_decoder 0.1.9: a position that a .dbc sends on pages 0, 1 and 5 is read from page 0 alone.
#
# A drive sends its position on three pages of a message, a torque on two others: SG_MUL_VAL_ of the .dbc names all of
# them, and the marks m0 and m3 of the signals only the first. Expected of the frames that an .mf4 has logged, as
# cantools 45.1.0 decodes them: six positions and four torques in two rounds. What happens: extract_bus_logging() of
# asammdf gives two positions and two torques, without a warning, so that a joint is sampled at a third of its rate.
# can_decoder, for which canmatrix reads the .dbc too, does so as well. A frame of 8 bytes by the .dbc is logged with a
# length of 4 and with zeros in the other bytes: an angle in these is 0 rad by asammdf, and an error by cantools.
# For us: decode logged frames by cantools, or give each page a signal of its own in the .dbc.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check \
    asammdf==8.8.28 can_decoder==0.1.9 canmatrix==1.2 cantools==45.1.0
cd "$folder"
cat > drive.dbc <<'DBC'
VERSION ""
NS_ :
BS_:
BU_: Drive
BO_ 257 Joint: 8 Drive
 SG_ Page M : 0|8@1+ (1,0) [0|0] "" Drive
 SG_ Position m0 : 8|32@1- (0.001,0) [0|0] "rad" Drive
 SG_ Torque m3 : 8|16@1- (0.1,0) [0|0] "Nm" Drive

BO_ 258 Output: 8 Drive
 SG_ Speed : 0|16@1- (0.01,0) [0|0] "rad/s" Drive
 SG_ Angle : 32|32@1- (0.001,0) [0|0] "rad" Drive

SG_MUL_VAL_ 257 Position Page 0-1, 5-5 ;
SG_MUL_VAL_ 257 Torque Page 3-4 ;
DBC
timeout 120 venv/bin/python -W error::UserWarning - <<'PYTHON'
import struct

import can_decoder
import cantools
import numpy as np
import pandas as pd
from asammdf import MDF, Signal
from asammdf.blocks import v4_constants as v4
from asammdf.blocks.source_utils import Source


def logged(frames):
    """Values by asammdf of frames that an .mf4 has logged."""
    prefix = 'CAN_DataFrame.'
    fields = [('BusChannel', 'u1'), ('ID', '<u4'), ('IDE', 'u1'), ('DLC', 'u1'), ('DataLength', 'u1')]
    kind = [(prefix + name, size) for name, size in fields] + [(prefix + 'DataBytes', 'u1', (8,))]
    samples = np.zeros(len(frames), kind)
    samples[prefix + 'BusChannel'] = 1
    for row, (identifier, data) in zip(samples, frames):
        row[prefix + 'ID'] = identifier
        row[prefix + 'DLC'] = row[prefix + 'DataLength'] = len(data)
        row[prefix + 'DataBytes'][: len(data)] = list(data)
    source = Source('CAN1', 'CAN1', '', v4.SOURCE_BUS, v4.BUS_TYPE_CAN)
    with MDF(version='4.11') as file:
        file.append([Signal(samples, np.arange(len(frames)) / 10, name='CAN_DataFrame', source=source)])
        file.groups[-1].channel_group.flags = v4.FLAG_CG_BUS_EVENT | v4.FLAG_CG_PLAIN_BUS_EVENT
        file.save('log.mf4', overwrite=True)
    with MDF('log.mf4') as file:
        decoded = file.extract_bus_logging({'CAN': [('drive.dbc', 0)]})
        return {signal.name: signal.samples.tolist() for signal in decoded.iter_channels()}


pages = [0, 1, 3, 4, 5] * 2
frames = [(257, struct.pack('<Bi3x', page, 1000 + count)) for count, page in enumerate(pages)]
database = cantools.database.load_file('drive.dbc')
by_cantools = {'Position': [], 'Torque': []}
for identifier, data in frames:
    values = database.decode_message(identifier, data)
    for name in by_cantools.keys() & values.keys():
        by_cantools[name].append(round(values[name], 3))
by_asammdf = {name: np.round(values, 3).tolist() for name, values in logged(frames).items() if name in by_cantools}
table = pd.DataFrame({'ID': 257, 'IDE': False, 'DataBytes': [list(data) for _, data in frames]})
table.index = pd.to_datetime(np.arange(len(frames)), unit='s', utc=True)
table.index.name = 'TimeStamp'
found = can_decoder.DataFrameDecoder(can_decoder.load_dbc('drive.dbc')).decode_frame(table)
by_can_decoder = {
    name: found['Physical Value'][found['Signal'] == name].astype(float).round(3).tolist() for name in by_cantools
}
print('cantools', by_cantools, 'asammdf', by_asammdf, 'can_decoder', by_can_decoder)
assert by_cantools == {'Position': [1.0, 1.001, 1.004, 1.005, 1.006, 1.009], 'Torque': [100.2, 100.3, 100.7, 100.8]}
assert by_asammdf == by_can_decoder == {'Position': [1.0, 1.005], 'Torque': [100.2, 100.7]}

short = struct.pack('<hhi', 200, 0, 1500)
angle = logged([(258, short), (258, short[:4]), (258, short)])['Angle']
print('Angles of a frame of 8, 4 and 8 bytes by asammdf:', angle)
assert angle == [1.5, 0.0, 1.5]
try:
    database.decode_message(258, short[:4])
except cantools.database.DecodeError as error:
    print('cantools:', error)
else:
    raise AssertionError('cantools decodes a short frame')
PYTHON
