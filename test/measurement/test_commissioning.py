# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""What recordings of known gears determine, and what they leave open."""

import math
from dataclasses import replace
from fractions import Fraction
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from gear_recordings import encoders, two_encoders_at_one_shaft
from hypothesis import given, settings
from hypothesis import strategies as st
from simulated_encoders import TURN, Drive, ramped_strokes, stamps

from gear_kinematics.kinematics.gear_ratio import GearRatio
from gear_kinematics.measurement.commissioning.analysis import (
    Channel,
    Request,
    commission,
    encoder_kind,
)
from gear_kinematics.measurement.commissioning.document import actuator_file, document
from gear_kinematics.measurement.encoder_range import find_range
from gear_kinematics.measurement.encoder_step import Step
from gear_kinematics.measurement.gate import gated
from gear_kinematics.measurement.recording import Recording, RecordingError
from gear_kinematics.measurement.sentences import Observation
from gear_kinematics.parameters import NodeParameters

STROKE = 15.0  # rad of the output
FULL_TURN = ramped_strokes(STROKE, 10.0, 1.0)


def recorded(rotor, output, times):
    both = encoders(rotor, output, stamps(times))
    return Recording(Path('gear'), 'gear', (), len(rotor), both)


def wrapped(angle, turn, low=0.0):
    return low + np.remainder(angle - low, turn)


@cache
def driven(ratio, profile):
    drive = Drive(ratio=ratio, errors={1.0: 5e-4}, noise=5e-5, rotor_step=TURN / 2**14)
    return drive.readings(profile, 40.0, rate=100.0)


def readings(
    ratio=-19.0, senses=(1, 1), zeros=(0.0, 0.0), wraps=(False, False), low=0.0, profile=FULL_TURN
):
    """Times, and positions of rotor and output of a real gear, rad."""
    times, *angles = driven(float(ratio), profile)
    rotor, output = (
        sense * angle + zero for sense, angle, zero in zip(senses, angles, zeros, strict=True)
    )
    if wraps[0]:
        rotor = wrapped(rotor, TURN, low)
    if wraps[1]:
        output = wrapped(output, TURN, low)
    return times, rotor, output


def commissioned(*recordings, **request):
    nowhere = Channel('', '')
    return commission(recordings, Request(rotor=nowhere, output=nowhere, **request))


def parameters(result, folder):
    path = folder / 'actuator.yaml'
    path.write_text(actuator_file(result), encoding='utf-8')
    return NodeParameters.load(path)


def value(result, name):
    (found,) = (each.value for each in result.values if each.name == name)
    return found


@pytest.mark.parametrize('turns', [1, 2])
def test_an_output_whose_positions_repeat_after_some_turns_is_unwrapped(turns):
    times, rotor, output = readings()
    result = commissioned(recorded(rotor, wrapped(output, turns * TURN, -1.0), times))
    assert value(result, 'gear_ratio') == '-19'
    assert result.longest.travel == pytest.approx(np.ptp(output), abs=1e-3)


@pytest.mark.parametrize(
    ('ratio', 'senses', 'wraps'),
    [
        (Fraction(-19), (1, 1), (False, False)),
        (Fraction(-19), (-1, 1), (True, False)),
        (Fraction(-19), (-1, -1), (True, True)),
        (Fraction(1457, 26), (1, -1), (False, True)),
        (Fraction(36, 5), (1, -1), (True, False)),
    ],
)
def test_file_gives_the_output_angle_of_the_encoder(ratio, senses, wraps, tmp_path):
    times, rotor, output = readings(ratio, senses, (2.5, -0.4), wraps)
    result = commissioned(recorded(rotor, output, times), ratio=GearRatio(ratio))
    file = parameters(result, tmp_path)
    assert GearRatio.parse(file.gear_ratio) == ratio
    assert file.rotor_direction * file.output_encoder_direction == senses[0] * senses[1]
    assert file.rotor_encoder == ('single_turn' if wraps[0] else 'multi_turn')
    # As documented of the node: φ2 = direction · (position - zero), φ5 = φ2/i.
    by_rotor = file.rotor_direction * (rotor - file.rotor_zero) / float(ratio)
    error = output - file.output_encoder_zero - by_rotor
    if any(wraps):  # of rotor turns and output turns together, all multiples of this are
        whole = TURN / abs(ratio.numerator)
        error = wrapped(error, whole, -0.5 * whole)
    assert np.max(np.abs(error)) < 2.5e-3


