#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# python-can 4.6.1: the time and direction of a frame in a log depend on the format of the log.
#
# A command is sent at 1700000000.5 s and answered by 1700000000.6 s. Logger and LogReader make of it, by the ending of
# the file:
#
#     .blf, .mf4, .log, .trc    the times as they were; one frame sent, one received
#     .asc                      the times begin at 0: two logs of a bench cannot be aligned
#     .csv, .db                 both frames were received
#
# So a command of the host may be decoded as an answer of the motor. None of them warns.
# For us: log a bus in .blf; even with relative_timestamp=False an .asc has the times of the zone where it is read.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check 'python-can[mf4]==4.6.1'
cd "$folder"
venv/bin/python - <<'PYTHON'
import can

sent = can.Message(timestamp=1.7e9 + 0.5, arbitration_id=0x141, data=[1], is_rx=False, is_extended_id=False)
received = can.Message(timestamp=1.7e9 + 0.6, arbitration_id=0x141, data=[2], is_extended_id=False)
for ending in ('blf', 'mf4', 'log', 'trc', 'asc', 'csv', 'db'):
    with can.Logger(f'bus.{ending}') as logger:
        logger(sent)
        logger(received)
    with can.LogReader(f'bus.{ending}') as reader:
        frames = list(reader)
    start, received_flags = frames[0].timestamp, [frame.is_rx for frame in frames]
    print(f'.{ending}', start, received_flags)
    assert abs(start - (0.0 if ending == 'asc' else 1.7e9 + 0.5)) < 1e-3
    assert received_flags == [ending in ('csv', 'db'), True]
PYTHON
