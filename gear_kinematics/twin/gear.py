# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The properties of a simulated actuator.

The branches and the shaft between their arms are springs. Branch k winds up by

    x_k = φ2/i + error(φ2) - ψ_k

with ψ_k the angle of its arm, and gives the arm the torque T_k: none within its dead band, which
is the play of its flanks, placed by the preload; and that of its spring beyond it. The output
shaft is the arm of the last branch. Friction acts between the output shaft and the stator.

Real springs bend, and friction grows with the load. A gear without preload may have a curve that
was measured at its output. Then each branch gives an equal share of the torque, and the shaft is
rigid, as its twist is in the curve.

Two branches are braced by an interference, by which branch A, the shaft and branch B are twisted
together. Without load, the output is at φ2/i: x_B = 0, and by the shaft x_A = -T0/ks, so that

    high_A = -T0 (1/kA + 1/ks)        low_B = T0/kB        low_B - high_A = interference

All signs are the opposite if branch A pushes the output in the negative direction.
"""

import math
from bisect import bisect, bisect_left
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise
from pathlib import Path
from typing import Self

import numpy as np

from gear_kinematics.correction.calibration_file import Calibration, Order
from gear_kinematics.kinematics import Mechanism, MechanismError
from gear_kinematics.kinematics.preload import Preload, Stiffness
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.parameters.arm import by_actuator
from gear_kinematics.parameters.files import given_parameters
from gear_kinematics.twin.parameters import NODE, PARAMETERS, TwinParameters

_BRACED = 2  # branches, which have a shaft between their arms


@dataclass(frozen=True, slots=True)
class LoadingCurve:
    """Torque and friction of a gear over its wind-up, interpolated linearly and extrapolated."""

    wind_up: tuple[float, ...]  #: wind-up angles, rad, ascending; 0 is one of them
    torque: tuple[float, ...]  #: torques, N·m, non-decreasing; 0 at 0 rad
    friction: tuple[float, ...]  #: friction torques, N·m

    def at(self, wind_up: float) -> tuple[float, float]:
        """Return torque and friction, N·m, at a wind-up, rad; friction stays beyond the ends."""
        right = bisect(self.wind_up, wind_up, 1, len(self.wind_up) - 1)
        left = right - 1
        share = (wind_up - self.wind_up[left]) / (self.wind_up[right] - self.wind_up[left])
        within = max(0.0, min(share, 1.0))
        torque, friction = self.torque, self.friction
        return (
            torque[left] + share * (torque[right] - torque[left]),
            max(0.0, friction[left] + within * (friction[right] - friction[left])),
        )

    @property
    def stiffness(self) -> tuple[float, ...]:
        """Stiffness between neighbouring points, N·m/rad."""
        ways = zip(pairwise(self.torque), pairwise(self.wind_up), strict=True)
        return tuple((t1 - t0) / (x1 - x0) for (t0, t1), (x0, x1) in ways)


@dataclass(frozen=True, slots=True, kw_only=True)
class TwinGear:
    """A gear to be simulated; angles and torques are those of the output.

    Raises MechanismError if a branch is rigid, or the rotor has no inertia.
    """

    parameters: NodeParameters  #: parameters of the mechanism, the bodies and the encoders
    stiffness: tuple[float, ...]
    """Stiffness of each branch once its flanks touch, N·m/rad; the greatest of a curve."""
    shaft_stiffness: float
    """Stiffness of the shaft between both arms, N·m/rad; infinite for a rigid one."""
    interference: float
    """Twist of the loop at the arms by the preload, rad; the remaining play if negative."""
    play: float  #: angle between the flanks of a branch, rad; at least the remaining play
    friction: float = 0.0  #: friction torque, N·m; the mean of a curve
    curve: LoadingCurve | None = None
    """Curve of all branches together once their flanks touch; only without shaft and preload."""
    errors: tuple[Order, ...] = ()  #: periodic errors of the output angle over the rotor angle
    rotor_damping: float = 0.0  #: viscous damping of the rotor, N·m·s/rad
    output_inertia: float  #: inertia of the output shaft, kg·m²
    ratio: float = field(init=False)  #: signed gear ratio i
    preload: float = field(init=False)
    """Preload T0 of two branches, N·m; negative if branch A pushes in the negative direction."""
    dead_bands: tuple[tuple[float, float], ...] = field(init=False)
    """Least and greatest x_k without torque, for each branch, rad."""
    _waves: tuple[tuple[float, float, float], ...] = field(init=False, repr=False, compare=False)
    """Cycles per turn of the rotor, cos and sin of each order, in plain floats."""

    def __post_init__(self) -> None:
        """Check the gear, and compute its dead bands."""
        faults = []
        if not all(0.0 < each < math.inf for each in self.stiffness):
            faults.append('branch_stiffness must be greater than 0: no simulated branch is rigid')
        if not self.parameters.loads.rotor_inertia:
            faults.append('loads.rotor_inertia must be greater than 0 for a simulation')
        if faults:
            raise MechanismError(faults)
        torque, bands = 0.0, ((-0.5 * self.play, 0.5 * self.play),) * len(self.stiffness)
        if len(self.stiffness) == _BRACED:
            torque = Preload(self.loop, self.interference).torque
            bands = self._braced_bands(torque)
        waves = tuple((float(each.cycles), each.cos, each.sin) for each in self.errors)
        object.__setattr__(self, '_waves', waves)
        object.__setattr__(self, 'ratio', float(self.parameters.gear.gear_ratio))
        object.__setattr__(self, 'preload', math.copysign(torque, self.parameters.preload))
        object.__setattr__(self, 'dead_bands', bands)

    @classmethod
    def load(
        cls, config: Path, node: str = NODE, calibration: Path | None = None, actuator: str = ''
    ) -> Self:
        """Read a gear from the parameters of a node in a file of ROS.

        The errors are those of the `calibration`, or else of the one that the file names, if any.
        `actuator` selects one of an arm. Raises ValueError if a file cannot be used, or the gear
        cannot be simulated.
        """
        shared = NodeParameters.load(config, node, PARAMETERS, actuator)
        given = by_actuator(given_parameters(config, node))[shared.actuator]
        return cls.of(shared, TwinParameters.of(given), calibration)

    @classmethod
    def of(
        cls, parameters: NodeParameters, twin: TwinParameters, calibration: Path | None = None
    ) -> Self:
        """Make a gear from valid parameters."""
        gear, file = parameters.gear, calibration or parameters.calibration
        count = len(gear.branches) if isinstance(gear, Mechanism) else 1
        stiffness, preload = parameters.branch_stiffness, parameters.preload
        if len(stiffness) not in {1, count}:
            fault = f'branch_stiffness has {len(stiffness)} values for {count} branches'
            raise MechanismError([fault])
        made = cls(
            parameters=parameters,
            stiffness=tuple(each or math.inf for each in (stiffness * count)[:count]),
            shaft_stiffness=parameters.shaft_stiffness or math.inf,
            interference=-twin.play,
            play=twin.play,
            friction=twin.friction,
            errors=Calibration.load(Path(file), gear).orders if file else (),
            rotor_damping=twin.rotor_damping,
            output_inertia=twin.output_inertia,
        )
        if preload:
            _ = parameters.sharing  # raises the error of an impossible preload
        return made.preloaded(abs(preload))

    @property
    def loop(self) -> Stiffness:
        """Stiffnesses of the two branches and the shaft, which a preload twists as a loop."""
        branch_a, branch_b = self.stiffness
        return Stiffness(branch_a, branch_b, self.shaft_stiffness)

    @property
    def has_shaft(self) -> bool:
        """Whether a shaft twists between the arms of two branches."""
        return len(self.stiffness) == _BRACED and math.isfinite(self.shaft_stiffness)

    @property
    def turning_inertia(self) -> float:
        """Inertia J3 + J4 of what turns with each arm, kg·m²."""
        return self.parameters.loads.satellite_inertia + self.parameters.loads.coupling_inertia

    @property
    def shaft_twist(self) -> float:
        """Angle by which arm A leads the output without load, rad."""
        return self.preload / self.shaft_stiffness

    def torques(self, wind_ups: Sequence[float]) -> tuple[tuple[float, ...], float]:
        """Compute T_k of all branches from their wind-ups x_k, rad, and the friction, N·m."""
        torques, friction = [], self.friction
        for x, (low, high), stiffness in zip(
            wind_ups, self.dead_bands, self.stiffness, strict=True
        ):
            beyond = x - high if x > high else min(x - low, 0.0)
            torque = stiffness * beyond
            if self.curve:
                torque, friction = self.curve.at(beyond)
                torque /= len(self.stiffness)
            torques.append(torque)
        return tuple(torques), friction

    def springs(self, branch: int) -> list[tuple[float, float, float]]:
        """Return the springs of a branch, which touch one after another.

        Returns:
            The wind-ups between which each one is slack, rad, and its stiffness, N·m/rad.
        """
        (low, high), curve = self.dead_bands[branch], self.curve
        if not curve:
            return [(low, high, self.stiffness[branch])]
        slopes = np.array(curve.stiffness) / len(self.stiffness)
        middle = bisect_left(curve.wind_up, 0.0)
        right = zip(curve.wind_up[middle:], np.diff(slopes[middle:], prepend=0.0), strict=False)
        left = zip(
            curve.wind_up[middle::-1], np.diff(slopes[:middle][::-1], prepend=0.0), strict=False
        )
        return [
            *((-math.inf, high + offset, float(more)) for offset, more in right),
            *((low + offset, math.inf, float(more)) for offset, more in left),
        ]

    def preloaded(self, torque: float) -> Self:
        """Copy the gear with a preload of this magnitude, N·m; 0 leaves it unchanged."""
        if not torque:
            return self
        return replace(self, interference=Preload.from_torque(self.loop, torque).interference)

    def worn(self, angle: float) -> Self:
        """Copy the gear with flanks worn by a total angle of the output, rad."""
        return replace(self, interference=self.interference - angle, play=self.play + angle)

    def error(self, rotor_angle: float) -> float:
        """Compute the deviation of the output angle, rad."""
        deviation = 0.0
        for cycles, cos, sin in self._waves:
            phase = cycles * rotor_angle
            deviation += cos * math.cos(phase) + sin * math.sin(phase)
        return deviation

    def _braced_bands(self, torque: float) -> tuple[tuple[float, float], ...]:
        low_b = torque / self.stiffness[1] + min(0.5 * self.interference, 0.0)
        high_a = low_b - self.interference
        bands = (high_a - self.play, high_a), (low_b, low_b + self.play)
        if self.parameters.preload < 0.0:
            return tuple((-high, -low) for low, high in bands)
        return bands
