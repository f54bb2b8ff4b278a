#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# FMPy 0.3.32: the inputs and outputs of an FMU for co-simulation are recorded a step late.
#
# A gear divides the angle of its motor by 20; the motor moves evenly by 100 rad/s, and is given as input at every 0.01
# s. Expected: in the row at 0.1 s the motor is at 10 rad, and the output, if at all, a step late. What happens: the
# motor itself is at 9 rad in that row, and the output at 0.45 rad. Each row is recorded before the input of its time is
# applied. So the two columns fit each other, and neither fits the time: an error of 1 rad at 100 rad/s, more with a
# longer interval.
# For us: compare an output of such an FMU with the input of the row before, by its own times, not with the column.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check fmpy==0.3.32 pythonfmu==0.7.0
cd "$folder"
cat > gear.py <<'PYTHON'
from pythonfmu import Fmi2Causality, Fmi2Slave, Real


class Gear(Fmi2Slave):
    def __init__(self, **kwargs):
        super().__init__(**kwargs)
        self.motor = self.output = 0.0
        self.register_variable(Real('motor', causality=Fmi2Causality.input))
        self.register_variable(Real('output', causality=Fmi2Causality.output))

    def do_step(self, current_time, step_size):
        self.output = self.motor / 20
        return True
PYTHON
PATH="$folder/venv/bin:$PATH" venv/bin/pythonfmu build -f gear.py > log 2>&1 || { cat log; exit 1; }
timeout 60 venv/bin/python - <<'PYTHON'
import numpy as np
from fmpy import simulate_fmu

times = np.arange(11) * 0.01
motor = np.array([(time, 100 * time) for time in times], dtype=[('time', float), ('motor', float)])
result = simulate_fmu('Gear.fmu', stop_time=0.1, output_interval=0.01, input=motor, output=['motor', 'output'])
print('given', motor['motor'][-3:], 'recorded', result['motor'][-3:], result['output'][-3:])
assert np.allclose(result['time'], times) and np.allclose(result['motor'][1:], 100 * times[:-1])
assert np.allclose(result['output'], result['motor'] / 20)
PYTHON
