# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Velocities that contradict the positions, as drivers send them."""

import math
import re
from contextlib import suppress
from dataclasses import replace

import numpy as np
import pytest
from live import SECOND, rotor_bytes

from gear_kinematics.parameters import NodeParameters
from gear_kinematics.state.disorder import sums_between
from gear_kinematics.state.rotor_input import RotorInput
from gear_kinematics.state.statuses import Condition
from gear_kinematics.state.velocity_field import VelocityField
from gear_kinematics.wire.joint_reader import RejectedInputError

SETTINGS = NodeParameters.load()
TURN = 2.0 * math.pi


def heard(motion, rate, duration, settings=SETTINGS, *, doubted=False):
    """The input after readings at a rate, and its samples; `motion` gives both fields."""
    rotor, samples = RotorInput(settings), []
    for time in np.arange(round(duration * rate)) / rate:
        position, velocity = motion(time)
        data = rotor_bytes(SECOND + round(time * SECOND), position=[position], velocity=[velocity])
        with suppress(RejectedInputError):
            samples.append(rotor.accept(data, int))
    assert doubted or not rotor.rejected
    return rotor, samples


def steady(factor, speed=100.0, rate=500, scatter=0.0, duration=1.0):
    generator = np.random.default_rng(1)
    return heard(
        lambda time: (speed * time, factor * speed + scatter * generator.normal()), rate, duration
    )


FAST, SLOW = {}, {'speed': 1.0, 'rate': 25, 'duration': 8.0}


@pytest.mark.parametrize(('factor', 'motion', 'meaning'), [
    (0.0, FAST, '0'), (30.0 / math.pi, FAST, 'rpm'), (0.5 / math.pi, FAST, 'turns/s'),
    (180.0 / math.pi, FAST, 'deg/s'), (-1.0 / 19.0, FAST, 'the velocity of the output'),
    (-1.0, FAST, 'the velocity with the opposite sign'), (3.0, FAST, 'an unknown quantity'),
    (2.0 * math.pi, FAST, 'rad/s, and the positions turns'),
    (math.pi / 180.0, FAST, 'rad/s, and the positions degrees'),
    (-19.0, FAST, 'those of the rotor, and the positions those of the output'),
    (1.0, {'scatter': 3.0}, None), (1.0, {'speed': -100.0}, None),
    (0.0, {'speed': 0.5}, None),  # too slow to tell
    (0.0, SLOW, '0'), (0.5 / math.pi, SLOW, 'turns/s'),
    (-1.0, SLOW | {'speed': -3.0}, 'the velocity with the opposite sign'), (1.0, SLOW, None),
    (2.0, SLOW, None),  # whole rad/s, rounded up, of half as many
])  # fmt: skip
def test_wrong_velocities_are_named_and_not_passed_on(factor, motion, meaning):
    rotor, samples = steady(factor, **motion)
    found = rotor.velocity_field
    assert (found.meaning and found.meaning.values['meaning']) == meaning
    if meaning:
        assert found.factor == pytest.approx(factor, abs=1e-6)
        assert samples[-1].velocity is None
    else:
        assert all(sample.velocity is not None for sample in samples)


@pytest.mark.parametrize('right', [3.3, 3.8])
def test_velocities_that_become_wrong_are_found_after_a_pause_of_a_second(right):
    rotor, _ = heard(lambda t: (50.0 * t, 50.0 if t < right else 477.0), 100, right + 1.6)
    assert rotor.velocity_field.contradicts


@pytest.mark.parametrize(('period', 'step', 'named'), [
    (0.5, 0.0, 'stuck at one value'), (0.9, 0.0, 'stuck at one value'),
    (5.0, 25.0, None),  # its steps last for up to 0.9 s
])  # fmt: skip
def test_velocities_that_freeze_while_the_speed_changes_are_named(period, step, named):
    def motion(time):
        speed, frozen = (60.0 * math.cos(TURN / period * t) for t in (time, min(time, 1.3)))
        position = 60.0 * period / TURN * math.sin(TURN / period * time)
        return position, math.trunc(speed / step) * step if step else frozen

    meaning = heard(motion, 200, 3.5)[0].velocity_field.meaning
    assert (meaning and meaning.values['meaning']) == named


