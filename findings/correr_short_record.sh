#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# correr 0.1.0: the delay of 250 ms of an output whose record ends before its rotor's is found as 320 ms.
#
# align() puts two series on one grid, and is documented to fill gaps inside of them but not to extrapolate past the
# range of either. Expected of a rotor that is recorded for 20 s and an output that ends after 8 s: NaN for the output
# after its end, and by find_best_lag() the same delay as of two records of 20 s. What happens: the last angle of the
# output is repeated to the end of the rotor's record, so that the output seems to stand still for 12 s; the best lag is
# 32 samples of 10 ms instead of 25, with a correlation of 0.64. Before the beginning of a record there are NaN, as
# documented: an output without its first 8 s has the right delay. The 8 s of both alone have it, too.
# For us: cut both records to their common time first.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check \
    correr==0.1.0 pandas==3.1.1 numpy==2.4.6 scipy==1.17.1
cd "$folder"
timeout 120 venv/bin/python - <<'PYTHON'
import numpy as np
import pandas as pd
from correr import align, find_best_lag

seconds = 0.01 * np.arange(2000)
times = pd.Timestamp('2026-11-28') + pd.to_timedelta(10 * np.arange(2000), unit='ms')


def swung(time):
    return np.sin(2 * np.pi * 0.13 * time + 0.3 * np.sin(time))


rotor, output = pd.Series(swung(seconds), times), pd.Series(swung(seconds - 0.25), times)
records = {'whole': output, 'without its end': output[:800], 'without its beginning': output[800:]}
found = {name: find_best_lag(rotor, record, 100, warn_nonstationary=False) for name, record in records.items()}
found['both for 8 s'] = find_best_lag(rotor[:800], output[:800], 100, warn_nonstationary=False)
for name, match in found.items():
    print(f'{name}: {match.lag} samples, correlation {match.correlation:.2f}')
_, aligned = align(rotor, output[:800])
print('Behind its end the output is', aligned.iloc[800:].unique(), 'and its last angle', output.iloc[799])
assert (aligned.iloc[800:] == output.iloc[799]).all()
assert {name: match.lag for name, match in found.items()} == {
    'whole': -25, 'without its end': -32, 'without its beginning': -25, 'both for 8 s': -25
}
PYTHON
