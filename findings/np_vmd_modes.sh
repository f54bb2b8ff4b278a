#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# np-vmd 0.1.1: an arm driven at its resonance lags by 6° instead of 90°, and modes of unequal inertias are wrong.
#
# An arm of 1 kg·m² on a gear of 100 N·m/rad resonates at 10 rad/s; its damping ratio is 0.05, and 1 N·m at 10 rad/s
# drives it. Expected of forced_cos_response_at_t_funcs() after a minute: the angle lags by 90°. What happens: it lags
# by 6.3°, as its phase has k - m ω instead of k - m ω², at any frequency. "v" is not the derivative of "x", as the
# amplitude that decays is a power there instead of a product. from_wn_kz() makes 0.0005 of a ratio of 0.05. Of two
# inertias, 9 kg·m² for an arm and 1 kg·m² for a rotor, the first mode turns the second one by 3 rad for 1 rad of the
# first, as Smat of TDOF_modal has it. What happens: `us` and print_eigenmodes() have 1/3 rad.
# For us: take the lag from phi_angle(), the mode shapes from Smat, and a system of one inertia from from_z_mk().
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check --no-deps \
    np-vmd==0.1.1 numpy==2.4.6 scipy==1.17.1
cd "$folder"
timeout 60 venv/bin/python - <<'PYTHON'
import numpy as np
from np_vmd.sdof_funcs import SDOF_system, phi_angle
from np_vmd.tdof_MCK import TDOF_modal
from scipy.integrate import solve_ivp

STIFFNESS, RATIO, SPEED = 100.0, 0.05, 10.0
arm = SDOF_system.from_z_mk(RATIO, 1.0, STIFFNESS)
assert (arm.wn, arm.zeta) == (10.0, RATIO)
response = arm.forced_cos_response_at_t_funcs(0.0, 0.0, 1.0, SPEED)

times = np.linspace(60.0 - 20 * np.pi / SPEED, 60.0, 4000, endpoint=False)  # the last ten periods


def motion(time, state):
    return state[1], np.cos(SPEED * time) - arm.c * state[1] - STIFFNESS * state[0]


def lag(angles):
    return np.degrees(np.arctan2(*(np.mean(angles * wave(SPEED * times)) for wave in (np.sin, np.cos))))


solved = solve_ivp(motion, (0.0, 60.0), (0.0, 0.0), t_eval=times, rtol=1e-9, atol=1e-12).y[0]
lags = lag(response['x'](times)), lag(solved), np.degrees(phi_angle(1.0, RATIO))
print('lag of the library, of the integrated motion, and of phi_angle():', lags)
assert abs(lags[0] - 6.34) < 0.01 and abs(lags[1] - 90.0) < 0.01 and abs(lags[2] - 90.0) < 1e-9

speed, slope = response['v'](0.5), (response['x'](0.5 + 1e-6) - response['x'](0.5 - 1e-6)) / 2e-6
print('"v" at 0.5 s:', speed, 'derivative of "x":', slope)
assert abs(speed - slope) > 0.1
ratio = SDOF_system.from_wn_kz(10.0, STIFFNESS, RATIO).zeta
print('from_wn_kz() of 0.05:', ratio)
assert abs(ratio - 0.0005) < 1e-9

inertias, stiffnesses = np.diag([9.0, 1.0]), np.array([[27.0, -3.0], [-3.0, 3.0]])
pair = TDOF_modal(inertias, stiffnesses)
for number, frequency in enumerate(pair.wns):
    right, found = pair.Smat[:, number] / pair.Smat[0, number], pair.us[:, number]
    residue = stiffnesses @ right - frequency**2 * inertias @ right
    print(f'mode at {frequency:.3f} rad/s: {found}, and by Smat {right}')
    assert np.allclose(residue, 0.0) and np.allclose(found[1], right[1] / 9)
PYTHON
