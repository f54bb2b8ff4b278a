# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Turns of the rotor: exact splitting, unwrapping, gaps, and homing."""

import math

import numpy as np
import oracle
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from properties import assert_close, assert_within, position_errors, samples

from gear_kinematics.kinematics import RotorPosition, RotorTurns, solve, split_turns

TAU = 2 * oracle.mp.pi
MANY = 10**10
LARGEST = 2.0 * math.pi * 2**51  # rad: up to here float64 angles are split exactly
RANGES = (0.0, -math.pi, -2.0 * math.pi, 1.0, 100.0, -1e6)
SIDES = pytest.mark.parametrize('side', [1, -1], ids=['forward', 'backward'])


def encoder(*, period=math.tau, max_speed=650.0, max_acceleration=1e5) -> RotorTurns:
    return RotorTurns(period=period, max_speed=max_speed, max_acceleration=max_acceleration)


def reading(angle, low: float = 0.0, period=TAU) -> float:
    """Reading of an encoder with the range [low, low + period) at an exact angle."""
    difference = oracle.mp.mpf(angle) - low
    return float(low + difference - period * oracle.mp.floor(difference / period))


def exact(position: RotorPosition):
    return oracle.rotor_angle_of(position.angle, turns=position.turns)


def assert_at(position: RotorPosition, expected, tolerance: float = 1e-12) -> None:
    assert abs(float(exact(position) - expected)) <= tolerance


def assert_split(angle: float, turns, rest: float) -> None:
    """The parts make up the angle, but for rounding them and the small product within once.

    The turn is the nearest, by the float64 of 2π, which is 2.45e-16 less than 2π.
    """
    assert turns == int(turns)
    assert abs(rest) <= math.pi + (abs(turns) + 4) * 2.45e-16
    error = abs(float(oracle.rotor_angle_of(rest, turns=int(turns)) - oracle.mp.mpf(angle)))
    assert error <= 2.0**-52 * (abs(rest) + abs(turns) * 3e-16)


def homed(angle, low: float = 0.0, period=TAU, **limits) -> RotorTurns:
    tracker = encoder(period=float(period), **limits)
    tracker.update(reading(angle, low, period), 0)
    tracker.home(0.0, 1)
    return tracker


# -- split_turns ---------------------------------------------------------------------------------

SPECIAL = [
    sign * value
    for value in (
        *(0.0, 5e-324, 1e-300, 1e-16, 1.0, 3.0, 1e5, 6.283e10, 1e12, LARGEST),
        *(float(TAU * n / 4) for n in (1, 2, 3, 4, 5, 6, 7, 8, 4 * 10**5, 4 * MANY, 4 * MANY + 1)),
        *(math.nextafter(n * math.pi, math.inf) for n in (1, 2, 3, 4)),
        *(math.nextafter(n * math.pi, 0.0) for n in (1, 2, 3, 4)),
    )
    for sign in (1.0, -1.0)
]


@settings(max_examples=80)
@given(samples(LARGEST) | samples(100.0))
@example(np.array(SPECIAL))
@example(LARGEST * 2.0 ** -np.random.default_rng(5).uniform(0.0, 53.0, 3000))
def test_split_is_exact(angles):
    """Floats and arrays agree to the last bit."""
    turns, rest = split_turns(angles)
    assert turns.shape == rest.shape == angles.shape
    for index in np.ndindex(angles.shape):
        assert_split(angles[index], turns[index], float(rest[index]))
        assert split_turns(float(angles[index])) == (turns[index], rest[index])


def test_split_of_values_that_are_not_finite_is_nan_in_arrays():
    with np.errstate(invalid='ignore'):
        turns, rest = split_turns(np.array([math.nan, math.inf, -math.inf]))
    assert np.all(np.isnan(turns))
    assert np.all(np.isnan(rest))


# -- unwrapping ----------------------------------------------------------------------------------


@settings(max_examples=80)
@given(
    st.sampled_from(RANGES), st.floats(-10.0, 10.0), st.lists(st.floats(-3.1, 3.1), max_size=30)
)
def test_unwrapping_follows_every_motion(low, start, steps):
    """For any range of the encoder, with steps of just under half a turn in either direction."""
    tracker = homed(start, low, max_speed=3.14)
    truth = oracle.mp.mpf(start)
    origin = exact(tracker.position) - truth
    for n, step in enumerate(steps, start=1):
        truth += step
        tracker.update(reading(truth, low), n * 10**9)
        # A reading is rounded within its own range.
        assert_at(tracker.position, origin + truth, 1e-14 + math.ulp(low))
    assert tracker.referenced


