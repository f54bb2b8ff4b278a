# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The driver of a simulated motor, and the encoders at rotor and output.

Position, speed and torque are controlled in a cascade. With the angle x and the speed v of the
rotor, and the commanded ones x_c and v_c,

    v_r = v_c + (ω/4)(x_c - x)                           within 90 % of the greatest speed
    M = J [ω (v_r - v) + (ω²/8) ∫ (v_r - v) dt]          within the greatest torque

J is the inertia of rotor and output at the rotor, so that ω is the bandwidth of the speed; the
poles of the position are at -0.11 ω and (-0.44 ± 0.28 j) ω. The integral is held while the torque
is at its limit.
"""

import math
import random
from typing import NamedTuple

from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.twin.fast_model import inertias
from gear_kinematics.twin.model import TwinModel
from gear_kinematics.twin.parameters import TwinParameters

_PERIOD = 2e-4  # s, of the servo loop
_BANDWIDTH = 30.0  # Hz, ω/2π; less if the inertia of the output needs it
_FRESH = 0.02
"""Time, s, for which a commanded position moves on with the velocity of the same command.

So a stream of commands causes no steps, and the position of a single command is held."""
_SEED = 0
_SHARE = 0.9  # share of the greatest speed that is commanded, to leave room for overshoot


class Command(NamedTuple):
    """Command of a JointState in the encoder's coordinates; None for a value not commanded.

    A position is held; if there is a velocity as well, it moves on for a moment, until the next
    command. Without a position, the velocity is held. Only without both does the effort act.
    """

    position: float | None  # commanded position, rad
    velocity: float | None  # commanded velocity, rad/s
    effort: float | None  # commanded torque, N·m


class Driver:
    """Moves a model by commands, and reads its encoders."""

    def __init__(self, model: TwinModel, own: TwinParameters) -> None:
        """Switch the driver on, with its own parameters and those of the model's gear.

        The rotor is free until the first command.
        """
        self.model = model
        self.torque = 0.0  # torque of the motor, or of the lock of the rotor, N·m
        self._own, self._parameters = own, model.gear.parameters
        self._random = random.Random(_SEED)  # noqa: S311, no secret
        rotor, output = inertias(model.gear)
        self._inertia = rotor + output / model.gear.ratio**2
        # The torque accelerates the rotor first, in a period by at most half of the speed error.
        self._omega = min(TURN * _BANDWIDTH, 0.5 / _PERIOD * rotor / self._inertia)
        self._origin = self._parameters.rotor_zero  # position at rotor angle 0, rad
        self._load = 0.0
        self._release()

    def _release(self) -> None:
        self._command: Command | None = None
        self._age = 0.0  # time since the command, s
        self._integral = 0.0  # integral of the error in speed, rad

    def follow(self, command: Command) -> None:
        """Follow a command until the next one."""
        self._command, self._age = command, 0.0

    def power_cycle(self) -> None:
        """Switch off and on: the rotor is free, and counting of turns starts again from here."""
        self._release()
        if not self._parameters.rotor_period:
            self._origin = -self._parameters.rotor_direction * self.model.rotor_angle

    def advance(self, duration: float, load_torque: float) -> None:
        """Advance the time, s, with an external torque on the output shaft, N·m."""
        model, self._load = self.model, load_torque
        steps = math.ceil(duration / _PERIOD - 1e-6)
        period = duration / steps
        for _ in range(steps):
            self.torque = self._servo(period)
            model.advance(period, self.torque, load_torque)
        if model.rotor_locked:
            self.torque = sum(model.branch_torques) / model.gear.ratio

    def rotor(self) -> tuple[float, float, float]:
        """Read position (rad), velocity (rad/s) and effort (N·m) of the rotor as published."""
        parameters = self._parameters
        direction = parameters.rotor_direction
        position = self._origin + direction * self.model.rotor_angle
        return (
            _counted(position, self._own.rotor_counts, parameters.rotor_period),
            direction * self.model.rotor_velocity,
            direction * self.torque / parameters.rotor_effort_factor,
        )

    def output(self) -> tuple[float, float, float]:
        """Read the output: position within a turn, rad, velocity, rad/s, and load torque, N·m."""
        direction = self._parameters.output_encoder_direction
        position = self._parameters.output_encoder_zero + direction * self.model.output_angle
        return (
            _counted(position, self._own.output_counts, TURN),
            direction * self.model.output_velocity,
            direction * self._load,
        )

    def drops(self) -> bool:
        """Decide whether the next message is dropped; every run drops the same messages."""
        return self._random.random() < self._own.dropout

    def _servo(self, period: float) -> float:
        """Compute the torque of the motor, N·m, for the next period, s."""
        if self._command is None:
            return 0.0
        model, omega, most = self.model, self._omega, self._own.max_rotor_torque
        fastest = _SHARE * self._parameters.max_rotor_speed
        direction = self._parameters.rotor_direction
        position, velocity, effort = self._command
        if position is None and velocity is None:
            self._integral = 0.0
            torque = direction * (effort or 0.0)
            if abs(model.rotor_velocity) > fastest and torque * model.rotor_velocity > 0.0:
                torque = 0.0
            return _within(torque, most)
        speed = direction * (velocity or 0.0)
        if position is not None:
            if self._age > _FRESH:
                speed = 0.0
            angle = direction * (position - self._origin) + speed * self._age
            self._age += period
            speed += 0.25 * omega * (angle - model.rotor_angle)
        error = _within(speed, fastest) - model.rotor_velocity
        integral = self._integral + period * error
        torque = self._inertia * omega * (error + 0.125 * omega * integral)
        if abs(torque) <= most:
            self._integral = integral
        return _within(torque, most)


def _within(value: float, bound: float) -> float:
    return max(-bound, min(value, bound))


def _counted(position: float, counts: int, period: float) -> float:
    """Round a position to the counts per turn of an encoder that repeats after a period, rad.

    0 counts leave it exact, and with a period of 0 it never repeats.
    """
    if counts:
        position = round(position * counts / TURN) * TURN / counts
    return position % period if period else position
