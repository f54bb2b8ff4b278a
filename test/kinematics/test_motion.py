# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The closed form against 50-digit matrix products, and the properties of the motion."""

import inspect
import math
import re
import tracemalloc
from dataclasses import fields

import numpy as np
import oracle
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from properties import (
    LENGTHS,
    SHAPES,
    assert_same,
    assert_within,
    field_names,
    mechanisms,
    numbers_of,
    position_errors,
    samples,
    speed_up,
)

from gear_kinematics.kinematics import (
    Branch,
    GearRatio,
    Mechanism,
    MotionState,
    matrix_method,
    solve,
    split_turns,
)
from gear_kinematics.kinematics.motion import BranchRates, closed_form

MOST_TURNS = 2**51  # up to here float64 angles are split exactly
LARGEST_ANGLE = 2.0 * math.pi * MOST_TURNS
BEYOND = math.nextafter(LARGEST_ANGLE, math.inf)
NOT_FINITE = (math.nan, math.inf, -math.inf)
SOLVERS = pytest.mark.parametrize('solver', [solve, matrix_method.solve], ids=['closed', 'matrix'])


@given(mechanisms(), samples(100.0))
def test_positions_agree_with_the_oracle(mechanism, angles):
    state = solve(mechanism, angles)
    exact = [oracle.rotor_angle_of(angle) for angle in angles.flat]
    assert_within(position_errors(state, mechanism, exact))


@pytest.mark.slow
@given(mechanisms(), samples(10.0, shapes=((), (4,))), st.floats(-1.0, 1.0))
@example(Mechanism(80, 76, 1e-3, (Branch('a'),)), np.array(1.0), 1.0)
@example(Mechanism(400, 1, 1e-3, (Branch('a'),)), np.array(1.0), -1.0)
def test_positions_lose_nothing_at_any_count_of_turns(mechanism, angles, share):
    turns = int(share * MOST_TURNS / speed_up(mechanism))
    state = solve(mechanism, angles, rotor_turns=turns)
    exact = [oracle.rotor_angle_of(angle, turns=turns) for angle in angles.flat]
    assert_within(position_errors(state, mechanism, exact))


@pytest.mark.parametrize(
    ('ring_teeth', 'satellite_teeth', 'turns'),
    [(302, 259, 2821787408222552), (187, 69, 1127845120280877), (29, 18, -4035087684763779)],
)
def test_turns_are_counted_where_their_product_with_the_teeth_is_not_exact(
    ring_teeth, satellite_teeth, turns
):
    """The output shaft's turns fit into 53 bits, turns times tooth difference do not."""
    mechanism = Mechanism(ring_teeth, satellite_teeth, 1e-3, (Branch('a'),))
    state = solve(mechanism, 1.0, rotor_turns=turns)
    exact = [oracle.rotor_angle_of(1.0, turns=turns)]
    assert_within(position_errors(state, mechanism, exact))


@settings(max_examples=60)
@given(mechanisms(), st.floats(-20.0, 20.0), st.floats(-1000.0, 1000.0), st.floats(-1e6, 1e6))
def test_rates_agree_with_the_oracle(mechanism, angle, velocity, acceleration):
    """Against numerical derivatives at 50 digits; rates in units of the fastest in the gear."""
    state = solve(mechanism, angle, velocity, acceleration)
    exact = oracle.rotor_angle_of(angle)
    expected = oracle.expected_derivatives(numbers_of(mechanism), exact, velocity, acceleration)
    fastest = speed_up(mechanism) * max(abs(velocity), math.sqrt(abs(acceleration)), 1e-3)
    e = mechanism.eccentricity
    output = (state.output_velocity, state.output_acceleration)
    for order, motion in enumerate((expected.first, expected.second), start=1):
        tolerance = 1e-12 * fastest**order
        assert oracle.angle_error(output[order - 1], motion.output_angle) <= tolerance
        name = ('velocity', 'acceleration')[order - 1]
        for k, branch in enumerate(motion.branches):
            for body in ('satellite', 'oldham'):
                actual = getattr(state, f'{body}_{name}')[k]
                point = getattr(branch, f'{body}_centre')
                assert oracle.point_error(actual, point, e) <= tolerance
    for name in ('satellite_slide', 'arm_slide'):
        for k, branch in enumerate(expected.first.branches):
            actual = getattr(state, f'{name}_velocity')[k]
            assert oracle.length_error(actual, getattr(branch, name), e) <= 1e-12 * fastest


def test_batches_longer_than_a_chunk_equal_their_parts(actuator):
    generator = np.random.default_rng(2)
    motion = generator.uniform(-1e3, 1e3, (3, 20_001))
    state = solve(actuator, *motion)
    for part in (slice(0, 1), slice(12_287, 12_289), slice(19_990, None)):
        alone = solve(actuator, *motion[:, part])
        assert_same(
            alone, MotionState(*(getattr(state, name)[part] for name in field_names(state)))
        )