@SIDES
@pytest.mark.parametrize('period', [TAU, 4 * TAU, oracle.mp.mpf(25), oracle.mp.mpf('3.3')])
def test_position_is_exact_after_ten_thousand_million_wraps(actuator, side, period):
    """1e-14 rad and 1e-14 e against the oracle, in either direction, with any range."""
    period = period if period in {TAU, 4 * TAU} else oracle.mp.mpf(float(period))
    tracker = homed(0.3, -float(period) / 2, period)
    tracker.periods = side * MANY
    start = side * MANY * period + oracle.mp.mpf(0.3)
    truth, positions = [], []
    for n in range(1, 300):
        truth.append(start + side * oracle.mp.mpf('1.3') * n)
        tracker.update(reading(truth[-1], -float(period) / 2, period), n * 2_000_000)
        positions.append(tracker.relative_to(RotorPosition(0, 0.0), 1))
    assert tracker.referenced
    turns, angles = np.transpose(positions)
    state = solve(actuator, angles, rotor_turns=turns)
    assert_within(position_errors(state, actuator, truth), 1e-14)


@SIDES
@given(st.floats(0.0, 2.0 * math.pi * MANY))
@example(2.0 * math.pi * MANY)
def test_multi_turn_position_is_used_as_it_is(actuator, side, position):
    """To the rounding of the encoder's own float64, whatever happened before."""
    tracker = encoder(period=0.0)
    for stamp, value in enumerate((0.0, -1e5, side * position)):
        tracker.update(value, stamp)
        assert tracker.referenced
    angle = tracker.relative_to(RotorPosition(0, 0.0), 1)
    assert_at(angle, oracle.mp.mpf(side * position), 1e-15)
    state = solve(actuator, angle.angle, rotor_turns=angle.turns)
    truth = [oracle.rotor_angle_of(side * position)]
    assert_within(position_errors(state, actuator, truth), 1e-12)


# -- gaps ----------------------------------------------------------------------------------------


@pytest.mark.parametrize(('max_speed', 'elapsed', 'known'), [
    (10.0, 0.314, True), (math.nextafter(math.pi, 0.0), 1.0, True), (math.pi, 1.0, False),
    (10.0, 0.315, False), (650.0, 0.0048, True), (650.0, 0.0049, False), (10.0, 0.0, True),
])  # fmt: skip
@pytest.mark.parametrize('velocities', [(None, None), (None, 1.0), (1.0, None)], ids=str)
def test_gaps_of_half_a_turn_leave_the_turns_unknown(max_speed, elapsed, known, velocities):
    """Only velocities at both ends could narrow the possible turn."""
    tracker = encoder(max_speed=max_speed, max_acceleration=1e-3)
    tracker.update(0.1, 10**12, velocities[0])
    tracker.home(0.0, 1)
    tracker.update(0.2, 10**12 + round(elapsed * 1e9), velocities[1])
    assert tracker.referenced is known


@SIDES
def test_counting_goes_on_from_the_nearest_turn_after_a_gap(side):
    tracker = homed(0.0)
    tracker.periods = side * 5
    tracker.update(reading(side * 3.0), 10**9)
    assert not tracker.referenced
    assert_at(tracker.position, side * (5 * TAU + 3.0))
    tracker.update(reading(side * 3.5), 10**9 + 1_000_000)
    assert not tracker.referenced
    assert_at(tracker.position, side * (5 * TAU + 3.5))


