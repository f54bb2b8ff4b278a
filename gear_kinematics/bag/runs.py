# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Runs of a recording: what was recorded until its clock began anew.

Under `ros2 bag record --use-sim-time`, times of reception are those of a simulation, and begin
anew when it is reset. The messages of both runs then have the same times, and stay in their order.
"""

from collections.abc import Hashable, Iterable

import numpy as np
from numpy.typing import NDArray

from gear_kinematics.wire.joint_reader import CLOCK_RESET

Array = NDArray[np.int64]

_MIXED = 10  # changes of run in the order of time, for each start and topic, that are not mixed


def starts_of_runs(
    messages: Iterable[tuple[Hashable, int]], *, mixed: bool = True, after: int = 0
) -> list[int]:
    """Return the numbers of messages, as recorded, that begin another run; mostly none.

    Messages are given by topic and time of reception, ns. The times of a topic fall there by more
    than a second. Those before and after are `mixed`, or some are earlier by as much than `after`,
    the time, ns, at which the file before this one ends. Otherwise messages, or chunks of them,
    are only out of order, and belong together.
    """
    numbers = dict[Hashable, int]()
    rows = ((numbers.setdefault(topic, len(numbers)), received) for topic, received in messages)
    topic, times = np.fromiter(rows, np.dtype((np.int64, 2))).T
    by_topic = np.argsort(topic, kind='stable')
    fell = (np.diff(times[by_topic]) < -CLOCK_RESET) & (np.diff(topic[by_topic]) == 0)
    starts = list[int]()
    for at, before in sorted(zip(by_topic[1:][fell], by_topic[:-1][fell], strict=True)):
        if not starts or before >= starts[-1]:  # otherwise another topic begins the same run
            starts.append(int(at))
    if not (starts and mixed) or times.min() < after - CLOCK_RESET:
        return starts
    run = np.searchsorted(starts, np.arange(len(times)), side='right')
    by_time = np.lexsort((times, topic))
    changes = (np.diff(run[by_time]) != 0) & (np.diff(topic[by_time]) == 0)
    fallen = len({*topic[by_topic[1:][fell]].tolist()})
    return starts if np.count_nonzero(changes) > _MIXED * len(starts) * fallen else []


def may_restart(indexes: Iterable[tuple[Hashable, Array]]) -> bool:
    """Return whether times of a topic fall in the order of recording, or none are given.

    Times, (n,), ns, are given with their topic.
    """
    last: dict[Hashable, np.int64] = {}
    for topic, times in indexes:
        if np.any(np.diff(times, prepend=last.get(topic, times[0])) < -CLOCK_RESET):
            return True
        last[topic] = times[-1]
    return not last
