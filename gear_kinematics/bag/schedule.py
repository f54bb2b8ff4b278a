"""The time at which each message is due in a replay, without ROS."""

import math
import time
from collections.abc import Collection, Iterator
from contextlib import suppress
from itertools import chain

from gear_kinematics.bag import Bag, BagError, Message, ReportProgress
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
) -> Iterator[tuple[float, Message]]:
    """Yield messages with the time at which each is due, s from the first; see `play`.

    Raises:
        BagError: at once, if there is nothing to play; later for damage.
        ValueError: at once, if the rate is not positive and finite.
    """
    if not 0.0 < rate < math.inf:
        raise ValueError(f'rate must be positive and finite, but is {rate:g}')
    rounds = _rounds(source, topics, rate, start_offset, duration, loop=loop)
    return chain([next(rounds)], rounds)


def count_due(
    source: Bag, topics: Collection[str], start_offset: float = 0.0, duration: float = math.inf
) -> int | None:
    """Count the messages of one round of `due_messages`; None if there are none.

    That takes reading them all.
    """
    count = 0
    with suppress(BagError):  # which playing them raises, too
        for _ in due_messages(source, topics, 1.0, start_offset, duration):
            count += 1
    return count or None


def _rounds(
    source: Bag,
    topics: Collection[str],
    rate: float,
    start_offset: float,
    duration: float,
    *,
    loop: bool,
) -> Iterator[tuple[float, Message]]:
    due = round_start = 0.0
    while True:
        first, begin, count = None, 0, 0
        for message in source.messages(topics):
            _, received, _ = message
            if first is None:
                first = received
            elapsed = received - first - start_offset * SECOND + 0.5  # ns, rounded
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
        # A loop that takes no time, such as a single message, is repeated every second.
        round_start = due + ((due - round_start) / max(count - 1, 1) or 1.0 / rate)


def throttled(progress: ReportProgress) -> ReportProgress:
    """Limit the calls to ten a second."""
    next_call = 0.0

    def call(done: int, total: int | None) -> None:
        nonlocal next_call
        if (now := time.monotonic()) >= next_call:
            next_call = now + _PROGRESS_PERIOD
            progress(done, total)

    return call
