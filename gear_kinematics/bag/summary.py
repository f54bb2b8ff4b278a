# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""What is in a recording: its topics, their rates and gaps, and which part each plays."""

from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass

import numpy as np

from gear_kinematics.bag.errors import BagError, DamagedBagError
from gear_kinematics.bag.reading import Bag, ReportProgress
from gear_kinematics.bag.roles import find_encoder_topic, find_rotor_topic, find_topics, joints_on
from gear_kinematics.wire.cdr import SECOND, header_stamp
from gear_kinematics.wire.topics import JOINT_STATE, OUTPUT_STATE, POSE_ARRAY, TOPICS, base_name

GAP = 5.0
"""Periods that count as a gap, in median periods."""
_WITH_STAMPS = {JOINT_STATE, POSE_ARRAY}
_UNSET = {-1, 0}
"""Stamps of messages that are cut off, and of those without one."""
_FEWEST = 10  # messages that have a rate


@dataclass(frozen=True, slots=True)
class TopicSummary:
    """One topic."""

    name: str
    type: str
    part: str
    """`rotor`, `output`, `poses` or `encoder`; `node` for its other topics, or empty."""
    messages: int
    joints: tuple[str, ...]
    """Of the first message, if they are joint states."""
    rate: float | None
    """Hz, from the median period; None of a few messages."""
    gaps: int
    """Periods longer than `GAP` median ones."""
    longest_gap: float
    """s."""


@dataclass(frozen=True, slots=True)
class Summary:
    """A recording."""

    duration: float
    """s, from the first to the last message."""
    topics: tuple[TopicSummary, ...]
    """Those with a part first."""
    unclear: str
    """Why the rotor's topic is not known, or empty."""
    damage: str
    """Where reading ended, if the recording is damaged."""

    @property
    def messages(self) -> int:
        """Number of messages on all topics."""
        return sum(topic.messages for topic in self.topics)


def summarise(
    bag: Bag,
    rotor_topic: str | None = None,
    joint: str = '',
    progress: ReportProgress | None = None,
) -> Summary:
    """Read a whole recording; if the rotor's topic is not given, its joint tells it from others.

    Raises:
        BagError: if no message can be read, or the given topic is missing.
    """
    parts, unclear = _parts(bag, rotor_topic, joint)
    times = {topic: list[int]() for topic in bag.topics}
    ends: list[int] = []
    damage = ''
    stamped = {topic for topic, kind in bag.topics.items() if kind in _WITH_STAMPS}
    try:
        for batch in bag.batches(bag.topics, progress):
            for topic, received, data in batch:
                stamp = header_stamp(data) if topic in stamped else 0
                times[topic].append(received if stamp in _UNSET else stamp)
            ends = [*ends[:1], batch[0][1], batch[-1][1]]
    except DamagedBagError as error:
        damage = str(error)
    joints = joints_on(bag, [t for t in times if times[t] and bag.topics[t] == JOINT_STATE])
    topics = [
        _summary(name, kind, parts.get(name, _part_of(name)), joints.get(name, []), times[name])
        for name, kind in bag.topics.items()
    ]
    order = ('rotor', 'encoder', 'output', 'poses', 'node', '')
    topics.sort(key=lambda topic: (order.index(topic.part), topic.name))
    duration = (max(ends) - min(ends)) / SECOND if ends else 0.0
    return Summary(duration, tuple(topics), unclear, damage)


def _parts(bag: Bag, rotor_topic: str | None, joint: str) -> tuple[Mapping[str, str], str]:
    """Return the parts that topics play, by name, and what is unclear about the rotor's."""
    parts, unclear = dict[str, str](), ''
    try:
        parts[find_rotor_topic(bag, rotor_topic, joint)] = 'rotor'
    except BagError as error:
        if rotor_topic:
            raise
        unclear = str(error).removeprefix(f'{bag.path}: ')
    with suppress(BagError):
        found = find_topics(bag, {'rotor': rotor_topic}, joint=joint)
        # Any other joint states would be taken for the output.
        if found.poses or found.output.endswith(f'/{OUTPUT_STATE}'):
            parts = {found.output: 'output', found.poses: 'poses', found.rotor: 'rotor'}
    with suppress(BagError):
        parts[find_encoder_topic(bag) or ''] = 'encoder'
    return parts, unclear


def _part_of(name: str) -> str:
    known = TOPICS.get(base_name(name)) or TOPICS.get(name)
    return 'node' if known and known.publisher == 'node' else ''


def _summary(name: str, kind: str, part: str, joints: list[str], times: list[int]) -> TopicSummary:
    periods = np.diff(np.array(times, np.int64)).astype(np.float64) / SECOND
    periods = periods[periods > 0.0]  # the clock may be set back
    rate, gaps, longest = None, 0, 0.0
    if len(times) >= _FEWEST and len(periods):
        median = float(np.median(periods))
        long = periods[periods > GAP * median]
        rate, gaps, longest = 1.0 / median, len(long), float(long.max(initial=0.0))
    return TopicSummary(name, kind, part, len(times), tuple(joints), rate, gaps, longest)
