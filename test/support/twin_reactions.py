# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""What MuJoCo says of the forces in a simulated gear, against `kinematics.loads`."""

import copy
import math

import mujoco
import numpy as np
from twins import PutIn

from gear_kinematics.kinematics import solve
from gear_kinematics.kinematics.loads import solve as solve_loads
from gear_kinematics.twin.mujoco_model import MujocoModel

_BEGIN, _RUN = 200, 300  # ms, in which the torques rise, and all
_EVERY = 20  # ms


def forces_off(put_in: PutIn) -> float:
    """Compare all forces while a motor speeds the loaded rotor up.

    From the couple that MuJoCo's arm takes, `kinematics.loads` computes the force of the teeth and
    the torque of the motor, which must be those of spring and motor. That force then acts in place
    of the spring, so that MuJoCo tells the forces of the cam and in the slots.

    Returns:
        The greatest difference as a share of the greatest force at a cam in the same state. A
        couple counts as a force on the rolling circle of the satellite, or on the cam.
    """
    put_in = put_in._replace(errors=())  # which have no place in the closed form
    model = MujocoModel(put_in.gear)
    load = -0.5 * put_in.preload
    torque = 0.03 + put_in.friction / abs(put_in.gear.ratio) - load / put_in.gear.ratio
    off = []
    for number in range(_RUN):
        # A step would make the springs ring, of which the closed form knows nothing.
        share = 0.5 - 0.5 * math.cos(math.pi * min(1.0, number / _BEGIN))
        model.advance(1e-3, share * torque, share * load)
        if number > _BEGIN and number % _EVERY == 0:
            off.append(_off(model, put_in, torque))
    assert abs(model.rotor_velocity) > 100.0  # rad/s, so that masses count
    return max(off)


def _off(simulated: MujocoModel, put_in: PutIn, torque: float) -> float:
    parameters, model, data = put_in.parameters, simulated.model, simulated.data
    mechanism, names = parameters.mechanism, [branch.name for branch in parameters.branches]
    radius = mechanism.satellite_rolling_radius
    _forward(model, data)
    state = solve(
        mechanism, simulated.rotor_angle, simulated.rotor_velocity, data.joint('rotor').qacc[0]
    )
    turn = float(state.output_angle)
    across = parameters.loads.coupling_mass * state.oldham_acceleration
    across = across @ (-math.cos(turn), -math.sin(turn))
    couples = np.array([_wrench(model, data, f'slot_arm_{name}')[1] for name in names])
    torques = -couples - state.arm_slide * across
    expected = solve_loads(mechanism, state, torques, parameters.loads)
    teeth = expected.mesh_tangential - np.array(simulated.branch_torques) / radius
    motor = (expected.rotor_torque - torque) / mechanism.eccentricity
    differences = [*teeth, motor]
    acting, moved = copy.copy(model), copy.copy(data)
    acting.tendon_stiffness[[acting.tendon(f'branch_{name}').id for name in names]] = 0.0
    for branch, force in zip(parameters.branches, expected.mesh_force, strict=True):
        angle = simulated.rotor_angle + branch.cam_phase
        x, y = -radius * math.sin(angle), radius * math.cos(angle)  # of the pitch point
        satellite = acting.body(f'satellite_{branch.name}').id
        moved.xfrc_applied[satellite] = [*force, 0.0, 0.0, 0.0, x * force[1] - y * force[0]]
    _forward(acting, moved)
    for number, name in enumerate(names):
        cam, _ = _wrench(acting, moved, f'satellite_{name}')
        slot, couple = _wrench(acting, moved, f'oldham_{name}')
        arm, _ = _wrench(acting, moved, f'slot_arm_{name}')
        differences += [
            *(cam - expected.cam_force[number]),
            *(slot - expected.satellite_slot_force[number]),
            *(arm - expected.arm_slot_force[number]),
            (couple - expected.satellite_couple[number]) / radius,
        ]
    return float(np.max(np.abs(differences)) / np.max(np.hypot(*expected.cam_force.T)))


def _forward(model: mujoco.MjModel, data: mujoco.MjData) -> None:
    """Compute the accelerations, and the forces between bodies."""
    mujoco.mj_forward(model, data)
    mujoco.mj_rnePostConstraint(model, data)


def _wrench(model: mujoco.MjModel, data: mujoco.MjData, name: str) -> tuple[np.ndarray, float]:
    """Give force and couple, about its centre, that a body takes from the one it hangs on."""
    body = model.body(name).id
    *_, torque, x, y, _ = data.cfrc_int[body]
    lever = data.xpos[body] - data.subtree_com[model.body_rootid[body]]
    return np.array([x, y]), torque - (lever[0] * y - lever[1] * x)
