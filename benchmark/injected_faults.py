# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""What the node says of faults that are put into real recordings, and what it calls fine.

    python benchmark/injected_faults.py [--faults 2000] [--shared FOLDER] [--jobs 2] [--json]

A fault of a kind and a size begins at a random moment of a recording; the messages about it go
through the objects with which the node processes its input, and diagnostics are taken once a
second, at a random phase. An output is wrong if its rotor angle differs by more than the bound in
`bounds` from what the recording has. It is called fine if the diagnostics before and after it are
`ok`, and the turns are known. Some faults also go through `gearkin validate`, with the outputs of
the node. Each recording as it is, too, must give no warning. Prints a table in Markdown.
"""

import argparse
import json
import math
import multiprocessing
import os
import sys
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from gear_kinematics.bag import Bag, MessagesByTopic
from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.share import share_directory
from gear_kinematics.state.gear_state import GearState
from gear_kinematics.state.monitors import Connections, DriverFacts
from gear_kinematics.state.reach import FLOOR, STALEST
from gear_kinematics.validation.findings import sentence
from gear_kinematics.validation.task import Task
from gear_kinematics.validation.validator import Validator
from gear_kinematics.wire.batches import decode_joint_states
from gear_kinematics.wire.cdr import JointStateTemplate, Template
from gear_kinematics.wire.joint_reader import RejectedInputError, joints_of
from gear_kinematics.wire.topics import OUTPUT_STATE, ROTOR_STATE

SECOND = 1_000_000_000  # ns
START = 1_700_000_000 * SECOND
BEFORE, AFTER = 1.2, 2.2  # s of a recording, about the begin of a fault
_JUDGED = 25  # of so many faults, one also goes through `gearkin validate`
_SHARED = Path(__file__).resolve().parents[2] / 'shared' / 'data'
"""Further recordings, which are used if they are there."""
_EQUAL = 1e-9  # rad, below which positions differ by rounding alone
_MOVING = 0.5  # rad, that a joint has to move in a recording
_DEFAULT = replace(NodeParameters.load(), rotor_joint='rotor')
_SINGLE = replace(_DEFAULT, rotor_encoder='single_turn')
_DUAL = replace(_DEFAULT, output_encoder_reference='absolute', transmission_error_max_gap=0.01)
_GEARS = {
    'neura_jogging_final_joint1': ('121', 0.003, TURN / 2**24),
    'neura_jogging_joint_mass_joint2': ('121', 0.003, TURN / 2**24),
    'sspg_backlash_sine_vel_2.500tps_2.00s': ('-36/5', 0.011, 1.0),  # its ratio is 1 % off
}
"""Ratio, limit of the transmission error, and rad of a count."""


class Recording(NamedTuple):
    """A motor, as it was recorded."""

    name: str
    parameters: NodeParameters
    stamp: Any
    """ns, (n,), as the other arrays."""
    position: Any
    """rad."""
    velocity: Any
    """rad/s; NaN without."""
    output: Any = None
    """rad, of an encoder at the output."""

    @property
    def speed(self) -> Any:
        """rad/s, from the positions."""
        stamps, first = np.unique(self.stamp, return_index=True)
        slopes = np.gradient(self.position[first], stamps * 1e-9)
        return slopes[np.searchsorted(stamps, self.stamp)]

    @property
    def finest(self) -> Any:
        """rad: the resolution that is known before each reading; at first, of Hall sensors."""
        steps = np.diff(self.position, prepend=self.position[0])
        sizes = np.abs([steps, np.diff(steps, prepend=0.0)])
        sizes = np.where(sizes > _EQUAL, sizes, TURN / 6.0).min(axis=0)
        finest = np.minimum.accumulate(sizes)
        return np.append(TURN / 6.0, finest[:-1])

    @property
    def since_moved(self) -> Any:
        """s: for how long each reading but the last has been repeated."""
        moved = np.append(True, np.diff(self.position) != 0.0)
        since = self.stamp - np.maximum.accumulate(np.where(moved, self.stamp, 0))
        return np.append(0.0, since[:-1] * 1e-9)

    def cut(self, rows: Any) -> 'Recording':
        """Take some of the rows."""
        output = None if self.output is None else self.output[rows]
        arrays = self.stamp[rows], self.position[rows], self.velocity[rows]
        return Recording(self.name, self.parameters, *arrays, output)


class Sent(NamedTuple):
    """A message of the rotor or the encoder at the output, and what is true in it."""

    received: int
    """ns."""
    stamp: int
    data: bytes
    true: float = math.nan
    """rad: the rotor's position; NaN for the encoder at the output."""
    bound: float = math.inf
    """rad."""


