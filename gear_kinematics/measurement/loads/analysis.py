# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The loads over a recording: the margin of the preload, and the force at every joint."""

from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from gear_kinematics.bag import Bag, BagError, ReportProgress, fleet
from gear_kinematics.bag.errors import unexpected
from gear_kinematics.bag.roles import find_rotor_topic, only_joint
from gear_kinematics.kinematics.motion import closed_form
from gear_kinematics.kinematics.rotor_turns import TURN, split_turns
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.state.loads import Loads
from gear_kinematics.state.rotor_input import RotorInput
from gear_kinematics.wire.cdr import SECOND

Array = NDArray[Any]

BEARING_EXPONENT = 3.0
"""p of ball bearings, ISO 281:2007, 4; roller bearings have 10/3, and live longer than said."""
ANGLE_BINS = 72
"""Of a turn of the rotor: 5° each."""
_KINDS = 'mesh', 'cam', 'slot'
UNKNOWN = 'loads unknown'
"""Cause of messages without an effort or an acceleration."""
_LEVELS = 64  # of the range of a force, below a step of which a cycle is not counted
_LONGEST_STEP = SECOND  # ns, of a sample without a next one to show how long it lasted


class Moment(NamedTuple):
    """A time in which a branch was out of mesh."""

    start: float
    """s, since the first sample."""
    duration: float
    """s; that of a single sample lasts until the next one."""
    branch: str
    least_margin: float
    """N·m, less than 0."""
    stamp: int
    """Of the first sample, ns."""
    sample: int
    """Its number."""


@dataclass(frozen=True, eq=False, slots=True)
class Force:
    """A force, N, or a couple, N·m, over a recording."""

    name: str
    """Of the joint, as in joint_loads."""
    unit: str
    greatest: float
    often: float
    """99.9 % of the samples are below."""
    mean: float
    cubic_mean: float
    """The cube root of the mean cube over the rotor's travel; NaN at a standstill."""
    by_angle: Array
    """(ANGLE_BINS,): the greatest at each angle of the rotor; NaN where it never was."""
    cycles: tuple[tuple[float, float], ...]
    """The load spectrum: ranges of the cycles, and how often they occurred, by rainflow."""


@dataclass(frozen=True, eq=False, slots=True)
class LoadHistory:
    """The loads over a recording."""

    name: str
    parameters: NodeParameters
    time: Array
    """(n,), s, since the first sample."""
    rotor: Array
    """(n,), rad: φ2."""
    margin: Array
    """(n,), N·m; NaN without a preload. See `TorqueSharing.margin`."""
    torque: Array
    """(n,), N·m: Σ T."""
    moments: tuple[Moment, ...]
    forces: tuple[Force, ...]
    turns: float
    """Of satellites on their cams, to and fro."""
    slot_friction: float | None
    """μ of the slots."""
    slot_loss: float | None
    """Share of the output's work that it takes."""
    left_out: dict[str, int]
    """Messages without known loads, by cause."""

    @property
    def duration(self) -> float:
        """s."""
        return float(self.time[-1] - self.time[0])

    @property
    def needed(self) -> float:
        """The least preload, N·m, with which both branches would have been in mesh."""
        return abs(self.parameters.preload) - self.least_margin

    @property
    def least_margin(self) -> float:
        """N·m."""
        return float(np.min(self.margin))

    @property
    def greatest_torque(self) -> float:
        """N·m, of the output in either direction."""
        return float(np.max(np.abs(self.torque)))

    @property
    def lost(self) -> float:
        """How long a branch was out of mesh, s."""
        return sum(moment.duration for moment in self.moments)

    def life(self, rating: float, force: Force) -> float:
        """L10 = (C/P)^p 10⁶ turns of the bearing of a cam (ISO 281), in h of this recording.

        Args:
            rating: C, N, the basic dynamic load rating.
            force: at the bearing.
        """
        turns = 1e6 * float((rating / force.cubic_mean) ** BEARING_EXPONENT)
        return turns / self.turns * self.duration / 3600.0


