#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# bdsim 1.4.0: the speed of a shaft at 1 rad/s, whose first value is given as 1 rad/s, begins at 10 000 rad/s in its
# derivative block.
#
# A shaft turns at 1 rad/s from 0 rad on, and the block DERIV with a pole of alpha = 100 rad/s takes its speed. Expected
# of y0 = 1.0, the initial output: 1 rad/s at all times. What happens: 10 000 rad/s at first, and 451 rad/s after 31 ms,
# as the state is set to -alpha y0 and not to -y0 / alpha, which is wrong by alpha². With alpha = 1 the two are equal.
# For us: give x0 = -y0 / alpha instead of y0; the speed is then 1 rad/s from the first value on.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check bdsim==1.4.0 numpy==2.4.6 scipy==1.17.1
cd "$folder"
export MPLBACKEND=Agg
timeout 120 venv/bin/python - > log <<'PYTHON' || { cat log; exit 1; }
import bdsim
import numpy as np

ALPHA = 100.0
simulator = bdsim.BDSim(graphics=False, animation=False, progress=False, verbose=False)


def speeds(**start):
    diagram = simulator.blockdiagram()
    angle, speed, gain = diagram.TIME(), diagram.DERIV(alpha=ALPHA, **start), diagram.GAIN(1.0)
    diagram.connect(angle, speed)
    diagram.connect(speed, gain)
    diagram.compile()
    result = simulator.run(diagram, 0.2, dt=0.001, watch=[gain])
    found = np.interp([0, 0.031, 0.2], result.t, np.array(result.y, float)[:, 0])
    print('at 0, 31 and 200 ms with', start, found)
    return found


given = speeds(y0=1.0)
right = speeds(x0=-1.0 / ALPHA)
assert abs(given[0] - 10000) < 1e-6 and abs(given[1] - 451.4) < 1 and abs(given[2] - 1) < 1e-3
assert np.allclose(right, 1.0, atol=1e-6)
PYTHON
grep '^at ' log
