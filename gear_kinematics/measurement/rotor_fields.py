# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""What seems wrong with a driver's messages: sizes, stamps, and units of velocity and effort."""

from collections.abc import Iterator, Sequence
from fractions import Fraction

import numpy as np

from gear_kinematics.bag import Bag, DamagedBagError
from gear_kinematics.measurement.commissioning.encoder_range import unwrapped
from gear_kinematics.measurement.encoder_step import Step
from gear_kinematics.measurement.sentences import Observation, Observed
from gear_kinematics.state.effort_field import EffortField, questioned
from gear_kinematics.state.statuses import Condition, Fact
from gear_kinematics.state.velocity_field import VelocityField, VelocityMeaning
from gear_kinematics.wire.batches import decode_joint_states
from gear_kinematics.wire.cdr import SECOND

MOST = 500_000  # messages that are examined; they take about 200 bytes each
_FEWEST = 10
_MOVED = 1.0  # rad: a rotor that travels as far has certainly moved
_EQUAL = 1e-9  # rad: positions that differ by less differ by rounding alone


def questions(
    data: Sequence[bytes], received: Sequence[int], joint: str, ratio: Fraction | None = None
) -> Iterator[Observed | Fact]:
    """Yield what seems to be wrong with the fields of n messages.

    Args:
        data: the messages, serialised sensor_msgs/JointState.
        received: times of reception, ns, which replace missing stamps.
        joint: name of the rotor's joint; '' takes the only one.
        ratio: gear ratio if known, to recognise velocities of the output.
    """
    states = decode_joint_states(data, joint)
    if unfit := int(np.count_nonzero(states.joint_found & ~states.arrays_fit)):
        yield Observation.SIZES_DIFFER(count=unfit)
    stamp = np.where(states.stamp == 0, np.asarray(received, np.int64), states.stamp)
    repeated = int(np.count_nonzero(np.diff(stamp) == 0))
    if 2 * repeated > len(stamp):
        yield Observation.STAMPS_REPEAT(count=repeated, total=len(stamp))
    newest = np.append(np.iinfo(np.int64).min, np.maximum.accumulate(stamp)[:-1])
    usable = states.arrays_fit & np.isfinite(states.values[:, 0])
    rows = np.flatnonzero(usable & (stamp > newest))
    if len(rows) < _FEWEST:
        return
    stamp, values = stamp[rows], states.values[rows]
    seconds = (stamp - stamp[0]) / SECOND
    values[:, 0] = unwrapped(values[:, 0], seconds, Step(0.0, seen=False))
    steps = np.abs(np.diff(values[:, 0]))
    given = values[np.isfinite(values[:, 1]), 1]
    velocities = VelocityField(float(1 / ratio) if ratio else np.nan)
    noise = 2.0 * float(np.min(steps[steps > _EQUAL], initial=1.0))
    velocities.believed(stamp, values, noise)
    if len(given) and not given.any() and np.ptp(values[:, 0]) > _MOVED:
        yield Condition.VELOCITIES_ARE(meaning=VelocityMeaning.ZERO)
    elif velocities.meaning:
        yield velocities.meaning
    field = EffortField()
    field.all_believed(values[:, 0], values[:, 2])
    if field.absent:
        yield Observation.NO_EFFORT()
    efforts = values[np.isfinite(values[:, 2]), 2]
    if question := questioned(float(np.max(np.abs(efforts), initial=0.0))):
        yield question


def recorded_questions(
    bag: Bag, topic: str, joint: str, ratio: Fraction | None = None
) -> Iterator[Observed | Fact]:
    """Yield the questions on a topic of a bag, up to any damage; see `questions`."""
    data, received = list[bytes](), list[int]()
    try:
        for batch in bag.by_topic([topic]):
            received += batch[topic].received
            data += batch[topic].data
            if len(data) > MOST:
                break
    except DamagedBagError:
        pass  # the reader of the recording reports it
    yield from questions(data, received, joint, ratio)
