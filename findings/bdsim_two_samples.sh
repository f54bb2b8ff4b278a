#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# bdsim 1.4.0: a swinging rotor and its output are recorded at 2 times instead of 1001, so that both stand still, if no block has a state.
#
# A rotor swings by a sine of 1 Hz, and a gain of 1/20 gives its output; one second is simulated with dt = 1 ms, without
# graphics. Expected: 1001 samples, with the output at 0.05 rad after 250 ms. What happens: run() records the first and the
# last time alone, where the sine is 0, as dt has an effect on the solver only, which nothing needs here. There is no warning.
# With an INTEGRATOR in the diagram, connected to neither, there are 1001 samples, and the output swings by 0.05 rad.
# For us: add an integrator of a constant 0 to a diagram that only reckons.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check bdsim==1.4.0 numpy==2.4.6 scipy==1.17.1
cd "$folder"
export MPLBACKEND=Agg
timeout 120 venv/bin/python - > log 2>&1 <<'PYTHON' || { cat log; exit 1; }
import bdsim
import numpy as np

simulator = bdsim.BDSim(graphics=False, animation=False, progress=False, verbose=False)


def recorded(with_state):
    diagram = simulator.blockdiagram()
    rotor, gear, output = diagram.WAVEFORM(wave='sine', freq=1), diagram.GAIN(1 / 20), diagram.GAIN(1.0)
    diagram.connect(rotor, gear)
    diagram.connect(gear, output)
    if with_state:
        diagram.connect(diagram.CONSTANT(0.0), diagram.INTEGRATOR())
    diagram.compile()
    result = simulator.run(diagram, 1.0, dt=0.001, watch=[gear])
    angles = np.array(result.y, float)[:, 0]
    print('samples', len(result.t), 'output to', np.max(np.abs(angles)), 'rad, with a state', with_state)
    return len(result.t), np.max(np.abs(angles))


count, swing = recorded(with_state=False)
assert count == 2 and swing < 1e-9
count, swing = recorded(with_state=True)
assert count == 1001 and abs(swing - 0.05) < 1e-6
PYTHON
grep '^samples ' log
