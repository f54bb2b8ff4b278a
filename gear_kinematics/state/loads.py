# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The loads at a sample of the rotor, and their messages `branch_loads` and `joint_loads`.

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

from gear_kinematics.kinematics import Mechanism, RotorSample
from gear_kinematics.kinematics.loads import BranchLoads, LoadEquations, Pair
from gear_kinematics.kinematics.motion import closed_form
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.state.rotor_input import RotorSamples
from gear_kinematics.wire.batches import Array, encode
from gear_kinematics.wire.cdr import SECOND, JointStateTemplate, WrenchesTemplate
from gear_kinematics.wire.topics import BRANCH_LOADS, JOINT_LOADS, LOAD_TOPICS

_WINDOW = 20_000_000  # ns. A velocity in steps of 0.01 rad/s gives steps of 0.5 rad/s².
_LONGEST = 100_000_000  # ns, beyond which a mean is no acceleration of the moment


def load_joints(mechanism: Mechanism) -> dict[str, list[str]]:
    """The joints in each of LOAD_TOPICS, without a prefix."""
    kinds = {BRANCH_LOADS: ('branch',), JOINT_LOADS: ('mesh', 'cam', 'slot_satellite', 'slot_arm')}
    names = [branch.name for branch in mechanism.branches]
    return {
        topic: [f'{kind}_{name}' for kind in each for name in names]
        for topic, each in kinds.items()
    }


class SampleLoads(NamedTuple):
    """The loads at a sample, or at n of them, as floats or arrays (n,)."""

    torque: Any
    """Σ T, N·m, of the branches on the output shaft; NaN if unknown."""
    shares: Sequence[Pair] = ()
    """Torque, N·m, and stand-off, rad, of each branch; see `TorqueSharing`."""
    branches: Sequence[BranchLoads] = ()


class Loads:
    """Computes and encodes the loads of a mechanism."""

    def __init__(self, parameters: NodeParameters) -> None:
        """Take the preload and the bodies from the parameters.

        Raises:
            MechanismError: if they describe no mechanism or no preload.
        """
        mechanism = parameters.mechanism
        self.sharing = parameters.sharing
        self._ratio = mechanism.gear_ratio
        self._torque_ratio = float(mechanism.gear_ratio)
        self._form = closed_form(mechanism)
        self._equations = LoadEquations(mechanism, parameters.loads)
        self._acceleration = None if parameters.loads.without_mass else Acceleration()
        prefix = parameters.frame_prefix
        names = {
            topic: [prefix + name for name in joints]
            for topic, joints in load_joints(mechanism).items()
        }
        self._templates = {
            BRANCH_LOADS: JointStateTemplate(names[BRANCH_LOADS], velocity=False, effort=True),
            JOINT_LOADS: WrenchesTemplate(f'{prefix}stator', names[JOINT_LOADS]),
        }

    @property
    def needs_motion(self) -> bool:
        """Whether the loads depend on velocity and acceleration."""
        return self._acceleration is not None

    def follow(self, sample: RotorSample, segment: int, *, whole: bool = True) -> SampleLoads:
        """Return the loads at the next sample, or only the torque of the output."""
        acceleration = velocity = 0.0
        if self._acceleration:
            velocity = math.nan if sample.velocity is None else sample.velocity
            acceleration = self._acceleration.follow(sample.stamp, velocity, segment)
        effort = math.nan if sample.effort is None else sample.effort
        motion = velocity, acceleration
        return self.at(*sample.position, effort, motion, math, whole=whole)

    @np.errstate(invalid='ignore', over='ignore')
    def follow_batch(self, samples: RotorSamples) -> SampleLoads:
        """Return the loads at the next samples, as `follow` does one by one."""
        acceleration = self.accelerations(samples.stamp, samples.velocity, samples.segment)
        motion = samples.velocity, acceleration
        return self.at(samples.turns, samples.angle, samples.effort, motion)

    def accelerations(self, stamps: Array, velocities: Array, segments: Array) -> Array:
        """The accelerations that the loads need at the next samples, rad/s², (n,); 0 if none."""
        if self._acceleration:
            return self._acceleration.follow_batch(stamps, velocities, segments)
        return np.zeros(len(stamps))

    def at(
        self,
        turns: Any,
        angle: Any,
        effort: Any,
        motion: Pair,
        xp: ModuleType = np,
        *,
        whole: bool = True,
    ) -> SampleLoads:
        """Return the loads where the rotor is at 2π turns + angle, as floats or arrays.

        Args:
            turns: whole turns of the rotor.
            angle: rad.
            effort: of the rotor, N·m; NaN if unknown.
            motion: velocity and acceleration of the rotor, which count if the bodies have mass.
            xp: `math` for floats.
            whole: whether more than the torque of the output is wanted.
        """
        torque = self._torque_ratio * effort
        branches: list[BranchLoads] = []
        if not (whole or self._acceleration):
            return SampleLoads(torque)
        _, rest = self._ratio.output_angle(turns, angle, xp)
        positions = self._form.branches(angle, rest, xp)
        arm, branch = (-xp.sin(rest), xp.cos(rest)), self._equations.branch
        if not self._acceleration:
            shares = self.sharing.branches(torque, xp)
            for position, (T, _) in zip(positions, shares, strict=True):
                branches.append(branch(position, arm, T))
            return SampleLoads(torque, shares, branches)
        output_acceleration = self._ratio.output_rate(motion[1])
        moved = [
            (
                position,
                output_acceleration,
                rates.satellite_acceleration,
                rates.oldham_acceleration,
            )
            for position, rates in zip(
                positions, self._form.rates(positions, *motion), strict=True
            )
        ]
        idle = [branch(position, arm, 0.0, *rates) for position, *rates in moved]
        torque = self._torque_ratio * (
            effort - self._equations.rotor_torque(idle, output_acceleration)
        )
        if not whole:
            return SampleLoads(torque)
        shares = self.sharing.branches(torque, xp)
        for (position, *rates), (T, _) in zip(moved, shares, strict=True):
            branches.append(branch(position, arm, T, *rates))
        return SampleLoads(torque, shares, branches)

    def encode(
        self, stamp: int, loads: SampleLoads, topics: Iterable[str] = LOAD_TOPICS
    ) -> Iterator[tuple[str, bytes]]:
        """Yield topic and message at a sample; none if its loads are unknown."""
        if math.isfinite(loads.torque):
            for topic in topics:
                yield topic, self._templates[topic].encode(stamp, *NUMBERS[topic](loads))

    def encode_batch(self, stamps: Array, loads: SampleLoads) -> dict[str, list[bytes]]:
        """Encode all LOAD_TOPICS at n samples, b'' where the loads are unknown."""
        known = np.isfinite(loads.torque).tolist()
        found = {}
        for topic, template in self._templates.items():
            messages = encode(template, stamps, *NUMBERS[topic](loads))
            found[topic] = [data * there for data, there in zip(messages, known, strict=True)]
        return found


