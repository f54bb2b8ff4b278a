# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Readings that the rotor cannot have reached, injected into motions within its limits."""

import math
from contextlib import suppress
from copy import deepcopy
from dataclasses import replace
from functools import cache
from unittest.mock import ANY

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from live import SECOND, rotor_bytes

from gear_kinematics.parameters import NodeParameters
from gear_kinematics.state.belief import BELIEVED, Belief
from gear_kinematics.state.plausibility import Plausibility
from gear_kinematics.state.reach import STALEST
from gear_kinematics.state.rotor_input import RotorInput
from gear_kinematics.state.statuses import Condition
from gear_kinematics.wire.joint_reader import RejectedInputError

MULTI = NodeParameters.load()
SINGLE = replace(MULTI, rotor_encoder='single_turn')
TURN = 2.0 * math.pi
START = 100 * SECOND
LIMITS = 650.0, 6500.0  # rad/s and rad/s², the defaults
RATES = (10, 25, 50, 100, 200, 500, 1000)
KINDS = (
    *('exact', 'quantised', 'hall', 'early', 'late', 'burst', 'bursts'),
    *('held', 'old', 'noisy', 'gaps'),
)


def motion(rate: int, count: int, generator) -> tuple[np.ndarray, np.ndarray]:
    """Times, s, and angles, rad, of random accelerations within the limits."""
    inner = max(1, math.ceil(1000 / rate))
    step, speed, angle = 1.0 / rate / inner, 0.0, 0.0
    angles, acceleration = [], 0.0
    for n in range(count * inner):
        if n % 40 == 0:
            acceleration = generator.choice([-1.0, 0.0, 1.0]) * LIMITS[1] * generator.random()
        faster = max(-LIMITS[0], min(speed + acceleration * step, LIMITS[0]))
        angle += 0.5 * (speed + faster) * step
        speed = faster
        if n % inner == 0:
            angles.append(angle)
    return np.arange(count) / rate, np.array(angles)


@cache
def drive(rate: int, seed: int) -> tuple[np.ndarray, np.ndarray, np.random.Generator]:
    """300 readings of a motion, and the generator that goes on from there."""
    generator = np.random.default_rng([seed, rate])
    return *motion(rate, 300, generator), generator


