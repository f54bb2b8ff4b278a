# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The loads at the samples of a recording, and their statistics."""

import math
from collections.abc import Iterable, Iterator, Mapping
from contextlib import ExitStack
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path
from typing import NamedTuple

import numpy as np

from gear_kinematics.bag import BagError, ReportProgress, TopicMessages
from gear_kinematics.bag.roles import find_rotor_topic, only_joint
from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.measurement.columns import Sources
from gear_kinematics.measurement.formats import is_table, open_bag
from gear_kinematics.measurement.tables import read_rotor
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.state.effort_field import questioned
from gear_kinematics.state.gear_state import GearState
from gear_kinematics.state.loads import LoadEstimator
from gear_kinematics.state.statuses import Fact
from gear_kinematics.wire.batches import Array, encode
from gear_kinematics.wire.cdr import SECOND, JointStateTemplate

ANGLE_BINS = 72  # bins of a turn of the rotor, of 5° each
_JOINTS = 'mesh', 'cam', 'slot'
_BEARING_EXPONENT = 3.0  # of ball bearings, ISO 281:2007, 4; roller bearings last longer
_STEPS = 64  # levels of the range of a force; cycles within a level are not counted
_LONGEST_STEP = SECOND  # ns, greatest duration of a sample
_UNKNOWN, _STEPS_APART = SECOND // 10, 3
"""Between known loads further apart, ns and usual steps, a branch can have been out of mesh."""


@dataclass(frozen=True, slots=True)
class LoadTask:
    """A recording, and options for the report on its loads."""

    bag: Path
    parameters: NodeParameters
    rotor_topic: str | None = None
    only_joint: bool = True  # whether a topic's only joint is taken, whatever its name
    cam_rating: float = math.nan  # C, N: dynamic load rating of a cam's bearing, for its life
    slot_friction: float = math.nan  # μ of the slots, for their loss
    by_default: bool = False  # whether the parameters are those of the installed default file
    sources: Sources | None = None  # columns of a table that the user names
    debug: bool = False  # whether to print tracebacks of unexpected errors to stderr


class Moment(NamedTuple):
    """An interval in which a branch was out of mesh."""

    start: float  # s, since the first sample
    duration: float  # s, until the first sample in mesh
    branch: str
    least_margin: float  # N·m, less than 0
    stamp: int  # stamp of the first sample, ns


class Force(NamedTuple):
    """A force, N, or a couple, N·m, over a recording."""

    name: str  # as in `RecordedLoads.joints`
    unit: str
    greatest: float
    p99_9: float  # percentile 99.9
    mean: float
    cubic_mean: float  # cube root of the mean cube over the rotor's travel; NaN at a standstill
    l10_hours: float  # life of a cam's bearing at the recording's speed and cubic mean, or NaN
    by_rotor_angle: list[tuple[float, float, float]]  # greatest, p99_9, mean in each angle bin
    cycles: list[tuple[float, float]]  # load spectrum of a force: ranges, N, and their counts