@pytest.mark.parametrize('rate', [500, 1000, 2000, 4000, 20_000])
def test_steps_of_a_hall_sensor_lose_no_turn(rate):
    """It resolves a sixth of a turn, more than the rotor can turn between two readings."""
    tracker = homed(0.0)
    for n in range(1, 5 * rate):
        tracker.update(math.tau / 6.0 * (n * 50 // rate % 6), n * 10**9 // rate)
    assert tracker.referenced


def reachable(v0: float, v1: float, acceleration: float, elapsed: float, side: int) -> float:
    """Simulate the farthest turn from speed v0 to v1: full acceleration while v1 is in reach."""
    steps = 2000
    dt, speed, way = elapsed / steps, v0, 0.0
    for n in range(steps):
        left = elapsed - (n + 1) * dt
        faster = speed + side * acceleration * dt
        if side * (faster - v1) > acceleration * left:
            faster = v1 + side * acceleration * left
        way += 0.5 * (speed + faster) * dt
        speed = faster
    assert speed == pytest.approx(v1, abs=1e-9 * (1.0 + acceleration))
    return way


@pytest.mark.parametrize(
    'speeds', [(0.0, 0.0), (50.0, 50.0), (-30.0, 45.0), (80.0, -10.0)], ids=str
)
@pytest.mark.parametrize('elapsed', [0.2, 0.7])
def test_velocities_narrow_a_gap_to_what_is_reachable(speeds, elapsed):
    """The acceleration at which simulated extremes are a turn apart divides known from unknown."""
    low, high = abs(speeds[1] - speeds[0]) / elapsed, 1e4
    for _ in range(30):
        middle = 0.5 * (low + high)
        ways = [reachable(*speeds, middle, elapsed, side) for side in (-1, 1)]
        low, high = (middle, high) if ways[1] - ways[0] < 2.0 * math.pi else (low, middle)

    def after_gap(acceleration: float, way: float) -> RotorTurns:
        tracker = encoder(max_speed=1e4, max_acceleration=acceleration)
        tracker.update(0.0, 0, speeds[0])
        tracker.home(0.0, 1)
        tracker.update(reading(way), round(elapsed * 1e9), speeds[1])
        return tracker

    assert not after_gap(1.01 * high, ways[0]).referenced
    ways = [reachable(*speeds, 0.99 * low, elapsed, side) for side in (-1, 1)]
    for way in (0.99 * ways[0] + 0.01 * ways[1], 0.01 * ways[0] + 0.99 * ways[1]):
        tracker = after_gap(0.99 * low, way)
        assert tracker.referenced
        assert_at(tracker.position, oracle.mp.mpf(way))


@pytest.mark.parametrize('seed', range(6))
def test_turns_are_right_as_long_as_they_are_called_known(seed):
    """Random motions within the limits of speed and acceleration, sampled at random gaps."""
    generator = np.random.default_rng(seed)
    max_speed, max_acceleration, dt = 100.0, 1500.0, 1_000_000
    narrowed = lost = 0
    for _ in range(40):
        way, speed, stamp = oracle.mp.mpf(0), generator.uniform(-max_speed, max_speed), 0
        tracker = encoder(max_speed=max_speed, max_acceleration=max_acceleration)
        tracker.update(0.0, 0, speed)
        tracker.home(0.0, 1)
        for _ in range(20):
            gap = int(generator.integers(1, 130))
            acceleration = 0.0
            for n in range(gap):
                if n % 20 == 0:
                    acceleration = generator.choice([-1.0, 1.0]) * max_acceleration
                faster = float(np.clip(speed + acceleration * dt * 1e-9, -max_speed, max_speed))
                way += 0.5 * (speed + faster) * dt * 1e-9
                speed = faster
            stamp += gap * dt
            tracker.update(reading(way), stamp, speed)
            if not tracker.referenced:
                lost += 1
                break
            assert_at(tracker.position, way, 1e-9)
            narrowed += max_speed * gap * dt * 1e-9 >= math.pi
    assert narrowed > 20
    assert lost > 5


@pytest.mark.parametrize(
    ('speeds', 'elapsed'),
    [((150.0, 150.0), 0.1), ((-150.0, -150.0), 0.1), ((0.0, 100.0), 0.1), ((90.0, -90.0), 0.1)],
)
def test_velocities_beyond_the_limits_narrow_nothing(speeds, elapsed):
    """Nothing is known of a rotor beyond its limits of speed or acceleration."""
    tracker = encoder(max_speed=100.0, max_acceleration=500.0)
    tracker.update(0.0, 0, speeds[0])
    tracker.home(0.0, 1)
    tracker.update(0.0, round(elapsed * 1e9), speeds[1])
    assert not tracker.referenced


@pytest.mark.parametrize(
    ('late', 'repeated'), [(True, 1), (False, 1), (False, 5)], ids=['held up', 'lost', 'repeated']
)
@pytest.mark.parametrize(
    ('period', 'speed', 'gap', 'brake'),
    [(25.0, 320.0, 0.07, 0.0), (math.tau, 90.0, 0.06, 0.0), (math.tau, 63.0, 0.141, 485.0)],
)
def test_messages_that_were_held_up_end_a_gap_that_velocities_narrow(
    period, speed, gap, brake, late, repeated
):
    """Messages that are stamped at arrival come in a burst, and seem to turn on in no time."""
    tracker = encoder(period=period, max_speed=1.2 * speed, max_acceleration=500.0)
    taken = np.arange(0.0, 0.4, 0.002)
    stamps = np.where((taken > 0.1) & (taken < 0.1 + gap) & late, 0.1 + gap, taken)
    speeds = (speed - brake * (taken - 0.1).clip(0.0)).clip(0.0)
    ways = np.append(0.0, np.cumsum(0.001 * (speeds[1:] + speeds[:-1])))
    read = np.arange(len(taken)) // repeated * repeated
    for way, now, stamp in zip(ways[read], speeds[read], stamps, strict=True):
        if stamp <= 0.1 or stamp >= 0.1 + gap:  # else it is lost
            tracker.update(way % period, round(stamp * 1e9), now)
        if not stamp:
            tracker.home(0.0, 1)
    turns, angle = tracker.position
    right = math.isclose(math.tau * turns + angle, way, rel_tol=1e-6)
    assert (tracker.referenced, right) == (not late, not late)
    assert tracker.longest_gap == (pytest.approx(gap, abs=0.003) if late else None)


# -- zero, direction, home -----------------------------------------------------------------------


@given(
    st.floats(-2.0 * math.pi * MANY, 2.0 * math.pi * MANY),
    st.floats(-2.0 * math.pi * MANY, 2.0 * math.pi * MANY) | st.floats(-10.0, 10.0),
    st.sampled_from([1, -1]),
)
def test_zero_and_direction_lose_nothing(position, zero, direction):
    tracker = encoder(period=0.0)
    tracker.update(position, 0)
    angle = tracker.relative_to(split_turns(zero), direction)
    assert_at(angle, oracle.rotor_angle_of(position, zero, direction), 4e-15)


@pytest.mark.parametrize('direction', [1, -1])
@pytest.mark.parametrize('single_turn', [True, False], ids=['single', 'multi'])
@pytest.mark.parametrize('turns', [0, 3, -3, MANY, -MANY])
@pytest.mark.parametrize('rotor_angle', [0.0, 0.7, -19.0, 1000.0])
def test_home_sets_the_rotor_angle(direction, single_turn, turns, rotor_angle):
    """Motion goes on from there; a multi-turn encoder keeps the rounding of its own float64."""
    tracker = encoder(period=math.tau * single_turn)
    start = 2.0 if single_turn else float(2.0 + TAU * turns)
    tracker.update(start, 0)
    if single_turn:
        tracker.periods = turns
        tracker.update(start, 1)
    zero = tracker.home(rotor_angle, direction)
    assert tracker.referenced
    rounding = 4e-15 + math.ulp(rotor_angle) + math.ulp(start)
    zero = split_turns(zero)
    assert_at(tracker.relative_to(zero, direction), oracle.mp.mpf(rotor_angle), rounding)
    now = tracker.relative_to(zero, direction)
    stop = reading(start + 2.5) if single_turn else start + 2.5
    tracker.update(stop, 1_000_000)
    moved = float(exact(tracker.relative_to(zero, direction)) - exact(now))
    travelled = 2.5 if single_turn else stop - start
    assert_close(moved, direction * travelled, 4e-15)


@pytest.mark.parametrize('single_turn', [True, False])
def test_reset_forgets_position_and_turns(single_turn):
    tracker = encoder(period=math.tau * single_turn)
    tracker.update(1.0, 10**9, 5.0)
    tracker.home(0.0, 1)
    tracker.reset()
    assert tracker.position is None
    assert tracker.referenced is not single_turn
    tracker.update(-2.0, 0)  # earlier than before
    assert_at(tracker.position, oracle.mp.mpf(-2.0))


def test_no_position_before_the_first_update():
    for ask in (RotorTurns.relative_to, RotorTurns.home):
        with pytest.raises(RuntimeError, match='before the first update'):
            ask(encoder(), 0.0, 1)
