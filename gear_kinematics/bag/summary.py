# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The contents of a recording: its topics, with their rates, gaps and roles."""

from collections import Counter, defaultdict
from collections.abc import Mapping, Sequence
from contextlib import suppress
from typing import NamedTuple

import numpy as np

from gear_kinematics.bag.errors import BagError, DamagedBagError
from gear_kinematics.bag.reading import Bag, ReportProgress
from gear_kinematics.bag.roles import find_rotor_topic, joints_on
from gear_kinematics.wire.cdr import SECOND, MalformedMessageError, header_stamp
from gear_kinematics.wire.joint_reader import (
    JointReader,
    RejectedInputError,
    Rejection,
    joints_of,
)
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
_UNSET = {-1, 0}  # stamps of messages that are cut off, and of those without one
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
    joints: tuple[str, ...]  # joints of the first message, if the topic has joint states
    rate: float | None  # rate from the median period, Hz; None for too few messages
    mean_rate: float | None  # mean rate, Hz; it differs from `rate` where messages come in bursts
    gaps: int  # periods longer than five median ones
    longest_gap: float  # longest of these periods, s
    followed: str = ''  # joint of the rotor or, on another topic, the first that can be read
    of_others: int = 0  # messages without that joint, which rate and gaps leave out


class Summary(NamedTuple):
    """The contents of a recording."""

    duration: float  # time from the first to the last message, s
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
    others, further = Counter[str](), defaultdict[str, dict[str, None]](dict)
    followed = {}
    if rotor and joints and joints[0]:
        recorded = joints_on(bag, [rotor])[rotor]
        followed[rotor] = next((joint for joint in joints if joint in recorded), joints[0])
    readers = {topic: JointReader(joint) for topic, joint in followed.items()}
    times = {topic: list[tuple[int, int]]() for topic in bag.topics}
    ends: list[int] = []
    stamped = {topic for topic, kind in bag.topics.items() if kind in _WITH_STAMPS} - bag.not_cdr
    states = {topic for topic in stamped if bag.topics[topic] == JOINT_STATE}
    try:
        for batch in bag.batches(bag.topics, progress, any_encoding=True):
            for topic, received, data in batch:
                if topic in states:
                    if not followed.get(topic):
                        followed[topic] = _first_joint(data)
                        readers[topic] = JointReader(followed[topic])
                    if followed[topic] and not _has_joint(readers[topic], data):
                        others[topic] += 1
                        further[topic].update(dict.fromkeys(joints_of(data)))
                        continue
                stamp = header_stamp(data) if topic in stamped else 0
                times[topic].append((received if stamp in _UNSET else stamp, received))
            ends = [*ends[:1], batch[0][1], batch[-1][1]]
    except DamagedBagError as error:
        damage = str(error)
    there = joints_on(bag, [topic for topic in states if times[topic] or others[topic]])
    topics = [
        _summary(
            name,
            kind,
            'rotor' if name == rotor else _PARTS.get(base_name(name), ''),
            [*(dict.fromkeys(there.get(name, [])) | further[name])],
            times[name],
            followed.get(name, ''),
            others[name],
        )
        for name, kind in bag.topics.items()
    ]
    order = ['rotor', *_PARTS.values(), '']
    topics.sort(key=lambda topic: (order.index(topic.part), topic.name))
    duration = (max(ends) - min(ends)) / SECOND if ends else 0.0
    return Summary(duration, tuple(topics), unclear, damage)


def _first_joint(data: bytes) -> str:
    """Return the first joint in a message, or '' if there is none that can be read."""
    with suppress(MalformedMessageError, RejectedInputError, IndexError):
        joint = joints_of(data)[0]
        JointReader(joint).read(data)
        return joint
    return ''


def _has_joint(reader: JointReader, data: bytes) -> bool:
    """Return whether a message has the joint of a reader."""
    try:
        reader.read(data)
    except RejectedInputError as rejection:
        return str(rejection) != Rejection.JOINT_MISSING
    return True


def _summary(
    name: str,
    kind: str,
    part: str,
    joints: list[str],
    times: list[tuple[int, int]],
    followed: str,
    others: int,
) -> TopicSummary:
    stamped, received = np.diff(np.array(times, np.int64).reshape(-1, 2), axis=0).T
    repeated = 2 * np.count_nonzero(stamped) < len(stamped)  # as without their nanoseconds
    apart = 10 * np.count_nonzero(stamped < 0) > len(stamped)  # as of drivers with two clocks
    periods = (received if repeated or apart else stamped).astype(np.float64) / SECOND
    periods = periods[periods > 0.0]  # the clock may be set back
    rate, mean, gaps, longest = None, None, 0, 0.0
    if len(times) >= _FEWEST and len(periods):
        median = float(np.median(periods))
        long = periods[periods > _GAP * median]
        rate, gaps, longest = 1.0 / median, len(long), float(long.max(initial=0.0))
        mean = (len(times) - 1) / float(periods.sum())
    numbers = rate, mean, gaps, longest, followed, others
    return TopicSummary(name, kind, part, len(times) + others, tuple(joints), *numbers)
