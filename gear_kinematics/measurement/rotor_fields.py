# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""What seems wrong with a driver's messages: sizes, stamps, and units of velocity and effort."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from fractions import Fraction

import numpy as np

from gear_kinematics.bag import Bag, DamagedBagError
from gear_kinematics.measurement.commissioning.analysis import Value, encoder_kind
from gear_kinematics.measurement.encoder_range import find_range
from gear_kinematics.measurement.encoder_step import Step
from gear_kinematics.measurement.recording import MOST_MESSAGES
from gear_kinematics.measurement.sentences import Observation, Observed
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.report.document import counted
from gear_kinematics.state.belief import VelocityMeaning
from gear_kinematics.state.effort_field import EffortField
from gear_kinematics.state.reach import FLOOR
from gear_kinematics.state.rotor_input import RotorInput
from gear_kinematics.state.statuses import Condition, Fact
from gear_kinematics.state.velocity_field import VelocityField
from gear_kinematics.state.wraps import too_seldom
from gear_kinematics.wire.batches import Array, JointStateBatch, JointStates, decode_joint_states
from gear_kinematics.wire.cdr import SECOND
from gear_kinematics.wire.joint_reader import Rejection

_FEWEST = 10
_MANY = 0.1  # of all readings: so many that are implausible show no single motion
_MOVED = 1.0  # rad: a rotor that travels as far has certainly moved
_STEP = Step(0.0, seen=False)
_EQUAL = 1e-9  # rad: positions that differ by less differ by rounding alone


def questions(
    data: Sequence[bytes],
    received: Sequence[int],
    joint: str,
    ratio: Fraction | None = None,
    limits: tuple[float, float] | None = None,
    *,
    steps: bool = False,
    parameters: NodeParameters | None = None,
) -> Iterator[Observed | Fact]:
    """Yield what seems to be wrong with the fields of n messages.

    Args:
        data: the messages, serialised sensor_msgs/JointState; a batch is decoded once.
        received: times of reception, ns, which replace missing stamps.
        joint: name of the rotor's joint; '' takes the only one.
        ratio: gear ratio if known, to recognise velocities of the output.
        limits: of the rotor's speed, rad/s, and acceleration, rad/s², up to which its turns are
            to be counted.
        steps: whether to name rejected positions and steps of the clock, too, and steps of the
            positions that a rotor cannot make.
        parameters: those by which a node would judge these steps; by default, the default ones
            with the range that the positions show.
    """
    states = decode_joint_states(data, joint)
    stamp = states.stamped(received)
    if unfit := int(np.count_nonzero(states.joint_found & ~states.arrays_fit)):
        yield Observation.SIZES_DIFFER(count=unfit)
    own = stamp[states.joint_found]  # other joints may have the same time
    repeated = int(np.count_nonzero(np.diff(own) == 0))
    if 2 * repeated > len(own):
        yield Observation.STAMPS_REPEAT(count=repeated, total=len(own))
    if unstamped := int(np.count_nonzero(states.joint_found & (states.stamp == 0))):
        yield Condition.UNSTAMPED(messages=counted(unstamped, 'message'))
    stamp, values = _in_order(states, stamp)
    found = replace(NodeParameters.load(), rotor_joint=joint)
    if len(stamp) < _FEWEST:
        if steps:
            rotor = RotorInput(parameters or found)
            rotor.accept_batch(data, received)
            yield from _impossible_steps(rotor, limited=False)
        return
    counts = not np.any(values[:, 0] % 1.0) and len(np.unique(values[:, 0])) >= _FEWEST
    if counts:
        yield Observation.COUNTS()
    known_period = parameters.rotor_period if parameters else 0.0
    values[:, 0], (period, _) = _unwrapped(stamp, values[:, 0], known_period)
    rotor = RotorInput(parameters or replace(found, rotor_encoder_range=period))
    if steps and not counts:
        rotor.accept_batch(data, received)
        yield from _impossible_steps(rotor, limited=bool(limits))
    sizes = np.abs(np.diff(values[:, 0]))
    given = values[np.isfinite(values[:, 1]), 1]
    velocities = VelocityField(float(1 / ratio) if ratio else np.nan)
    noise = max(2.0 * float(np.min(sizes[sizes > _EQUAL], initial=1.0)), FLOOR)
    velocities.believed(stamp, values, noise)
    # One step alone can be another zero, after which the rotor stands as before.
    moved = np.ptp(values[:, 0]) - np.max(sizes) > _MOVED
    absent = len(given) and not given.any() and moved
    if absent:
        yield Condition.VELOCITIES_ARE(meaning=VelocityMeaning.ZERO)
    # Otherwise the readings are of no single motion, as of two drivers.
    elif rotor.rejected[Rejection.IMPLAUSIBLE] <= _MANY * len(stamp) and (
        meaning := velocities.in_recording
    ):
        yield meaning
    usual, known = float(np.median(np.diff(stamp))) / SECOND, len(given) and not absent
    known = bool(known and not velocities.contradicts)
    if period and limits and (seldom := too_seldom(period, *limits, usual, known=known)):
        yield seldom
    field = EffortField()
    field.all_believed(values[:, 0], values[:, 2])
    field.note(values[:, 2])
    if field.doubt:
        yield field.doubt


