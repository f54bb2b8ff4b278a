#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# rapier3d 0.36.1: the gear ratio of a joint equality in an MJCF is inverted, 1/20 becomes 20.
#
# <joint joint1="output" joint2="motor" polycoef="0 -0.05 0 0 0"/> means output = -0.05 · motor. With 0.01 N·m at a
# rotor of 0.01 kg·m², and an output of 4 kg·m², MuJoCo 4.0.0 has 0.5 rad/s at the rotor and -0.025 at the output after
# a second. The loader of rapier, where joints are inserted as a multibody, has 6e-6 and -1.2e-4: the rotor turns with a
# twentieth of the speed of the output. Where they are inserted as impulse joints, the equality has no effect.
# For us: exchange joint1 and joint2 for rapier, and keep polycoef.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check rapier3d==0.36.1 mujoco==4.0.0 numpy==2.4.6
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import mujoco
import numpy as np
import rapier3d
from rapier3d.loaders import mjcf

MJCF = '''
<mujoco>
  <option gravity="0 0 0" timestep="0.001"/>
  <worldbody>
    <body name="rotor"><joint name="motor" axis="0 0 1" damping="1e-6"/>
      <inertial pos="0 0 0" mass="1" diaginertia=".01 .01 .01"/></body>
    <body name="shaft"><joint name="output" axis="0 0 1" damping="1e-6"/>
      <inertial pos="0 0 0" mass="1" diaginertia="4 4 4"/></body>
  </worldbody>
  <equality><joint joint1="{}" joint2="{}" polycoef="0 -0.05 0 0 0"/></equality>
  <actuator><motor joint="motor"/></actuator>
</mujoco>'''


def in_rapier(*joints, multibody=True):
    robot, _ = mjcf.MjcfRobot.from_str(MJCF.format(*joints))
    world = rapier3d.PhysicsWorld(gravity=(0, 0, 0))
    world.integration_parameters.dt = 0.001
    if multibody:
        inserted = world.multibody_joints
        handles = robot.insert_using_multibody_joints(
            world.rigid_bodies, world.colliders, inserted, world.impulse_joints
        )
    else:
        inserted = world.impulse_joints
        handles = robot.insert_using_impulse_joints(world.rigid_bodies, world.colliders, inserted)
    for _ in range(1000):
        handles.apply_controls(world.rigid_bodies, inserted, [0.01])
        world.step()
    bodies = [handles.bodies[handles.body_name_to_idx[name]].body for name in ('rotor', 'shaft')]
    return [world.rigid_bodies[body].angvel.z for body in bodies]


model = mujoco.MjModel.from_xml_string(MJCF.format('output', 'motor'))
data = mujoco.MjData(model)
data.ctrl[0] = 0.01
mujoco.mj_step(model, data, 1000)
speeds = {
    'MuJoCo': data.qvel,
    'rapier, multibody': in_rapier('output', 'motor'),
    'rapier, exchanged': in_rapier('motor', 'output'),
    'rapier, impulse joints': in_rapier('output', 'motor', multibody=False),
}
for name, (rotor, output) in speeds.items():
    print(name, 'rotor', rotor, 'output', output, 'rad/s')
for name in 'MuJoCo', 'rapier, exchanged':
    assert np.allclose(speeds[name], [0.5, -0.025], rtol=0.02)
assert np.allclose(speeds['rapier, multibody'], [6.25e-6, -1.25e-4], rtol=0.02)
assert np.allclose(speeds['rapier, impulse joints'], [1, 0], rtol=0.02)
PYTHON