class Fault(NamedTuple):
    """What a fault makes of a recording."""

    first: int
    """Index of the first message of which something is wrong."""
    sent: Sequence[Sent]


class Outcome(NamedTuple):
    """What came of a fault."""

    kind: str
    size: float
    recording: str
    delay: float
    """s, from its begin to the word; NaN if it was not found."""
    fine: int
    """Wrong outputs that are called fine."""
    worst: float
    """The largest error among them, as a multiple of the bound."""
    judged: float
    """Whether `gearkin validate` says it; NaN if it was not asked."""
    seed: int


# The recordings.


def joints(path: Path, topic: str) -> Iterator[tuple[str, Any, Any]]:
    """Read name, stamps and values of each joint on a topic that moves."""
    with Bag(path) as bag:
        data = [data for _, _, data in bag.messages([topic])]
    for joint in joints_of(data[0]):
        states = decode_joint_states(data, joint)
        use = states.joint_found & np.isfinite(states.values[:, 0])
        if np.ptp(states.values[use, 0]) > _MOVING:
            yield joint, states.stamp[use], states.values[use]


def encoders(path: Path) -> Recording:
    """Read a recording of both encoders of a gear, the zero of the output's adjusted."""
    ratio, limit, unit = _GEARS[path.stem]
    time, *angles = np.loadtxt(path, delimiter=',', skiprows=1, usecols=(0, 1, 2), unpack=True)
    rotor, output = np.multiply(angles, unit)
    parameters = replace(_DUAL, gear_ratio=ratio, transmission_error_limit=limit)
    zero = float(np.median(output - rotor / float(parameters.gear.gear_ratio)))
    parameters = replace(parameters, output_encoder_zero=zero)
    stamps = START + np.round(time * SECOND).astype(np.int64)
    return Recording(path.stem, parameters, stamps, rotor, np.full_like(rotor, np.nan), output)


@cache
def recordings(shared: Path) -> Sequence[Recording]:
    """Read all recordings that have no faults of their own."""
    bags = share_directory() / 'bags'
    sources = [
        (bags / 'servo_point_to_point', '/rotor_state'),
        (bags / 'constant_speed_3000rpm', '/rotor_state'),
        (bags / 'single_turn_encoder', '/rotor_state'),
        (shared / 'bags' / 'feetech_servos', '/servo/out/state'),
        (shared / 'bags' / 'pr2_joints' / 'pr1012_sensors.bag', '/joint_states'),
        *((path, '/rotor_state') for path in sorted((shared / 'recorded').glob('*/'))),
    ]
    found = []
    for path, topic in [source for source in sources if source[0].exists()]:
        for joint, stamp, values in joints(path, topic):
            position, velocity, _ = values.T
            name = f'{path.stem} {joint}'.removesuffix(' rotor')
            if path.stem == 'single_turn_encoder':
                position = np.unwrap(position)
            else:
                found.append(Recording(name, _DEFAULT, stamp, position, velocity))
            if path.parent == bags:
                found.append(Recording(f'{name}, in a turn', _SINGLE, stamp, position, velocity))
    return *found, *map(encoders, sorted((shared / 'dual_encoders').glob('[ns]*.csv')))


# The faults.


def message(recording: Recording, stamp: int, position: float, velocity: float) -> bytes:
    """Encode what a driver sends."""
    if recording.parameters.single_turn:
        position %= TURN
    if math.isnan(velocity):
        return _POSITION.encode(stamp, [position])
    return _BOTH.encode(stamp, [position, velocity])


def of_wrong_length(stamp: int, values: Sequence[float]) -> bytes:
    """Encode a message of one joint with other than one position."""
    position, nothing = (len(values), 1, (0,)), (0, 1, ())
    return Template('', ['rotor'], position, nothing, nothing).encode(stamp, values)


_POSITION = JointStateTemplate(['rotor'], velocity=False, effort=False)
_BOTH = JointStateTemplate(['rotor'], velocity=True, effort=False)
_SHAFT = JointStateTemplate(['shaft'], velocity=False, effort=False)


