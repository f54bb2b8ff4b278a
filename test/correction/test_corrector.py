# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The correction of the output angle, against its definition in 50 digits."""

import math
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from calibrations import MP, calibration, expected_deviations
from hypothesis import given, settings
from hypothesis import strategies as st

from gear_kinematics.correction.calibration_file import Order
from gear_kinematics.correction.corrector import MAX_GAP, Correction, Corrector
from gear_kinematics.kinematics import RotorPosition, RotorSample

MS = 10**6
START = 1_700_000_000 * 10**9
STEADY = 1.0  # rad/s of the rotor: within the span


def samples(positions, *, velocity=STEADY, effort=None, period=MS) -> list[RotorSample]:
    return [
        RotorSample(START + k * period, RotorPosition(*position), velocity, effort)
        for k, position in enumerate(positions)
    ]


def at_angles(*angles, **fields) -> list[RotorSample]:
    """Make samples at rotor angles, rad."""
    return samples([(0, angle) for angle in angles], **fields)


def correct_all(corrector: Corrector, motion, **options) -> list[Correction]:
    return [corrector.correct(sample, **options) for sample in motion]


def columns(motion, segment=0) -> list[np.ndarray]:
    """Convert samples to the arrays that `correct_batch` takes."""
    stamps = np.array([sample.stamp for sample in motion], np.int64)
    numbers = [(*s.position, s.velocity, s.effort) for s in motion]
    table = np.array(numbers, np.float64).reshape(-1, 4)  # None becomes NaN
    return [stamps, *table.T, np.full(len(motion), segment)]


@st.composite
def motions(draw, shortest=0) -> list[RotorSample]:
    """Draw a motion with reversals, standstills, jumps of many turns, gaps and missing fields."""
    turns, angle, stamp = draw(st.integers(-(10**9), 10**9)), 0.0, START
    efforts = st.none() | st.floats(-3.0, 3.0)
    velocities = st.none() | st.floats(-100.0, 100.0)
    motion = []
    for _ in range(draw(st.integers(1, 40))):
        angle += draw(st.sampled_from((0.0, 1e-3, -1e-3)) | st.floats(-0.05, 0.05))
        turns += draw(st.sampled_from((0, 0, 0, 0, 0, 0, 1, -1, 700, -3000)))
        stamp += draw(st.sampled_from((shortest, MS, MS, MS, 150 * MS, MAX_GAP, MAX_GAP + 1)))
        position = RotorPosition(turns, angle)
        motion.append(RotorSample(stamp, position, draw(velocities), draw(efforts)))
    return motion


@settings(max_examples=60)
@given(
    st.lists(
        st.tuples(st.integers(-1, 1), st.floats(-math.pi, math.pi), st.none() | st.floats(-1, 1)),
        min_size=1,
        max_size=30,
    ),
    st.integers(-(2**40), 2**40),
)
def test_deviation_and_unknown_part_are_those_of_the_definition(steps, turns):
    made = calibration()
    motion = []
    for step, angle, effort in steps:
        turns += step
        motion.append((turns, angle, effort))
    corrector = Corrector(made)
    for k, (moved, expected) in enumerate(
        zip(motion, expected_deviations(made, motion), strict=True)
    ):
        sample = RotorSample(START + k * MS, RotorPosition(*moved[:2]), STEADY, moved[2])
        deviation, _, half_width, _ = corrector.correct(sample)
        assert abs(MP.mpf(deviation) - expected[0]) < 1e-14
        inside = math.isclose(half_width - float(expected[1]), made.half_width, abs_tol=1e-14)
        outside = made.outside_half_width
        assert inside or math.isclose(half_width - float(expected[1]), outside, abs_tol=1e-14)


def test_slope_is_the_derivative_along_the_output_angle():
    step = 1e-7
    for start in np.linspace(-3.0, 3.0, 25):
        corrector = Corrector(calibration())
        # Away and a little back, so that some stop operators move, at a distance from their ends.
        angles = start + np.array([0.0, 0.2, 0.2 - 0.01, 0.2 - 0.01 - step, 0.2 - 0.01 - 2 * step])
        corrections = correct_all(corrector, at_angles(*angles))
        change = corrections[4].deviation - corrections[2].deviation
        assert corrections[3].slope == pytest.approx(change / (-2 * step / -19), rel=1e-5)


@pytest.mark.parametrize('cause', ['gap', 'clock', 'segment', 'reset'])
def test_plays_are_unknown_again_after_motion_was_missed(cause):
    corrector = Corrector(calibration(compliance=None))
    first = at_angles(0.0, 0.5)
    assert correct_all(corrector, first)[-1].half_width == 1e-4
    stamp = {'gap': MAX_GAP + 1, 'clock': -2 * 10**9}.get(cause, MS) + first[-1].stamp
    if cause == 'reset':
        corrector.reset()
    again = corrector.correct(first[-1]._replace(stamp=stamp), segment=int(cause == 'segment'))
    assert again.half_width == pytest.approx(1e-4 + 0.6 * 4e-4 + 0.2 * 2e-3)


@settings(max_examples=60)
@given(
    st.lists(st.sampled_from((-1, 0, 1)), min_size=10, max_size=960),
    st.sampled_from((0.0, 2.0, 15.0)),
)
def test_interval_covers_what_a_gap_can_hide(pushes, speed):
    most = 500.0  # rad/s² of the rotor
    pushed = most * np.repeat([0, *pushes, 0], [20, *(len(pushes) * [1]), 300])
    velocity = speed + np.cumsum(pushed) / 1000
    angle = np.cumsum(velocity - pushed / 2000) / 1000
    motion = [
        RotorSample(START + k * MS, RotorPosition(0, x), v, 0.0)
        for k, (x, v) in enumerate(zip(angle.tolist(), velocity.tolist(), strict=True))
    ]
    whole = correct_all(Corrector(calibration(), most), motion)
    with_gap = correct_all(Corrector(calibration(), most), motion[:20] + motion[-300:])
    for known, unknown in zip(whole[-300:], with_gap[-300:], strict=True):
        wider = unknown.half_width - known.half_width
        assert abs(known.deviation - unknown.deviation) <= wider + 1e-12


