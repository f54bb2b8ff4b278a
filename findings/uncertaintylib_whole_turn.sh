#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# uncertaintylib 1.1.2: the torque of an arm at 100 turns of its shaft has an uncertainty of 0 N·m instead of 0.1 N·m.
#
# A torque is 10 N·m times the sine of an angle that is known to 0.01 rad. At whole turns the sine is near 0, and the
# torque is known to 0.1 N·m, however many turns there were. What happens: the derivative is a difference over one per
# cent of the angle, which the documentation does not say. After 100 turns this is one whole turn and after 50 turns
# half a turn, so that the derivative and the uncertainty are 0; after 30 turns it is 0.05 N·m, and after one turn it is
# right. A simulation of 4000 cases by the same package gives 0.1 N·m for all of them.
# For us: reduce an angle to one turn beforehand, or use monte_carlo_simulation().
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check uncertaintylib==1.1.2 numpy==2.4.6 scipy==1.17.1
cat > "$folder/turns.py" <<'PYTHON'
import numpy as np
from uncertaintylib.uncertainty_functions import calculate_uncertainty, monte_carlo_simulation


def torque(values):
    return {'torque': values['weight'] * np.sin(values['angle'])}


np.random.seed(0)
found = {}
for turns in (0, 1, 30, 50, 100):
    inputs = {
        'mean': {'angle': 2 * np.pi * turns, 'weight': 10.0},
        'standard_uncertainty': {'angle': 0.01, 'weight': 0.001},
        'standard_uncertainty_percent': {'angle': np.nan, 'weight': np.nan},
    }
    found[turns] = calculate_uncertainty(inputs, torque)['u']['torque']
    simulated = monte_carlo_simulation(inputs, torque, 4000)['torque'].std()
    print(f'{turns} turns: {found[turns]:.4f} N·m, simulated {simulated:.4f} N·m, right is 0.1000 N·m')
    assert abs(simulated - 0.1) < 0.005
assert abs(found[0] - 0.1) < 0.001 and abs(found[1] - 0.1) < 0.001
assert abs(found[30] - 0.0505) < 0.001 and found[50] < 1e-9 and found[100] < 1e-9
PYTHON
timeout 100 "$folder/venv/bin/python" -W ignore "$folder/turns.py"