def disturbed(kind, times, angles, rate, generator) -> tuple[np.ndarray, np.ndarray]:
    """What real drivers do with them."""
    count = len(times)
    if kind == 'quantised':
        angles = np.round(angles / 0.01) * 0.01
    elif kind == 'hall':
        angles = np.floor(angles * 6.0 / TURN) * TURN / 6.0
    elif kind == 'early':
        times = times + generator.uniform(0.0, min(0.9 / rate, 2e-3), count)
    elif kind == 'late':
        times = np.maximum.accumulate(times + (generator.random(count) < 0.05) * 3e-3)
    elif kind == 'burst':  # stamped on arrival, after they were held up
        times, gap = times.copy(), generator.uniform(1.0, 5.0) / rate
        for start in generator.choice(times[1:], 3):
            held = (times >= start) & (times < start + gap)
            times[held] = start + gap + 5e-5 * np.arange(np.count_nonzero(held))
        times = np.maximum.accumulate(times)
    elif kind == 'bursts':  # the same, all, as by a USB adapter
        of, n = generator.integers(1, 2 + rate // 50), np.arange(count)
        times = n // of * of / rate + generator.uniform(0.0, 1e-4) * (n % of)
    elif kind == 'held':
        angles = angles[np.arange(count) // max(1, rate // 100) * max(1, rate // 100)]
    elif kind == 'repeated':
        angles = angles[np.arange(count) // 2 * 2]
    elif kind == 'old':  # by up to an interval, with stamps on a grid
        older = generator.uniform(0.0, min(0.01, 1.0 / rate), count)
        angles = np.interp(times - older, times, angles)
    elif kind == 'single':  # precision, of a Hall sensor
        angles = np.float32(np.floor(angles * 24.0 / TURN) * TURN / 24.0).astype(float)
    elif kind == 'noisy':
        angles = angles + generator.normal(0.0, 0.01, count)
    elif kind == 'gaps':
        kept = generator.random(count) < 0.8
        times, angles = times[kept], angles[kept]
    return times, angles


def messages(times, angles) -> list[bytes]:
    stamps = START + np.round(np.asarray(times) * SECOND).astype(np.int64)
    return [rotor_bytes(int(s), position=[float(a)]) for s, a in zip(stamps, angles, strict=True)]


def fed(parameters, batch) -> tuple[RotorInput, list]:
    """The input after the messages, and its samples; None for one that was rejected."""
    rotor, samples = RotorInput(parameters), []
    for data in batch:
        try:
            samples.append(rotor.accept(data, int))
        except RejectedInputError:
            samples.append(None)
    assert set(rotor.rejected) <= {'implausible'}
    return rotor, samples


def state_of(judge) -> dict:
    """All but what makes it faster."""
    return vars(judge) | {
        '_even': None,
        'noise': pytest.approx(judge.noise, abs=2e-8),
        '_last': judge._last[1:],
        '_former': judge._former[2:],
        'alternation': repr(judge.alternation),  # NaN equals NaN
    }


def complaints(rotor, taken_back=0) -> tuple:
    judge = rotor.plausibility
    assert judge.alternation.fact is None
    assert judge.alternation.taken_back == taken_back
    return rotor.rejected, judge.jumped, judge.beyond_limits


@pytest.mark.parametrize('unit', [1.0, TURN, math.radians(1.0)])
@pytest.mark.parametrize('start', [3e5, 3e6, -2e6])
def test_positions_of_single_precision_are_named_where_they_are_coarse(start, unit):
    """They have 24 bits: beyond 2^20 units a step is an eighth of a unit or more."""
    times = np.arange(500) / 500.0
    angles = start * unit + 100.0 * np.sin(times)
    single = np.float32(angles / unit).astype(float) * unit
    step = float(np.spacing(np.float32(abs(start)))) * unit
    for positions, named in ((single, step > 0.05), (angles, False)):
        rotor, _ = fed(MULTI, messages(times, positions))
        coarse = Condition.BEYOND_PRECISION(angle=step)
        found = rotor.plausibility.beyond_limits
        assert (found.values['which'] if found else []) == [coarse] * named
        assert not found or 'count turns in double precision' in found.advice


@pytest.mark.parametrize('kind', KINDS)
@pytest.mark.parametrize('rate', RATES)
def test_no_motion_within_the_limits_is_doubted(kind, rate):
    for seed in range(3):
        *moved, generator = drive(rate, seed)
        times, angles = disturbed(kind, *moved, rate, deepcopy(generator))
        rotor, _ = fed(MULTI, messages(times, angles))
        assert complaints(rotor) == ({}, None, None)
        rotor, _ = fed(SINGLE, messages(times, np.mod(angles, TURN)))
        assert complaints(rotor) == ({}, None, None)


@pytest.mark.parametrize('unit', [1.0, TURN, math.radians(1.0)])
@pytest.mark.parametrize('steps', [6, 24, 42])
@pytest.mark.parametrize('rate', RATES)
def test_hall_sensors_whose_angle_is_of_single_precision_are_believed(rate, steps, unit):
    """Rounding makes their steps unequal, which tells nothing of their resolution."""
    for seed, far in ((0, 0), (1, -5000), (2, 100)):
        times, angles, _ = drive(rate, seed)
        counts = far + np.floor(angles * steps / TURN)
        for parameters, each in ((MULTI, counts), (SINGLE, counts % steps)):
            if parameters is SINGLE and rate < 500:
                continue  # the rotor can turn half a turn between two readings, or a whole one
            single = np.float32(each * TURN / steps / unit).astype(float) * unit
            rotor, _ = fed(parameters, messages(times, single))
            assert complaints(rotor) == ({}, None, None)


@settings(max_examples=50)
@given(
    st.sampled_from([10, 100, 1000]),
    st.integers(0, 2**32),
    st.sampled_from([-1e9, -1500.0, -150.0, 150.0, 1e5]),
)
def test_a_corrupt_reading_gives_no_output_and_changes_nothing(rate, seed, size):
    size *= max(1.0, 100.0 / rate)  # a rotor turns far between few readings
    generator = np.random.default_rng(seed)
    times, angles = motion(rate, 40, generator)
    bad = int(generator.integers(5, 38))
    right, expected = fed(MULTI, messages(times, angles))
    angles[bad] += size
    rotor, samples = fed(MULTI, messages(times, angles))
    assert rotor.rejected == {'implausible': 1}
    assert samples[bad] is None
    assert [s for s in samples if s] == expected[:bad] + expected[bad + 1 :]
    assert rotor.referenced
    assert rotor.segment == right.segment


@pytest.mark.parametrize('batch', [1, 37, 400])
@pytest.mark.parametrize('speed', [0.0, 5.0, 40.0])
@pytest.mark.parametrize(('rate', 'size'), [(50, -6.0), (100, 2.0), (200, -1.0)])
def test_a_wrong_reading_that_the_rotor_could_reach_is_said_once_it_is_taken_back(
    rate, size, speed, batch
):
    """In two of its intervals and 20 ms, it cannot go so far and return, by 6500 rad/s²."""
    times = np.arange(400) / rate
    angles = speed * times + 0.001 * (np.arange(400) % 2)
    angles[200] += size
    data = messages(times, angles)
    rotor = RotorInput(MULTI)
    for first in range(0, 400, batch):
        rotor.accept_batch(data[first : first + batch], [0] * len(data[first : first + batch]))
    assert complaints(rotor, taken_back=1) == ({}, None, None)
    angle = pytest.approx(size, abs=1.1 * speed / rate + 2e-3)
    time = START / SECOND + 200 / rate
    assert rotor.disorder.fault == Condition.TAKEN_BACK(count=1, angle=angle, time=time)


@pytest.mark.parametrize('rate', [50, 100, 200])
@pytest.mark.parametrize('acceleration', [100.0, 6500.0])
def test_a_wrong_reading_at_rest_is_said_from_the_documented_bound_on(acceleration, rate):
    """The bound of docs/trust.md; for the lower acceleration, most of it is that of the noise."""
    time = 1.0 / rate + min(1.25 / rate, 0.01)
    bound = 0.5 * acceleration * time * time + 0.1625
    for share in (0.95, 1.05):
        angles = 0.001 * (np.arange(100) % 2)
        angles[60] += share * bound
        settings = replace(MULTI, max_rotor_acceleration=acceleration)
        rotor, _ = fed(settings, messages(np.arange(100) / rate, angles))
        assert complaints(rotor, taken_back=int(share > 1.0)) == ({}, None, None)


def test_a_quick_motion_there_and_back_is_not_taken_back():
    """It takes 40 ms and turns by 0.65 rad, with the greatest acceleration."""
    for rate in (25, 50, 100, 500):
        for phase in np.linspace(0.0, 1.0 / rate, 9):
            times = phase + np.arange(rate) / rate
            since = np.clip(times - 0.5, 0.0, 0.04)
            since = np.minimum(since, 0.04 - since)  # by symmetry
            angles = np.where(since < 0.01, since**2, 2e-4 - (0.02 - since) ** 2)
            rotor, _ = fed(MULTI, messages(times, 0.5 * LIMITS[1] * angles))
            assert complaints(rotor) == ({}, None, None)


@pytest.mark.parametrize('acceleration', [60.0, -180.0])
def test_a_reading_with_the_stamp_of_the_one_before_is_not_taken_back(acceleration):
    """The gear accelerates slowly, and its stamps, at 50 Hz, are cut off to whole intervals."""
    number = np.arange(100)
    stamps = number - (number % 30 == 20)
    slow = replace(MULTI, max_rotor_acceleration=200.0)
    rotor, _ = fed(slow, messages(stamps / 50, 0.5 * acceleration * (number / 50) ** 2))
    assert complaints(rotor) == ({}, None, None)


@pytest.mark.parametrize('size', [1.0, -2.0, 3.0, 0.5])
def test_a_corrupt_reading_of_a_single_turn_encoder_loses_no_turn(size):
    times, angles = motion(1000, 400, np.random.default_rng(5))
    batch = messages(times, np.mod(angles, TURN))
    rotor, samples = RotorInput(SINGLE), []
    for n, data in enumerate(batch):
        if n % 50 == 49:
            wrong = messages(times[n : n + 1], np.mod(angles[n : n + 1] + 4.0 * size, TURN))
            with pytest.raises(RejectedInputError, match='implausible'):
                rotor.accept(wrong[0], int)
            continue
        samples.append((rotor.accept(data, int), angles[n]))
        if n == 0:
            rotor.home(0.0)
    assert rotor.referenced
    for sample, angle in samples[1:]:
        position = TURN * sample.position.turns + sample.position.angle
        assert position == pytest.approx(angle - angles[0], abs=1e-9)


@pytest.mark.parametrize('rate', [10, 100, 1000])
@pytest.mark.parametrize('size', [100.0, -1000.0])
def test_a_jump_that_stays_is_named_and_ends_the_reference(rate, size):
    times = np.arange(30) / rate
    angles = np.where(np.arange(30) < 20, 1.0, 1.0 + size)
    rotor, samples = fed(MULTI, messages(times, angles))
    assert rotor.rejected == {'implausible': 2}
    assert [n for n, sample in enumerate(samples) if sample is None] == [20, 21]
    jumped = Condition.JUMPED(angle=pytest.approx(size), time=pytest.approx(100.0 + times[20]))
    assert rotor.plausibility.jumped == jumped
    assert not rotor.referenced
    assert rotor.segment == 1
    rotor.home(0.0)
    assert rotor.referenced


@pytest.mark.parametrize('gap', [1.5, 2.0, 5.0])
def test_a_jump_within_a_long_gap_that_no_speed_explains_is_named(gap):
    times = np.append(np.arange(500) / 500, 1.0 + gap + np.arange(50) / 500)
    size = 2.0 * LIMITS[0] * gap
    angles = 50.0 * times + size * (times > 1.0)
    rotor, _ = fed(MULTI, messages(times, angles))
    jumped = Condition.JUMPED(angle=pytest.approx(size), time=pytest.approx(101.0 + gap))
    assert rotor.plausibility.jumped == jumped
    assert not rotor.referenced


@pytest.mark.parametrize(('before', 'size', 'lost'), [
    (1_700_000_000, -50.0, True), (1_700_000_000, 0.0, False), (500, -50.0, False),
])  # fmt: skip
def test_a_drive_elsewhere_whose_stamps_become_the_time_since_its_start_has_jumped(
    before, size, lost
):
    data = [
        rotor_bytes(start * SECOND + k * SECOND // 100, position=[zero + 0.5 * k])
        for start, zero in ((before, 0.0), (1, 50.0 + size))
        for k in range(100)
    ]
    rotor, whole = RotorInput(MULTI), RotorInput(MULTI)
    for each in data:
        rotor.accept(each, int)
    whole.accept_batch(data, [*range(len(data))])
    jumped = Condition.JUMPED(angle=pytest.approx(size, abs=0.6), time=1.0)
    for each in (rotor, whole):
        assert each.resets == 1
        assert each.referenced is not lost
        assert each.plausibility.jumped == (jumped if lost else None)


def test_a_single_turn_encoder_has_not_jumped_where_its_drive_restarts():
    rotor = RotorInput(SINGLE)
    for start, zero in ((1_700_000_000, -2.0), (1, 0.0)):
        for k in range(100):
            stamp, position = start * SECOND + k * SECOND // 100, zero + 0.01 * k
            rotor.accept(rotor_bytes(stamp, position=[position]), int)
    assert rotor.resets == 1
    assert not rotor.referenced
    assert rotor.plausibility.jumped is None


@pytest.mark.parametrize('rest', [5, 8, 15])
def test_a_rotor_that_trembles_between_moves_by_a_turn_does_not_wrap(rest):
    generator = np.random.default_rng(rest)
    count = TURN / 4096
    moved = TURN * (np.arange(20_000) // rest % 2)
    angles = moved + count * generator.integers(-1, 2, len(moved))
    rotor, _ = fed(MULTI, messages(np.arange(len(moved)) / 10, angles))
    assert rotor.referenced
    assert rotor.plausibility.jumped is None


@pytest.mark.parametrize('wrong', [0.0, 1.2, -1.5, 2.0])
def test_a_wrong_reading_in_a_burst_is_out_of_reach_at_the_speed_before_it(wrong):
    """At 40 rad/s and 500 Hz the driver is held up for 11 ms; then 5 readings come at once.

    In 16 ms the rotor can reach 141 rad/s, and 0.5 rad more in 4.5 ms than at 40 rad/s in 2 ms; a
    reading has a noise of 0.16 rad, as no finer steps were seen.
    """
    arrivals = [START + 2_000_000 * k for k in range(100)]
    arrivals += [arrivals[-1] + 11_000_000 + 10_000 * k for k in range(5)]
    judge = Plausibility(*LIMITS)
    beliefs = [
        judge.judge(0.08 * k + (wrong if k == 103 else 0.0), stamp)
        for k, stamp in enumerate(arrivals)
    ]
    assert beliefs.pop(103) is (Belief.IMPLAUSIBLE if wrong else BELIEVED)
    assert {*beliefs} == {BELIEVED}


@pytest.mark.parametrize('first', range(100, 113))
@pytest.mark.parametrize('held', [[5], [5, 37], [37, 5]])
def test_readings_that_were_held_up_are_believed_at_each_phase_of_a_motion(first, held):
    """The rotor oscillates with up to 100 rad/s and 2500 rad/s², and 50 readings in a second.

    They come at once after the driver was held up, or soon after that again.
    """
    times = 0.02 * np.arange(200)
    arrivals = times.copy()
    for count in held:
        burst = slice(first, first + count)
        arrivals[burst] = times[first + count] - 5e-6 * np.arange(count, 0, -1)
        first += count + 3
    judge = Plausibility(*LIMITS)
    for angle, stamp in zip(4.0 * np.sin(25.0 * times), np.round(arrivals * SECOND), strict=True):
        assert judge.judge(float(angle), START + int(stamp)) is BELIEVED


@pytest.mark.parametrize('first', range(100, 106))
@pytest.mark.parametrize(('rate', 'repeated', 'held'), [(500, 2, 7), (200, 3, 4), (200, 2, 12)])
def test_readings_that_a_driver_repeats_are_believed_in_a_burst(rate, repeated, held, first):
    times = np.arange(2 * rate) / rate
    arrivals = times.copy()
    arrivals[first : first + held] = times[first + held] - 5e-5 * np.arange(held, 0, -1)
    read = times[np.arange(2 * rate) // repeated * repeated]
    angles = 300.0 * read + 5.0 * np.sin(20.0 * read)
    rotor, _ = fed(MULTI, messages(arrivals, angles))
    assert complaints(rotor) == ({}, None, None)
    wrong = np.where(np.arange(2 * rate) >= first + held // 2, angles + 60.0, angles)
    assert fed(MULTI, messages(arrivals, wrong))[0].plausibility.jumped


def test_an_encoder_that_is_stuck_is_named_after_a_burst_and_a_clock_that_was_set_back():
    times = np.arange(350) / 500
    arrivals = times.copy()
    arrivals[99:111] = times[111] - 5e-5 * np.arange(12, 0, -1)  # each reading comes twice
    arrivals[120:] -= 0.5
    read = times[np.minimum(np.arange(350) // 2 * 2, 300)]
    angles = 400.0 * read + 5.0 * np.sin(20.0 * read)
    judge = Plausibility(*LIMITS)
    for n, (angle, stamp) in enumerate(zip(angles.tolist(), arrivals.tolist(), strict=True)):
        if n == 120:
            judge.set_back(SECOND // 2)
        verdict = judge.judge(angle, START + round(stamp * SECOND))
        assert n > 300 or verdict is BELIEVED
    assert judge.beyond_limits


def test_a_reading_is_repeated_where_stamps_of_a_coarse_clock_are_the_same():
    """The clock ticks each 10 ms, less or more than 1 ns."""
    times = 0, 10_000_001, 10_000_001, 20_000_000, 30_000_001, 40_000_000, 40_000_000, 50_000_001
    judge = Plausibility(300.0, 500.0, TURN)
    for time, steps in zip((*times, times[-1]), (0, 0, 1, 2, 3, 4, 5, 5, 5), strict=True):
        assert judge.judge(1.8 * steps % TURN, START + time) is BELIEVED


@pytest.mark.parametrize('period', [2_000_000, 500_000])
def test_a_wrong_reading_in_a_second_burst_is_out_of_reach(period):
    """The driver is held up twice, for 11 ms; the rotor can turn 2.9 rad within 4.5 ms."""
    arrivals = [START + period * k for k in range(400)]
    for regular in (3, 0):
        arrivals += [arrivals[-1] + 11_000_000 + 10_000 * k for k in range(5)]
        arrivals += [arrivals[-1] + period * k for k in range(1, 1 + regular)]
    judge = Plausibility(*LIMITS)
    beliefs = [judge.judge(0.08 * k + 3.5 * (k == 411), stamp) for k, stamp in enumerate(arrivals)]
    assert [k for k, each in enumerate(beliefs) if each is not BELIEVED] == [411]


@pytest.mark.parametrize('first', range(8))
@pytest.mark.parametrize(('limit', 'after'), [(650.0, 0), (28.0, -15_000_000)])
def test_a_rotor_that_starts_while_its_driver_is_held_up_is_believed(first, limit, after):
    """At rest, it was read each 20 ms; then 8 readings come at once, and further ones."""
    n = np.arange(32)
    times = 0.02 * (n - 20 - first).clip(0)
    held_up = (n >= 20) & (n < 28)
    stamps = START + 20_000_000 * np.where(held_up, 27, n) + n
    stamps[28:] += after
    judge = Plausibility(limit, LIMITS[1])
    assert judge.judge(0.001, START - SECOND) is BELIEVED
    for stamp, angle in zip(stamps, np.minimum(1500.0 * times, 20.0) * times, strict=True):
        assert judge.judge(float(angle), int(stamp)) is BELIEVED


@pytest.mark.parametrize('first', range(5))
def test_a_rotor_that_starts_within_a_burst_is_believed(first):
    """Each 0.1 s come 5 readings that were taken 20 ms apart."""
    n = np.arange(40)
    times = 0.02 * (n - 25 - first).clip(0)
    judge = Plausibility(*LIMITS)
    assert judge.judge(0.001, START - SECOND) is BELIEVED
    for stamp, angle in zip(START + 100_000_000 * (n // 5) + n, 3000.0 * times**2, strict=True):
        assert judge.judge(float(angle), int(stamp)) is BELIEVED


@pytest.mark.parametrize('speed', [49.97, 599.97])
@pytest.mark.parametrize('lost', [202, 210, 219])
def test_a_reading_that_is_lost_in_a_burst_makes_no_other_one_a_jump(speed, lost):
    """At 1 kHz, 20 readings come at once after the driver was held up."""
    n = np.arange(400)
    held_up = (n >= 200) & (n < 220)
    stamps = START + np.where(held_up, 219_500_000 + 20_000 * (n - 200), 1_000_000 * n)
    judge = Plausibility(*LIMITS)
    for k in np.delete(n, lost).tolist():
        assert judge.judge(round(speed * 1e-3 * k, 3), int(stamps[k])) is BELIEVED


@pytest.mark.parametrize(('period', 'count', 'apart'), [
    (0.001, 256, 60_000), (0.001, 16, 60_000), (0.02, 3, 400_000), (0.04, 3, 100_000),
])  # fmt: skip
def test_a_driver_that_always_sends_in_bursts_is_believed_from_the_first_reading_on(
    period, count, apart
):
    """As one that reads 4096 bytes from a port at a time."""
    judge, n = Plausibility(*LIMITS), np.arange(4 * count)
    stamps = START + round(period * count * SECOND) * (n // count) + apart * (n % count)
    angles = np.round(599.97 * period * n, 3)
    for stamp, angle in zip(stamps.tolist(), angles.tolist(), strict=True):
        assert judge.judge(angle, stamp) is BELIEVED


def test_a_driver_that_sends_each_30_ms_what_there_is_is_believed():
    """From an encoder at 20 Hz: the times between its messages are 30 or 60 ms."""
    judge = Plausibility(*LIMITS)
    for k in range(60):
        stamp = START + 30_000_000 * -(-5 * k // 3)
        assert judge.judge(round(599.97 * 0.05 * k, 4), stamp) is BELIEVED


@pytest.mark.parametrize('start', [0.1, 0.203, 0.505])
@pytest.mark.parametrize('rate', [1000, 2000])
def test_a_rotor_is_believed_that_starts_after_bursts_that_did_not_show(rate, start):
    """Each 4 ms come the readings since; of a rotor that stands they are all alike."""
    judge, n, count = Plausibility(*LIMITS), np.arange(int(rate * (start + 0.2))), rate // 250
    stamps = START + 4_000_000 * (n // count) + 5_000 * (n % count)
    angles = np.round(1500.0 * (n / rate - start).clip(0.0) ** 2, 4)
    for stamp, angle in zip(stamps.tolist(), angles.tolist(), strict=True):
        assert judge.judge(angle, stamp) is BELIEVED


@pytest.mark.parametrize('rate', [500, 1000])
def test_an_encoder_that_is_stuck_soon_after_the_start_is_named(rate):
    times = np.arange(rate) / rate
    rotor, _ = fed(MULTI, messages(times, np.round(299.97 * np.minimum(times, 0.03), 3)))
    assert rotor.rejected['implausible'] == 2
    assert rotor.plausibility.seen_acceleration > LIMITS[1]


def test_regular_readings_of_a_rotor_at_rest_are_no_pauses():
    """A second driver sends right behind each of them, 40 ms apart."""
    judge = Plausibility(*LIMITS)
    assert judge.judge(0.001, START - SECOND) is BELIEVED
    for stamp in range(START, START + SECOND, 40_000_000):
        assert judge.judge(0.0, stamp) is BELIEVED
        if stamp > START + 40_000_000:
            assert judge.judge(3.0, stamp + 1000) is Belief.IMPLAUSIBLE


@pytest.mark.parametrize('after', [100, 101, 102, 108])
def test_readings_that_flicker_at_rest_are_no_pauses(after):
    """One count for 8 ms, and another for 2 ms."""
    judge = Plausibility(*LIMITS)
    stamps = range(START, START + after * 1_000_000, 1_000_000)
    assert all(
        judge.judge(0.002 * (k % 10 < 8), stamp) is BELIEVED for k, stamp in enumerate(stamps)
    )
    assert judge.judge(4.0, START + after * 1_000_000) is Belief.IMPLAUSIBLE


def test_a_pause_behind_the_first_reading_hides_no_wrong_one():
    arrivals = [START, *(START + 90_000_000 + 2_000_000 * np.arange(20)).tolist()]
    judge = Plausibility(*LIMITS)
    beliefs = [judge.judge(0.01 * k + (k == 15), stamp) for k, stamp in enumerate(arrivals)]
    assert [k for k, each in enumerate(beliefs) if each is not BELIEVED] == [15]


@pytest.mark.parametrize('velocities', [True, False])
@pytest.mark.parametrize('rate', [10, 25, 50])
@pytest.mark.parametrize('turns', [0.32, 0.4, 0.48, -0.36, 0.7, -0.55])
def test_positions_that_wrap_are_named_where_the_rotor_turns_far_between_readings(
    rate, turns, velocities
):
    times = np.arange(0.0, 6.0, 1.0 / rate)
    speed = turns * TURN * rate
    angles = np.mod(speed * times + 1.0, TURN)
    velocity = {'velocity': [speed]} if velocities else {}
    rotor = RotorInput(MULTI)
    for stamp, angle in zip(START + np.round(times * SECOND).astype(int), angles, strict=True):
        rotor.accept(rotor_bytes(int(stamp), position=[angle], **velocity), int)
    assert rotor.plausibility.jumped == Condition.WRAPS(angle=TURN, setting=ANY)
    assert not rotor.referenced
    assert rotor.velocity_field.meaning is None


@pytest.mark.parametrize('rate', [10, 50])
@pytest.mark.parametrize('share', [0.2855, 2 / 7, 0.3, 0.305, 1 / 3, 0.334, 0.4, 0.4999, 0.5])
def test_a_vibration_does_not_wrap_though_its_steps_back_are_those_of_wraps(rate, share):
    angles = TURN * share * np.arange(300)
    for size in np.linspace(0.9, 1.3, 9) * 0.5 * TURN / (1.0 - math.cos(TURN * share)):
        for phase in np.linspace(0.0, TURN, 5):
            judge = Plausibility(*LIMITS)
            for n, angle in enumerate((size * np.sin(angles + phase)).tolist()):
                judge.judge(angle, START + n * SECOND // rate)
            assert judge.wraps.fact is None


@pytest.mark.parametrize(('rate', 'speed', 'period'), [
    (10, 1.0, TURN), (10, -15.0, TURN), (20, 20.0, TURN), (50, -5.0, TURN), (50, 80.0, TURN),
    (100, 100.0, TURN), (200, 300.0, TURN), (1000, -5.0, TURN),
    (1000, 300.0, TURN), (200, 100.0, 25.0), (1000, -100.0, 8.0 * math.pi),
])  # fmt: skip
def test_positions_that_wrap_are_named_after_three_wraps(rate, speed, period):
    count = math.ceil(4.2 * period / abs(speed) * rate)
    times = np.arange(count) / rate
    angles = np.mod(0.5 * period + speed * times, period) - 0.5 * period
    third = int(np.flatnonzero(np.abs(np.diff(angles)) > 0.5 * period)[2]) + 1
    batch = messages(times, angles)
    rotor, _ = fed(MULTI, batch[:third])
    assert rotor.plausibility.wraps.fact is None
    rotor, _ = fed(MULTI, batch[: third + 3])
    named = Condition.WRAPS(angle=pytest.approx(period, rel=0.01), setting=ANY)
    assert rotor.plausibility.jumped == rotor.why_lost == named
    assert not rotor.referenced
    whole = RotorInput(MULTI)
    whole.accept_batch(batch[: third + 3], [*range(third + 3)])
    assert state_of(whole.plausibility) == state_of(rotor.plausibility)
    rotor.home(0.0)
    for data in batch[third + 3 :]:
        with suppress(RejectedInputError):
            rotor.accept(data, int)
    assert not rotor.referenced, 'the next wrap loses the turns again'
    rotor.parameters = replace(MULTI, rotor_encoder_range=period)
    assert rotor.plausibility.wraps.fact is None


@pytest.mark.parametrize(('period', 'changes'), [
    (25.0, {'rotor_encoder': 'single_turn'}), (25.0, {'rotor_encoder_range': 24.9}),
    (25.0, {'rotor_encoder_range': 25.0}), (TURN, {'rotor_encoder': 'single_turn'}),
    (4.0 * TURN, {'rotor_encoder': 'single_turn'}), (12.0, {'rotor_encoder_range': 12.06}),
])  # fmt: skip
@pytest.mark.parametrize('late', [0.0, 0.1])
def test_positions_that_wrap_at_another_range_than_the_configured_one_are_named(
    period, changes, late
):
    parameters, generator = replace(MULTI, **changes), np.random.default_rng(8)
    times = np.arange(8000) / 1000
    angles = 250.0 * np.sin(times) + 40.0 * np.sin(5.0 * times)
    times = times + late * 1e-3 * generator.random(len(times))
    rotor, samples = fed(parameters, messages(times[:1], angles[:1] * 0.0))
    rotor.home(0.0)
    for data in messages(times, np.mod(angles, period)):
        with suppress(RejectedInputError):
            samples.append(rotor.accept(data, int))
    known = parameters.rotor_period
    other = abs(math.remainder(period, known)) > 0.05
    named = Condition.WRAPS(angle=pytest.approx(period, abs=0.01), setting=ANY)
    assert rotor.plausibility.jumped == (named if other else None)
    assert rotor.referenced != other


@pytest.mark.parametrize(('ramps', 'resolution'), [
    (False, 0.0), (False, TURN / 100), (True, 0.0),
])  # fmt: skip
@pytest.mark.parametrize(('rate', 'frequency', 'amplitude'), [
    (10, 1.0, 0.5), (20, 3.0, 0.5), (30, 4.0, 1.0), (40, 4.0, 0.5), (50, 2.48, 4.0),
])  # fmt: skip
def test_an_oscillation_about_the_wrap_is_no_other_range(
    rate, frequency, amplitude, ramps, resolution
):
    """Its speed is greatest at each wrap, and with ramps, as of a leg, has a corner there."""
    phases = 2.0 * frequency * np.arange(20 * rate) / rate
    angles = amplitude * np.sin(math.pi * phases)
    if ramps:
        angles = amplitude * 4.0 * (phases % 1.0) * (1.0 - phases % 1.0) * (-1.0) ** (phases // 1)
    if resolution:
        angles = np.floor(angles / resolution) * resolution
    settings = {'rotor_encoder_range': 100.0, 'max_rotor_speed': 8.5 * frequency * amplitude}
    rotor = RotorInput(replace(MULTI, **settings))
    for data in messages(np.arange(20 * rate) / rate, np.mod(angles, 100.0)):
        rotor.accept(data, int)
    assert rotor.plausibility.jumped is None


def test_positions_next_to_zero_are_no_numbers_of_single_precision():
    """rclpy publishes a whole number in a field of float64 as 5e-324."""
    rotor, _ = fed(MULTI, messages([0.0, 0.01, 0.02], [0.0, 5e-324, 1e-323]))
    assert rotor.plausibility.beyond_limits is None


@pytest.mark.parametrize('count', [1, 2, 3.5, 5])
def test_readings_of_one_stamp_do_not_make_a_range_look_like_another(count):
    """As of a clock that steps more seldom than a driver at 1 kHz sends."""
    rotor = RotorInput(replace(SINGLE, max_rotor_speed=200.0))
    for k in range(5000):
        position = math.remainder(0.15 * k, TURN)
        stamp = START + round(k // count * count * 1_000_000)
        rotor.accept(rotor_bytes(stamp, position=[position]), int)
    assert rotor.plausibility.jumped is None


@pytest.mark.parametrize('rate', [10, 20, 50, 1000])
def test_machine_with_a_quick_return_or_a_drive_that_restarts_does_not_wrap(rate):
    times = np.arange(40 * rate) / rate
    quick = 0.06 + 1.0 / rate
    cycle = np.mod(times, 2.0)
    back = np.where(cycle < 2.0 - quick, cycle / (2.0 - quick), (2.0 - cycle) / quick)
    indexed, restarted = np.floor(times / 2.0) % 2 * TURN, 25.0 * np.minimum(cycle, 1.0)
    for angles in (4.0 * back, 9.0 * back, indexed, restarted):
        rotor, _ = fed(MULTI, messages(times, angles))
        assert rotor.plausibility.wraps.fact is None


@pytest.mark.parametrize('rate', [500, 1000])
@pytest.mark.parametrize(('held_up', 'count'), [
    ('never', 0), ('reads late', 4), ('stamps late', 4), ('stamps late', 12),
])  # fmt: skip
@pytest.mark.parametrize('settings', [MULTI, SINGLE], ids=['multi-turn', 'single-turn'])
def test_a_rotor_that_stops_at_once_is_named(settings, held_up, count, rate):
    times = np.arange(rate) / rate
    read = times.copy()
    if count:  # just before the stop, for so many readings, which come in a burst
        times[rate // 2 - count + 1 : rate // 2 + 1] = 0.5 + 1e-5 * np.arange(1 - count, 1)
    if held_up == 'reads late':
        read = times
    angles = np.round(299.97 * np.minimum(read, 0.5), 3)  # the resolution can be known
    if settings.single_turn:
        angles = np.mod(angles, TURN)
    batch = messages(times, angles)
    rotor, _ = fed(settings, batch[: rate // 2])
    assert complaints(rotor) == ({}, None, None)
    rotor, samples = fed(settings, batch)
    batched = RotorInput(settings)
    batched.accept_batch(batch, [0] * len(batch))
    assert complaints(batched) == complaints(rotor)
    stopped = [n for n, sample in enumerate(samples) if sample is None]
    assert len(stopped) == 2
    assert times[stopped[0]] == pytest.approx(0.5 + STALEST, abs=0.005)
    said = rotor.plausibility.jumped or rotor.plausibility.beyond_limits.values['which'][0]
    expected = Condition.JUMPED if settings.single_turn else Condition.BEYOND_ACCELERATION
    assert said.condition is expected
    assert rotor.referenced != settings.single_turn


@pytest.mark.parametrize('settings', [MULTI, SINGLE], ids=['multi-turn', 'single-turn'])
def test_a_slow_rotor_can_stand_right_behind_a_burst(settings):
    """A single-turn encoder passes its zero in the pause before."""
    times = np.arange(500) / 500.0
    angles = 5.0 * np.minimum(times, 0.5) - 2.49
    times[247:251] = 0.5 + 1e-4 * np.arange(-3, 1)
    if settings.single_turn:
        angles = np.mod(angles, TURN)
    rotor, _ = fed(settings, messages(times, angles))
    assert complaints(rotor) == ({}, None, None)


@pytest.mark.parametrize(('rate', 'speed', 'repeated', 'offset'), [
    (100, 100.0, 0.5, 0.0), (200, -60.0, 0.1, 0.0), (500, 300.0, 0.03, 0.0),
    (500, 300.0, 0.5, 0.0), (1000, 20.0, 0.04, 0.0), (1000, 60.0, 0.9, 0.0),
    (1000, -200.0, 0.015, 0.0), (1000, 60.0, 0.1, 2.0), (1000, 60.0, 0.1, -2.0),
    (1000, 60.0, 1.2, 0.0),
])  # fmt: skip
def test_a_reading_that_a_driver_repeats_while_the_rotor_turns_on_is_no_jump(
    rate, speed, repeated, offset
):
    times = np.arange(2 * rate + rate // 2) / rate
    angles = np.round(speed * np.maximum(times, 0.2), 3)
    first, end = rate // 2, rate // 2 + round(repeated * rate)
    angles[first:end] = angles[first - 1]
    angles[end:] += offset
    rotor, samples = fed(MULTI, messages(times, angles))
    assert 2 <= rotor.rejected['implausible'] <= 5
    jumped = offset != 0.0 or repeated > 1.0
    assert bool(rotor.plausibility.jumped) == (not rotor.referenced) == jumped
    assert rotor.plausibility.limits[:2] == LIMITS
    after = [TURN * s.position.turns + s.position.angle for s in samples[end + 3 :]]
    assert after == pytest.approx(angles[end + 3 :].tolist())


@pytest.mark.parametrize('period', [0.0, 500.0])
@pytest.mark.parametrize(('rate', 'repeated'), [(20, 2), (50, 2), (50, 3), (100, 3), (200, 4)])
def test_a_driver_that_publishes_more_often_than_it_reads_is_believed(rate, repeated, period):
    parameters = replace(MULTI, rotor_encoder_range=period)
    times = np.arange(4 * rate) // repeated * repeated / rate
    angles = 60.0 * np.cos(6.0 * np.maximum(0.0, times - 0.5))
    readings = angles % period if period else angles
    data = messages(np.arange(4 * rate) / rate, readings)
    rotor, samples = fed(parameters, data)
    assert complaints(rotor) == ({}, None, None)
    assert rotor.turns.unknown_gaps == 0
    turned = [TURN * s.position.turns + s.position.angle for s in samples]
    assert np.diff(turned) == pytest.approx(np.diff(angles))
    fed_on = messages(4.0 + np.arange(4) / rate, [readings[-1] + 150.0] * 4)
    assert fed(parameters, data + fed_on)[0].plausibility.jumped


@pytest.mark.parametrize(('limit', 'repeated', 'hides'), [
    (140.0, 1, False), (140.0, 4, True), (35.0, 4, False), (140.0, 2, True),
])  # fmt: skip
def test_turns_are_unknown_that_hide_behind_readings_which_a_driver_repeats(
    limit, repeated, hides
):
    times = np.arange(200) // repeated * repeated / 50
    angles = 0.9 * min(limit, math.pi * 50) * times + 0.01 * np.sin(5.0 * times)
    rotor = RotorInput(replace(SINGLE, max_rotor_speed=limit))
    data = messages(np.arange(200) / 50, angles % TURN)
    rotor.accept(data[0], int)
    rotor.home(0.0)
    for each in data[1:]:
        rotor.accept(each, int)
    seldom = Condition.TOO_SELDOM(rate=50 / repeated, limit=limit, speed=ANY, least=ANY, other=ANY)
    assert rotor.referenced is not hides
    assert rotor.why_lost == (seldom if hides else None)
    rotor.home(0.0)
    for each in messages(4.0 + np.arange(10) / 50, [angles[-1] % TURN] * 10):
        rotor.accept(each, int)
    assert rotor.referenced


def test_jumps_after_a_rest_are_found_where_a_driver_had_a_lower_rate_before():
    idle, often = np.arange(20.0), 20.0 + np.arange(150) / 100
    turned = 5.0 * np.minimum(often - 20.0, 0.5)  # then it stands for a second
    times = [*idle, *often, *21.5 + np.arange(4) / 100]
    angles = [*2.51 * (idle // 2) + 0.01 * np.sin(idle // 2), *25.0 + turned, *[87.5] * 4]
    rotor, _ = fed(MULTI, messages(np.array(times), np.array(angles)))
    assert rotor.plausibility.jump == Condition.JUMPED(angle=pytest.approx(60.0), time=ANY)


@pytest.mark.parametrize('speed', [0.5, 60.0, 250.0])
def test_a_corrupt_reading_of_any_size_is_no_jump(speed):
    times = np.arange(30) / 1000
    for size in np.arange(-1.5, 1.5, 0.05):
        angles = np.round(speed * times, 3)
        angles[20] += size
        rotor, _ = fed(MULTI, messages(times, angles))
        assert (rotor.plausibility.jumped, rotor.referenced) == (None, True)


def test_single_wrong_readings_between_the_others_are_no_jump():
    times = np.arange(400) / 100
    angles, wrong = 10.0 * times, np.array([50, 150, 250, 350])
    wrongly = np.insert(times, wrong + 1, times[wrong] + 0.001)
    batch = messages(wrongly, np.insert(angles, wrong + 1, 500.0))
    rotor, samples = fed(MULTI, batch)
    assert rotor.rejected == {'implausible': 4}
    assert (rotor.plausibility.jumped, rotor.referenced) == (None, True)
    found = [TURN * s.position.turns + s.position.angle for s in samples if s]
    assert found == pytest.approx(angles.tolist())


@pytest.mark.parametrize('size', [5.0, -40.0, 300.0])
def test_a_wrong_reading_before_a_jump_does_not_make_it_a_motion(size):
    times = np.arange(60) / 1000
    angles = np.round(20.0 * times, 3)
    angles[30] += 1.0  # rad, out of reach
    angles[31:] += size
    rotor, _ = fed(MULTI, messages(times, angles))
    assert rotor.plausibility.jump
    assert rotor.plausibility.jump.values['angle'] == pytest.approx(size, abs=0.3)
    assert not rotor.referenced
    assert rotor.plausibility.limits[:2] == LIMITS


def test_the_first_steps_after_a_standstill_hide_no_jump():
    times = np.arange(500) / 500
    angles = np.where(times < 0.8, 1.0, 1.0 + 1e-4 * np.cumsum(times >= 0.8))
    angles[10:20] += 1e-4  # the resolution is known then
    angles[402:] -= 1.6
    rotor, _ = fed(MULTI, messages(times, angles))
    assert rotor.plausibility.jump.values['angle'] == pytest.approx(-1.6, abs=0.01)


@pytest.mark.parametrize('speed', [900.0, -5000.0])
def test_a_motor_beyond_the_limits_is_named_once_and_not_rejected_for_ever(speed):
    times = np.arange(500) / 1000
    start = 1e-3 * (np.arange(50) % 2)  # the resolution is known then
    rotor, _ = fed(MULTI, messages(times, np.concatenate([start, speed * times[:450]])))
    assert rotor.rejected['implausible'] <= 4
    beyond = Condition.BEYOND_SPEED(speed=pytest.approx(abs(speed)))
    assert beyond in rotor.plausibility.beyond_limits.values['which']
    assert rotor.plausibility.jumped is None
    assert rotor.referenced


@pytest.mark.parametrize('at_once', [True, False], ids=['batch', 'one by one'])
def test_a_motor_that_exceeds_its_speed_little_by_little_is_named(at_once):
    times = np.arange(1000) / 1000
    data = messages(times, 1000.0 * times**2)  # up to 2000 rad/s, with 2000 rad/s²
    rotor = RotorInput(MULTI)
    if at_once:
        rotor.accept_batch(data, [0] * len(data))
    else:
        rotor, _ = fed(MULTI, data)
    assert LIMITS[0] < rotor.plausibility.seen_speed < 2000.0
    assert 1 < rotor.rejected['implausible'] < 10


@settings(max_examples=50)
@given(
    st.integers(0, 2**32),
    st.lists(st.integers(1, 99), max_size=4),
    st.sampled_from([*KINDS, 'repeated', 'single']),
)
@example(109, [], 'gaps')  # intervals of exactly one and two periods
def test_batches_are_judged_as_one_by_one(seed, bad, kind):
    generator = np.random.default_rng(seed)
    rate = int(generator.choice([50, 500]))
    times, angles = motion(rate, 100, generator)
    stop = int(generator.integers(100))
    if stop > 50:
        angles *= 0.001
        angles[stop : stop + 20] = angles[stop]
    times, angles = disturbed(kind, times, angles, rate, generator)
    for n in bad:
        angles[n % len(angles) :] += 1000.0 if n % 2 else 0.0
        angles[n % len(angles)] -= 300.0
    data = messages(times, angles)
    single, samples = fed(MULTI, data)
    batched = RotorInput(MULTI)
    parts = [data[:1], data[1:30], data[30:31], data[31:]]
    found = [batched.accept_batch(part, [0] * len(part)) for part in parts]
    assert batched.rejected == single.rejected
    assert state_of(batched.plausibility) == state_of(single.plausibility)
    assert (batched.last, batched.segment) == (single.last, single.segment)
    positions = [(t, a) for part in found for t, a in zip(part.turns, part.angle, strict=True)]
    assert positions == [sample.position for sample in samples if sample]
