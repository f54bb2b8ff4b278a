#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# tabular2mcap 0.1.12: a position that a .csv lacks is 0 rad in the mcap, and stamps in ns are off by up to 128 ns.
#
# A table of a stamp in nanoseconds, a position and the name of a joint, without a position in its second row, and the
# template {{ position | float }}, as its command gen writes for a field of floats. Expected: null, NaN or an error.
# What happens: the empty cell becomes None, of which the filter makes 0.0, so that the shaft is at 0 rad for a
# sample. A table without a column of text ends in an error there, but each of its rows is converted to floats first,
# in which a stamp of today has steps of 256 ns: 1795838400001000037 becomes 1795838400000999936.
# For us: let the template write 'NaN' for an empty cell, as below, and use seconds and nanoseconds in two columns.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check \
    'tabular2mcap[protobuf]==0.1.12' pandas==3.1.1 scipy==1.17.1
cd "$folder"
timeout 60 venv/bin/python - <<'PYTHON'
import json
from pathlib import Path

from tabular2mcap.converter.functions import ConverterFunction, ConverterFunctionJinja2Environment
from tabular2mcap.loader import load_tabular_data
from tabular2mcap.loader.models import ConverterFunctionDefinition

STAMPS = [1795838400000000037, 1795838400001000037, 1795838400002000037]


def converted(position, log_time, columns, *rows):
    table = Path('motor.csv')
    table.write_text('\n'.join([columns, *rows]))
    definition = ConverterFunctionDefinition(
        template='{"position": ' + position + '}', log_time_template='{{ ' + log_time + ' | int }}'
    )
    function = ConverterFunction(definition=definition, jinja2_env=ConverterFunctionJinja2Environment())
    function.init_jinja2_template()
    results = [function.convert_row(row) for _, row in load_tabular_data(table).iterrows()]
    return [result.data['position'] for result in results], [result.log_time_ns for result in results]


filtered = '{{ position | float }}'
rows = [f'{stamp},{position},rotor' for stamp, position in zip(STAMPS, ('1.5', '', '1.6'), strict=True)]
positions, stamps = converted(filtered, 'stamp', 'stamp,position,joint', *rows)
print('with an empty cell', positions, stamps)
assert positions == [1.5, 0.0, 1.6] and stamps == STAMPS

rows = [f'{stamp},{position}' for stamp, position in zip(STAMPS, ('1.5', '1.55', '1.6'), strict=True)]
positions, stamps = converted(filtered, 'stamp', 'stamp,position', *rows)
print('numbers alone', positions, stamps)
assert positions == [1.5, 1.55, 1.6]
assert stamps == [1795838400000000000, 1795838400000999936, 1795838400002000128]

rows[1] = f'{STAMPS[1]},'
try:
    converted(filtered, 'stamp', 'stamp,position', *rows)
    raise SystemExit('an empty cell among numbers alone is no error')
except json.JSONDecodeError as error:
    print('numbers alone, with an empty cell', error)

rows = [f'1795838400,{stamp % 10**9},{position}' for stamp, position in zip(STAMPS, ('1.5', '', '1.6'), strict=True)]
position = "{{ position if position == position and position is not none else 'NaN' }}"
positions, stamps = converted(position, 'sec | int * 1000000000 + nanosec', 'sec,nanosec,position', *rows)
print('as advised', positions, stamps)
assert positions[1] != positions[1] and stamps == STAMPS
PYTHON