@dataclass(frozen=True, eq=False)
class RecordedLoads:
    """The loads at n samples of a recording."""

    parameters: NodeParameters
    stamp: Array
    """(n,), ns."""
    rotor: Array
    """(n,), rad: φ2."""
    torque: Array
    """(n,), N·m: Σ T."""
    joints: Mapping[str, Array]
    """(n,) each, without signs: `output`, the torque, N·m, and for each branch `mesh_<name>` and
    `cam_<name>`, forces, N, and `slot_<name>`, the couple of the satellite's slot, N·m."""
    left_out: Mapping[str, int]
    """Numbers of messages without known loads, by cause."""
    damage: str
    """Damage at which reading ended, if any."""
    taken: str = ''
    """Columns that were read from a table."""
    unknown: tuple[float, float] = 0.0, 0.0
    """Time in which the loads are unknown, and its beginning since the first known sample, s."""

    @cached_property
    def time(self) -> Array:
        """(n,), s, since the first sample."""
        return np.asarray((self.stamp - self.stamp[0]) / SECOND)

    @cached_property
    def margin(self) -> Array:
        """(n,), N·m; NaN without a preload. See `TorqueSharing.margin`."""
        return np.asarray(self.parameters.sharing.margin(self.torque))

    @cached_property
    def travel(self) -> Array:
        """Travel of the rotor up to each sample, (n,), rad."""
        return np.asarray(np.abs(np.diff(self.rotor, prepend=self.rotor[:1])))

    @property
    def question(self) -> Fact | None:
        """Why the efforts can hardly be torques, if so."""
        mechanism = self.parameters.mechanism
        greatest = float(np.max(np.abs(self.torque)))
        return questioned(greatest / float(mechanism.gear_ratio), mechanism)

    @property
    def needed_preload(self) -> float:
        """Least preload that would have kept both branches in mesh, N·m; NaN without a preload."""
        return round(abs(self.parameters.preload) - float(np.min(self.margin)), 12)

    def moments(self) -> Iterator[Moment]:
        """Yield the intervals in which a branch was out of mesh."""
        edges = np.flatnonzero(np.diff(self.margin <= 0.0, prepend=False, append=False))
        lasts = np.diff(self.stamp, append=self.stamp[-1]).clip(0, _LONGEST_STEP)
        for begin, end in edges.reshape(-1, 2).tolist():
            worst = begin + int(np.argmin(self.margin[begin:end]))
            # The branch that pushes in the direction of the torque transmits all of it.
            left = int(self.parameters.preload * self.torque[worst] > 0.0)
            yield Moment(
                float(self.time[begin]),
                float(lasts[begin:end].sum()) / SECOND,
                self.parameters.branches[left].name,
                float(self.margin[worst]),
                int(self.stamp[begin]),
            )

    def forces(self, cam_rating: float) -> Iterator[Force]:
        """Yield what each joint carried.

        With a bearing of the dynamic load rating C, N, the life of a cam is (C/P)^p 10⁶ turns (ISO
        281).
        """
        ratio = float(self.parameters.mechanism.gear_ratio)
        turns = self.travel.sum() / TURN * (1.0 - 1.0 / ratio)  # of the satellite on its cam
        hours = self.time[-1] / 3600.0
        bins = np.minimum(self.rotor % TURN / TURN * ANGLE_BINS, ANGLE_BINS - 1).astype(np.uint8)
        places = [np.flatnonzero(bins == k) for k in range(ANGLE_BINS)]
        for name, values in self.joints.items():
            unit = 'N' if name.startswith(('mesh', 'cam')) else 'N·m'
            rating = cam_rating if name.startswith('cam') else math.nan
            with np.errstate(divide='ignore', invalid='ignore'):  # without travel or load
                cubic_mean = np.cbrt(values**3 @ self.travel / self.travel.sum())
                life = (rating / cubic_mean) ** _BEARING_EXPONENT * 1e6 / turns * hours
            at_angles = [_levels(values[place]) for place in places]
            cycles = spectrum(values) if unit == 'N' else []
            yield Force(name, unit, *_levels(values), cubic_mean, life, at_angles, cycles)

    @np.errstate(divide='ignore', invalid='ignore')  # without any work
    def slot_loss(self, friction: float) -> float:
        """Share of the output's work lost in the slots: μ (4/π)(zk/zs) Σ abs(T)/abs(Σ T).

        Each couple T acts as two forces at a distance of 2 rs. Both slides have the amplitude e,
        so that the sum of their speeds is (4/π) e (zk/zs) φ2' on average. The friction is μ.
        """
        mechanism = self.parameters.mechanism
        torques, _ = self.parameters.sharing.branches(self.torque)
        couples = sum(map(abs, torques))
        teeth = mechanism.ring_teeth / mechanism.satellite_teeth
        given, taken = abs(self.torque) @ self.travel, couples @ self.travel
        return float(friction * 4.0 / math.pi * teeth * taken / given)


