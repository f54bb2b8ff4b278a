# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""When the messages of a bag are due in a replay."""

from itertools import islice

import pytest

from gear_kinematics.bag.schedule import due_messages
from gear_kinematics.wire.cdr import SECOND


class Source:
    """A bag with messages at some times, s."""

    path = 'source'

    def __init__(self, times) -> None:
        self._times = times

    def messages(self, topics):
        yield from ((topics[0], round(time * SECOND), b'') for time in self._times)


def schedule(times, **options) -> list[tuple[float, float]]:
    found = islice(due_messages(Source(times), ['/x'], **{'rate': 1.0} | options), 10)
    return [(pytest.approx(due, abs=1e-9), received / SECOND) for due, (_, received, _) in found]


@pytest.mark.parametrize(('options', 'expected'), [
    ({}, [(0.0, 5.0), (1.0, 6.0), (1.5, 6.5), (4.0, 9.0)]),
    ({'rate': 2.0}, [(0.0, 5.0), (0.5, 6.0), (0.75, 6.5), (2.0, 9.0)]),
], ids=str)  # fmt: skip
def test_due_times(options, expected):
    assert schedule([5.0, 6.0, 6.5, 9.0], **options) == expected


def test_messages_are_due_one_after_another_where_the_time_of_a_recording_begins_anew():
    again = [(0.0, 5.0), (1.0, 6.0), (1.0, 0.0), (1.5, 0.5), (7.5, 6.5)]
    assert schedule([received for _, received in again]) == again


@pytest.mark.parametrize(('times', 'options', 'due'), [
    ([5.0, 6.0, 7.0], {}, [0, 1, 2, 3, 4, 5, 6, 7, 8, 9]),
    ([5.0, 6.0, 7.0], {'rate': 2.0}, [0, 0.5, 1, 1.5, 2, 2.5, 3, 3.5, 4, 4.5]),
    ([5.0], {'rate': 4.0}, [0, 0.25, 0.5, 0.75, 1, 1.25, 1.5, 1.75, 2, 2.25]),
], ids=str)  # fmt: skip
def test_a_loop_restarts_after_a_mean_period(times, options, due):
    assert [moment for moment, _ in schedule(times, loop=True, **options)] == due
