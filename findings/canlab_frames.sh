#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# canlab 0.1.6: a CAN FD frame of an .asc begins with its length, 0x181 is 0x8000000C, and a goal is sent as another.
#
# Expected of parseASC() for a CAN FD frame with the bytes 1 to 8, and for one with twelve bytes: these bytes. What
# happens: the column before them, which has their number, is taken for the first one, so that the last one is missing,
# and of twelve bytes there are nine, since the DLC 9 stands for twelve. read_asc() leaves out frames of one byte, as a
# heartbeat has. Expected of the bus_id of a message that a .dbc gives the identifier 385 (0x181, the first TPDO of node
# 1): 0x181. What happens: it is 0x8000000C, and 0x90 is 0x10. Expected of encode() after decode() of a frame with a
# multiplexor: the same frame. What happens: the multiplexor is left at 0, so that a drive takes a goal of its speed,
# which has the multiplexor 2, for whatever 0 means. The .asc is written by python-can.
# For us: read such logs with python-can and cantools.
#
# Exit code 0: still so. Installs the versions into a temporary folder; canlab asks for Python 3.12, but runs on 3.11.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check --ignore-requires-python \
    canlab==0.1.6 polars==2.1.0 python-can==4.6.1
cd "$folder"
cat > drive.dbc <<'DBC'
VERSION ""
BU_: Drive
BO_ 385 State: 8 Drive
 SG_ Kind M : 0|8@1+ (1,0) [0|0] "" Drive
 SG_ Position m1 : 8|16@1- (0.001,0) [0|0] "rad" Drive
 SG_ Speed m2 : 8|16@1- (0.01,0) [0|0] "rad/s" Drive
DBC
timeout 60 venv/bin/python - <<'PYTHON'
import can
from dbc.dbc_loader import extract_messages
from dbc.message_data import MessageData
from log_reader.asc import parseASC, read_asc

sent = [bytes(range(1, 9)), bytes(range(12))]
with can.ASCWriter('flexible.asc') as log:
    for time, data in enumerate(sent):
        log(can.Message(timestamp=time, arbitration_id=0x181, is_extended_id=False, is_fd=True, data=data))
read = parseASC('flexible.asc', [0x181])['data_bytes'].to_list()
for data, found in zip(sent, read, strict=True):
    print(list(data), 'is read as', found)
assert read == [[8, 1, 2, 3, 4, 5, 6, 7], [0x12, 0, 1, 2, 3, 4, 5, 6, 7]]

with can.ASCWriter('classic.asc') as log:
    for identifier, data in ((0x181, b'\x01\x02'), (0x701, b'\x05')):
        log(can.Message(timestamp=1, arbitration_id=identifier, is_extended_id=False, data=data))
identifiers = read_asc('classic.asc')['messageID'].to_list()
print('Of 0x181 and the heartbeat 0x701 there are', [hex(identifier) for identifier in identifiers])
assert identifiers == [0x181]

(state,) = extract_messages('drive.dbc')
print('The identifier of 0x181 is', hex(state.bus_id), 'and that of 0x90 is', hex(MessageData(dbc_id=0x90).bus_id))
assert (state.bus_id, MessageData(dbc_id=0x90).bus_id) == (0x8000000C, 0x10)

frame = bytearray([2, 0x2C, 0x01, 0, 0, 0, 0, 0])
decoded = state.decode(frame)
for signal in state.active_signals:
    signal.value = decoded[signal.name]
print(decoded, 'of', frame.hex(), 'is encoded as', state.encode().hex())
assert decoded == {'Speed': 3.0} and state.encode() == bytearray([0, *frame[1:]])
PYTHON
