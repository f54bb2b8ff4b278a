#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# typhoon-rainflow 0.2.5: the slope of an S-N curve beyond its knee is ignored, and the table of all cycles is empty.
#
# WoehlerCurveParams(sd=100, nd=1e6, k1=5, k2=9) has, by the README, a slope of 9 beyond 10^6 cycles. Expected: 59.9 at
# 10^8 cycles. What happens: 100, as without k2; with MinerType.HAIBACH the slope is 2 k1 - 1, whatever k2 is. Of two
# cycles that rainflow() counts, counter_to_full_interval_df() shows none, neither without bins nor with the bin size of
# 0.1 that the table has by default: rainflow() gives 0.6 in 32 bits as 0.6000000238, which is in no bin, and what is in
# none is dropped. With 0.25 the table has both.
# For us: a load beyond the knee does no damage there; take a power of 2 as bin size of both.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check typhoon-rainflow==0.2.5 numpy==2.4.6
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import numpy as np
from typhoon import helper, rainflow
from typhoon.woehler import MinerType, WoehlerCurveParams, woehler_loads, woehler_loads_basic

curve = WoehlerCurveParams(sd=100, nd=1e6, k1=5, k2=9)
plain = woehler_loads_basic([1e4, 1e8], curve)
probable = woehler_loads([1e4, 1e8], curve)
haibach = [
    woehler_loads_basic([1e8], WoehlerCurveParams(sd=100, nd=1e6, k1=5, k2=k2), MinerType.HAIBACH)[0]
    for k2 in (7, 9, 20)
]
print('at 1e4 and 1e8 cycles', plain, probable, 'HAIBACH with three slopes', haibach, 'expected', 100 * 100 ** (-1 / 9))
assert abs(plain[0] - 251.19) < 0.01 and plain[1] == 100 and probable[1] == 100
assert len(set(haibach)) == 1
torque = np.array([0.0, 0.55, 0.1, 0.42, 0.2, 1.0, 0.0])
cycles, rest = rainflow(torque)
table = helper.counter_to_full_interval_df(cycles)
print('cycles', cycles, 'in the table', table['value'].sum())
assert sum(cycles.values()) == 2 and table['value'].sum() == 0
assert min(high for high, low in cycles) == np.float32(0.42)
for size, shown in [(0.1, 0), (0.25, 2)]:
    cycles, rest = rainflow(torque, bin_size=size)
    table = helper.counter_to_full_interval_df(cycles, bin_size=size)
    print('bin size', size, 'cycles', sum(cycles.values()), 'in the table', table['value'].sum())
    assert sum(cycles.values()) == 2 and table['value'].sum() == shown
PYTHON