def read_loads(task: LoadTask, progress: ReportProgress | None = None) -> RecordedLoads:
    """Read a recording, up to any damage, and compute its loads.

    Raises:
        BagError, RecordingError: if it cannot be read, or never contains what the loads need.
        MechanismError: if the parameters describe no mechanism or no preload.
    """
    parameters, damage, taken = task.parameters, '', ''
    batches: Iterable[TopicMessages]
    stamps: list[Array] = []
    tables: list[Array] = []
    every: list[Array] = []
    with ExitStack() as opened:
        if is_table(task.bag):
            topic, (table, taken) = task.bag.name, _of_table(task)
            batches = [table]
        else:
            bag = opened.enter_context(open_bag(task.bag))
            topic = find_rotor_topic(bag, task.rotor_topic, parameters.rotor_joint)
            if task.only_joint:
                joint = only_joint(bag, topic, parameters.rotor_joint)
                parameters = replace(parameters, rotor_joint=joint)
            batches = (batch[topic] for batch in bag.by_topic([topic], progress))
        gear, loads = GearState(parameters), LoadEstimator(parameters)
        try:
            for messages in batches:
                samples = gear.input.accept_batch(messages.data, messages.received)
                found = loads.follow_batch(samples)
                rows = [TURN * samples.turns + samples.angle, found.torque]
                for _, mesh, cam, _, _, couple, _ in found.branches:
                    rows += np.hypot(*mesh), np.hypot(*cam), np.abs(couple)
                known = np.isfinite(found.torque)
                every.append(samples.stamp)
                stamps.append(samples.stamp[known])
                tables.append(np.stack(rows)[:, known])
                if unknown := np.count_nonzero(~known):
                    gear.input.rejected[f'{loads.needed} missing'] += int(unknown)
        except BagError as error:  # what was read before is used
            damage = str(error)
    if gear.input.effort_field.absent:
        absent = f'the effort on {topic} is 0 throughout the motion, and is taken as absent'
        damage = damage or f'{task.bag}: {absent}'
        stamps.clear()
    if not any(map(len, stamps)):
        why = gear.input.why_rejected or 'no messages'
        raise BagError(damage or f'{task.bag}: the loads on {topic} are unknown: {why}')
    angle, torque, *forces = np.concatenate(tables, axis=1)
    names = [f'{kind}_{each.name}' for each in parameters.branches for kind in _JOINTS]
    joints = {'output': np.abs(torque), **dict(zip(names, forces, strict=True))}
    stamp = np.concatenate(stamps)
    return RecordedLoads(
        parameters,
        stamp,
        angle,
        torque,
        joints,
        dict(gear.input.rejected),
        damage,
        taken,
        _unknown(stamp, np.concatenate(every)),
    )


def _unknown(known: Array, every: Array) -> tuple[float, float]:
    """Return `RecordedLoads.unknown` by the stamps of known loads and of all samples, ns."""
    ends = np.concatenate([every[:1], known, every[-1:]])
    steps = np.diff(ends)
    apart = steps > max(_UNKNOWN, _STEPS_APART * float(np.median(steps)))
    total, begins = steps[apart].sum(), ends[:-1][apart]
    return float(total) / SECOND, float((begins[:1] - known[0]).sum()) / SECOND


def _of_table(task: LoadTask) -> tuple[TopicMessages, str]:
    """Return the rows of a table as messages of a driver, and the columns that were read."""
    parameters, sources = task.parameters, task.sources or Sources()
    stamp, angle, torque, taken = read_rotor(task.bag, sources, parameters.gear.gear_ratio)
    stamp = stamp + max(0, SECOND - int(stamp[0]))  # a stamp of 0 would be a missing one
    template = JointStateTemplate([parameters.rotor_joint], velocity=False, effort=True)
    messages = TopicMessages(encode(template, stamp, [angle, torque]), stamp.tolist())
    return messages, f'{task.bag.name}: {taken}'


def _levels(values: Array) -> tuple[float, float, float]:
    """Return the greatest value, the percentile 99.9 and the mean."""
    if not len(values):
        return np.nan, np.nan, np.nan
    return float(values.max()), float(np.percentile(values, 99.9)), float(values.mean())


def spectrum(values: Array) -> list[tuple[float, float]]:
    """Count the cycles of a load, (n,), in 64 levels by rainflow (ASTM E1049-85, 5.4.4).

    Returns the ranges of cycles, the largest first, with their counts.
    """
    import rainflow  # noqa: PLC0415, of an extra

    step = float(np.ptp(values)) / _STEPS or 1.0
    levels = np.round((values - values.min()) / step).astype(int)
    changes = levels[np.flatnonzero(np.diff(levels, prepend=-1))]
    counts = rainflow.count_cycles(changes.tolist())
    return [(size * step, count) for size, count in reversed(counts) if size]
