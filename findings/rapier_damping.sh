#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# rapier3d 0.36.1: a joint of an MJCF without damping has one of 0.1 N·m·s/rad, and one with damping has only its own.
#
# A motor gives 0.01 N·m to a rotor of 0.01 kg·m². Expected: without damping it turns at 1 rad/s after a second, as in
# MuJoCo 4.0.0. What happens where joints are inserted as a multibody: it turns at 0.1 rad/s, which it reaches in 0.1 s
# and never exceeds. With damping="0.01" it is faster, and right: 0.632 rad/s. The loader gives a joint that is not
# damped the standard damping of a multibody, which the description of the loader does not mention; joints of a URDF
# have it too.
# For us: set `multibody.set_damping()` after loading, or give each joint a damping of 1e-9.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check rapier3d==0.36.1 mujoco==4.0.0 numpy==2.4.6
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import math

import mujoco
import rapier3d
from rapier3d.loaders import mjcf

MJCF = '''
<mujoco>
  <option gravity="0 0 0" timestep="0.001"/>
  <worldbody>
    <body name="rotor"><joint name="motor" axis="0 0 1" damping="{}"/>
      <inertial pos="0 0 0" mass="1" diaginertia=".01 .01 .01"/></body>
  </worldbody>
  <actuator><motor joint="motor"/></actuator>
</mujoco>'''


def in_rapier(damping, seconds):
    robot, _ = mjcf.MjcfRobot.from_str(MJCF.format(damping))
    world = rapier3d.PhysicsWorld(gravity=(0, 0, 0))
    world.integration_parameters.dt = 0.001
    handles = robot.insert_using_multibody_joints(
        world.rigid_bodies, world.colliders, world.multibody_joints, world.impulse_joints
    )
    for _ in range(round(1000 * seconds)):
        handles.apply_controls(world.rigid_bodies, world.multibody_joints, [0.01])
        world.step()
    return world.rigid_bodies[handles.bodies[handles.body_name_to_idx['rotor']].body].angvel.z


def in_mujoco(damping, seconds):
    model = mujoco.MjModel.from_xml_string(MJCF.format(damping))
    data = mujoco.MjData(model)
    data.ctrl[0] = 0.01
    mujoco.mj_step(model, data, round(1000 * seconds))
    return data.qvel[0]


for damping, seconds, expected, found in (
    (0, 1, 1, 0.1),
    (0, 10, 10, 0.1),
    (1e-9, 1, 1, 1),
    (0.01, 1, 1 - math.exp(-1), 1 - math.exp(-1)),
):
    mujoco_speed, rapier_speed = in_mujoco(damping, seconds), in_rapier(damping, seconds)
    print('damping', damping, 'after', seconds, 's: MuJoCo', mujoco_speed, 'rapier', rapier_speed, 'rad/s')
    assert abs(mujoco_speed - expected) < 0.01 and abs(rapier_speed - found) < 0.01
PYTHON