@pytest.mark.parametrize('seen', [lambda t: t - 0.2, lambda t: t // 0.25 * 0.25])
@pytest.mark.parametrize('change', [1.0, 1.8])
def test_velocities_that_are_late_or_held_are_not_stuck(seen, change):
    def motion(time):
        ramp = min(max(0.0, time - change), 0.1)
        position = 5.0 * time + 275.0 * ramp**2 + 55.0 * max(0.0, time - change - 0.1)
        return position, 5.0 + 550.0 * min(max(0.0, seen(time) - change), 0.1)

    assert all(sample.velocity is not None for sample in heard(motion, 50, change + 1.0)[1])


@pytest.mark.parametrize('rate', [100, 500])
@pytest.mark.parametrize('held', [0.076, 0.078, 0.08])
def test_right_velocities_beside_readings_that_are_repeated_are_no_unknown_quantity(held, rate):
    def motion(time):  # in most intervals of 0.1 s, there is one new reading
        read = held * math.floor(time / held + 1e-9)
        return 100.0 * read + 0.02 * math.sin(7.0 * read), 100.0

    rotor, samples = heard(motion, rate, 8.0, doubted=True)
    assert rotor.velocity_field.meaning is None
    assert all(sample.velocity == 100.0 for sample in samples)


@pytest.mark.parametrize('factor', [1.0, 1.4])
def test_two_comparisons_decide_on_whichever_side_of_a_bound_their_factors_are(factor):
    """Each takes 0.2 s, and between them the factor changes from 0.5 % below to 0.5 % above."""

    def motion(time):
        return 100.0 * time, 100.0 * factor + math.copysign(0.5, time - 0.21)

    rotor, _ = heard(motion, 500, 1.0)
    assert rotor.velocity_field.decided == pytest.approx(1.4 * SECOND)
    assert bool(rotor.velocity_field.meaning) == (factor > 1.0)


@pytest.mark.parametrize('bits', [16, 32])
def test_negative_velocities_that_are_sent_as_unsigned_are_found_at_once(bits):
    """As from the register of a servo, in steps of 0.229 rpm."""
    whole = 2.0**bits * 0.229 * math.pi / 30.0
    rotor, samples = heard(lambda t: (9.0 * math.cos(t), -9.0 * math.sin(t) % whole), 100, 0.3)
    assert rotor.velocity_field.contradicts
    assert samples[-1].velocity is None


def test_velocities_that_become_right_are_named_in_a_recording():
    """As of a driver that sends zeros until it has measured for a while."""
    rotor, _ = heard(lambda t: (50.0 * t, 50.0 * (t >= 2.0)), 100, 4.0)
    field = rotor.velocity_field
    assert (field.contradicts, field.meaning) == (False, None)
    said = str(field.in_recording)
    assert re.fullmatch(r'until 3\.\d+ s, the velocities contradict .* seem to be 0', said)


def stop_and_go(t):
    """Turn by 0.5 rad within 20 ms, ten times a second."""
    return 0.5 * math.floor(10.0 * t) + min(0.5, 25.0 * (t - math.floor(10.0 * t) / 10.0))


COUNT = 2.0 * math.pi / 128.0


@pytest.mark.parametrize(('motion', 'factor', 'meaning'), [
    (lambda t: 4.0 * math.sin(t), 0.0, '0'),
    (lambda t: 100.0 * (t > 4.0) + 0.1 * math.sin(t), 0.0, None),  # a jump near rest
    (lambda t: 4.0 * math.sin(4.0 * t), -1.0, 'the velocity with the opposite sign'),
    (lambda t: 4.0 * math.sin(4.0 * t), 30.0 / math.pi, 'rpm'),
    # Each right only on average: the readings compared see but one phase, or one count or none.
    (stop_and_go, 1.0, None),
    (lambda t: t + 0.05 * math.sin(100.0 * math.pi * t), 1.0, None),
    (lambda t: COUNT * math.floor(15.0 * t / COUNT), 1.0, None),
])  # fmt: skip
def test_velocities_are_judged_by_their_mean_however_unsteady_the_motion_is(
    motion, factor, meaning
):
    def fields(time):
        return motion(time), factor * (motion(time) - motion(time - 0.002)) / 0.002

    rotor, _ = heard(fields, 500, 8.0, doubted=True)
    found = rotor.velocity_field.meaning
    assert (found and found.values['meaning']) == meaning


def swinging(t):
    """Position, rad, velocity and acceleration."""
    waves = [(40.0, 4.4, 0.0), (20.0, 1.9, 1.0)]
    return [
        sum(size * w**n * math.sin(w * t + start + n * math.pi / 2.0) for size, w, start in waves)
        for n in range(3)
    ]


@pytest.mark.parametrize(('sent', 'wrong'), [
    (lambda x, _v, _a: x, True), (lambda _x, _v, a: a, True), (lambda _x, v, _a: abs(v), True),
    (lambda _x, v, _a: v, False), (lambda _x, v, _a: 10.0 * round(v / 10.0), False),
])  # fmt: skip
@pytest.mark.parametrize('held', [0.0, 0.2])
def test_what_is_no_velocity_at_all_is_found_in_unsteady_motion(sent, wrong, held):
    def fields(time):
        read = held * math.floor(time / held) if held else time  # a driver repeats readings
        return swinging(read)[0], sent(*swinging(time))

    limits = replace(SETTINGS, max_rotor_acceleration=1e6)
    rotor, samples = heard(fields, 100, 14.0, limits, doubted=True)
    assert rotor.velocity_field.contradicts == wrong
    named = Condition.VELOCITIES_ARE(meaning='an unknown quantity')
    assert rotor.velocity_field.meaning == (named if wrong else None)
    assert (samples[-1].velocity is None) == wrong


def test_velocities_of_an_oscillation_that_is_sampled_seldom_are_right():
    w = 7.0 * math.tau
    rotor, _ = heard(lambda t: (3.0 * math.sin(w * t), 3.0 * w * math.cos(w * t)), 20, 14.0)
    assert rotor.velocity_field.in_recording is None


def test_velocities_that_are_noise_around_zero_are_not_used():
    rotor, samples = steady(0.0, scatter=2.0)
    assert rotor.velocity_field.contradicts
    assert samples[-1].velocity is None


@pytest.mark.parametrize('step', [0.0, TURN / 60.0])
@pytest.mark.parametrize(('delay', 'named'), [
    (0.0, None), (0.02, None), (0.06, Condition.VELOCITIES_LATE),
    (-0.02, None), (-0.06, Condition.POSITIONS_LATE), (-0.15, Condition.POSITIONS_LATE),
])  # fmt: skip
def test_fields_that_are_late_in_unsteady_motion_are_named(delay, named, step):
    def fields(time):
        position, speed = 40.0 * math.sin(5.0 * time), 200.0 * math.cos(5.0 * (time - delay))
        return step * math.floor(position / step) if step else position, speed

    rotor, samples = heard(fields, 500, 10.0)
    meaning = rotor.velocity_field.meaning
    assert samples[-1].velocity == pytest.approx(fields(9.998)[1])
    assert (meaning and meaning.condition) is named
    if meaning:
        assert meaning.values == {'delay': pytest.approx(abs(delay), rel=0.05)}


def meanings(time, position, velocity):
    """What is said in each second of (n,) readings."""
    field, said = VelocityField(-1 / 19), []
    values = np.column_stack([position, velocity, np.full_like(time, np.nan)])
    stamps = SECOND + np.round(time * SECOND).astype(np.int64)
    for second in np.split(np.arange(len(time)), np.flatnonzero(np.diff(np.floor(time))) + 1):
        field.believed(stamps[second], values[second], 0.05)
        said.append(field.meaning and field.meaning.condition)
    return said


@pytest.mark.parametrize('rows', [[], [0], [0, 1, 199], [50, 100, 150], [3, 40, 41, 80, 140]])
@pytest.mark.parametrize('count', [0, 200])
@pytest.mark.parametrize('carried', [0.0, -7.3])
def test_sums_between_rows_are_those_of_one_addition_after_another(rows, count, carried):
    """To the last bit, so that batches of any size give the same mean velocities."""
    generator = np.random.default_rng(1)
    values = generator.normal(size=count) * 10.0 ** generator.integers(-6, 7, count)
    given = generator.random(count) < 0.8
    values[~given] = 0.0
    values[41:80] = -0.0
    rows = [row for row in rows if row < count]
    expected, counts = [], []
    for start, end in zip([-1, *rows], [*rows, count], strict=True):
        total = 0.0 if expected else carried
        for value in values[start + 1 : end].tolist():
            total += value
        expected.append(total)
        counts.append(int(given[start + 1 : end].sum()))
    sums, found = sums_between(values, given, np.array(rows, np.intp), carried)
    assert [total.hex() for total in sums] == [total.hex() for total in expected]
    assert found == counts


@pytest.mark.parametrize('seed', range(4))
@pytest.mark.parametrize('size', [1, 7, 50, 2000])
def test_means_of_velocities_are_those_of_all_messages_however_they_come(size, seed):
    """To the last bit, also between readings that are not in the same batch."""
    time = np.arange(2000) / 500
    velocity = 30.0 / math.pi * np.random.default_rng(seed).normal(20.0, 9.0, len(time))
    values = np.column_stack([20.0 * time, velocity, np.full_like(time, np.nan)])
    stamps = SECOND + np.round(time * SECOND).astype(np.int64)
    single, batches = VelocityField(-1 / 19), VelocityField(-1 / 19)
    for stamp, (position, given, _) in zip(stamps.tolist(), values.tolist(), strict=True):
        if stamp < single.due:
            single.add(given)
        else:
            single.note(stamp, position, given, 0.05)
    for start in range(0, len(time), size):
        part = slice(start, start + size)
        batches.believed(stamps[part], values[part], 0.05)
    assert batches.factor == single.factor == pytest.approx(30.0 / math.pi, rel=0.1)


def test_delay_stays_named_until_velocities_are_right():
    """Not each part of this motion shows a delay of 0.06 s, which ends after 30 s."""
    time = np.arange(6000) / 100
    position = 10.0 * np.sin(6.0 * time) + 2.0 * np.sin(17.0 * time)
    past = time - 0.06 * (time < 30.0)
    said = meanings(time, position, 60.0 * np.cos(6.0 * past) + 34.0 * np.cos(17.0 * past))
    assert {*said[5:30]} == {Condition.VELOCITIES_LATE}
    assert {*said[35:]} == {None}


def test_right_velocities_are_not_late_where_messages_are_lost():
    time = np.arange(6000) / 100
    time = time[time % 0.7 >= 0.4]
    said = meanings(time, 40.0 * np.sin(4.0 * time), 160.0 * np.cos(4.0 * time))
    assert {*said} == {None}


def test_right_velocities_are_not_too_great_after_a_pause_of_the_driver():
    time = np.arange(600) / 100
    time[200:] += 10.0 * math.tau / 3.0
    said = meanings(time, 20.0 * np.sin(3.0 * time), 60.0 * np.cos(3.0 * time))
    assert {*said} == {None}


def test_velocities_of_0_beside_a_vibration_are_not_late():
    time = np.arange(600) / 100
    assert {*meanings(time, 0.8 * np.sin(8.0 * math.pi * time), 0.0 * time)} == {None}


@pytest.mark.parametrize(('eccentric', 'noise'), [(0.02, 0.0), (0.0, 0.01)])
def test_errors_of_positions_at_a_steady_speed_are_no_delay(eccentric, noise):
    """Even where readings, 0.1 s apart, take them half a turn apart."""
    time, speed = np.arange(36_000) / 100, 5.0 * TURN
    angle = speed * time
    errors = noise * np.random.default_rng(3).uniform(-1.0, 1.0, len(time))
    position = angle + eccentric * np.sin(angle + 0.5) + errors
    values = np.column_stack([position, np.full_like(time, speed), np.zeros_like(time)])
    stamps = SECOND + np.arange(len(time)) * (SECOND // 100)
    rotor = VelocityField(np.nan)
    rotor.believed(stamps, values, 0.05)
    assert rotor.meaning is None


def test_stamps_of_a_coarse_clock_at_a_steady_speed_are_no_delay():
    """The clock ticks each 15.625 ms, and readings are 20 ms apart."""
    for start in np.arange(20) / 1000:
        time = np.arange(600) / 50 + start
        stamps = (np.floor(time / 0.015625) * (SECOND // 64)).astype(np.int64)
        velocity = 300.0 + 3.0 * np.sin(8.0 * time)
        position = 300.0 * time - 0.375 * np.cos(8.0 * time)
        rotor = VelocityField(np.nan)
        rotor.believed(SECOND + stamps, np.column_stack([position, velocity, 0.0 * time]), 0.05)
        assert rotor.meaning is None


@pytest.mark.parametrize('age', [0.0, 0.5])
@pytest.mark.parametrize('rate', [10, 20, 30, 100])
def test_velocities_of_a_slow_driver_are_no_sign_of_a_delay(rate, age):
    """They are those of the end of the travel, or their mean since the message before."""

    def fields(time):
        return 40.0 * math.sin(3.0 * time), 120.0 * math.cos(3.0 * (time - age / rate))

    rotor, _ = heard(fields, rate, 20.0)
    assert rotor.velocity_field.meaning is None


def test_velocities_of_one_count_or_none_of_a_slow_driver_are_no_unknown_quantity():
    count = TURN / 64.0

    def fields(time):
        now, before = (3.0 * math.sin(t + 0.3) // count * count for t in (time, time - 0.002))
        return now, (now - before) / 0.002

    rotor, _ = heard(fields, 10, 30.0)
    assert rotor.velocity_field.in_recording is None


@pytest.mark.parametrize(('rate', 'delay'), [(20, 0.06), (20, -0.06), (30, 0.05), (30, -0.05)])
def test_delay_of_more_than_an_interval_of_a_slow_driver_is_named(rate, delay):
    def fields(time):
        return 40.0 * math.sin(3.0 * time), 120.0 * math.cos(3.0 * (time - delay))

    rotor, _ = heard(fields, rate, 20.0)
    late = Condition.VELOCITIES_LATE if delay > 0.0 else Condition.POSITIONS_LATE
    assert rotor.velocity_field.meaning == late(delay=pytest.approx(abs(delay), rel=0.05))


@pytest.mark.parametrize(('rate', 'vibration'), [
    (20, 8.5), (40, 12.2), (40, 18.0), (50, 9.1), (50, 23.0), (60, 12.3), (100, 22.1)
])  # fmt: skip
def test_vibration_is_no_delay(rate, vibration):
    w = vibration * math.tau
    size = min(1.0, 6000.0 / w**2)

    def fields(time):
        swing = size * math.sin(w * time + 1.0), size * w * math.cos(w * time + 1.0)
        return 2.0 * math.sin(2.0 * time) + swing[0], 4.0 * math.cos(2.0 * time) + swing[1]

    rotor, _ = heard(fields, rate, 20.0)
    assert rotor.velocity_field.in_recording is None


@pytest.mark.parametrize('settings', [SETTINGS, replace(SETTINGS, rotor_encoder='single_turn')])
def test_turns_that_pass_while_a_single_turn_encoder_is_stuck_stay_unknown(settings):
    rotor, rate = RotorInput(settings), 500
    for k in range(6 * rate):
        turned = 50.0 * (k if k < rate else max(k - 3 * rate, rate)) / rate  # stuck until 4 s
        stamp, position = SECOND + k * SECOND // rate, math.remainder(turned, TURN)
        position = position if settings.single_turn else turned
        rotor.accept(rotor_bytes(stamp, position=[position], velocity=[50.0]), int)
        if k in {0, 3 * rate}:
            rotor.home(0.0)
    assert rotor.velocity_field.in_recording.condition is Condition.VELOCITIES_WERE
    assert rotor.referenced != settings.single_turn
    assert rotor.turns.unknown_gaps == 2 * settings.single_turn


@pytest.mark.parametrize(('factor', 'gap', 'referenced'), [
    (1.0, 0.3, True),
    (-1.0, 0.0, True),
    (-1.0, 0.3, False),
])  # fmt: skip
def test_turns_that_wrong_velocities_showed_in_a_gap_are_not_known(factor, gap, referenced):
    limits = {'max_rotor_speed': 100.0, 'max_rotor_acceleration': 100.0}
    settings = replace(SETTINGS, rotor_encoder='single_turn', **limits)
    rotor, rate = RotorInput(settings), 100
    for k in range(3 * rate):
        time = k / rate
        if k and time < gap:
            continue
        position, velocity = math.remainder(20.0 * time, TURN), factor * 20.0
        rotor.accept(
            rotor_bytes(SECOND + k * SECOND // rate, position=[position], velocity=[velocity]), int
        )
        if not k:
            rotor.home(0.0)
    assert rotor.velocity_field.contradicts == (factor < 0.0)
    assert rotor.referenced == referenced


@pytest.mark.parametrize('speed', [2.0, 40.0, 200.0])
def test_right_velocities_do_not_contradict_positions_that_wrap_unexpectedly(speed):
    rotor, _ = heard(lambda time: (speed * time % TURN, speed), 1000, 10.0, doubted=True)
    assert rotor.plausibility.jumps
    assert rotor.velocity_field.in_recording is None


@pytest.mark.parametrize(('velocity', 'stuck'), [
    (lambda t: 50.0 + 25.0 * math.sin(3.0 * t), True),
    (lambda t: 300.0 * math.exp(-10.0 * t), False),  # of a filter behind a rotor that stops
    (lambda t: 300.0 * math.exp(-2.0 * t), False),
    (lambda t: 20.0 * math.sin(20.0 * t), False),  # within a step of the encoder
    (lambda t: 40.0 * math.sin(20.0 * t), True),
])  # fmt: skip
def test_velocities_of_an_unsteady_motion_show_that_an_encoder_is_stuck(velocity, stuck):
    rotor, _ = heard(lambda time: (1.0, velocity(time)), 200, 3.0)
    assert rotor.velocity_field.positions_stand == stuck


@pytest.mark.parametrize(('speed', 'within'), [(60.0, 0.2), (12.0, 0.5)])
@pytest.mark.parametrize('begin', [1.2, 1.65])
@pytest.mark.parametrize('rate', [40, 500])
def test_an_encoder_that_is_stuck_beside_right_velocities_is_named(rate, begin, speed, within):
    def fields(time):
        return speed * min(time, begin) + 0.05 * math.sin(20.0 * min(time, begin)), speed

    rotor, _ = heard(fields, rate, begin + within + 1.5 / rate)
    assert rotor.velocity_field.positions_stand


@pytest.mark.parametrize('end', [0.52, 2.0])
def test_positions_that_are_cut_off_at_an_end_of_their_range_are_named(end):
    """As of 16 bits, of 10⁻⁴ turns each, of a rotor that goes beyond them for 2.6 s at a time."""
    time = np.arange(1600) / 100
    turned = 8.0 * np.sin(0.9 * time)
    said = meanings(time, np.clip(turned, -end * TURN, end * TURN), 7.2 * np.cos(0.9 * time))
    assert {*said[6:]} == {Condition.POSITIONS_STAND if end < 1.0 else None}


def test_an_encoder_that_is_stuck_over_a_pause_of_the_driver_is_named():
    time = np.delete(np.arange(320) / 100, np.s_[235:260])
    braking = np.interp(time, [2.0, 2.35, 2.351], [20.0, 12.0, 14.0])
    *_, said = meanings(time, 20.0 * np.minimum(time, 2.0), braking)
    assert said is Condition.POSITIONS_STAND


@pytest.mark.parametrize('lag', [0.02, 0.1, 0.5])
@pytest.mark.parametrize('stop', [1.2, 1.65])
def test_filtered_velocities_of_a_rotor_that_stops_show_no_stuck_encoder(stop, lag):
    def fields(time):
        return 100.0 * min(time, stop), 100.0 * math.exp(-max(0.0, time - stop) / lag)

    rotor, _ = heard(fields, 200, 2.5)
    assert rotor.velocity_field.meaning is None


@pytest.mark.parametrize('noise', [0.0, 0.002])
@pytest.mark.parametrize(('speed', 'duration'), [(10.0, 2.0), (-1.0, 10.0)])
def test_velocities_of_an_encoder_that_is_stuck_contradict_it(speed, duration, noise):
    def fields(time):
        error = noise * math.sin(1e6 * time)
        return math.copysign(min(abs(speed) * time, 4.0), speed) + error, speed

    rotor, _ = heard(fields, 500, duration)
    assert rotor.velocity_field.meaning == Condition.POSITIONS_STAND()


@pytest.mark.parametrize('rate', [50, 100, 500])
def test_velocities_behind_a_filter_are_no_unknown_quantity(rate):
    """A filter of 0.2 s leaves 37 % of swings of 2 Hz, 68° late."""
    turning, time = 4.0 * math.pi, np.arange(30 * rate) / rate
    response = 1j * turning / (1.0 + 0.2j * turning)
    for seed in range(5):
        swing = 10.0 * np.exp(1j * (turning * time + seed))
        noise = 1e-3 * np.random.default_rng(seed).normal(size=len(time))
        states = np.column_stack([swing.real + noise, (response * swing).real, np.nan * time])
        field = VelocityField(-1 / 19)
        field.believed(SECOND + np.round(SECOND * time).astype(np.int64), states, 1e-3)
        assert not field.contradicts
