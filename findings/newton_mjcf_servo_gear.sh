#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# Newton 1.8.0: of an MJCF, a position servo and a velocity servo lose their gear, a motor keeps it.
#
# A joint has a gear of 20 between its actuator and its output, gear="20" in the MJCF. Expected of add_mjcf() and
# SolverMuJoCo, as of MuJoCo 3.17.0, which the solver uses: a servo with kp="50" whose goal is 20 rad turns the output
# to 1 rad, and gives way by 0.5 mrad under 10 N·m, as its stiffness is 20 · 20 · 50 N·m/rad. What happens: it turns to
# 20 rad, and gives way by 0.2 rad. A velocity servo with gear="-20" and a goal of 20 rad/s turns at 20 rad/s instead of
# -1 rad/s. There is no warning, also with verbose=True. The gears are parsed and lie in model.mujoco.actuator_gear. A
# motor keeps its gear, and with ctrl_direct=True the servos do, too. It is documented that servos get their goals from
# `joint_target_q` and `joint_target_qd`; these could be goals of the output, but then the stiffness is 400 times too
# low. That the gear has no effect on them is not documented.
# For us: use ctrl_direct=True, or give goals of the output and multiply `joint_target_ke` and `joint_target_kd` by the
# square of the gear.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check newton==1.8.0 mujoco==3.17.0 mujoco-warp==3.17.0 \
  warp-lang==1.19.0 numpy==2.4.6
cat > "$folder/servo.py" <<'PYTHON'
import mujoco
import newton
import numpy as np

MODEL = """<mujoco><option timestep="0.001" gravity="0 0 0" integrator="implicitfast"/><worldbody><body>
  <joint name="output" axis="0 0 1"/><inertial pos="0 0 0" mass="1" diaginertia="0.1 0.1 0.1"/></body></worldbody>
  <actuator>{}</actuator></mujoco>"""
POSITION = '<position joint="output" kp="50" kv="2" gear="20"/>'
VELOCITY = '<velocity joint="output" kv="2" gear="-20"/>'
MOTOR = '<motor joint="output" gear="20"/>'


def in_mujoco(text, goal, load):
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    data.ctrl[0], data.qfrc_applied[0] = goal, load
    mujoco.mj_step(model, data, 1500)
    return data.qpos[0], data.qvel[0]


def in_newton(text, goal, load, direct):
    builder = newton.ModelBuilder(gravity=(0, 0, 0))
    newton.solvers.SolverMuJoCo.register_custom_attributes(builder)
    builder.add_mjcf(text, ctrl_direct=direct, verbose=True)
    model = builder.finalize(device='cpu')
    solver = newton.solvers.SolverMuJoCo(model, use_mujoco_cpu=True)
    state, following, control = model.state(), model.state(), model.control()
    if direct or 'motor' in text:
        control.mujoco.ctrl.assign([goal])
    else:
        control.joint_target_q.assign([goal])
        control.joint_target_qd.assign([goal if 'velocity' in text else 0])
    control.joint_f.assign([load])
    for _ in range(1500):
        state.clear_forces()
        solver.step(state, following, control, None, 0.001)
        state, following = following, state
    parsed = model.mujoco.actuator_gear.numpy()[0][0]
    return state.joint_q.numpy()[0], state.joint_qd.numpy()[0], parsed, solver.mj_model.actuator_gear[0, 0]


for actuator, goal, load, direct, right, found in (
    (POSITION.replace('gear="20"', ''), 1, 0, False, (1, 0), (1, 0, 1, 1)),
    (POSITION, 20, 0, False, (1, 0), (20, 0, 20, 1)),
    (POSITION, 0, 10, False, (0.0005, 0), (0.2, 0, 20, 1)),
    (POSITION, 20, 0, True, (1, 0), (1, 0, 20, 20)),
    (POSITION, 0, 10, True, (0.0005, 0), (0.0005, 0, 20, 20)),
    (VELOCITY, 20, 0, False, (-1.5, -1), (29, 20, -20, 1)),
    (VELOCITY, 20, 0, True, (-1.5, -1), (-1.5, -1, -20, -20)),
    (MOTOR, 0.01, 0, False, (2.25, 3), (2.25, 3, 20, 20)),
):
    text = MODEL.format(actuator)
    expected, others = in_mujoco(text, goal, load), in_newton(text, goal, load, direct)
    print(f'{actuator}, goal {goal}, load {load} N·m, ctrl_direct={direct}: MuJoCo {expected[0]:.4f} rad, '
          f'{expected[1]:.2f} rad/s; Newton {others[0]:.4f} rad, {others[1]:.2f} rad/s, gear {others[3]:g}', flush=True)
    assert np.allclose(expected, right, rtol=2e-3, atol=1e-5) and np.allclose(others, found, rtol=2e-3, atol=1e-3)
PYTHON
export OMP_NUM_THREADS=1 WARP_CACHE_PATH="$folder/cache"
timeout 580 "$folder/venv/bin/python" "$folder/servo.py" > "$folder/log" 2>&1 || { cat "$folder/log"; exit 1; }
grep MuJoCo "$folder/log"
if grep -i warning "$folder/log" | grep -vi cuda; then exit 1; fi