@pytest.mark.parametrize('orders', [1, 3])
def test_batches_take_little_more_memory_than_their_results(actuator, orders):
    motion = np.random.default_rng(3).uniform(-1e3, 1e3, (orders, 100_000))
    tracemalloc.start()
    state = solve(actuator, *motion)
    held, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert held >= state.oldham_centre.nbytes
    assert peak <= 1.3 * held


@SOLVERS
def test_inputs_broadcast(mechanism, solver):
    angle, turns = np.arange(3.0)[:, np.newaxis], np.array([[[7]], [[8]]])
    state = solver(mechanism, angle, np.arange(2.0), 5.0, rotor_turns=turns)
    whole = np.broadcast_arrays(angle, np.arange(2.0), 5.0, turns)
    assert_same(state, solver(mechanism, *whole[:3], rotor_turns=whole[3]))
    assert state.output_angle.shape == (2, 3, 2)


@pytest.mark.parametrize('shape', SHAPES, ids=str)
def test_shapes_and_types_are_those_of_the_contract(mechanism, shape):
    state = solve(mechanism, np.zeros(shape), 1.0)
    count = len(mechanism.branches)
    for field in fields(state):
        array = getattr(state, field.name)
        ending = ()
        if not field.name.startswith('output'):
            ending = (count,) if 'slide' in field.name else (count, 2)
        assert array.shape == (*shape, *ending), field.name
        assert array.dtype == np.float64


def test_python_numbers_lists_and_integers_are_accepted(actuator):
    assert_same(solve(actuator, [1, 2], 3), solve(actuator, np.array([1.0, 2.0]), 3.0))
    assert solve(actuator, 1).output_angle.shape == ()


@SOLVERS
def test_results_are_read_only_and_inputs_stay_as_they_are(mechanism, solver):
    angle = np.array([1e9, -2.0])
    state = solver(mechanism, angle, angle, angle)
    assert angle.tolist() == [1e9, -2.0]
    angle[:] = 0.0  # still writeable
    for field in fields(state):
        with pytest.raises(ValueError, match='read-only'):
            getattr(state, field.name)[...] = 1.0


@pytest.mark.parametrize(
    ('solver', 'bad'),
    [
        *((each, bad) for each in (solve, matrix_method.solve) for bad in NOT_FINITE),
        *((solve, bad) for bad in (-1e300, BEYOND)),
    ],
)
def test_angles_that_are_not_finite_or_too_large_give_nan(mechanism, solver, bad):
    state, good = solver(mechanism, [0.5, bad], 1.0, 1.0), solver(mechanism, [0.5], 1.0, 1.0)
    for field in fields(state):
        array = getattr(state, field.name)
        np.testing.assert_array_equal(array[:1], getattr(good, field.name))
        if not field.name.startswith('output'):
            assert np.all(np.isnan(array[1])), field.name
    assert not np.isfinite(state.output_angle[1])


@pytest.mark.parametrize('bad', NOT_FINITE)
@pytest.mark.parametrize('order', [1, 2])
def test_rates_that_are_not_finite_leave_the_positions(mechanism, bad, order):
    rates = [1.0, 1.0]
    rates[order - 1] = bad
    state = solve(mechanism, 0.5, *rates)
    still = solve(mechanism, 0.5)
    for name in LENGTHS[0] + ('output_angle', 'output_turn_angle'):
        np.testing.assert_array_equal(getattr(state, name), getattr(still, name))
    assert not np.any(np.isfinite(state.oldham_acceleration))
    assert not np.isfinite((state.output_velocity, state.output_acceleration)[order - 1])
    if order == 1:
        assert not np.any(np.isfinite(state.oldham_velocity))
        assert not np.any(np.isfinite(state.satellite_slide_velocity))


def one_by_one(mechanism, angle, turns, velocity, acceleration) -> dict[str, object]:
    """Go through the formulas with plain floats and ints; returns what a state has."""
    form, ratio = closed_form(mechanism), mechanism.gear_ratio
    own_turns, rest = split_turns(angle)
    output_turns, output_rest = ratio.output_angle(turns + own_turns, rest, math)
    assert isinstance(output_turns, int)
    positions = form.branches(rest, output_rest, math)
    rates = list(form.rates(positions, velocity, acceleration))
    return {
        'output_angle': 2.0 * math.pi * output_turns + output_rest,
        'output_velocity': ratio.output_rate(velocity),
        'output_acceleration': ratio.output_rate(acceleration),
        'output_turn_angle': output_rest,
        'satellite_centre': [position.satellite for position in positions],
        'oldham_centre': [position.oldham for position in positions],
        'satellite_slide': [position.satellite_slide for position in positions],
        'arm_slide': [position.arm_slide for position in positions],
        **{name: [getattr(rate, name) for rate in rates] for name in BranchRates._fields},
    }


