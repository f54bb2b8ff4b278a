# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""What a simulated actuator is made of.

The branches and the shaft between their arms are springs. Branch k winds up by

    x_k = φ2/i + error(φ2) - ψ_k

with ψ_k the angle of its arm, and gives the arm the torque T_k: none within its dead band, the
play of its flanks, whose place is the preload, and that of its spring beyond it. The output shaft
is the arm of the last branch. Friction acts between the output shaft and the stator.

Two branches are braced by an interference, by which branch A, the shaft and branch B are twisted
together. Without load, the output stands at φ2/i: x_B = 0, and x_A = -T0/ks by the shaft, so that

    high_A = -T0 (1/kA + 1/ks)        low_B = T0/kB        low_B - high_A = interference

All signs are the opposite if branch A pushes the output in the negative direction.
"""

import math
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, Self

from gear_kinematics.correction.calibration_file import Calibration, Order
from gear_kinematics.kinematics import Mechanism, MechanismError
from gear_kinematics.kinematics.preload import braced
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.twin.parameters import NODE, PARAMETERS, own_values

_BRACED = 2  # branches, which have a shaft between their arms


@dataclass(frozen=True, slots=True, kw_only=True)
class TwinGear:
    """A gear to be simulated; angles and torques are those of the output.

    Raises:
        MechanismError: if a branch is rigid, or the rotor has no inertia.
    """

    parameters: NodeParameters
    """Of its mechanism, bodies and encoders."""
    stiffness: tuple[float, ...]
    """N·m/rad, of each branch from its flanks on."""
    shaft_stiffness: float
    """N·m/rad, between both arms; infinite: rigid."""
    interference: float
    """rad: twist of the loop at the arms by the preload; if negative, the play that is left."""
    play: float
    """rad: between the flanks of a branch, at least the play that is left."""
    friction: float = 0.0
    """N·m."""
    errors: tuple[Order, ...] = ()
    """Of the output angle, by the rotor angle."""
    rotor_damping: float = 0.0
    """N·m·s/rad."""
    output_inertia: float
    """kg·m²."""
    ratio: float = field(init=False)
    """i, signed."""
    preload: float = field(init=False)
    """T0, N·m, of two branches; negative if branch A pushes in the negative direction."""
    dead_bands: tuple[tuple[float, float], ...] = field(init=False)
    """Least and greatest x_k without torque, for each branch, rad."""

    def __post_init__(self) -> None:
        """Check the gear, and place its dead bands."""
        faults = []
        if math.inf in self.stiffness:
            faults.append('branch_stiffness must be greater than 0: no simulated branch is rigid')
        if not self.parameters.loads.rotor_inertia:
            faults.append('loads.rotor_inertia must be greater than 0 to be simulated')
        if faults:
            raise MechanismError(faults)
        torque, bands = 0.0, ((-0.5 * self.play, 0.5 * self.play),) * len(self.stiffness)
        if len(self.stiffness) == _BRACED:
            torque = max(self.interference, 0.0) / self._compliance
            bands = self._braced_bands(torque)
        object.__setattr__(self, 'ratio', float(self.parameters.gear.gear_ratio))
        object.__setattr__(self, 'preload', math.copysign(torque, self.parameters.preload))
        object.__setattr__(self, 'dead_bands', bands)

    @classmethod
    def load(cls, config: Path, node: str = NODE, calibration: Path | None = None) -> Self:
        """Read a gear from a parameter file.

        Args:
            config: of ROS, as config/simulated_actuator.yaml.
            node: whose parameters are taken.
            calibration: of the errors; None: the one that the file names, if any.

        Raises:
            ValueError: if a file cannot be used, or the gear cannot be simulated.
        """
        shared = NodeParameters.load(config, node, PARAMETERS)
        return cls.of(shared, own_values(config, node), calibration)

    @classmethod
    def of(
        cls, parameters: NodeParameters, values: dict[str, Any], calibration: Path | None = None
    ) -> Self:
        """Make a gear of valid parameters; `values` are those of `twin.parameters`."""
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
            interference=-values['play'],
            play=values['play'],
            friction=values['friction'],
            errors=Calibration.load(Path(file), gear).orders if file else (),
            rotor_damping=values['rotor_damping'],
            output_inertia=values['output_inertia'],
        )
        if preload:
            braced(parameters.mechanism)
        return made.preloaded(abs(preload))

    @property
    def has_shaft(self) -> bool:
        """Whether a shaft twists between the arms of two branches."""
        return len(self.stiffness) == _BRACED and math.isfinite(self.shaft_stiffness)

    @property
    def shaft_twist(self) -> float:
        """By how much arm A leads the output without load, rad."""
        return self.preload / self.shaft_stiffness

    def branch_torque(self, branch: int, angle: float) -> float:
        """T_k, N·m, of a branch wound up by the angle x_k, rad."""
        low, high = self.dead_bands[branch]
        return self.stiffness[branch] * (max(angle - high, 0.0) + min(angle - low, 0.0))

    def preloaded(self, torque: float) -> Self:
        """The same gear with a preload of this magnitude, N·m; as it is if that is 0."""
        return replace(self, interference=torque * self._compliance) if torque else self

    def worn(self, angle: float) -> Self:
        """The same gear with flanks that wore off by an angle of the output, rad, together."""
        return replace(self, interference=self.interference - angle, play=self.play + angle)

    def error(self, rotor_angle: float) -> float:
        """The deviation of the output angle, rad."""
        deviation = 0.0
        for order in self.errors:
            phase = float(order.cycles) * rotor_angle
            deviation += order.cos * math.cos(phase) + order.sin * math.sin(phase)
        return deviation

    @property
    def _compliance(self) -> float:
        """The twist of branches and shaft by a torque, rad/(N·m)."""
        return sum(1.0 / each for each in (*self.stiffness, self.shaft_stiffness))

    def _braced_bands(self, torque: float) -> tuple[tuple[float, float], ...]:
        low_b = torque / self.stiffness[1] + min(0.5 * self.interference, 0.0)
        high_a = low_b - self.interference
        bands = (high_a - self.play, high_a), (low_b, low_b + self.play)
        if self.parameters.preload < 0.0:
            return tuple((-high, -low) for low, high in bands)
        return bands
