# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
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
    source: Bag, topics: Collection[str], rate: float, *, loop: bool = False
) -> Iterator[tuple[float, Message]]:
    """Yield messages with the time at which each is due, s from the first; see `play`.

    Raises:
        BagError: at once, if there is nothing to play; later for damage.
        ValueError: at once, if the rate is not positive and finite.
    """
    if not 0.0 < rate < math.inf:
        raise ValueError(f'rate must be positive and finite, but is {rate:g}')

    def rounds() -> Iterator[tuple[float, Message]]:
        due = start = 0.0
        while True:
            count = 0
            for elapsed, message in _one_round(source, topics):
                due = start + elapsed / (rate * SECOND)
                count += 1
                yield due, message
            if not loop:
                return
            # A loop that takes no time, such as a single message, is repeated every second.
            start = due + ((due - start) / max(count - 1, 1) or 1.0 / rate)

    messages = rounds()
    return chain([next(messages)], messages)


def count_due(source: Bag, topics: Collection[str]) -> int | None:
    """Count the messages of one round of `due_messages`, by reading all; None without any."""
    count = 0
    with suppress(BagError):  # playing them raises it, too
        for _ in _one_round(source, topics):
            count += 1
    return count or None


def _one_round(source: Bag, topics: Collection[str]) -> Iterator[tuple[int, Message]]:
    """Yield messages with the time since the first one, ns."""
    begin, last = None, 0
    for message in source.messages(topics):
        _, received, _ = message
        if begin is None or received < last:  # the clock of the recorder was reset
            begin = received - (last - begin if begin is not None else 0)
        last = received
        yield received - begin, message
    if begin is None:
        raise BagError(f'{source.path}: nothing to play on {", ".join(topics)}')


def throttled(progress: ReportProgress) -> ReportProgress:
    """Limit the calls to ten a second."""
    next_call = 0.0

    def call(done: int, total: int | None) -> None:
        nonlocal next_call
        if (now := time.monotonic()) >= next_call:
            next_call = now + _PROGRESS_PERIOD
            progress(done, total)

    return call
