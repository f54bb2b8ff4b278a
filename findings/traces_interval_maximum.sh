#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# traces 0.7.0: a motor that has 1 N·m from 5 s to 10 s has a maximum of 10 N·m in this interval.
#
# A torque is recorded when it changes: 10 N·m at 0 s, 1 N·m at 5 s and 2 N·m at 10 s, and it holds in between. Expected
# of sample_interval() for each 5 s with the operation "max": 10 and 1 N·m, as by distribution(start, end).max(). At 5 s
# the value is 1 N·m, as a TimeSeries has the value of its last measurement by its documentation. What happens: 10 and
# 10 N·m, as the value before the interval counts, too, where a reading is exactly at the start of the interval, though
# it holds there for no time at all. So a step at the border of two intervals is found in both, and a minimum of 5 N·m
# is 1 N·m after a step upward. The operation "mean" is right, and so are maxima where no reading is at the start.
# For us: take distribution(start, end).max() or .min().
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check traces==0.7.0 pandas==2.3.3 numpy==2.4.6
cat > "$folder/torque.py" <<'PYTHON'
import datetime

import traces

ZERO = datetime.datetime(2026, 1, 1)


def at(seconds):
    return ZERO + datetime.timedelta(seconds=seconds)


def sampled(changes, operation):
    """Give the operation for each 5 s, by sample_interval() and by the distribution of the values in the interval."""
    torque = traces.TimeSeries({at(seconds): value for seconds, value in changes.items()})
    found = torque.sample_interval(5, operation=operation)
    starts = range(0, max(changes), 5)
    other = [getattr(torque.distribution(at(start), at(start + 5)), operation)() for start in starts]
    assert list(found.index) == [at(start) for start in starts]
    print(changes, operation, found.tolist(), 'by the distribution', other)
    return found.tolist(), other


assert sampled({0: 10.0, 5: 1.0, 10: 2.0}, 'max') == ([10, 10], [10, 1])
assert sampled({0: 1.0, 5: 5.0, 10: 2.0}, 'min') == ([1, 1], [1, 5])
assert sampled({0: 10.0, 4: 1.0, 10: 2.0}, 'max') == ([10, 1], [10, 1])
assert sampled({0: 10.0, 5: 1.0, 10: 2.0}, 'mean') == ([10, 1], [10, 1])
PYTHON
timeout 60 "$folder/venv/bin/python" "$folder/torque.py"
