#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# vcdvcd 2.6.0: of a .vcd that has the changes of two encoder channels in one line, no edge is read, without an error.
#
# A value change dump has a free format (IEEE 1364): its changes are separated by white space, line feeds or blanks.
# Expected: the channels A and B of an encoder have the same edges if a line says "1! 0"", or is indented by a blank, as
# if each change had a line of its own. What happens: the rest of the line is taken as the identifier of a channel that
# is not asked for, and left out; an indented line is left out whole. Both channels are empty, so that the shaft stands
# still. In one line with the time, as sigrok writes them ("#10 1! 0""), vcdvcd reads the changes, too. pyvcd 0.5.0
# reads all four files alike.
# For us: read such a file by the tokens of pyvcd, or put each change into a line of its own beforehand.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check vcdvcd==2.6.0 pyvcd==0.5.0
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import io

from vcd.reader import TokenKind, tokenize
from vcdvcd import VCDVCD

HEAD = '''$timescale 1 us $end
$scope module encoder $end
$var wire 1 ! A $end
$var wire 1 " B $end
$upscope $end
$enddefinitions $end
'''
# One period of the encoder forwards: 4 counts.
STATES = [(0, '0', '0'), (10, '1', '0'), (20, '1', '1'), (30, '0', '1'), (40, '0', '0')]


def counts(a, b):
    """The position in counts of a quadrature encoder of which each time has the states of A and B."""
    order = ['00', '10', '11', '01']
    found = [order.index(a[time] + b[time]) for time in sorted(a)]
    return sum((after - before + 1) % 4 - 1 for before, after in zip(found, found[1:]))


def by_pyvcd(text):
    values, time = {'!': {}, '"': {}}, 0
    for token in tokenize(io.BytesIO(text.encode())):
        if token.kind is TokenKind.CHANGE_TIME:
            time = token.data
        elif token.kind is TokenKind.CHANGE_SCALAR:
            values[token.scalar_change.id_code][time] = token.scalar_change.value
    return counts(values['!'], values['"'])


def by_vcdvcd(text):
    read = VCDVCD(vcd_string=text)
    return counts(dict(read['encoder.A'].tv), dict(read['encoder.B'].tv))


found = {}
for name, form in {'a line each': '#{}\n{}!\n{}"\n', 'one line': '#{}\n{}! {}"\n', 'indented': '#{}\n {}!\n {}"\n',
                   'one line with the time': '#{} {}! {}"\n'}.items():
    text = HEAD + ''.join(form.format(*state) for state in STATES)
    found[name] = by_vcdvcd(text), by_pyvcd(text)
    print(f'{name}: {found[name][0]} counts by vcdvcd, {found[name][1]} by pyvcd')
assert found == {'a line each': (4, 4), 'one line': (0, 4), 'indented': (0, 4), 'one line with the time': (4, 4)}
PYTHON
