#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# simplify-vcd 1.1.0: which channel of an encoder is "a" in its output is by chance, so that a shaft may turn backward.
#
# A value change dump has the channels A and B of an encoder, from which a shaft turns forward by 4 counts. Expected of
# the simplified file: the names A and B, or at least "a" for the first channel and "b" for the second. What happens:
# the names are lost, and "a" and "b" are given in the order of a set of Python, which changes from start to start, here
# by PYTHONHASHSEED: the shaft turned by 2 or by -2 counts. Two counts are missing, as the changes at time 0 are left
# out, so that the first states are unknown; if the times begin at 1, it is 4 or -4.
# For us: compare the identifiers ("!") in both files to know A from B, and let no recording begin at time 0.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check simplify-vcd==1.1.0 pyvcd==0.5.0
cd "$folder"
timeout 100 venv/bin/python - <<'PYTHON'
import os
import subprocess

from vcd.reader import TokenKind, tokenize

HEAD = '''$timescale 1 us $end
$scope module encoder $end
$var wire 1 ! A $end
$var wire 1 " B $end
$upscope $end
$enddefinitions $end
'''
ORDER = ['00', '10', '11', '01']


def recording(start):
    """Changes of the channels every 10 us; A rises first, so that the shaft turns forward."""
    changes = [(start, '0!\n0"'), (10, '1!'), (20, '1"'), (30, '0!'), (40, '0"')]
    return HEAD + ''.join(f'#{time}\n{change}\n' for time, change in changes)


def counts(path):
    """The position in counts, by the names of the channels without their case."""
    names, state, found = {}, {}, 0
    with open(path, 'rb') as file:
        for token in tokenize(file):
            if token.kind is TokenKind.VAR:
                names[token.var.id_code] = token.var.reference.lower()
            elif token.kind is TokenKind.CHANGE_SCALAR:
                before = dict(state)
                state[names[token.scalar_change.id_code]] = token.scalar_change.value
                if len(before) == 2:
                    steps = [ORDER.index(each['a'] + each['b']) for each in (before, state)]
                    found += (steps[1] - steps[0] + 1) % 4 - 1
    return found


def simplified(text, seed):
    with open('in.vcd', 'w') as file:
        file.write(text)
    environment = {**os.environ, 'PYTHONHASHSEED': str(seed)}
    subprocess.run(['venv/bin/simplify-vcd', 'in.vcd', 'out.vcd'], check=True, env=environment)
    return counts('out.vcd')


found = {}
for start in 0, 1:
    text = recording(start)
    found[start] = sorted({simplified(text, seed) for seed in range(12)})
    print(f'times from {start}: {counts("in.vcd")} counts before, {found[start]} after, by the start of the program')
    assert counts('in.vcd') == 4
assert found == {0: [-2, 2], 1: [-4, 4]}
PYTHON
