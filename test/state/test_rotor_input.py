# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The rotor input: what rejected messages leave, resets, zero and direction, any numbers."""

import math
from contextlib import suppress
from dataclasses import replace

import oracle
import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from live import SECOND, rotor_bytes

from gear_kinematics.parameters import NodeParameters
from gear_kinematics.state.rotor_input import RotorInput
from gear_kinematics.state.statuses import Condition
from gear_kinematics.wire.joint_reader import RejectedInputError

SETTINGS = NodeParameters.load()
SINGLE_TURN = replace(SETTINGS, rotor_encoder='single_turn')
NOW = 77 * SECOND + 7
START = 100 * SECOND
TURN = 2.0 * math.pi


def clock() -> int:
    return NOW


def no_clock() -> int:
    raise AssertionError('a message with a stamp needs no clock')


def accept(rotor_input, stamp, position, velocity=(), effort=()):
    data = rotor_bytes(stamp, position=[position], velocity=velocity, effort=effort)
    return rotor_input.accept(data, no_clock)


def homed(position, velocity=()) -> RotorInput:
    """The input of a single-turn encoder, homed at its first message."""
    rotor_input = RotorInput(SINGLE_TURN)
    accept(rotor_input, START, position, velocity)
    rotor_input.home(0.0)
    return rotor_input


def angle_error(sample, expected) -> float:
    """Difference from an exact rotor angle, including its turns, rad."""
    turns, angle = sample.position
    assert isinstance(turns, int)
    return oracle.angle_error(angle, expected - 2 * oracle.mp.pi * turns)


@pytest.fixture
def rotor_input() -> RotorInput:
    return RotorInput(SETTINGS)


@pytest.mark.parametrize(('stamp', 'position', 'cause'), [
    (START + SECOND, math.nan, 'position not finite'), (START - 1, -1.0, 'out of order'),
    (START - SECOND, -1.0, 'out of order'),
])  # fmt: skip
def test_a_rejected_message_changes_nothing(stamp, position, cause):
    """`test_faults.py` tests what is counted, and `test_joint_reader.py` what has which cause."""
    rotor_input = homed(3.0)
    newest = rotor_input.last
    for count in (1, 2):  # the age counts from the last accepted message
        assert not rotor_input.mostly_rejected
        with pytest.raises(RejectedInputError, match=f'^{cause}$'):
            accept(rotor_input, stamp, position)
        assert rotor_input.rejected == {cause: count}
    assert rotor_input.last is newest
    assert rotor_input.resets == 0
    assert accept(rotor_input, START + 1_000_000, -3.0).position.turns == 1
    assert rotor_input.referenced


@pytest.mark.parametrize('age', [SECOND + 1, START - 1, START + 5])
@pytest.mark.parametrize('settings', [SETTINGS, SINGLE_TURN], ids=['multi', 'single'])
def test_stamp_older_by_more_than_a_second_resets_the_state(settings, age):
    rotor_input = RotorInput(settings)
    accept(rotor_input, START, 1.0)
    rotor_input.home(0.0)
    assert accept(rotor_input, START - age, 2.0).stamp == START - age
    assert (rotor_input.resets, rotor_input.rejected.total()) == (1, 0)
    assert rotor_input.referenced is not settings.single_turn
    assert accept(rotor_input, START - age + 1, 2.0).stamp == START - age + 1