def bounds(received: Any, recording: Recording, uneven: Any) -> Any:
    """Find by how much each reading can be wrong and be believed, rad; see docs/trust.md.

    Args:
        received: times of all readings, ns.
        recording: their rows of the recording.
        uneven: whether further messages come in between.
    """
    period = np.diff(received, prepend=2 * received[0] - received[1]) * 1e-9
    longest = np.max([period, np.roll(period, 1), np.roll(period, 2)], axis=0)
    stale = np.minimum(STALEST, 1.25 * longest)
    held = np.minimum(recording.since_moved, STALEST)  # a reading is as old as the first of it
    time, noise = period + held + stale, np.maximum(FLOOR, 2.0 * recording.finest)
    fast, hard = _DEFAULT.max_rotor_speed, _DEFAULT.max_rotor_acceleration
    speed = np.abs(recording.speed)
    bound = 2.5 * hard * time * time + speed * (stale + 0.25 * time) + 3.25 * noise
    # A rotor that stood may have started as long ago as a reading is old.
    start = period + STALEST
    starting = hard * start * (2.0 * period + 0.5 * start) + noise
    still = recording.since_moved > STALEST
    bound = np.where(still, starting, bound)
    turned = np.abs(np.diff(recording.position, prepend=recording.position[0]))
    time = np.maximum(time, start * still)
    far = fast * time + np.maximum(speed * time, turned) + noise
    # Where stamps are uneven, the speed is not known.
    before = np.roll(period, 1)
    even = (np.minimum(period, before) > 0.5 * np.maximum(period, before)) & ~uneven
    bound = np.where(even & np.roll(even, 1), np.minimum(bound, far), far)
    return np.maximum(bound, in_bursts(period, speed, noise))


def in_bursts(period: Any, speed: Any, noise: Any) -> Any:
    """Find the bounds of readings that come in a burst after a pause, rad; 0 of others.

    They are as far apart as those before it, and their speed may have changed in all this time.
    Of bursts that follow each other, only the limit of the speed is known. Arguments: times since
    the reading before, s, speeds, rad/s, and noise, rad.
    """
    bounds, fast, hard = 0.0 * period, _DEFAULT.max_rotor_speed, _DEFAULT.max_rotor_acceleration
    pause = since = usual = before = 0.0
    for k in range(2, len(period)):
        since += period[k - 1]
        if period[k - 1] > max(2.0 * period[k], pause - since):
            again = pause > 0.0 and since < 3.0 * pause
            pause, since, before = period[k - 1], 0.0, speed[k - 2]
            usual = math.nan if again else period[k - 2]
        if since + period[k] < pause:
            if math.isnan(usual):
                bounds[k] = fast * 2.25 * pause + noise[k]
                continue
            time = usual + min(1.25 * usual, STALEST)
            most = before + hard * (pause + since + time)
            bounds[k] = 2.5 * hard * time * time + most * (1.25 * time - usual) + 3.25 * noise[k]
    return bounds


class Lines:
    """The messages of a recording, as columns that a fault changes from an index on."""

    def __init__(self, recording: Recording, first: int, random: np.random.Generator) -> None:
        """Take a recording as it is, with random numbers for the faults."""
        self.recording, self.first, self.random = recording, first, random
        self.received, self.stamp = recording.stamp.copy(), recording.stamp.copy()
        self.position, self.velocity = recording.position.copy(), recording.velocity.copy()
        self.true = recording.position.copy()
        self.output = None if recording.output is None else recording.output.copy()
        self.kept = np.ones(len(self.stamp), bool)
        self.lasting = True
        """Whether what is wrong at the first reading stays wrong."""
        self.times = np.ones(len(self.stamp))
        """How often each reading has become wrong."""
        self.uneven = np.zeros(len(self.stamp), bool)
        """Whether further messages come in between."""
        self.further = np.zeros(len(self.stamp))
        """rad: by what each is wrong without any jump."""
        self.raw: dict[int, list[float]] = {}
        """Positions of messages with arrays of a wrong length."""
        self.second: dict[int, float] = {}
        """Positions of a second publisher, right after a message."""
        if recording.output is not None:  # which finds the zero no better
            limit = recording.parameters.transmission_error_limit
            self.further += 2.0 * limit * abs(float(recording.parameters.gear.gear_ratio))

    def sent(self) -> Iterator[Sent]:
        """Yield what drivers send, in order."""
        rows, recording = np.flatnonzero(self.kept), self.recording
        bound = self.further.copy()
        allowed = bounds(self.received[rows], recording.cut(rows), self.uneven[rows])
        if self.lasting:
            later = rows >= self.first
            allowed[later] = np.maximum.accumulate(allowed[later])
        bound[rows] += allowed * self.times[rows]
        for k in rows.tolist():
            received, stamp = int(self.received[k]), int(self.stamp[k])
            truth = float(self.true[k]), float(bound[k])
            data = message(recording, stamp, float(self.position[k]), float(self.velocity[k]))
            if k in self.raw:
                data = of_wrong_length(stamp, self.raw[k])
            yield Sent(received, stamp, data, *truth)
            if k in self.second:
                stamp += 1000
                data = message(recording, stamp, self.second[k], math.nan)
                yield Sent(received + 1000, stamp, data, *truth)
            if self.output is not None:
                yield Sent(received, stamp, _SHAFT.encode(stamp, [float(self.output[k])]))