@pytest.mark.parametrize(
    # A motion within 500 rad/s² is at most a t²/8 from the straight one: 0.4 mrad of the output.
    ('most', 'wider'),
    [(500.0, 0.5 * (0.6 + 0.2) * 500.0 * 0.011**2 / 8.0 / 19.0), (1e9, 6.4e-4)],
)
def test_interval_widens_by_what_a_gap_can_hide_until_histories_meet(most, wider):
    motion = at_angles(*(0.02 * np.arange(100)), velocity=20.0)
    corrector = Corrector(calibration(compliance=None), most)
    after = correct_all(corrector, motion[:50] + motion[60:])[50:]
    assert after[0].half_width == pytest.approx(1e-4 + wider)
    assert after[-1].half_width == 1e-4


def test_homing_makes_the_play_unknown():
    corrector = Corrector(calibration(orders=(), compliance=None))
    widths = [
        corrector.correct(sample, referenced=k > 1).half_width
        for k, sample in enumerate(at_angles(0.0, 1.0, 2.0, 3.0))
    ]
    unknown = 0.6 * 4e-4 + 0.2 * 2e-3
    assert widths == pytest.approx([1e-4 + unknown, 1e-4, 1e-4 + unknown, 1e-4])


def half_width(sample: RotorSample, *, angle_span=(-4.0, 4.0), **options) -> float:
    """Give the half width at a sample, when all plays are known."""
    made = calibration()
    corrector = Corrector(replace(made, spans=replace(made.spans, angle=angle_span)))
    before = sample.position._replace(angle=sample.position.angle - 0.2)
    corrector.correct(sample._replace(stamp=sample.stamp - MS, position=before), **options)
    return corrector.correct(sample, **options).half_width


def at(turns=0, angle=0.0, velocity=STEADY, effort=0.0) -> RotorSample:
    return RotorSample(START, RotorPosition(turns, angle), velocity, effort)


@pytest.mark.parametrize(('sample', 'inside'), [
    (at(), True), (at(velocity=19 * 2.99), True), (at(velocity=-19 * 3.01), False),
    (at(velocity=None), True), (at(effort=-29.9 / 19), True), (at(effort=20.1 / 19), False),
])  # fmt: skip
def test_interval_is_that_of_the_ideal_output_outside_of_what_was_calibrated(sample, inside):
    assert half_width(sample) == (1e-4 if inside else 2e-3)


@pytest.mark.parametrize('output_turns', [0, 1, -1, 10**9])
def test_span_of_the_angle_counts_within_the_period_of_the_orders(output_turns):
    def inside(x: float) -> bool:
        turns = round(-19 * x / (2 * math.pi))
        sample = at(-19 * output_turns + turns, -19 * x - 2 * math.pi * turns)
        return half_width(sample, angle_span=(-0.5, 1.0)) == 1e-4

    angles = (-0.51, -0.49, 0.0, 0.99, 1.01, 3.0)
    assert [inside(x) for x in angles] == [False, True, True, True, False, False]


def test_span_of_the_angle_does_not_matter_where_orders_repeat_every_turn():
    made = calibration(orders=(Order('rotor × 1', Fraction(1), 1e-3, 0.0),))
    corrector = Corrector(replace(made, spans=replace(made.spans, angle=(0.0, 0.1))))
    motion = at_angles(100.0, 101.0, effort=0.0)
    assert correct_all(corrector, motion)[-1].half_width == 1e-4


def test_orders_of_the_output_are_unknown_until_referenced():
    made = calibration(hysteresis=(), compliance=None)
    corrector = Corrector(made)
    deviation, slope, width, _ = corrector.correct(at(7, 0.3), referenced=False)
    rotor = 1e-3 * math.cos(0.3) - 4e-4 * math.sin(0.3) + 2e-4 * math.sin(0.6)
    assert deviation == pytest.approx(1e-5 + rotor, rel=1e-13)
    along_rotor = -1e-3 * math.sin(0.3) - 4e-4 * math.cos(0.3) + 4e-4 * math.cos(0.6)
    assert slope == pytest.approx(-19 * along_rotor, rel=1e-13)
    assert width == pytest.approx(1e-4 + math.hypot(5e-4, 7e-4) + math.hypot(1e-4, 3e-5))


def test_calibration_without_terms_adds_its_constant():
    made = calibration(orders=(), hysteresis=(), compliance=None)
    assert Corrector(made).correct(at()) == (1e-5, 0.0, 1e-4, 0.0)
    batch = Corrector(made).correct_batch(*columns([at(), at()]))
    np.testing.assert_array_equal(np.transpose(batch), 2 * [(1e-5, 0.0, 1e-4, 0.0)])


@settings(max_examples=60)
@given(motions(shortest=MS), st.integers(1, 39))
def test_history_before_the_first_sample_changes_no_more_than_is_said(motion, start):
    made = calibration()
    whole = correct_all(Corrector(made), motion)[start:]
    part = correct_all(Corrector(made), motion[start:])
    for known, unknown in zip(whole, part, strict=True):
        less = unknown.half_width - known.half_width
        assert -1e-12 <= less <= unknown.unknown_history + 1e-12
        assert abs(known.deviation - unknown.deviation) <= unknown.unknown_history + 1e-12
