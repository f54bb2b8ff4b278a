#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# canml 0.1.14: all positions of a log are NaN if the .dbc has a name for one of their values, and a motor at 2 rad/s is
# read at 1 rad/s.
#
# An arm's .dbc names the raw value -32768 of a position "not available", as is usual; the log never has it. Expected of
# load_blf(): the positions as numbers. What happens: each signal with a named value becomes a category of its names, so
# that all 100 positions are NaN. cantools decodes them as numbers, and a position whose values have no names is right.
# Motor and output are sent at 100 Hz in a frame each. Expected of force_uniform_timing with 0.01 s: one row each 0.01
# s. What happens: the rows are numbered, and as each frame has a row of its own, 1 s takes 2 s, and each speed is
# halved.
# For us: decode with cantools, or take the VAL_ lines out of the .dbc; leave force_uniform_timing off.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check canml==0.1.14 pyarrow==26.0.1
cd "$folder"
timeout 100 "$folder/venv/bin/python" - <<'PYTHON' 2> log || { cat log; exit 1; }
from pathlib import Path

import can
import cantools
from canml import CanmlConfig, load_blf

INTERVAL, MOTOR_SPEED, OUTPUT_SPEED = 0.01, 2.0, 0.1
Path('arm.dbc').write_text("""VERSION ""
BU_: Drive
BO_ 256 Motor: 2 Drive
 SG_ motor : 0|16@1- (0.001,0) [-30|30] "rad" Drive
BO_ 257 Output: 2 Drive
 SG_ output : 0|16@1- (0.001,0) [-30|30] "rad" Drive
VAL_ 257 output -32768 "not available" ;
""")
with can.BLFWriter('arm.blf') as log:
    for sample in range(100):
        for frame, speed in ((256, MOTOR_SPEED), (257, OUTPUT_SPEED)):
            data = round(1000 * sample * INTERVAL * speed).to_bytes(2, 'little', signed=True)
            time = 1.7e9 + sample * INTERVAL + 0.001 * (frame - 256)
            log(can.Message(time, frame, is_extended_id=False, data=data))

database = cantools.database.load_file('arm.dbc')
decoded = [database.decode_message(m.arbitration_id, m.data)['output'] for m in can.BLFReader('arm.blf') if m.arbitration_id == 257]
config = CanmlConfig(progress_bar=False, force_uniform_timing=True, interval_seconds=INTERVAL)
rows = load_blf('arm.blf', 'arm.dbc', config)
motor = rows.dropna(subset='motor')
slope = {clock: float(motor.motor.diff().iloc[1:].sum() / motor[clock].diff().iloc[1:].sum()) for clock in ('timestamp', 'raw_timestamp')}
print('output decoded by cantools', decoded[-3:], 'in canml', rows.output.dtype, 'values left:', int(rows.output.notna().sum()))
print('motor: positions', len(motor), 'speed in rad/s by clock', slope)
assert len(decoded) == len(motor) == 100 and decoded[-1] == 0.099
assert rows.output.notna().sum() == 0
assert abs(slope['raw_timestamp'] - MOTOR_SPEED) < 1e-3 and abs(slope['timestamp'] - MOTOR_SPEED / 2) < 1e-3
PYTHON