COUNT = TURN / 4096  # of a counter


@pytest.mark.parametrize(
    ('size', 'low', 'step', 'found'),
    [
        (25.0, -12.5, 0.0, 25.0),
        (8 * math.pi, -4 * math.pi, 0.0, 8 * math.pi),
        (25.14, -12.57, 25.14 / 65535, 25.14),
        (65536 * COUNT, -32768 * COUNT, COUNT, 16 * TURN),
        (65535 * COUNT, -32767 * COUNT, COUNT, 65535 * COUNT),
        (65536 / 10_000 * TURN, 0.0, TURN / 10_000, 6.5536 * TURN),
    ],
)
@pytest.mark.parametrize('every', [1, 4])
def test_position_that_repeats_after_another_range(size, low, step, found, every, tmp_path):
    """As protocols have that send ±12.5 rad or ±4π, and of counters of 16 bits."""
    times, rotor, output = (values[::every] for values in readings(zeros=(7.0, 0.0)))
    position = wrapped(rotor, size, low)
    position = np.round(position / step) * step if step else position
    result = commissioned(recorded(position, output, times))
    assert result.between == -19
    assert result.answer.what is Observation.RATIO_AND_RANGE
    assert result.answer.values['size'] == pytest.approx(found, rel=4e-6, abs=1e-8)
    file = parameters(result, tmp_path)
    assert file.rotor_encoder_range == pytest.approx(found, rel=4e-6, abs=1e-8)
    error = (rotor - file.rotor_zero) / -19.0 - output
    assert np.max(np.abs(wrapped(error, size / 19, -size / 38))) < 4e-3


def test_wraps_of_a_fast_output_are_counted_by_the_rotor():
    """From row to row it turns by up to 0.29 turns, and where two rows are left out, by 0.76."""
    rotor, output, times = two_encoders_at_one_shaft(150.0, seed=1)
    kept = np.arange(len(times)) % 20 < 18
    result = commissioned(recorded(rotor[kept], wrapped(output[kept], TURN), times[kept]))
    assert result.between == -1
    assert abs(result.ratio.measured.value + 1.0) < 2.0 * result.ratio.measured.expanded < 0.01


def test_a_slip_of_a_position_that_repeats_is_named(tmp_path):
    times, rotor, output = readings(zeros=(7.0, 0.0))
    row = len(times) * 11 // 20
    slipped = output + 0.15 * (np.arange(len(times)) >= row)
    result = commissioned(recorded(wrapped(rotor, 25.0, -12.5), slipped, times))
    assert (result.between, result.answer.what) == (-19, Observation.RATIO_AND_RANGE)
    jump, *_ = result.longest.recording.faults
    assert (jump.what, jump.values['moment']) == (Observation.JUMPED, pytest.approx(times[row]))
    error = (rotor - parameters(result, tmp_path).rotor_zero) / -19.0 - output
    assert np.max(np.abs(wrapped(error[:row], 25.0 / 19, -25.0 / 38))) < 4e-3


