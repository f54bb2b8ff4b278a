#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# Newton 1.8.0: in SolverXPBD a geared rotor does not start under a small torque, and loses its ratio after one turn.
#
# An output of 4 kg·m² is the mimic of a rotor of 0.01 kg·m², by -0.05. Expected: SolverXPBD lists mimics as supported,
# so 0.01 N·m turn the rotor by 0.25 rad in a second, and 0.1 N·m by 10 rad in two, the output by -0.5 rad.
# SolverFeatherstone does that. What happens in SolverXPBD, in steps of 1 ms: with 0.01 N·m the rotor stands still after
# 0.001 rad; more iterations or shorter steps do not help. With 0.1 N·m all is right to one turn of the rotor; there its
# angle begins anew at 0, and the mimic turns the output back, to -0.07 rad.
# For us: give a model with a gear to SolverFeatherstone or SolverMuJoCo.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check newton==1.8.0 warp-lang==1.19.0
cat > "$folder/gear.py" <<'PYTHON'
import newton
import numpy as np
import warp as wp

URDF = '''
<robot name="gear">
  <link name="stator"/>
  <link name="rotor"><inertial><mass value="1"/>
    <inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <link name="shaft"><inertial><mass value="1"/><inertia ixx="4" iyy="4" izz="4" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="motor" type="continuous"><parent link="stator"/><child link="rotor"/><axis xyz="0 0 1"/></joint>
  <joint name="output" type="continuous"><parent link="stator"/><child link="shaft"/><axis xyz="0 0 1"/>
    <mimic joint="motor" multiplier="-0.05"/></joint>
</robot>'''


def turned(solver, torque, seconds, step=0.001, **options):
    builder = newton.ModelBuilder(gravity=(0.0, 0.0, 0.0))
    builder.add_urdf(URDF, floating=False)
    model = builder.finalize(device='cpu')
    solver = solver(model, **options)
    state, following, control = model.state(), model.state(), model.control()
    newton.eval_fk(model, model.joint_q, model.joint_qd, state)
    control.joint_f = wp.array([torque, 0.0], dtype=float, device='cpu')
    for _ in range(round(seconds / step)):
        state.clear_forces()
        solver.step(state, following, control, None, step)
        state, following = following, state
    angles, speeds = (wp.zeros(2, dtype=float, device='cpu') for _ in range(2))
    newton.eval_ik(model, state, angles, speeds)
    print(type(solver).__name__, torque, 'N·m', options, 'rotor and output', angles, 'rad', speeds, 'rad/s')
    return angles.numpy()


featherstone, xpbd = newton.solvers.SolverFeatherstone, newton.solvers.SolverXPBD
inertia = 0.01 + 0.05**2 * 4
assert abs(turned(featherstone, 0.01, 1)[0] - 0.01 / inertia / 2) < 0.01
assert abs(turned(featherstone, 0.1, 2)[1] - -0.05 * 0.1 / inertia / 2 * 4) < 0.01
for still in (
    turned(xpbd, 0.01, 1),
    turned(xpbd, 0.01, 1, iterations=20),
    turned(xpbd, 0.01, 0.2, 0.0002),
):
    assert 0 < still[0] < 0.002
assert abs(turned(xpbd, 0.1, 1)[1] - -0.05 * 0.1 / inertia / 2) < 0.01
assert np.allclose(turned(xpbd, 0.1, 2)[1], -0.073, atol=0.01)
PYTHON
WARP_CACHE_PATH="$folder/cache" timeout 300 "$folder/venv/bin/python" "$folder/gear.py" > "$folder/log" 2>&1 \
    || { cat "$folder/log"; exit 1; }
grep Solver "$folder/log"
