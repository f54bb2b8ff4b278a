"""When something happened: counted exactly, and kept in bounded memory."""

import numpy as np

from gear_kinematics.validation.occurrences import Occurrences


def test_instants_and_spans_are_kept_apart():
    found = Occurrences()
    found.add(np.array([50, 10]))
    found.add_spans(np.array([20]), np.array([30]))
    assert (found.count, found.first) == (3, 50)
    assert found.spans.tolist() == [[10, 10], [20, 30], [50, 50]]


def test_nothing_is_no_occurrence():
    found = Occurrences()
    found.add(np.zeros(0, np.int64))
    found.add_all(Occurrences())
    assert (found.count, found.first, found.spans.tolist()) == (0, None, [])


def test_overlapping_spans_are_one():
    found = Occurrences()
    found.add_spans(np.array([0, 5, 40]), np.array([20, 10, 50]))
    assert found.spans.tolist() == [[0, 20], [40, 50]]


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


def test_those_of_another_are_taken_over():
    one, other = Occurrences(), Occurrences()
    other.add(np.array([7, 9]))
    one.add_all(other)
    assert (one.count, one.first, one.spans.tolist()) == (2, 7, [[7, 7], [9, 9]])
    one.add_all(other)
    assert (one.count, one.first) == (4, 7)