def _torques(loads: SampleLoads) -> tuple[Sequence[Any], ...]:
    """The arrays of branch_loads: positions and efforts of the branches, floats or arrays."""
    torques, stand_off = zip(*loads.shares, strict=True)
    return stand_off, torques


def _wrenches(loads: SampleLoads) -> tuple[list[Any]]:
    """The array of joint_loads, of floats or arrays: for each joint force and couple, x y z."""
    meshes: list[Any] = []
    cams: list[Any] = []
    satellite_slots: list[Any] = []
    arm_slots: list[Any] = []
    for _, (mx, my), (cx, cy), (sx, sy), (ax, ay), C3, C5, _ in loads.branches:
        meshes += mx, my, 0.0, 0.0, 0.0, 0.0
        cams += cx, cy, 0.0, 0.0, 0.0, 0.0
        satellite_slots += sx, sy, 0.0, 0.0, 0.0, C3
        arm_slots += ax, ay, 0.0, 0.0, 0.0, C5
    return (meshes + cams + satellite_slots + arm_slots,)


NUMBERS: Mapping[str, Callable[[SampleLoads], tuple[Sequence[Any], ...]]] = {
    BRANCH_LOADS: _torques,
    JOINT_LOADS: _wrenches,
}
"""The numbers of each array of the messages, by topic."""


class Acceleration:
    """The acceleration from velocities, rad/s²: their difference over at least 20 ms.

    NaN where the velocity is unknown, in the first 20 ms of a segment, and across a gap that makes
    it the mean of more than 0.1 s.
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

    def follow_batch(self, stamps: Array, velocities: Array, segments: Array) -> Array:
        """Return the accelerations at the next samples, (n,), as `follow` does one by one."""
        found = np.full(len(stamps), np.nan)
        borders = np.flatnonzero(np.diff(segments)) + 1
        for rows in np.split(np.arange(len(stamps)), borders):
            if not len(rows):
                continue
            if segments[rows[0]] != self._segment:
                self._segment = int(segments[rows[0]])
                self._velocities.clear()
            earlier = len(self._velocities)
            kept = np.array(self._velocities, 'i8, f8')
            time = np.concatenate([kept['f0'], stamps[rows]])
            speed = np.concatenate([kept['f1'], velocities[rows]])
            then = np.searchsorted(time, time - _WINDOW, side='right') - 1
            span = time - time[then]
            change = (speed - speed[then]) * SECOND / np.maximum(span, 1)
            known = (then >= 0) & (span <= _LONGEST)
            found[rows] = np.where(known, change, np.nan)[earlier:]
            first = max(int(then[-1]), 0)
            pairs = zip(time[first:].tolist(), speed[first:].tolist(), strict=True)
            self._velocities = deque(pairs)
        return found