def _impossible_steps(rotor: RotorInput, *, limited: bool) -> Iterator[Observed | Fact]:
    """Yield jumps, faults of the clock, rejected positions; if `limited`, what exceeds limits."""
    known = {Rejection.JOINT_MISSING, Rejection.ARRAY_SIZES}
    jumped, beyond = rotor.plausibility.jumped, rotor.plausibility.beyond_limits
    if jumped:
        yield jumped
    elif beyond and limited:
        advice = beyond.advice[0].lower() + beyond.advice[1:].rstrip('.')
        yield Observation.BEYOND_LIMITS(beyond=str(beyond), advice=advice)
    if jumped or beyond:
        known.add(Rejection.IMPLAUSIBLE)
    if counts := {cause: count for cause, count in rotor.rejected.items() if cause not in known}:
        yield Condition.REJECTED(counts=counts)
    if fault := rotor.disorder.fault:
        yield fault


def kind_of_encoder(data: Sequence[bytes], received: Sequence[int], joint: str) -> list[Value]:
    """Return the parameters of the rotor's encoder that messages show; see `questions`."""
    states = decode_joint_states(data, joint)
    stamp, values = _in_order(states, states.stamped(received))
    turned, found = values[:, 0], (0.0, 0)
    if len(stamp) >= _FEWEST:
        turned, found = _unwrapped(stamp, turned)
    return [*encoder_kind([found], float(np.ptp(turned)) if len(turned) else 0.0)]


def _unwrapped(
    stamp: Array, positions: Array, period: float = 0.0
) -> tuple[Array, tuple[float, int]]:
    """Return positions, rad, without their wraps, and what `find_range` returns for them.

    A period that is known, rad, is not looked for.
    """
    found = (period, 0) if period else find_range(positions, (stamp - stamp[0]) / SECOND, _STEP)
    return np.unwrap(positions, period=found[0]) if found[0] else positions, found


def _in_order(states: JointStates, stamp: Array) -> tuple[Array, Array]:
    """Return stamps and values of the messages with a position, each later than those before."""
    newest = np.append(np.iinfo(np.int64).min, np.maximum.accumulate(stamp)[:-1])
    usable = states.arrays_fit & np.isfinite(states.values[:, 0])
    rows = np.flatnonzero(usable & (stamp > newest))
    return stamp[rows], states.values[rows]


def recorded_questions(
    bag: Bag, topic: str, joints: Mapping[str, NodeParameters | None]
) -> Iterator[tuple[str, Observed | Fact]]:
    """Yield joints on a topic of a bag, and the questions on them up to any damage.

    Their parameters are those of the recorded node, if they are known.
    """
    data, received = list[bytes](), list[int]()
    try:
        for batch in bag.by_topic([topic]):
            received += batch[topic].received
            data += batch[topic].data
            if len(data) > MOST_MESSAGES:
                break
    except DamagedBagError:
        pass  # the reader of the recording reports it
    decoded = JointStateBatch(data)
    for joint, parameters in joints.items():
        known = (parameters.gear.gear_ratio, parameters.rotor_limits) if parameters else ()
        for question in questions(
            decoded, received, joint, *known, steps=True, parameters=parameters
        ):
            yield joint, question