@pytest.mark.parametrize('settings', [SETTINGS, SINGLE_TURN], ids=['multi', 'single'])
@pytest.mark.parametrize('direction', [1, -1])
@pytest.mark.parametrize('declared', [0.0, 3.7, -250.0])
def test_home_gives_the_zero_for_the_declared_angle(settings, direction, declared):
    settings = replace(settings, rotor_direction=direction, rotor_zero=0.5)
    rotor_input = RotorInput(settings)
    accept(rotor_input, START, 2.25)
    zero = rotor_input.home(declared)
    rotor_input.parameters = replace(settings, rotor_zero=zero)
    assert rotor_input.referenced
    sample = accept(rotor_input, START + SECOND // 1000, 2.25)
    assert angle_error(sample, oracle.mp.mpf(declared)) < 1e-13


def test_velocity_narrows_the_possible_turn_of_a_single_turn_encoder():
    # 20 ms at a steady 400 rad/s are 8 rad: more than a turn, and known from the velocities.
    rotor_input = homed(0.0, [400.0])
    sample = accept(rotor_input, START + 20_000_000, 8.0 - TURN, [400.0])
    assert rotor_input.referenced
    assert sample.position == (1, pytest.approx(8.0 - TURN))


@pytest.mark.parametrize('speed', [-600.0, -500.0, 500.0, 600.0])
def test_fast_rotor_loses_no_turn_silently_by_a_single_wrong_reading(speed):
    """At 250 Hz, it turns by 2 rad or more between two readings, nearly half a turn."""
    for off in [k / 10 for k in range(1, 63)]:
        rotor_input, error = homed(0.0), math.inf
        for k in range(1, 60):
            position = speed * k / 250
            with suppress(RejectedInputError):
                read = (position + off * (k == 40)) % TURN
                sample = accept(rotor_input, START + k * SECOND // 250, read)
                error = angle_error(sample, position)
            assert k >= 40 or rotor_input.referenced
        assert not rotor_input.referenced or error < 1e-9


def test_change_of_encoder_resets_the_state(rotor_input):
    accept(rotor_input, START, 20.0)
    rotor_input.parameters = SINGLE_TURN
    assert not rotor_input.referenced
    with pytest.raises(RuntimeError):
        rotor_input.home(0.0)
    rotor_input.parameters = SETTINGS
    assert rotor_input.referenced
    rotor_input.parameters = replace(SETTINGS, rotor_joint='other')
    with pytest.raises(RejectedInputError, match=r'^joint missing$'):
        accept(rotor_input, START, 1.0)


def test_other_changes_keep_the_turns_and_hold_from_now_on():
    rotor_input = homed(3.0)
    accept(rotor_input, START + 1_000_000, -3.0)
    rotor_input.parameters = replace(SINGLE_TURN, rotor_zero=0.25, max_rotor_speed=1.0)
    assert accept(rotor_input, START + 3 * SECOND, -3.0).position == (1, -3.25)
    assert rotor_input.referenced  # 3 rad at most
    accept(rotor_input, START + 7 * SECOND, -3.0)
    assert not rotor_input.referenced


@pytest.mark.parametrize('settings', [SETTINGS, SINGLE_TURN], ids=['multi-turn', 'single-turn'])
@pytest.mark.parametrize(('back', 'jump', 'alike'), [
    (2, 0.0, 1), (12, 0.0, 1), (27, 0.0, 1), (400, 0.0, 1), (27, 2.0, 1), (400, -3.0, 1),
    (400, 0.0, 2), (400, -3.0, 2),
])  # fmt: skip
def test_a_clock_that_is_set_back_hides_no_jump_and_loses_no_turn(settings, back, jump, alike):
    rotor_input, end = RotorInput(settings), None
    for k in range(1000):
        ms = (k if k < 500 else k - back) // alike * alike
        angle = 1.0 + 0.3 * k + jump * (k >= 500)
        reading = angle % math.tau if settings.single_turn else angle
        with suppress(RejectedInputError):
            end = accept(rotor_input, START + ms * 1_000_000 + 1, reading)
        if not k:
            rotor_input.home(1.0)
    assert set(rotor_input.rejected) == {'out of order'}
    assert bool(rotor_input.disorder.fault) is (back > 20)
    assert rotor_input.plausibility.beyond_limits is None
    assert bool(rotor_input.plausibility.jumped) == (not rotor_input.referenced) == bool(jump)
    if not jump:
        assert math.tau * end.position.turns + end.position.angle == pytest.approx(angle)


@pytest.mark.parametrize('chunk', [(20, 1), (5, 20), (2, 2)])
def test_messages_that_come_after_later_ones_are_no_jump(chunk):
    late, later = chunk
    order = [*range(100), *range(100 + late, 100 + late + later), *range(100, 100 + late)]
    rotor_input = RotorInput(SETTINGS)
    for k in [*order, *range(len(order), 200)]:
        with suppress(RejectedInputError):
            accept(rotor_input, START + k * 1_000_000, 0.3 * k)
    assert rotor_input.rejected == {'out of order': late}
    assert rotor_input.referenced


@pytest.mark.parametrize('copied', [3, 30, 100])
@pytest.mark.parametrize('position', [lambda t: 20.0 * math.sin(2.0 * t), lambda _: 7.0])
def test_copies_of_earlier_messages_are_no_clock_that_was_set_back(position, copied):
    """A relay repeats them, with their stamps, also while the driver pauses."""
    rotor_input, period = RotorInput(SETTINGS), SECOND // 100
    sent = [(START + k * period, position(k / 100.0)) for k in range(300) if k % 150 < 140]
    for number, message in enumerate(sent):
        copies = sent[number - copied + 1 : number + 1] if number % 140 == 139 else []
        for each in (message, *copies):
            with suppress(RejectedInputError):
                accept(rotor_input, *each)
    assert rotor_input.rejected == {'out of order': 2 * (copied - 1)}
    assert rotor_input.plausibility.jumped is None
    assert rotor_input.disorder.fault is None
    assert rotor_input.referenced


def test_a_turn_while_the_clock_is_set_back_is_seen_from_an_equal_position_and_stamp():
    """A Hall sensor of 24 steps makes it within 0.2 s; the clock is set back by 0.19 s."""
    rotor_input, end = RotorInput(replace(SINGLE_TURN, max_rotor_speed=118.0)), None
    for k in range(100):
        stamp, steps = START + (k - 20 * (k >= 50)) * SECOND // 100, k * 24 // 20
        with suppress(RejectedInputError):
            end = accept(rotor_input, stamp, steps % 24 * math.tau / 24)
        if not k:
            rotor_input.home(0.0)
    assert rotor_input.rejected == {'out of order': 19}
    turned = math.tau * end.position.turns + end.position.angle
    assert not rotor_input.referenced or turned == pytest.approx(steps * math.tau / 24)


@pytest.mark.parametrize('length', [1, 2, 53, 54, 100])
def test_a_clock_that_is_set_back_is_said_wherever_batches_end(length):
    """The last of four readings that are rejected for it can end a batch."""
    rotor_input = RotorInput(SETTINGS)
    sent = [
        rotor_bytes(START + (2 * k - 9 * (k >= 50)) * SECOND // 200, position=[0.01 * k])
        for k in range(100)
    ]
    for first in range(0, 100, length):
        batch = sent[first : first + length]
        rotor_input.accept_batch(batch, [0] * len(batch))
    step = Condition.CLOCK_SET_BACK(size=0.035, time=(START + 49 * SECOND // 100) / SECOND)
    assert (rotor_input.rejected, rotor_input.disorder.fault) == ({'out of order': 4}, step)


@pytest.mark.parametrize('back', range(10, 240, 5))
def test_a_clock_that_is_set_back_by_some_messages_loses_no_turn_silently(back):
    """At 40 Hz, the first message that is rejected came an interval after the last one."""
    rotor_input, end = RotorInput(replace(SINGLE_TURN, max_rotor_speed=60.0)), None
    for k in range(100):
        ms, angle = 25 * k - back * (k >= 50), 1.0 + 1.25 * k
        with suppress(RejectedInputError):
            end = accept(rotor_input, START + ms * 1_000_000, angle % math.tau)
        if not k:
            rotor_input.home(1.0)
    turned = math.tau * end.position.turns + end.position.angle
    assert not rotor_input.referenced or turned == pytest.approx(angle)


@pytest.mark.parametrize('count', [16, 1000])
def test_a_batch_of_messages_that_came_in_one_burst_shows_no_fast_clock(count):
    """As the last ones of a recorder that was held up; they are 5 µs apart."""
    taken = [START + k * 1_000_000 for k in range(count)]
    received = [taken[-1] + 5000 * k for k in range(count)]
    rotor_input = RotorInput(SETTINGS)
    rotor_input.accept_batch([rotor_bytes(t, position=[1e-9 * t]) for t in taken], received)
    assert rotor_input.disorder.fault is None


numbers = st.lists(st.floats(width=64), max_size=2)


@given(
    st.sampled_from([SETTINGS, SINGLE_TURN]),
    st.lists(
        st.tuples(st.integers(-3 * SECOND, 3 * SECOND), numbers, numbers, numbers), max_size=8
    ),
)
@example(SINGLE_TURN, [(0, [1.0], [0.0], []), (SECOND, [1.0], [1e200], [])])
@example(SETTINGS, [(0, [1.7e308], [1.7e308], [-1.7e308])])
@example(SINGLE_TURN, [(0, [1.7e308], [], []), (SECOND, [-1.7e308], [], [])])
def test_any_numbers_are_accepted_or_rejected(settings, messages):
    rotor_input = RotorInput(settings)
    stamp, taken = START, 0
    for step, position, velocity, effort in messages:
        stamp += step
        data = rotor_bytes(stamp, ['rotor'], position, velocity, effort)
        try:
            sample = rotor_input.accept(data, clock)
        except RejectedInputError:
            continue
        taken += 1
        assert math.isfinite(sample.position.angle)
        assert all(value is None or math.isfinite(value) for value in sample[2:])
    assert rotor_input.received == len(messages) == taken + rotor_input.rejected.total()
