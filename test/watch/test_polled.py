# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Rates of polled subscriptions, from the times at which the middleware received messages."""

from contextlib import nullcontext
from itertools import cycle
from types import SimpleNamespace

import pytest

pytest.importorskip('rclpy', reason='rclpy is not installed')

from gear_kinematics.watch.polled import Polled

MS = 1_000_000


class Handle(nullcontext):
    """The queue of a middleware with messages that were received at given times, ms."""

    def __init__(self, times, numbers=(None,)):
        super().__init__()
        self.queue = [
            (
                bytes([time % 2]),
                {
                    'received_timestamp': MS * time,
                    'source_timestamp': 0,
                    'publication_sequence_number': number,
                },
            )
            for time, number in zip(times, cycle(numbers), strict=False)
        ]

    def take_message(self, _type, _raw):
        return self.queue.pop(0) if self.queue else None


@pytest.mark.parametrize(
    ('times', 'wanted', 'count', 'rate'),
    [
        (range(7000, 7101, 10), bool, 11, 100.0),
        (range(7000, 7101, 5), lambda data: data == b'\0', 11, 100.0),  # every other message
        ([7000], bool, 1, 0.0),
        ([7001, 7000], bool, 2, 0.0),  # the latest of two publishers, in any order
        ([], bool, 0, 0.0),
    ],
)
def test_mean_rate_is_that_of_the_wanted_messages_whenever_they_are_taken(
    times, wanted, count, rate
):
    polled = polling(Handle(times), wanted)
    assert len(polled.take()) == count
    assert polled.take() == []
    assert polled.count == count
    assert polled.mean_rate == pytest.approx(rate)


@pytest.mark.parametrize(('numbers', 'lost'), [((1, 2, 5, 9), 5), ((None,), 0)])
def test_lost_messages_are_counted_where_they_are_numbered(numbers, lost):
    polled = polling(Handle(range(4), numbers))
    polled.take()
    assert polled.lost == lost
    polled.losses.numbered = False  # as with two publishers
    assert polled.lost == 0


def polling(handle, wanted=bool):
    subscription = SimpleNamespace(handle=handle, msg_type=None, raw=True)
    node = SimpleNamespace(create_subscription=lambda *_, **__: subscription)
    return Polled(node, '/motor', wanted=wanted)
