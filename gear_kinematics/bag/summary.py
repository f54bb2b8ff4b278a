# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The contents of a recording: its topics, with their rates, gaps and roles."""

from collections import Counter, defaultdict
from collections.abc import Mapping, Sequence
from operator import itemgetter
from typing import NamedTuple

import numpy as np

from gear_kinematics.bag.errors import BagError, DamagedBagError
from gear_kinematics.bag.reading import Bag, MessagesByTopic, ReportProgress
from gear_kinematics.bag.roles import find_rotor_topic, joints_on
from gear_kinematics.wire.batches import Array, JointStateBatch
from gear_kinematics.wire.cdr import SECOND, header_stamp
from gear_kinematics.wire.joint_reader import joints_of
from gear_kinematics.wire.topics import (
    BODY_POSES,
    JOINT_STATE,
    OUTPUT_ENCODER,
    OUTPUT_STATE,
    POSE_ARRAY,
    base_name,
)

_GAP = 5.0  # median periods; a longer period counts as a gap
_WITH_STAMPS = {JOINT_STATE, POSE_ARRAY}
_UNSET = [-1, 0]  # stamps of messages that are cut off, and of those without one
_FEWEST = 10  # messages from which a rate is computed
_PARTS: Mapping[str, str] = {
    OUTPUT_ENCODER: 'encoder',
    OUTPUT_STATE: 'output',
    BODY_POSES: 'poses',
}
"""Parts of topics by their names, in the order of a summary behind the rotor's."""


class TopicSummary(NamedTuple):
    """The contents of one topic."""

    name: str
    type: str
    part: str  # `rotor`, `output`, `poses` or `encoder`, or empty
    messages: int
    joints: tuple[str, ...]  # joints in any of its messages, if it has joint states
    rate: float | None  # rate from the median period, Hz; None for too few messages
    mean_rate: float | None  # mean rate, Hz; it differs from `rate` where messages come in bursts
    gaps: int  # periods longer than five median ones
    longest_gap: float  # longest of these periods, s
    followed: str = ''  # joint of the rotor or, on another topic, the first of its joints
    of_others: int = 0  # messages without that joint, which rate and gaps leave out
    malformed: int = 0  # messages that are no joint states, which rate and gaps leave out


class Summary(NamedTuple):
    """The contents of a recording."""

    duration: float  # time from the first to the last message, s; a sum where time began anew
    topics: tuple[TopicSummary, ...]  # all topics; those with a part come first
    unclear: str  # why the rotor's topic is not known, or empty
    damage: str  # where reading ended, if the recording is damaged


def summarise(
    bag: Bag,
    rotor_topic: str | None = None,
    joints: Sequence[str] = (),
    progress: ReportProgress | None = None,
) -> Summary:
    """Read a whole recording; joints identify the topic of the rotors if it is not given.

    Raises BagError if no message can be read, or the given topic is missing.
    """
    rotor = unclear = damage = ''
    try:
        rotor = find_rotor_topic(bag, rotor_topic, *joints)
    except BagError as error:
        if rotor_topic:
            raise
        unclear = str(error).removeprefix(f'{bag.path}: ')
    others, malformed = Counter[str](), Counter[str]()
    found = defaultdict[str, dict[str, None]](dict)
    followed = dict[str, str]()
    if rotor and joints and joints[0]:
        recorded = joints_on(bag, [rotor])[rotor]
        followed[rotor] = next((joint for joint in joints if joint in recorded), joints[0])
    times = {topic: [np.zeros((2, 0), np.int64)] for topic in bag.topics}
    duration = last = 0
    stamped = {topic for topic, kind in bag.topics.items() if kind in _WITH_STAMPS} - bag.not_cdr
    try:
        for batch in bag.batches(bag.topics, progress, any_encoding=True):
            for topic, messages in MessagesByTopic(bag.topics, batch).items():
                stamp = received = np.array(messages.received, np.int64)
                if topic in stamped:
                    stamp = np.array([*map(header_stamp, messages.data)], np.int64)
                    stamp = np.where(np.isin(stamp, _UNSET), received, stamp)
                own = np.ones(len(received), bool)
                states = topic in stamped and bag.topics[topic] == JOINT_STATE
                tables = JointStateBatch(messages.data).tables if states else []
                good = np.full(len(received), not states)
                for rows in sorted((rows for rows, *_ in tables), key=itemgetter(0)):
                    good[rows] = True
                    names = joints_of(messages.data[rows[0]])
                    found[topic] |= dict.fromkeys(names)
                    if names:
                        followed.setdefault(topic, names[0])
                    own[rows] = followed.get(topic) in {None, *names}
                others[topic] += int(np.count_nonzero(~own))
                malformed[topic] += int(np.count_nonzero(~good))
                times[topic].append(np.stack([stamp, received])[:, own & good])
            clock = np.fromiter(map(itemgetter(1), batch), np.int64, len(batch))
            duration += int(np.maximum(np.diff(clock, prepend=last or clock[0]), 0).sum())
            last = int(clock[-1])
    except DamagedBagError as error:
        damage = str(error)
    topics = [
        _summary(
            name,
            kind,
            'rotor' if name == rotor else _PARTS.get(base_name(name), ''),
            [*found[name]],
            np.hstack(times[name]),
            followed.get(name, ''),
            others[name],
            malformed[name],
        )
        for name, kind in bag.topics.items()
    ]
    order = ['rotor', *_PARTS.values(), '']
    topics.sort(key=lambda topic: (order.index(topic.part), topic.name))
    return Summary(duration / SECOND, tuple(topics), unclear, damage)


def _summary(
    name: str, kind: str, part: str, joints: list[str], times: Array, followed: str, *left_out: int
) -> TopicSummary:
    stamped, received = np.diff(times)
    repeated = 2 * np.count_nonzero(stamped) < len(stamped)  # as without their nanoseconds
    apart = 10 * np.count_nonzero(stamped < 0) > len(stamped)  # as of drivers with two clocks
    periods = (received if repeated or apart else stamped).astype(np.float64) / SECOND
    periods = periods[periods > 0.0]  # the clock may be set back
    rate, mean, gaps, longest = None, None, 0, 0.0
    count = times.shape[1]
    if count >= _FEWEST and len(periods):
        median = float(np.median(periods))
        long = periods[periods > _GAP * median]
        rate, gaps, longest = 1.0 / median, len(long), float(long.max(initial=0.0))
        mean = (count - 1) / float(periods.sum())
    numbers = rate, mean, gaps, longest, followed
    return TopicSummary(
        name, kind, part, count + sum(left_out), tuple(joints), *numbers, *left_out
    )
