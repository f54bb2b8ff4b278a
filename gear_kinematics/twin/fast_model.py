# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""A model in plain floats: rotor and output shaft as two inertias, with the branches between them.

    J2 φ2'' = motor torque - damping φ2' - Σ T_k/i        J5 φ5'' = load torque + Σ T_k - friction

Satellites and couplings circle with the rotor and turn with the output. Arm A has no mass: the
shaft is in series with the spring of its branch.

Velocities step before angles (the symplectic Euler method): oscillations on the springs neither
grow nor decay while their angular frequency is below 2/h. Damping is implicit, and unlimited.
Friction stops the output within a step if it can, and otherwise slows it with all of its torque.
"""

import math
from dataclasses import replace

from gear_kinematics.kinematics import Mechanism, MechanismError
from gear_kinematics.twin.gear import TwinGear

_STEP = 1e-4  # h, s, at most
_FASTEST = 1.0 / _STEP  # rad/s: half of the bound, where the period is 5 % too short


class FastModel:
    """Implements `TwinModel` without MuJoCo; it begins at rest, without load, at φ2 = 0.

    Raises MechanismError if the gear is too stiff for its inertias.
    """

    def __init__(self, gear: TwinGear) -> None:
        self.notice = ''
        self.rotor_angle = self.rotor_velocity = self.output_velocity = 0.0
        self.output_angle = gear.error(0.0)
        self.rotor_locked = self.output_locked = False
        self.gear = gear

    @property
    def gear(self) -> TwinGear:
        """The simulated gear; a replacement must have the same mechanism."""
        return self._gear

    @gear.setter
    def gear(self, gear: TwinGear) -> None:
        springs = [*gear.stiffness]
        if gear.has_shaft:
            springs[0] = gear.loop.branch_a_alone
        self._ratio = gear.ratio
        self._rotor_inertia, self._output_inertia = inertias(gear)
        reduced = self._ratio**2 * self._rotor_inertia
        stiffness = sum(springs)
        frequency = math.sqrt(stiffness / reduced + stiffness / self._output_inertia)
        if frequency > _FASTEST:
            fault = f'rotor and output would oscillate at {frequency:.0f} rad/s, but the fast '
            fault += f'model follows up to {_FASTEST:.0f}: give more inertia or less stiffness'
            raise MechanismError([fault])
        self._in_series = replace(gear, stiffness=tuple(springs), shaft_stiffness=math.inf)
        self._gear = gear
        self.branch_torques, self._friction = self._torques(self.rotor_angle, self.output_angle)

    def advance(self, duration: float, rotor_torque: float, load_torque: float) -> None:
        """Advance the time; see `TwinModel`."""
        steps = math.ceil(duration / _STEP - 1e-6)
        h = duration / steps
        rotor_gain = 0.0 if self.rotor_locked else h / self._rotor_inertia
        output_gain = 0.0 if self.output_locked else h / self._output_inertia
        damped = 1.0 + rotor_gain * self._gear.rotor_damping
        ratio, rotor, output = self._ratio, self.rotor_angle, self.output_angle
        rotor_velocity = 0.0 if self.rotor_locked else self.rotor_velocity
        output_velocity = 0.0 if self.output_locked else self.output_velocity
        torques, friction = self.branch_torques, self._friction
        for _ in range(steps):
            torque = sum(torques)
            rotor_velocity += rotor_gain * (rotor_torque - torque / ratio)
            rotor_velocity /= damped
            output_velocity += output_gain * (load_torque + torque)
            slowed = output_gain * friction
            output_velocity -= max(-slowed, min(output_velocity, slowed))
            rotor += h * rotor_velocity
            output += h * output_velocity
            torques, friction = self._torques(rotor, output)
        self.rotor_angle, self.rotor_velocity = rotor, rotor_velocity
        self.output_angle, self.output_velocity = output, output_velocity
        self.branch_torques, self._friction = torques, friction

    def _torques(self, rotor: float, output: float) -> tuple[tuple[float, ...], float]:
        wind_up = rotor / self._ratio - output
        if self._gear.errors:
            wind_up += self._gear.error(rotor)
        return self._in_series.torques((wind_up,) * len(self._in_series.stiffness))


def inertias(gear: TwinGear) -> tuple[float, float]:
    """Compute the inertias J2 of what circles with the rotor, J5 of what turns with the output.

    A coupling's centre moves by (e/2)[n(θ) + κ n(2 φ5 - θ)] φ2' with κ = 2/i - 1: the mean over a
    turn counts.
    """
    bodies, ring = gear.parameters.loads, gear.parameters.gear
    if not isinstance(ring, Mechanism):
        return bodies.rotor_inertia, gear.output_inertia
    count, e = len(ring.branches), ring.eccentricity
    kappa = 2.0 / gear.ratio - 1.0
    circling = bodies.satellite_mass + 0.25 * (1.0 + kappa**2) * bodies.coupling_mass
    output = gear.output_inertia + count * gear.turning_inertia
    return bodies.rotor_inertia + count * e**2 * circling, output