def test_steps_of_a_servo_and_a_restart_are_no_range():
    times, rotor, _ = readings()
    servo = np.where(np.arange(len(rotor)) // 50 % 2, 1.5, -1.5)
    restarted = rotor - 40.0 * (times > 12.0)
    for values in (servo, restarted):
        noisy = values + 1e-4 * np.sin(np.arange(len(values)))
        assert find_range(noisy, times, Step(0.0, seen=False)) == (0.0, 0)


def test_gaps_hide_no_wraps_and_wraps_that_are_too_fast_are_named():
    late = np.random.default_rng(1).random(600) < 0.05
    times = np.arange(600)[~late] / 100.0
    for speed, found in ((100.0, TURN), (270.0, 0.0)):
        rotor = wrapped(speed * times, TURN)
        assert find_range(rotor, times, Step(0.0, seen=False))[0] == found
    (kind,) = encoder_kind([(0.0, 0)], float(np.ptp(rotor)), 270.0 * 6.0 / 19.0)
    assert (kind.value, kind.evidence.what) == (None, Observation.WRAPS_UNCLEAR)


@pytest.mark.parametrize('period', [25.0, 2.0 * TURN, 4.0 * TURN])
def test_times_of_samples_that_are_uneven_hide_no_round_range(period):
    times, count = np.arange(6000) / 100.0, TURN / 16384
    rotor = 132.0 - np.abs(66.0 * times % 528.0 - 264.0)  # rad: to and fro at a steady speed
    values = np.round(wrapped(rotor, period) / count) * count
    late = np.random.default_rng(4).uniform(0.0, 0.001, len(times))
    found, wraps = find_range(values, times + late, Step(count, seen=True))
    assert (found, wraps > 100) == (pytest.approx(period, rel=1e-12), True)


@given(
    ratio=st.fractions(3, 60, max_denominator=5),
    senses=st.tuples(st.sampled_from((1, -1)), st.sampled_from((1, -1))),
    zeros=st.tuples(st.floats(-50.0, 50.0), st.floats(-3.0, 3.0)),
    wraps=st.tuples(st.booleans(), st.booleans()),
    low=st.sampled_from((0.0, -math.pi)),
)
@settings(max_examples=5, deadline=None)
def test_ratio_and_sign_are_found_or_open(ratio, senses, zeros, wraps, low):
    times, rotor, output = readings(ratio, senses, zeros, wraps, low)
    result = commissioned(recorded(rotor, output, times))
    truth, measured = senses[0] * senses[1] * ratio, result.ratio.measured
    assert abs(measured.value - truth) <= 2.0 * measured.uncertainty
    assert result.between in (truth, None)
    if result.between:  # nothing tells which encoder counts backwards
        assert value(result, 'gear_ratio') == str(truth)
        assert value(result, 'rotor_direction') == 1
    known = commissioned(recorded(rotor, output, times), ratio=GearRatio(ratio))
    assert value(known, 'rotor_direction') == senses[0] * senses[1]


def test_several_recordings_tell_the_ratio_by_the_longest_and_the_zero_by_the_last():
    times, rotor, output = readings()
    short = recorded(rotor[:1500] + 1.9, output[:1500], times[:1500])
    result = commissioned(recorded(rotor, output, times), short)
    assert (result.between, result.longest.travel) == (-19, np.ptp(output))
    assert value(result, 'rotor_zero') == pytest.approx(1.9, abs=0.02)
    lines = actuator_file(result).splitlines()
    command = [line for line in lines if '--ros-args' in line]
    assert len(command) == 1  # to be copied
    assert max(len(line) for line in lines if line not in command) <= 110


def test_a_stray_reading_does_not_hide_how_far_to_turn():
    times, rotor, output = readings(profile=ramped_strokes(1.5, 10.0, 1.0))
    result = commissioned(gated(recorded(rotor, output + 0.1 * (times == times[1800]), times)))
    (stray,) = result.longest.recording.faults
    assert (stray.what, result.between) == (Observation.STRAY, None)
    assert '; turn the output by 390° or more, or give' in str(result.answer)


def test_less_than_a_rotor_turn_leaves_the_kind_open():
    times, rotor, output = readings(profile=ramped_strokes(0.2, 10.0, 1.0))
    result = commissioned(recorded(rotor, output, times), ratio=GearRatio(-19))
    (kind,) = (each for each in result.values if each.name == 'rotor_encoder')
    assert (kind.value, kind.evidence.what) == (None, Observation.TURNED_TOO_LITTLE)
    assert kind.evidence.values['turns'] == pytest.approx(0.605, abs=5e-4)
    assert 'rotor_encoder' not in actuator_file(result).split('# Open')[0]


@pytest.mark.parametrize(
    ('unit', 'said'),
    [
        (lambda r, o: (np.degrees(r), o), r'rotor are degrees .*1/2\^14 turn.*by 0.0174532925'),
        (lambda r, o: (r, np.degrees(o) % 360.0), r'output are degrees .*\d+ wraps at 360'),
        (lambda r, o: (np.round(r / TURN * 2**14) / 2**14, o), r'turns .*1/2\^14 .*by 6.28318531'),
        (lambda r, o: (np.floor(r / TURN % 1.0 * 4096), o), r'counts .*\d+ wraps at 4096'),
        (lambda r, o: (np.floor(r / TURN % 1.0 * 4000), o), 'counts .*unknown number'),
        (lambda r, o: (np.floor(r / TURN * 4096), o), 'counts .*whole numbers.*unknown number'),
    ],
)
def test_positions_in_another_unit_are_told(unit, said):
    times, *angles = readings()
    with pytest.raises(RecordingError, match=said):
        commissioned(recorded(*unit(*angles), times))


@pytest.mark.parametrize('moment', ['START', 'END', 1_700_000_004.0])
def test_zero_is_where_it_is_named(moment):
    times, rotor, output = readings(zeros=(7.0, 0.3), wraps=(False, True))
    result = commissioned(recorded(rotor, output, times), zero_here=moment)
    row = {'START': 0, 'END': -1}.get(moment, 400)
    zero = value(result, 'output_encoder_zero')
    assert math.remainder(output[row] - zero, TURN) == pytest.approx(0.0, abs=1e-8)
    turned = (rotor[row] - value(result, 'rotor_zero')) / -19.0
    assert turned == pytest.approx(0.0, abs=2e-3)


def test_zero_outside_of_the_recording_is_refused():
    times, rotor, output = readings()
    with pytest.raises(RecordingError, match='50 s is not in 1700000000 to 17'):
        commissioned(recorded(rotor, output, times), zero_here=50.0)


def test_rotor_and_output_that_are_exchanged_give_no_file():
    times, rotor, output = readings()
    result = commissioned(recorded(output, rotor, times))
    assert 'the output turns more than the rotor: exchange the two' in str(result.answer)
    assert not result.between


def test_turns_that_pass_in_a_gap_leave_the_ratio_open():
    times, rotor, output = readings(wraps=(True, False))
    seen = (times < 2.0) | (times >= 2.4)  # the rotor turns at 5 Hz
    assert not commissioned(recorded(rotor[seen], output[seen], times[seen])).between


@pytest.mark.parametrize(('late', 'named'), [(0.01, 'LATE'), (-0.01, 'EARLY')])
def test_stamps_of_the_output_are_late_or_early(late, named):
    times, rotor, output = readings()
    at = slice(10, -10)
    found = commissioned(
        recorded(rotor[at], np.interp(times - late, times, output)[at], times[at])
    )
    (delay,) = (what.values['delay'] for what in found.notes if what.what.name == named)
    assert delay.value == pytest.approx(0.01, abs=1e-3)


def test_greatest_speed_is_allowed_twice():
    times, rotor, output = readings()
    fast = recorded(rotor * 40.0, output, times)
    speed = value(commissioned(fast), 'max_rotor_speed')
    # 15 rad in 10 s with ramps of 1 s: 15/9 rad/s at the output.
    assert speed == pytest.approx(2.0 * 40.0 * 19.0 * 15.0 / 9.0, rel=0.01)


@pytest.fixture(scope='module')
def found_before(tmp_path_factory) -> NodeParameters:
    times, rotor, output = readings(zeros=(2.5, 0.3), wraps=(True, True))
    result = commissioned(recorded(rotor, output, times))
    return parameters(result, tmp_path_factory.mktemp('before'))


@pytest.mark.parametrize(
    ('change', 'contradicted'),
    [
        ({}, set()),
        ({'rotor_direction': -1}, {'rotor_direction'}),
        ({'gear_ratio': '-18'}, set()),  # a fault
        ({'rotor_encoder': 'multi_turn'}, {'rotor_encoder'}),
        ({'rotor_zero': 3.5}, {'rotor_zero'}),
        ({'rotor_zero': 3.5, 'output_encoder_reference': 'absolute'}, set()),  # found at the start
        ({'rotor_zero': 2.5 + 19.0 * 0.3}, set()),  # another turn of a single-turn encoder
        ({'output_encoder_zero': 0.1}, {'rotor_zero'}),
        ({'max_rotor_speed': 3.0}, {'max_rotor_speed'}),
    ],
)
def test_check_names_what_a_new_recording_contradicts(change, contradicted, found_before):
    times, rotor, output = readings(
        zeros=(2.5, 0.3), wraps=(True, True), profile=ramped_strokes(9.0, 7.0, 1.0)
    )
    file = replace(found_before, **change)
    result = commissioned(recorded(rotor, output, times), ratio=file.gear.gear_ratio, file=file)
    assert set(document(result, 'a.yaml').data['contradicted']) == contradicted
    assert (result.between is None) == (change == {'gear_ratio': '-18'})