def corrupt(lines: Lines, size: float) -> None:
    """Change one reading."""
    lines.position[lines.first] += size
    lines.lasting = False


def corrupt_twice(lines: Lines, size: float) -> None:
    """Change two readings in a row, each by another angle."""
    corrupt(lines, size)
    lines.position[lines.first + 1] += size * lines.random.uniform(-1.0, 1.0)
    lines.times[lines.first + 1] = 2.0  # it may be judged by the other one


def jump(lines: Lines, size: float) -> None:
    """Change the zero of the readings from then on."""
    lines.position[lines.first :] += size


def stick(lines: Lines, size: float) -> None:
    """Repeat a reading for a time."""
    recording, n = lines.recording, lines.first
    speed, period = np.abs(recording.speed[n - 3 : n]), np.diff(recording.stamp[n - 4 : n]) * 1e-9
    until = lines.received[n] + size * SECOND
    lines.position[n:][lines.received[n:] < until] = recording.position[n - 1]
    # A rotor at less than this speed can stop unseen; else a reading may be as old.
    unseen = np.min(speed) < stopping(float(np.max(period)))
    lines.further[n:] = math.inf if unseen else np.max(speed) * (STALEST + np.max(period))


def stopping(period: float) -> float:
    """The speed, rad/s, from which a rotor cannot have stopped between readings."""
    hard, time = _DEFAULT.max_rotor_acceleration, 2.0 * period + min(STALEST, 1.25 * period)
    slow = math.sqrt(2.0 * hard * FLOOR) + 2.0 * hard * time
    return (slow * time + FLOOR) / (2.0 * period)


def factor(lines: Lines, size: float) -> None:
    """Send a multiple of the velocities throughout."""
    lines.velocity[:] = size * lines.recording.speed


def single(lines: Lines, size: float) -> None:
    """Send positions so far from 0 as numbers of single precision."""
    lines.true += size
    lines.position[:] = lines.true.astype(np.float32)
    lines.further += float(np.spacing(np.float32(size + np.max(np.abs(lines.true)))))


def slip(lines: Lines, size: float) -> None:
    """Let the output slip against the rotor."""
    recording, parameters = lines.recording, lines.recording.parameters
    ratio = float(parameters.gear.gear_ratio)
    lines.output[lines.first :] += size
    lines.true[lines.first :] += size * ratio
    limit, delay = parameters.transmission_error_limit, parameters.transmission_error_max_gap
    fastest = float(np.max(np.abs(recording.speed)))
    lines.further += abs(ratio) * limit + 2.0 * delay * fastest


