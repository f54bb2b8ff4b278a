# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Gears to be simulated, and what their output does under a load, by hand."""

import math
from dataclasses import replace
from fractions import Fraction
from typing import NamedTuple

import numpy as np

from gear_kinematics.correction.calibration_file import Order
from gear_kinematics.kinematics import Branch, GearRatio
from gear_kinematics.kinematics.loads import Bodies
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.twin.gear import TwinGear


class PutIn(NamedTuple):
    """What a simulated gear of two branches is made of."""

    preload: float
    """T0, N·m; 0 if there is play."""
    remaining: float
    """rad: the play of the output; 0 with a preload."""
    play: float
    """rad: between the flanks of each branch."""
    branch_a: float
    """kA, N·m/rad."""
    branch_b: float
    """kB, N·m/rad."""
    shaft: float
    """ks, N·m/rad."""
    friction: float
    """N·m."""
    errors: tuple[Order, ...]
    parameters: NodeParameters

    @property
    def path_a(self) -> float:
        """kAe, N·m/rad: of branch A and the shaft in series."""
        return 1.0 / (1.0 / self.branch_a + 1.0 / self.shaft)

    @property
    def thresholds(self) -> tuple[float, float]:
        """Loads, N·m, at which branch A and branch B leave mesh (mechanism.md, Preload)."""
        share = self.path_a / self.branch_b
        return self.preload * (1.0 + 1.0 / share), -self.preload * (1.0 + share)

    @property
    def gear(self) -> TwinGear:
        """The gear to be simulated."""
        compliance = 1.0 / self.path_a + 1.0 / self.branch_b
        return TwinGear(
            parameters=self.parameters,
            stiffness=(self.branch_a, self.branch_b),
            shaft_stiffness=self.shaft,
            interference=abs(self.preload) * compliance - self.remaining,
            play=self.play,
            friction=self.friction,
            errors=self.errors,
            output_inertia=1e-4,
        )

    def turn(self, load: np.ndarray) -> np.ndarray:
        """The turn of the output, rad, under a load on the springs, N·m, but not 0.

        While the rotor is locked, each branch is wound up by the turn backwards. The common
        stiffness of branch A and the shaft acts from the flanks of A on.
        """
        place_a = 0.5 * self.remaining - self.preload / self.path_a
        place_b = self.preload / self.branch_b - 0.5 * self.remaining
        other = math.copysign(self.play, self.preload)
        bands = [
            (self.path_a, *sorted((place_a, place_a - other))),
            (self.branch_b, *sorted((place_b, place_b + other))),
        ]
        corners = sorted({-1.0, 1.0, *(-end for _, *ends in bands for end in ends)})
        loads = [
            sum(k * (max(turn + low, 0.0) + min(turn + high, 0.0)) for k, low, high in bands)
            for turn in corners
        ]
        return np.interp(load, loads, corners)


def drawn(number: int, *, braced: bool | None = None) -> PutIn:
    """Draw a gear; unless told, every other one has a preload, and the others play."""
    random = np.random.default_rng(number)
    braced = number % 2 == 0 if braced is None else braced

    def about(low: float, high: float) -> float:
        return float(np.exp(random.uniform(math.log(low), math.log(high))))

    ring_teeth, difference = int(random.integers(60, 101)), int(random.integers(5, 9))
    ratio = GearRatio(difference - ring_teeth, difference)
    kA, kB, ks = about(1500.0, 5000.0), about(1500.0, 5000.0), about(700.0, 3000.0)
    preload = float(random.choice([-1.0, 1.0])) * about(0.5, 3.0) if braced else 0.0
    remaining = 0.0 if braced else about(1e-4, 5e-3)
    interference = abs(preload) * (1.0 / kA + 1.0 / kB + 1.0 / ks)
    play = interference * about(0.5, 1.5) if braced else remaining + about(1e-4, 1e-3)
    sizes = ('rotor × 1', 1, 5e-4), ('rotor × 2', 2, 2e-4), ('output × 2', 2 / abs(ratio), 1e-3)
    errors = tuple(
        Order(name, Fraction(cycles), *random.uniform(-size, size, 2).tolist())
        for name, cycles, size in sizes
    )
    parameters = replace(
        NodeParameters.load(),
        ring_teeth=ring_teeth,
        satellite_teeth=ring_teeth - difference,
        eccentricity=about(0.8e-3, 2e-3),
        branches=(Branch('a'), Branch('b', float(random.uniform(-3.0, 3.0)), -0.08)),
        rotor_direction=int(random.choice([-1, 1])),
        rotor_zero=float(random.uniform(-3.0, 3.0)),
        output_encoder_direction=int(random.choice([-1, 1])),
        output_encoder_zero=float(random.uniform(-3.0, 3.0)),
        preload=preload,
        branch_stiffness=(kA, kB),
        shaft_stiffness=ks,
        loads=Bodies(0.09, 5e-5, 0.05, 5e-5, 1e-5, 0.35),
    )
    return PutIn(preload, remaining, play, kA, kB, ks, about(0.05, 0.5), errors, parameters)
