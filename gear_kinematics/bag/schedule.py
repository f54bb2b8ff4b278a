"""When which of a bag's messages is due in a replay, and when to tell of it; no ROS."""

import math
import time
from collections.abc import Callable, Collection, Iterator
from itertools import chain

from gear_kinematics.bag import Bag, BagError, RawMessage, listed
from gear_kinematics.wire.cdr import SECOND

_PROGRESS_PERIOD = 0.1  # s


def due_messages(
    source: Bag,
    topics: Collection[str],
    rate: float,
    start_offset: float = 0.0,
    duration: float = math.inf,
    *,
    loop: bool = False,
) -> Iterator[tuple[float, RawMessage]]:
    """Give messages with the time at which each is due, s from the first; see `play`.

    Raises:
        BagError: at once, if there is nothing to play; for damage behind what can be read.
        ValueError: at once, if the rate is out of its range.
    """
    if not 0.0 < rate < math.inf:
        raise ValueError(f'rate must be positive and finite, but is {rate:g}')
    rounds = _rounds(source, topics, rate, start_offset, duration, loop=loop)
    return chain([next(rounds)], rounds)


def _rounds(
    source: Bag,
    topics: Collection[str],
    rate: float,
    start_offset: float,
    duration: float,
    *,
    loop: bool,
) -> Iterator[tuple[float, RawMessage]]:
    due = round_start = 0.0
    while True:
        first, begin, count = None, 0, 0
        for message in source.messages(topics):
            _, received, _ = message
            if first is None:
                first = received
            elapsed = received - first - start_offset * SECOND + 0.5  # ns; half of one to round
            if elapsed > duration * SECOND + 1.0:
                break
            if elapsed < 0.0:
                continue
            if count == 0:
                begin = received
            due = round_start + (received - begin) / (rate * SECOND)
            count += 1
            yield due, message
        if count == 0:
            raise BagError(f'{source.path}: nothing to play on {", ".join(topics)}')
        if not loop:
            return
        # What takes no time, such as a single message, comes every second.
        round_start = due + ((due - round_start) / max(count - 1, 1) or 1.0 / rate)


def type_of(source: Bag, topic: str) -> str:
    """Give the type of a topic.

    Raises:
        BagError: if it is not in the bag.
    """
    try:
        return source.topics[topic]
    except KeyError:
        there = listed(source.topics) or 'no topics'
        raise BagError(f'{source.path}: no {topic} in it; there are {there}') from None


def throttled(progress: Callable[[int], None]) -> Callable[[int], None]:
    """The same, at most ten times a second."""
    next_call = 0.0

    def call(count: int) -> None:
        nonlocal next_call
        if (now := time.monotonic()) >= next_call:
            next_call = now + _PROGRESS_PERIOD
            progress(count)

    return call