@given(
    mechanisms(),
    st.floats(-LARGEST_ANGLE, LARGEST_ANGLE) | st.floats(-10.0, 10.0),
    st.integers(-MOST_TURNS, MOST_TURNS) | st.just(0),
    st.floats(-1000.0, 1000.0),
    st.floats(-1e6, 1e6),
    st.integers(0, 20),
)
@example(Mechanism(400, 1, 1e-3, (Branch('a', 0.3),)), 7e15, 2**51 - 1, 1.0, 1.0, 3)
def test_batches_and_floats_agree_to_the_last_bit(
    mechanism, angle, turns, velocity, acceleration, others
):
    """`solve` of one sample among others, of one alone, and the node's plain floats."""
    inputs = (angle, velocity, acceleration)
    among = solve(
        mechanism,
        *([*range(others), value] for value in inputs),
        rotor_turns=[*range(others), turns],
    )
    alone = solve(mechanism, *inputs, rotor_turns=turns)
    floats = one_by_one(mechanism, angle, turns, velocity, acceleration)
    assert sorted(floats) == sorted(field_names(alone))
    for name, value in floats.items():
        np.testing.assert_array_equal(getattr(alone, name), value, name)
        np.testing.assert_array_equal(getattr(among, name)[-1], value, name)


@settings(max_examples=80)
@given(mechanisms(), st.floats(-1.0, 1.0))
def test_bodies_are_in_their_places_up_to_the_largest_angle(mechanism, share):
    """The largest angle is one of the rotor, even if the output turns faster."""
    angle = share * LARGEST_ANGLE
    state = solve(mechanism, angle)
    errors = position_errors(state, mechanism, [oracle.rotor_angle_of(angle)])
    exact = oracle.rotor_angle_of(angle) / mechanism.gear_ratio.numerator
    exact *= mechanism.gear_ratio.denominator
    assert errors.pop('output_angle') <= 2.0 * math.ulp(float(exact))
    assert_within(errors)


@pytest.mark.parametrize(
    ('turns', 'given_turns'),
    [
        (0.5, '0.5'),
        (-1.25, '-1.25'),
        ([1.0, 2.0, 3.5], '[1.  2.  3.5]'),
        (math.inf, 'inf'),
        ([0.0, math.nan], '[ 0. nan]'),
        (2**52 + 1, '4.50359963e+15'),
        (-(2**60), '-1.1529215e+18'),
    ],
)
@SOLVERS
def test_turns_that_are_not_integers_are_refused(actuator, solver, turns, given_turns):
    wanted = f'rotor_turns must be integers up to ±2^52, not {given_turns}'
    with pytest.raises(ValueError, match=f'^{re.escape(wanted)}$'):
        solver(actuator, np.zeros(np.shape(turns)), rotor_turns=turns)


@pytest.mark.parametrize('turns', [3, 3.0, -(2**52), 2**52, True, np.int8(3), [1, 2], []])
@SOLVERS
def test_turns_of_any_type_are_taken(actuator, solver, turns):
    state = solver(actuator, 0.25, rotor_turns=turns)
    same = solver(actuator, 0.25, rotor_turns=np.array(turns, np.float64))
    assert_same(state, same)
    assert state.output_angle.shape == np.shape(turns)


def test_poses_are_those_of_satellites_then_couplings_with_the_angle_within_a_turn(actuator):
    state = solve(actuator, [0.5, 400.0])
    assert state.poses.shape == (2, 4, 3)
    for k, centre in enumerate((state.satellite_centre, state.oldham_centre)):
        np.testing.assert_array_equal(state.poses[:, 2 * k : 2 * k + 2, :2], centre)
    # 400 rad of the rotor are -21.0526 rad of the output: 3 turns less 2.2031 rad.
    np.testing.assert_allclose(state.poses[1, :, 2], -400.0 / 19.0 + 6.0 * math.pi, atol=1e-14)


def test_a_state_and_the_signature_are_short_to_read(actuator):
    shown = repr(solve(actuator, np.linspace(0.0, 19.0, 1000)))
    assert shown.startswith('MotionState(shape=(1000,), branches=2, output_angle=[')
    assert '..., ' in shown
    assert len(shown) < 150
    assert str(inspect.signature(solve)).count("'ArrayLike'") == 4


def test_a_ratio_alone_is_refused_with_what_to_call_instead():
    with pytest.raises(TypeError, match=r'not a GearRatio; .* call output_angle\(\*split_turns'):
        solve(GearRatio(-19), 0.5)
    with pytest.raises(TypeError, match='needs a Mechanism, not a list'):
        solve([0.5], 314.0)
    turns, rest = GearRatio(-19).output_angle(*split_turns([0.5, 19.0 * 7.0]), np)
    np.testing.assert_allclose(2.0 * math.pi * turns + rest, [-0.5 / 19.0, -7.0], rtol=1e-15)