def second(lines: Lines, size: float) -> None:
    """Send the angle of another motor in between, for half a second."""
    since = lines.received - lines.received[lines.first]
    lines.uneven[lines.first :] = True
    for k in np.flatnonzero((since >= 0) & (since < SECOND // 2)).tolist():
        lines.second[k] = lines.recording.position[lines.first] + size


def clock(lines: Lines, size: float) -> None:
    """Set the driver's clock back."""
    lines.stamp[lines.first :] -= round(size * SECOND)


def early(lines: Lines, size: float) -> None:
    """Make every second stamp early."""
    lines.stamp[lines.first :: 2] -= round(size * SECOND)


def gap(lines: Lines, size: float) -> None:
    """Lose messages for a time."""
    later = lines.received[lines.first :]
    lines.kept[lines.first :] = later >= later[0] + size * SECOND


def restart(lines: Lines, size: float) -> None:
    """Restart the drive within 0.3 s, with another zero."""
    gap(lines, 0.3)
    jump(lines, size)


def flip(lines: Lines, size: float) -> None:
    """Change the sign of the positions."""
    n, position = lines.first, lines.recording.position
    turned = position[n:] - position[n]
    lines.position[n:] = position[n] + size - turned
    lines.further[n:] += np.abs(2.0 * turned)  # it looks like a reversal


def lengths(lines: Lines, size: float) -> None:
    """Send so many positions for one name, in 20 messages."""
    for k in range(lines.first, min(lines.first + 20, len(lines.stamp))):
        lines.raw[k] = [lines.position[k] + 1.0] * int(size)


def wrap(lines: Lines, size: float) -> None:
    """Let the position repeat after a range."""
    position = lines.recording.position
    start = position[0] - size * lines.random.random()
    periods = np.floor((position - start) / size)
    lines.position[:] = position - periods * size
    lines.times += np.cumsum(np.abs(np.diff(periods, prepend=0.0)))
    lines.first = 0


def other_range(lines: Lines, size: float) -> None:
    """Let the position repeat after another range than the parameters say."""
    parameters = replace(lines.recording.parameters, rotor_encoder_range=_CONFIGURED)
    lines.recording = lines.recording._replace(parameters=parameters)
    wrap(lines, size)


class Kind(NamedTuple):
    """A kind of fault."""

    name: str
    unit: str
    sizes: Sequence[float]
    put: Callable[[Lines, float], None]
    angles: bool = True
    """Whether the size is an angle of the rotor, of either sign."""
    dual: bool = False
    """Whether it takes an encoder at the output."""


_ANGLES = tuple(float(f'{x:.2g}') for x in np.geomspace(0.1, 1000.0, 21))
_TIMES = tuple(float(f'{x:.2g}') for x in np.geomspace(0.001, 3.0, 15))
_CONFIGURED = 25.0  # rad
_OTHER_RANGES = (TURN, 2.0 * TURN, 24.0, 24.9, 4.0 * TURN, 26.0, 50.0, 65.536, 100.0)
_RANGES = (TURN, 2.0 * TURN, 25.0, 4.0 * TURN, 100.0, 500.0)
_DISTANCES = tuple(map(float, np.geomspace(1e4, 1e8, 9)))
_FACTORS = (0.0, -1.0, 0.5 / math.pi, 30.0 / math.pi, 180.0 / math.pi, 1 / -19, 0.5, 1.5, 2.0, 3.0)
KINDS = (
    Kind('one corrupt reading', 'rad', _ANGLES, corrupt),
    Kind('two corrupt readings in a row', 'rad', _ANGLES, corrupt_twice),
    Kind('a jump that stays', 'rad', _ANGLES, jump),
    Kind('the drive restarts within 0.3 s', 'rad', _ANGLES, restart),
    Kind('a second publisher for 0.5 s', 'rad', _ANGLES, second),
    Kind('the position repeats after a range', 'rad', _RANGES, wrap, angles=False),
    Kind('the position repeats after another range than 25 rad', 'rad', _OTHER_RANGES, other_range,
         angles=False),
    Kind('the sign of the positions changes', 'rad', (0.0, *_ANGLES), flip),
    Kind('a stuck reading', 's', _TIMES, stick, angles=False),
    Kind('lost messages', 's', _TIMES, gap, angles=False),
    Kind('the clock is set back', 's', _TIMES, clock, angles=False),
    Kind('every second stamp is early', 's', _TIMES[:6], early, angles=False),
    Kind('velocities times a factor', '', _FACTORS, factor, angles=False),
    Kind('positions of single precision', 'rad', _DISTANCES, single, angles=False),
    Kind('arrays of another length', 'values', (0.0, 2.0, 3.0), lengths, angles=False),
    Kind('the output slips', 'rad', (0.003, 0.005, 0.01, 0.02, 0.05, 0.1, 0.3), slip,
         angles=False, dual=True),
)  # fmt: skip


# The node.


class Node:
    """The state of the node, with a clock that is that of the recording."""

    def __init__(self, parameters: NodeParameters, begun: int, phase: float) -> None:
        """Start at a time, ns; the first report is a phase, s, later."""
        self.gear = GearState(parameters)
        self.gear.choose([OUTPUT_STATE])
        self._connections = Connections(DriverFacts(since=begun * 1e-9))
        self.due = begun + round(phase * SECOND)
        self.reports: list[tuple[int, str]] = []
        """Time, ns, and what is said; '' if all is well."""
        self.outputs: list[tuple[int, float, float, bytes]] = []
        """Time, ns, error and its bound, rad, and message."""

    def take(self, each: Sent, *, encoded: bool) -> None:
        """Process a message, as the node does."""
        while each.received >= self.due:
            self.report()
        gear, encoder = self.gear, math.isnan(each.true)
        monitor = gear.encoder_monitor if encoder else gear.monitor
        monitor.last_input = each.received * 1e-9
        try:
            if encoder:
                gear.encoder(each.data, lambda: each.received)
                return
            position = gear.rotor(each.data, lambda: each.received).position
        except RejectedInputError:
            return
        if not self.outputs and gear.parameters.rotor_period:
            gear.input.home(each.true)
            gear.monitor.unreferenced = 0
        referenced = gear.input.referenced
        error = TURN * position.turns + position.angle - each.true
        self.outputs.append((
            each.received,
            abs(error) if referenced and len(self.outputs) else 0.0,
            each.bound,
            gear.encode()[0][1] if encoded else b'',
        ))  # fmt: skip

    def report(self) -> None:
        """Take the diagnostics."""
        reports = self.gear.report(self.due * 1e-9, self._connections).values()
        self.reports.append((self.due, '; '.join(each.message for each in reports if each.level)))
        self.due += SECOND


def live(
    recording: Recording, messages: Sequence[Sent], phase: float, *, encoded: bool = False
) -> Node:
    """Let the node process messages, and then wait for a report."""
    node = Node(recording.parameters, messages[0].received, phase)
    for each in messages:
        node.take(each, encoded=encoded)
    node.report()
    return node


def recorded(recording: Recording, messages: Sequence[Sent], node: Node) -> set[str]:
    """Let `gearkin validate` judge the messages and the node's outputs; returns what it found."""
    rotor = [(f'/{ROTOR_STATE}', m.received, m.data) for m in messages if m.true == m.true]
    outputs = [('/output_state', time + 1, data) for time, _, _, data in node.outputs]
    validator = Validator(Task(Path('faulty'), recording.parameters))
    messages = sorted(rotor + outputs, key=lambda each: each[1])
    validator.take(MessagesByTopic(validator.topics, messages))
    report = validator.report()
    health = report.rotor
    texts = {sentence(finding, report) for finding in report.findings}
    if health:
        texts |= {*health.rejected, health.jumped, health.velocity_is, health.beyond_limits}
    return {str(text).split(':')[0] for text in texts if text} | {str(report.verdict)}


def suits(kind: Kind, recording: Recording) -> bool:
    """Whether a kind of fault can be put into a recording."""
    if kind.dual:
        return recording.output is not None
    if kind.put in {single, other_range} and recording.output is not None:
        return False  # its encoder finds another zero
    return kind.put not in {wrap, other_range, single} or not recording.parameters.single_turn


def trial(task: tuple[Path, int]) -> Outcome:
    """Put in the fault of a number, and see what is said."""
    shared, seed = task
    random = np.random.default_rng(seed)
    kind = KINDS[seed % len(KINDS)]
    known = [each for each in recordings(shared) if suits(kind, each)]
    recording = known[int(random.integers(len(known)))]
    size = float(random.choice(kind.sizes))
    if kind.angles:
        size *= float(random.choice([-1.0, 1.0]) * random.uniform(0.9, 1.1))
        if recording.parameters.single_turn:
            size = math.remainder(size, TURN)
    moment = int(random.integers(10, len(recording.stamp) - 10))
    at = int(recording.stamp[moment])
    times = [at - round(BEFORE * SECOND), at + round(AFTER * SECOND)]
    begin, end = np.searchsorted(recording.stamp, times).tolist()
    part = recording.cut(slice(begin, end))
    lines = Lines(part, moment - begin, random)
    kind.put(lines, size)
    faulty = lines.recording
    judge = seed // len(KINDS) % _JUDGED == 0 and part.output is None
    messages, phase = list(lines.sent()), float(random.uniform(0.1, 1.0))
    node = live(faulty, messages, phase, encoded=judge)
    said = [time for time, text in node.reports if text and time >= at]
    delay = (said[0] - at) / SECOND if said else math.nan
    fine, worst = called_fine(node)
    judged = math.nan
    if judge:
        clean = list(Lines(part, 0, random).sent())
        as_it_is = recorded(part, clean, live(part, clean, phase, encoded=True))
        judged = float(bool(recorded(faulty, messages, node) - as_it_is))
    return Outcome(kind.name, abs(size), recording.name, delay, fine, worst, judged, seed)


def called_fine(node: Node) -> tuple[int, float]:
    """Count the wrong outputs between two reports that all is well, and find the worst."""
    times = np.array([time for time, _ in node.reports])
    well = np.array([True, *(not text for _, text in node.reports)])
    count, worst = 0, 0.0
    for time, error, bound, _ in node.outputs:
        if error > bound:
            k = int(np.searchsorted(times, time, side='right'))
            if well[k] and well[k + 1]:
                count += 1
                worst = max(worst, error / bound)
    return count, worst


def false_alarms(recording: Recording) -> list[str]:
    """What is said of a recording as it is."""
    as_it_is = Lines(recording, 0, np.random.default_rng(0))
    node = live(recording, list(as_it_is.sent()), 1.0)
    # An absolute encoder first has to find the turns.
    reports = node.reports[recording.output is not None :]
    return sorted({text for _, text in reports if text} | set(node.gear.input.rejected))


# The table.


def table(outcomes: Sequence[Outcome]) -> Iterator[str]:
    """Yield the lines of the table in Markdown."""
    columns = 'fault', 'faults', 'found', 'always found from', 'delay: median, longest'
    yield f'| {" | ".join(columns)} | `validate` | wrong outputs called fine |'
    yield f'|{"---|" * 7}'
    for kind in KINDS:
        of_kind = [each for each in outcomes if each.kind == kind.name]
        if not of_kind:
            continue
        found = [each for each in of_kind if not math.isnan(each.delay)]
        missed = [each.size for each in of_kind if math.isnan(each.delay)]
        bigger = [each.size for each in found if each.size > max(missed, default=math.inf)]
        always = f'{min(bigger):.3g} {kind.unit}' if bigger else '-'
        always = always if missed else 'any size'
        delays = [each.delay for each in found] or [math.nan]
        judged = [each.judged for each in of_kind if not math.isnan(each.judged)]
        share = f'{100 * np.mean(judged):.0f} %' if judged else '-'
        yield (
            f'| {kind.name} | {len(of_kind)} | {100 * len(found) / len(of_kind):.0f} % | {always} '
            f'| {np.median(delays):.2f} s, {max(delays):.2f} s | {share} '
            f'| {sum(each.fine for each in of_kind)} |'
        )


def main() -> None:
    """Put in faults, and print what came of them."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('--faults', type=int, default=2000, metavar='N')
    parser.add_argument('--first', type=int, default=0, metavar='N', help='number of the first')
    parser.add_argument('--shared', type=Path, default=_SHARED, metavar='FOLDER')
    parser.add_argument('--jobs', type=int, default=os.cpu_count())
    parser.add_argument('--json', action='store_true')
    parser.add_argument('--wrong', action='store_true', help='list what is called fine')
    options = parser.parse_args()
    if not (options.shared / 'recorded').is_dir():
        parser.error(f'--shared {options.shared}: it has no folder recorded, of recordings')
    known = recordings(options.shared)
    alarms = {each.name: said for each in known if (said := false_alarms(each))}
    tasks = [(options.shared, n) for n in range(options.first, options.first + options.faults)]
    with multiprocessing.get_context('fork').Pool(options.jobs) as pool:
        outcomes = list(pool.imap_unordered(trial, tasks, chunksize=50))
    if options.json:
        rows = (
            [None if str(n) == 'nan' else n for n in each] for each in outcomes
        )  # JSON has no NaN
        print(json.dumps({'alarms': alarms, 'outcomes': sorted(rows, key=lambda row: row[-1])}))
        return
    print('\n'.join(table(outcomes)))
    print(f'\n{len(known)} recordings as they are: {len(alarms)} with a warning')
    for name, said in alarms.items():
        print(f'- {name}: {"; ".join(said)}')
    for each in sorted(outcomes, key=lambda o: -o.worst) if options.wrong else ():
        if each.fine:
            print(each, file=sys.stderr)


if __name__ == '__main__':
    main()
