#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# bdsim 1.4.0: an integral that has once reached its limit stays there for good, and a limit of 1 instead of 1.0 is
# none.
#
# A PID block of a joint has P = 1, I = 1 and I_limit = 1.0; its error is 1 rad for 2 s and -1 rad for the next 4 s.
# Expected: the integral grows to 1 within 1 s, falls from 2 s on and is -1 after 4 s, so the output at 5.5 s is -2.
# What happens: the integral stays at 1.00 and the output is 0, as a block INTEGRATOR beyond its max has a rate of 0
# whatever the sign of its input. With I_limit = 1, a whole number, the integral goes to 2 without any limit, and the
# output at 2 s is 3 instead of 2.
# For us: a joint that was once blocked is pushed to one side ever after; limit the integral outside of the block.
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

simulator = bdsim.BDSim(graphics=False, animation=False, progress=False, verbose=False)


def simulated(output_of):
    """The values at 1.9 s and 5.5 s."""
    diagram = simulator.blockdiagram()
    error = diagram.PIECEWISE((0, 1.0), (2, -1.0))
    block = output_of(diagram, error)
    diagram.compile()
    result = simulator.run(diagram, 6, dt=0.05, watch=[block])
    values = np.array(result.y, float)[:, 0]
    return np.interp([1.9, 5.5], result.t, values)


def integrated(**limits):
    def connect(diagram, error):
        block = diagram.INTEGRATOR(**limits)
        diagram.connect(error, block)
        return block

    return simulated(connect)


def controlled(limit):
    def connect(diagram, error):
        block, measured = diagram.PID(P=1.0, I=1.0, I_limit=limit), diagram.CONSTANT(0.0)
        diagram.connect(measured, block[0])
        diagram.connect(error, block[1])
        gain = diagram.GAIN(1.0)
        diagram.connect(block, gain)
        return gain

    return simulated(connect)


free, limited = integrated(), integrated(min=-1.0, max=1.0)
real, whole = controlled(1.0), controlled(1)
print('at 1.9 s and 5.5 s: free integral', free, 'limited', limited)
print('at 1.9 s and 5.5 s: output with a limit of 1.0', real, 'and of 1', whole)
assert np.allclose(free, [1.9, -1.5], atol=0.02)
assert np.allclose(limited, [1.0, 1.0], atol=0.02)
assert np.allclose(real, [2.0, 0.0], atol=0.02)
assert np.allclose(whole, [2.9, -2.5], atol=0.02)
PYTHON
grep '^at ' log