@dataclass(frozen=True, slots=True)
class Task:
    """A recording, and how to compute its loads."""

    path: Path
    parameters: NodeParameters
    rotor_topic: str | None = None
    any_joint: bool = True
    """Whether the only joint of the rotor's topic is taken, whatever it is called."""
    slot_friction: float | None = None
    """μ of the slots."""
    debug: bool = False
    """Whether to print tracebacks of unexpected errors to stderr."""


def _history(
    name: str, loads: Loads, task: Task, table: Array, start: int, left_out: dict[str, int]
) -> LoadHistory:
    """Make it of stamps since the start, rotor angles, torques, and the forces of `_joints`."""
    parameters, (stamp, rotor, torque, *forces) = task.parameters, table
    travel, margin = np.abs(np.diff(rotor, prepend=rotor[:1])), loads.sharing.margin(torque)
    ratio = float(parameters.mechanism.gear_ratio)
    found = tuple(map(partial(_force, rotor, travel), _joints(parameters), forces))
    return LoadHistory(
        name,
        parameters,
        stamp / SECOND,
        rotor,
        margin,
        torque,
        tuple(_moments(stamp, start, margin, torque, parameters)),
        found,
        float(travel.sum()) / TURN * (1.0 - 1.0 / ratio),
        task.slot_friction,
        _slot_loss(task, rotor, torque, forces[2::3]) if task.slot_friction else None,
        left_out,
    )


def _joints(parameters: NodeParameters) -> list[str]:
    return [f'{kind}_{each.name}' for each in parameters.branches for kind in _KINDS]


def _slot_loss(task: Task, rotor: Array, torque: Array, couples: Sequence[Array]) -> float:
    """μ Σ (2 |C|/w) (|dx| + |dy|) of both slots, as pairs of forces at a distance w = 2 rs."""
    mechanism = task.parameters.mechanism
    form, width = closed_form(mechanism), 2.0 * mechanism.satellite_rolling_radius
    turns, angle = split_turns(rotor)
    _, output = mechanism.gear_ratio.output_angle(turns, angle, np)
    travel, lost = np.diff(rotor, prepend=rotor[:1]), 0.0
    for position, couple in zip(form.branches(angle, output, np), couples, strict=True):
        along = np.abs(form.slide_velocities(position, travel)).sum(axis=0)
        lost += float((task.slot_friction or 0.0) * (2.0 * couple / width) @ along)
    return lost / float(np.abs(torque) @ np.abs(mechanism.gear_ratio.output_rate(travel)))


def _moments(
    stamp: Array, start: int, margin: Array, torque: Array, parameters: NodeParameters
) -> Iterator[Moment]:
    edges = np.diff((margin <= 0.0).astype(np.int8), prepend=0, append=0)
    begins, ends = (np.flatnonzero(edges == sign).tolist() for sign in (1, -1))
    lasts = np.minimum(np.diff(stamp, append=stamp[-1]), _LONGEST_STEP).clip(0)
    for begin, end in zip(begins, ends, strict=True):
        worst = begin + int(np.argmin(margin[begin:end]))
        # The branch that pushes in the direction of the torque gives all of it.
        left = parameters.branches[int(parameters.preload * torque[worst] > 0.0)]
        yield Moment(
            stamp[begin] / SECOND,
            lasts[begin:end].sum() / SECOND,
            left.name,
            float(margin[worst]),
            start + int(stamp[begin]),
            begin,
        )


def _force(angle: Array, travel: Array, name: str, values: Array) -> Force:
    weight = float(travel.sum())
    cubic = float(np.sum(values**3 * travel) / weight) ** (1.0 / 3.0) if weight else np.nan
    bins = np.minimum(((angle % TURN) / TURN * ANGLE_BINS).astype(int), ANGLE_BINS - 1)
    by_angle = np.full(ANGLE_BINS, np.nan)
    np.fmax.at(by_angle, bins, values)
    return Force(
        name,
        'N·m' if name.startswith('slot') else 'N',
        float(values.max()),
        float(np.percentile(values, 99.9)),
        float(values.mean()),
        cubic,
        by_angle,
        () if name.startswith('slot') else spectrum(values),
    )


