#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# canopen-lens 0.5.1: a drive that says it is still too hot is reported as recovered, "everything was fine at the end".
#
# The package tells from a log of CANopen which devices had problems and which of these are over. By CiA 301, an
# emergency message with the code 0x0000 says that errors are gone, all or some, and the error register in it which
# errors remain: only with a register of 0 the device is free of errors. Expected of a drive at 0x4210 (too hot, with
# the register 0x09) that then sends 0x0000 with the register 0x09, whose bit 3 is the temperature: an open problem.
# What happens: the register of a 0x0000 is not looked at. The problem is "recovered", the drive too, and the level of
# the whole log "warning" instead of "error". If the drive also had too much current (0x2310), which then is gone, the
# temperature is "cleared", as the first problem, and the current "open": the wrong way round.
# The package does know the register: its breakdown of the bytes of the same message names "generic, temperature".
# Output: register 0x00 at last: warning, Excess temperature device recovered
#         register 0x09 at last: warning, Excess temperature device recovered
#         current gone, still too hot: error, Continuous over current open, Excess temperature device recovered
# For us: take a drive as recovered only after a 0x0000 with a register of 0, or read its objects 0x1001 and 0x6041.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check canopen-lens==0.5.1
cd "$folder"
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
from canopen_lens import CanopenLog

NODE = 5
TOO_HOT, CURRENT_TOO = (1.0, '1042090000000000'), (1.5, '10230B0000000000')


def told(*emergencies):
    """The overview of a log with heartbeats of a node in operation, and the register in its last emergency."""
    frames = [(k / 10, f'{0x700 + NODE:03X}#05') for k in range(100)]
    frames = sorted(frames + [(time, f'{0x80 + NODE:03X}#{data}') for time, data in emergencies])
    log = CanopenLog.from_text(''.join(f'({time:.6f}) can0 {frame}\n' for time, frame in frames))
    overview = log.overview('en')
    problems = sorted((problem.title.split(': ')[1].split(' →')[0], problem.status) for problem in overview.incidents)
    last = next(row for row, frame in reversed(list(enumerate(frames))) if frame[1].startswith('085'))
    (register,) = [meaning for _, meaning in log.byte_breakdown(last, 'en') if 'error register' in meaning]
    return overview, problems, register


hot, current = 'Excess temperature device', 'Continuous over current'
for case, emergencies, level, seen in (
    ('register 0x00 at last', [TOO_HOT, (3.0, '0000000000000000')], 'warning', [(hot, 'recovered')]),
    ('register 0x09 at last', [TOO_HOT, (3.0, '0000090000000000')], 'warning', [(hot, 'recovered')]),
    ('current gone, still too hot', [TOO_HOT, CURRENT_TOO, (3.0, '0000090000000000')], 'error',
     [(current, 'open'), (hot, 'recovered')]),
):
    overview, problems, register = told(*emergencies)
    print(f'{case}: {overview.level},', ', '.join(' '.join(problem) for problem in problems))
    assert overview.level == level and problems == seen, (overview.level, problems)
    assert ('everything was fine at the end' in overview.sentence) == (level == 'warning'), overview.sentence
    assert ('temperature' in register) == (emergencies[-1][1][4:6] == '09'), register
PYTHON
