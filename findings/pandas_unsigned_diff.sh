#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# pandas 3.1.1: diff() of an encoder's unsigned counts gives 65530.0 where they fall by 6.
#
# The result of Series.diff() is a float64 with NaN in its first row, so that it can hold -6; but the difference is
# taken between unsigned numbers before it becomes a float. counts - counts.shift(), and diff() of a group, give -6.0;
# so does diff() of int16. diff() of int32 wraps as well: from 2147483647 to -2147483648 it is 1.0, not -4294967295.0.
# polars 2.1.0 gives -6 for every unsigned type.
# For us: the speed of a rotor that turns backwards is wrong in such a table; make counts int64 first.
#
# Exit code 0: still so. Installs the packages into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check pandas==3.1.1 polars==2.1.0
"$folder/venv/bin/python" - <<'PYTHON'
import pandas
import polars

for type_name, expected in (('uint8', 250.0), ('uint16', 65530.0), ('uint32', 4294967290.0), ('int16', -6.0)):
    counts = pandas.Series([10, 4], dtype=type_name)
    first, last = counts.diff().iloc[1], (counts - counts.shift()).iloc[1]
    print(type_name, 'diff', first, 'with shift', last, 'grouped', counts.groupby([1, 1]).diff().iloc[1])
    assert (first, last) == (expected, -6.0)
    assert counts.groupby([1, 1]).diff().iloc[1] == -6.0
assert pandas.Series([2**31 - 1, -(2**31)], dtype='int32').diff().iloc[1] == 1.0
assert polars.Series([10, 4], dtype=polars.UInt16).diff()[1] == -6
PYTHON
