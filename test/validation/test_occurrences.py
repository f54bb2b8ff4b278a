# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""When something happened: counted exactly, and kept in bounded memory."""

import numpy as np

from gear_kinematics.validation.occurrences import Occurrences


def test_instants_and_spans_that_overlap_are_one():
    found, other = Occurrences(), Occurrences()
    found.add_all(other)
    found.add(np.array([50, 10]))
    found.add_spans(np.array([20, 25]), np.array([30, 27]))
    other.add(np.array([7, 50]))
    found.add_all(other)
    assert (found.count, found.first) == (6, 50)
    assert found.spans.tolist() == [[7, 7], [10, 10], [20, 30], [50, 50]]


def test_of_many_the_nearest_are_joined_and_all_counted():
    """Ten bursts of a thousand, a second from one another; within them 1 ms."""
    bursts = [1_000_000_000 * k + 1_000_000 * np.arange(1000) // 2 for k in range(10)]
    found = Occurrences()
    for stamps in bursts:
        found.add(stamps)
    assert found.count == 10_000
    assert len(found.spans) <= 400
    covered = [
        any(start <= stamp <= end for start, end in found.spans.tolist())
        for stamps in bursts
        for stamp in stamps[::97].tolist()
    ]
    assert all(covered)
    assert (np.diff(found.spans.ravel())[1::2] > 0).all()
    # The pauses between bursts are still there.
    assert sum(np.diff(found.spans.ravel())[1::2] > 400_000_000) == 9
