#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# qualistics 0.1.0: readings that scatter with a variance of 1 have a repeatability of about 0.5 in a gauge R&R study.
#
# Three persons measure the backlash of ten gears twice. The readings of a person at a gear scatter with a variance of
# 1, the persons with 4, the gears with 100, and there is no interaction. Expected of gauge_rr(), a table in the style
# of Minitab: a repeatability of 1 in the mean of 500 such studies, as by the mean square within the cells. What
# happens: about 30/59, as the squares are divided by 59, one less than the number of readings, instead of by 30, as
# each of the 30 cells has a mean of its own. With three readings each it is about 60/89. And an interaction of 0.31 is
# found although there is none, as the part that the scatter of the readings has in the means is not taken off.
# For us: the scatter of an encoder looks 30 % smaller than it is; take the mean square within the cells instead.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check qualistics==0.1.0 numpy==2.4.6 pandas==2.3.3
cat > "$folder/study.py" <<'PYTHON'
import numpy as np
import pandas as pd
from qualistics.gauge.gauge_rr import gauge_rr

STUDIES = 500
random = np.random.default_rng(1)


def components(readings):
    """Give the repeatability and interaction in the mean of many studies, by the table and by the mean squares."""
    found = np.zeros((STUDIES, 4))
    for row in found:
        values = (random.normal(0, 2, (3, 1, 1)) + random.normal(0, 10, (1, 10, 1))
                  + random.normal(0, 1, (3, 10, readings)))
        operator, part, reading = np.indices(values.shape).reshape(3, -1)
        table = gauge_rr(pd.DataFrame({
            'Operator': operator, 'Part': part, 'Measurement': values.ravel(),
            'Randomised Order': np.arange(values.size),
        }))
        table.index = table['Source'].str.strip()
        means = values.mean(axis=2)
        within = values.var(axis=2, ddof=1).mean()
        rest = means - means.mean(axis=0) - means.mean(axis=1, keepdims=True) + means.mean()
        row[:] = (
            float(table['Variance']['Repeatability (Instrument)']), float(table['Variance']['Operator-by-Part']),
            within, (rest ** 2).sum() / 18 - within / readings,
        )
    mean = found.mean(axis=0)
    print(f'{readings} readings each: repeatability {mean[0]:.2f} and interaction {mean[1]:.2f}; '
          f'by the mean squares {mean[2]:.2f} and {mean[3]:.2f}')
    return mean


two, three = components(2), components(3)
assert np.allclose(two, (30 / 59, 0.31, 1, 0), atol=0.05) and np.allclose(three[[0, 2]], (60 / 89, 1), atol=0.05)
PYTHON
timeout 120 "$folder/venv/bin/python" -W ignore "$folder/study.py"
