#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# motulator 0.5.0: the encoder of a motor that drives its load over an elastic shaft stays at 0, and the drive cannot
# run.
#
# TwoMassMechanicalSystem is a rotor and a load with a stiffness and damping between them. Expected: the rotor's angle
# is the integral of its speed, as in StiffMechanicalSystem. What happens: the angle is kept as a complex number of
# length 1, which begins at 0 here and stays there: theta_M is 0 where the rotor has turned by 10.76 rad. A control with
# an encoder (sensorless=False) that is to turn at 20.94 rad/s then does not: the rotor turns by 0.59 rad instead of
# 10.69 rad in 0.6 s. meas_load_position() is an AttributeError. 0.5.0 is what pip installs with Python 3.11; the state
# of 0.18.0, which needs Python 3.12, is the angle itself.
# For us: set mechanics.state.exp_j_theta_M to complex(1) before the simulation; then all is right.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check motulator==0.5.0 numpy==2.4.6 scipy==1.17.1
cd "$folder"
timeout 200 venv/bin/python - <<'PYTHON'
import numpy as np
from motulator.drive import model
from motulator.drive.control.sm import CurrentReferenceCfg, CurrentVectorControl
from motulator.drive.utils import SynchronousMachinePars, TwoMassMechanicalSystemPars


def run(mechanics, sensorless):
    pars = SynchronousMachinePars(n_p=3, R_s=3.6, L_d=0.036, L_q=0.051, psi_f=0.545)
    drive = model.Drive(model.VoltageSourceConverter(u_dc=540), model.SynchronousMachine(pars), mechanics)
    references = CurrentReferenceCfg(pars, nom_w_m=2 * np.pi * 75, max_i_s=10.6)
    control = CurrentVectorControl(pars, references, J=0.015, sensorless=sensorless)
    control.ref.w_m = lambda t: (t > 0.05) * 2 * np.pi * 10
    model.Simulation(drive, control).simulate(t_stop=0.6)
    data = drive.mechanics.data
    return np.trapezoid(data.w_M, data.t), np.unwrap(data.theta_M)[-1] - data.theta_M[0]


def elastic():
    return model.TwoMassMechanicalSystem(TwoMassMechanicalSystemPars(J_M=0.005, J_L=0.010, K_S=700.0, C_S=0.13))


mended = elastic()
mended.state.exp_j_theta_M = complex(1)
turns = {
    'stiff, without encoder': run(model.StiffMechanicalSystem(J=0.015), True),
    'elastic, without encoder': run(elastic(), True),
    'stiff, with encoder': run(model.StiffMechanicalSystem(J=0.015), False),
    'elastic, with encoder': run(elastic(), False),
    'elastic and set, with encoder': run(mended, False),
}
for name, (turned, angle) in turns.items():
    print(name, 'turned by', turned, 'rad, its angle by', angle)
for name in 'stiff, without encoder', 'stiff, with encoder', 'elastic and set, with encoder':
    assert abs(turns[name][0] - turns[name][1]) < 1e-3 and turns[name][1] > 10.6
assert turns['elastic, without encoder'][0] > 10.6 and turns['elastic, without encoder'][1] == 0
assert abs(turns['elastic, with encoder'][0]) < 2 and turns['elastic, with encoder'][1] == 0
PYTHON
