#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# controlsim 0.1.0: a drive that is unstable has an infinite phase margin, and a delay of one step is none.
#
# ProcessDefinition gives the margins of a position loop, 7200 / (s (s + 10) (s + 20)). Expected: a phase margin of
# -4.8°, as the loop is unstable when it is closed. What happens: its frequencies are a grid of 10 000, and the gain
# counts as 1 only within 0.01 dB. Where the gain falls by more than 0.02 dB from one frequency to the next, the
# crossing can be missed, and the margin is infinite without a warning: for 9 of 90 gains from 100 to 9000. In step(),
# a delay of 10 ms at steps of 10 ms has no effect, and one of 50 ms is simulated as 40 ms, so that a simulated loop
# is better damped than the drive.
# For us: use control.margin(), and take the delay times the crossing frequency from its phase margin.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check controlsim==0.1.0 control==0.10.2 numpy==2.4.6 \
    scipy==1.17.1 matplotlib==3.10.3
cat > "$folder/margins.py" <<'PYTHON'
import control
import numpy as np
from controlsim import ProcessDefinition


def phase_margins(gain):
    loop = control.tf([gain], [1, 30, 200, 0])
    _, given, _, _ = ProcessDefinition(loop, 0.0).gain_phase_margin()
    _, right, _, _ = control.margin(loop)
    return given, right


given, right = phase_margins(7200)
poles = control.poles(control.feedback(control.tf([7200], [1, 30, 200, 0])))
print('phase margin', given, 'right', right, 'poles of the closed loop', poles)
assert np.isinf(given) and abs(right + 4.82) < 0.01 and max(poles.real) > 0
missed = sum(np.isinf(phase_margins(gain)[0]) for gain in range(100, 9001, 100))
print('infinite margins', missed, 'of 90')
assert missed == 9
for gain in 2000, 8000:  # where no crossing is missed, the margin is right
    given, right = phase_margins(gain)
    assert abs(given - right) < 0.05
for delay, simulated in (0.01, 0), (0.03, 2), (0.05, 4):
    process = ProcessDefinition(control.tf([1], [0.1, 1]), delay, dt=0.01)
    for _ in range(10):
        process.step(1.0)
    steps = process.u[1:].index(1.0)
    print('a delay of', delay, 's is simulated as', steps, 'steps of 0.01 s')
    assert steps == simulated
PYTHON
MPLBACKEND=agg timeout 60 "$folder/venv/bin/python" "$folder/margins.py"
