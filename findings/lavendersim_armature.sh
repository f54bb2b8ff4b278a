#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# LavenderSim 0.2.0: armature and friction of a motor, and the spring, limits and friction of a tendon, have no effect.
#
# Its README names "actuator dynamics" and "fixed tendons" among its features, and an armature and a fixed tendon as
# those of two of its tasks. A motor gives 0.15 N·m to a rotor of 0.015 kg·m² for a second. Expected: 5 rad at 10 rad/s,
# less than a hundredth of it with an armature of 10 kg·m² or a friction of 5 N·m, and an output that turns along where
# a fixed tendon of 100 N·m/rad couples it to the rotor, or a stop at 0.1 rad. What happens: each of these gives the
# same, -1.44 rad at 9.37 rad/s, while the output stands still, as nothing reads these values. The angle wraps at half a
# turn, although the joint is limited to ±100 rad, and a torque sensor on the rotor reads 0. There is no warning.
# For us: simulate a gear with MuJoCo.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check lavendersim==0.2.0 numpy==2.4.6
timeout 100 "$folder/venv/bin/python" -W error - <<'PYTHON'
import numpy as np
from lavendersim import PD, Scene
from lavendersim.runtime import CodeSceneEnv


def run(motor=None, tendon=None):
    """Observe the joints after the motor has given 0.15 N·m for a second."""
    scene = Scene('gear', gravity=0.0, ground=False, self_collision=False)
    stator = scene.box('stator', size=(0.1, 0.1, 0.1), position=(0, 1, 0), mass=0)
    joints = []
    for name, x in (('rotor', 0), ('output', 1)):
        body = scene.box(name, size=(0.3, 0.3, 0.3), position=(x, 1, 0), mass=1.0)
        joints.append(
            scene.revolute(
                name, stator, body, anchor=(x, 1, 0), axis=(0, 0, 1), limits=(-100, 100), pd=PD(0, 0, 100), control_mode='effort'
            )
        )
    if tendon is not None:
        scene.fixed_tendon('belt', {joints[0]: 1.0, joints[1]: -1.0}, **tendon)
    scene.actuator('motor', target=joints[0], control_range=(-1, 1), **(motor or {}))
    scene.torque_sensor('torque', site=scene.site('flange', body='rotor'))
    with CodeSceneEnv(scene, control_dt=0.005) as simulation:
        simulation.reset(seed=1)
        for _ in range(200):
            observed, *_ = simulation.step({'actuators': {'motor': 0.15}})
    return observed


def shown(observed):
    return [observed['joint'][name][:2].round(3).tolist() for name in ('rotor', 'output')]


plain, geared = run(), run({'gear': 2.0})
print('rotor and output, rad and rad/s: plain', shown(plain), 'with a gear of 2', shown(geared))
angle, speed = plain['joint']['rotor'][:2]
assert 9 < speed < 10 and abs(angle + 2 * np.pi - 5) < 0.3 and 18 < geared['joint']['rotor'][1] < 20
assert not plain['torque_sensors']['torque'].any()
for motor, tendon in (
    ({'armature': 10.0}, None),
    ({'friction_loss': 5.0}, None),
    (None, {'stiffness': 100.0}),
    (None, {'damping': 100.0}),
    (None, {'friction_loss': 5.0}),
    (None, {'limits': (-0.1, 0.1)}),
):
    observed = run(motor, tendon)
    print('motor', motor, 'tendon', tendon, shown(observed), observed['tendons'])
    assert shown(observed) == shown(plain) and observed['joint']['output'][0] == 0
PYTHON