def spectrum(values: Array) -> tuple[tuple[float, float], ...]:
    """Count the cycles of a load by rainflow (ASTM E1049-85, 5.4.4).

    Args:
        values: (n,), of which only 64 levels are told apart.

    Returns:
        Ranges in the unit of the values, the largest first, with their counts.
    """
    import rainflow  # noqa: PLC0415, of an extra

    low, span = float(values.min()), float(np.ptp(values))
    if not span:
        return ()
    levels = np.round((values - low) / span * _LEVELS).astype(int)
    changes = levels[np.flatnonzero(np.diff(levels, prepend=-1))]
    counted = Counter[int]()
    for size, _, count, *_ in rainflow.extract_cycles(changes.tolist()):
        counted[size] += count
    found = sorted(counted.items(), reverse=True)
    return tuple((size * span / _LEVELS, count) for size, count in found if size)


# Many recordings


class Outcome(NamedTuple):
    """What became of a recording: its loads or an error, and what is damaged in it."""

    history: LoadHistory | None
    error: str = ''


def compute_loads(task: Task, progress: ReportProgress | None = None) -> Outcome:
    """Compute the loads over a recording; any error about it is in the outcome."""
    try:
        with Bag(task.path) as bag:
            return _loads_of(bag, task, progress)
    except (ValueError, OSError) as error:
        cause = str(error)
        return Outcome(None, cause) if str(task.path) in cause else _failed(task, cause)
    except Exception as error:  # noqa: BLE001, the other recordings are worth reporting
        return _failed(task, unexpected(error, debug=task.debug))


def _loads_of(bag: Bag, task: Task, progress: ReportProgress | None) -> Outcome:
    joint = task.parameters.rotor_joint
    topic = find_rotor_topic(bag, task.rotor_topic, joint)
    if task.any_joint:
        joint = only_joint(bag, topic, joint)
    task = replace(task, parameters=replace(task.parameters, rotor_joint=joint))
    rotor, loads, damage = RotorInput(task.parameters), Loads(task.parameters), ''
    tables: list[Array] = []
    start: int | None = None
    try:
        for batch in bag.batches({topic}, progress):
            messages, received = [data for _, _, data in batch], [time for _, time, _ in batch]
            samples = rotor.accept_batch(messages, received)
            if start is None and len(samples.stamp):
                start = int(samples.stamp[0])
            found = loads.follow_batch(samples)
            rows = [
                samples.stamp - (start or 0),
                TURN * samples.turns + samples.angle,
                found.torque,
            ]
            for branch in found.branches:
                rows += np.hypot(*branch.mesh_force), np.hypot(*branch.cam_force)
                rows.append(np.abs(branch.satellite_couple))
            tables.append(np.stack(rows)[:, np.isfinite(found.torque)])
    except BagError as error:  # what could be read counts
        damage = str(error)
    known = sum(table.shape[1] for table in tables)
    unknown = rotor.received - rotor.rejected.total() - known
    if not known:
        raise BagError(f'{bag.path}: {_why_unknown(rotor, unknown, topic)}')
    left_out = dict(rotor.rejected) | ({UNKNOWN: unknown} if unknown else {})
    table = np.concatenate(tables, axis=1)
    return Outcome(_history(bag.path.name, loads, task, table, start or 0, left_out), damage)


def _why_unknown(rotor: RotorInput, unknown: int, topic: str) -> str:
    if unknown:
        missing = 'effort' if rotor.parameters.loads.without_mass else 'effort and velocity'
        return f'the loads need the {missing} of the rotor, which {topic} lacks'
    if rotor.received:
        return (
            f'no valid state of the joint {rotor.parameters.rotor_joint!r}: {rotor.why_rejected}'
        )
    return f'no messages on {topic}'


def _failed(task: Task, cause: str) -> Outcome:
    return Outcome(None, f'{task.path}: {cause}')


WORK = fleet.Work(compute_loads, _failed)
"""For `fleet.on_this_machine`."""
