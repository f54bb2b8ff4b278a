# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The loads at samples of the rotor, their messages, and the diagnostics of the preload.

The torque of the output is i × (rotor effort - τ2 of the inertias alone), lossless. If the bodies
have mass, velocity and acceleration count: the acceleration is the difference of the rotor's
velocities over at least 20 ms, which lags by half of that.
"""

import math
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from types import ModuleType
from typing import Any, NamedTuple

import numpy as np

from gear_kinematics.kinematics import RotorSample
from gear_kinematics.kinematics.loads import AT_REST, BranchLoads, Inertia, LoadEquations
from gear_kinematics.kinematics.motion import BranchPosition, closed_form
from gear_kinematics.kinematics.preload import Pair
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.state.rotor_samples import RotorSamples
from gear_kinematics.state.rotor_samples import Row as SampleRow
from gear_kinematics.state.state_messages import Row
from gear_kinematics.state.statuses import Condition, GearReport
from gear_kinematics.wire.batches import Array, encode
from gear_kinematics.wire.cdr import SECOND, JointStateTemplate, Template, WrenchesTemplate
from gear_kinematics.wire.topics import BRANCH_LOADS, JOINT_LOADS

_WINDOW = 20_000_000  # ns. A velocity in steps of 0.01 rad/s gives steps of 0.5 rad/s².
_LONGEST = 100_000_000  # ns, beyond which a mean is no acceleration of the moment
_JOINTS = 'mesh', 'cam', 'slot_satellite', 'slot_arm'  # of each branch


class SampleLoads(NamedTuple):
    """The loads at a sample, or at n of them, as floats or arrays (n,)."""

    torque: Any  # Σ T, N·m, of the branches on the output shaft; NaN if unknown
    torques: Sequence[Any]  # N·m, of the branches; see `TorqueSharing`
    stand_offs: Sequence[Any]  # rad, of the branches
    equations: LoadEquations  # with the bodies' positions and inertias, of the forces
    positions: Sequence[BranchPosition]
    inertias: Sequence[Inertia]

    @property
    def branches(self) -> Sequence[BranchLoads]:
        """The forces and couples, which BRANCH_LOADS and the margin do without."""
        return self.equations.branches(self.positions, self.torques, self.inertias)


class LoadEstimator:
    """Computes and encodes the loads of a mechanism."""

    def __init__(self, parameters: NodeParameters) -> None:
        """Take preload and bodies from the parameters; raises MechanismError without them."""
        mechanism = parameters.mechanism
        self.sharing = parameters.sharing
        self._ratio = mechanism.gear_ratio
        self._torque_ratio = float(mechanism.gear_ratio)
        self._form = closed_form(mechanism)
        self._equations = LoadEquations(mechanism, parameters.loads)
        self._at_rest = [AT_REST] * len(mechanism.branches)
        self._acceleration = None if parameters.loads.without_mass else Acceleration()
        self.needed = 'effort or acceleration' if self._acceleration else 'effort'
        """What a sample needs for loads to be known, in words."""
        prefix, names = parameters.frame_prefix, [each.name for each in mechanism.branches]
        branches = [f'{prefix}branch_{name}' for name in names]
        joints = [f'{prefix}{kind}_{name}' for name in names for kind in _JOINTS]
        self.templates: Mapping[str, Template] = {
            BRANCH_LOADS: JointStateTemplate(branches, velocity=False, effort=True),
            JOINT_LOADS: WrenchesTemplate(f'{prefix}stator', joints),
        }
        """Templates of the messages, by topic."""

    def follow(self, sample: RotorSample, segment: int) -> SampleLoads:
        """Return the loads at the next sample."""
        stamp, (turns, angle), velocity, effort = sample
        velocity = math.nan if velocity is None else velocity
        effort = math.nan if effort is None else effort
        acceleration = 0.0
        if self._acceleration:
            acceleration = self._acceleration.follow(stamp, velocity, segment)
        return self.at(turns, angle, effort, (velocity, acceleration), math)

    @np.errstate(invalid='ignore', over='ignore')
    def follow_batch(self, samples: RotorSamples) -> SampleLoads:
        """Return the loads at the next samples, as `follow` does one by one."""
        acceleration = self.accelerations(samples.stamp, samples.velocity, samples.segment)
        motion = samples.velocity, acceleration
        return self.at(samples.turns, samples.angle, samples.effort, motion)

    def accelerations(self, stamps: Array, velocities: Array, segments: Array) -> Array:
        """Return the accelerations that the loads need at the next samples, rad/s², (n,), or 0."""
        if not self._acceleration:
            return np.zeros(len(stamps))
        samples = zip(stamps.tolist(), velocities.tolist(), segments.tolist(), strict=True)
        return np.array([self._acceleration.follow(*sample) for sample in samples])

    def at(
        self, turns: Any, angle: Any, effort: Any, motion: Pair, xp: ModuleType = np
    ) -> SampleLoads:
        """Return the loads at a rotor angle of 2π turns + angle, rad; arrays, or floats by `math`.

        The effort is that of the rotor, N·m, NaN if unknown. The motion, its velocity and
        acceleration, counts if the bodies have mass.
        """
        torque, inertias = self._torque_ratio * effort, self._at_rest
        _, rest = self._ratio.output_angle(turns, angle, xp)
        positions, equations = self._form.branches(angle, rest, xp), self._equations
        if self._acceleration:
            arm, acceleration = (-xp.sin(rest), xp.cos(rest)), self._ratio.output_rate(motion[1])
            rates = self._form.rates(positions, *motion)
            inertias = [
                equations.inertia(position, arm, acceleration, a3, a4)
                for position, (*_, a3, a4) in zip(positions, rates, strict=True)
            ]
            idle = equations.rotor_torque((share for *_, share in inertias), acceleration)
            torque = self._torque_ratio * (effort - idle)
        torques, stand_offs = self.sharing.branches(torque)
        return SampleLoads(torque, torques, stand_offs, equations, positions, inertias)

    def rows(self, loads: SampleLoads, topics: Iterable[str]) -> Iterator[Row]:
        """Yield what the messages at a sample are encoded of; none if its loads are unknown."""
        if math.isfinite(loads.torque):
            for topic in topics:
                yield topic, self.templates[topic], NUMBERS[topic](loads)

    @np.errstate(invalid='ignore', over='ignore')
    def encode_batch(self, stamps: Array, loads: SampleLoads) -> dict[str, list[bytes]]:
        """Encode all LOAD_TOPICS at n samples, b'' where the loads are unknown."""
        known = np.isfinite(loads.torque).tolist()
        found = {}
        for topic, template in self.templates.items():
            messages = encode(template, stamps, NUMBERS[topic](loads))
            found[topic] = [data * there for data, there in zip(messages, known, strict=True)]
        return found


def _wrenches(loads: SampleLoads) -> list[Any]:
    """Return force x, y and couple z of each joint."""
    numbers: list[Any] = []
    for _, mesh, cam, satellite_slot, arm_slot, C3, C5 in loads.branches:
        numbers += *mesh, 0.0, *cam, 0.0, *satellite_slot, C3, *arm_slot, C5
    return numbers


NUMBERS: Mapping[str, Callable[[SampleLoads], Sequence[Any]]] = {
    BRANCH_LOADS: lambda loads: (*loads.stand_offs, *loads.torques),
    JOINT_LOADS: _wrenches,
}
"""The numbers of the messages, floats or arrays, by topic."""


class Acceleration:
    """The acceleration from velocities, rad/s²: their difference over at least 20 ms.

    It is NaN where the velocity is unknown, in the first 20 ms of a segment, and across a gap that
    makes it the mean of more than 0.1 s.
    """

    def __init__(self) -> None:
        self._velocities: deque[tuple[int, float]] = deque()
        self._segment = -1

    def follow(self, stamp: int, velocity: float, segment: int) -> float:
        """Return the acceleration at the next sample: stamp, ns, and velocity, rad/s."""
        velocities = self._velocities
        if segment != self._segment:
            self._segment = segment
            velocities.clear()
        velocities.append((stamp, velocity))
        while len(velocities) > 1 and stamp - velocities[1][0] >= _WINDOW:
            velocities.popleft()
        then, before = velocities[0]
        span = stamp - then
        if not _WINDOW <= span <= _LONGEST:
            return math.nan
        return (velocity - before) * SECOND / span


class PreloadMonitor:
    """Reports whether both branches stayed in mesh: the margin is less than 0 while one is out."""

    def __init__(self, parameters: NodeParameters) -> None:
        self._loads, self._preload = LoadEstimator(parameters), abs(parameters.preload)
        self._rows = list[SampleRow]()

    def follow(self, sample: RotorSample, segment: int) -> None:
        """Take the next sample and the number of its segment; only the report uses them."""
        self._rows.append((sample, 0, 0, segment, True))

    def report(self) -> GearReport:
        """Report on the time since the last report."""
        samples = RotorSamples.of(self._rows)
        self._rows.clear()
        torques = self._loads.follow_batch(samples).torque
        known = np.isfinite(torques)
        if not known.any():
            return GearReport([Condition.MARGIN_UNKNOWN(lacking=self._loads.needed)], {})
        margins, stamps = self._loads.sharing.margin(torques[known]), samples.stamp[known]
        least = float(margins.min())
        steps = np.diff(stamps, prepend=stamps[0]).clip(1, SECOND)
        share = 100.0 * float(np.average(margins <= 0.0, weights=steps))
        values = {'preload (N·m)': self._preload}
        for name, margin in (('margin', float(margins[-1])), ('least margin', least)):
            values[f'{name} (N·m)'] = margin
            values[f'{name} (% of the preload)'] = 100.0 * margin / self._preload
        values['out of mesh (% of the time)'] = share
        return GearReport([Condition.OUT_OF_MESH(share=share)] if least <= 0.0 else [], values)
