# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Readings that cannot be true are left out before anything is fitted."""

import math
import re
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from gear_recordings import Gear, creep, ramps, write_csv
from simulated_encoders import ARC_MINUTE, TURN, Drive, even_strokes, ramped_strokes, with_play

from gear_kinematics.measurement.answer import Limits, answer
from gear_kinematics.measurement.calibration import fit
from gear_kinematics.measurement.columns import Sources
from gear_kinematics.measurement.gate import gated
from gear_kinematics.measurement.loops import RampError
from gear_kinematics.measurement.lost_motion import measure
from gear_kinematics.measurement.ramp_gate import gated_ramps
from gear_kinematics.measurement.reading import read
from gear_kinematics.measurement.recording import RecordingError
from gear_kinematics.measurement.sentences import Observation
from gear_kinematics.measurement.tables import read_table
from gear_kinematics.parameters import NodeParameters

RATIO = Fraction(-19)


@pytest.fixture
def clean(shared_path):
    """Columns of time, rotor and output of a real motion, 25 Hz."""
    path = shared_path('data/faults/both_encoders_clean.csv')
    return np.loadtxt(path, delimiter=',', skiprows=1)


@pytest.fixture
def gate(tmp_path):
    """Give a function that reads columns, and returns the recording before and after the gate."""

    def of(columns):
        time_s, rotor_rad, output_rad = columns.T
        path = tmp_path / 'both.csv'
        write_csv(path, time_s=time_s, rotor_rad=rotor_rad, output_rad=output_rad)
        recording = read_table(path, Sources(), RATIO)
        return recording, gated(recording)

    return of


def test_nothing_is_left_out_of_a_clean_recording(clean, gate):
    before, after = gate(clean)
    assert after is before


def test_times_that_few_rows_share_change_no_error(tmp_path):
    """1.2 kHz with times in ms: the error of the gear is ±1 mrad, as no row is a late one."""
    time = np.arange(12_000) / 1200.0
    rotor, path = 30.0 * np.sin(math.pi * time), tmp_path / 'both.csv'
    output = rotor / 10.0 + 1e-3 * np.sin(rotor)
    write_csv(path, time_s=np.floor(1e3 * time) / 1e3, rotor_rad=rotor, output_rad=output)
    parameters = NodeParameters.of({'gear_ratio': '10'})
    found = measure(read_table(path, Sources(), Fraction(10)), parameters).transmission
    assert found.forward.value == pytest.approx(2e-3, rel=1e-2)


@pytest.mark.parametrize('rows', [1320, 1319])
def test_two_samples_may_have_the_same_time(clean, gate, rows):
    columns = clean[:rows].copy()
    columns[1::2, 0] = columns[: rows - 1 : 2, 0]
    before, after = gate(columns)
    assert after is before


@pytest.mark.parametrize(
    ('decimals', 'error', 'named'), [(15, 0.0, True), (6, 0.0, True), (6, 1e-5, False)]
)
def test_output_that_is_computed_from_the_rotor_is_named(clean, gate, decimals, error, named):
    """The best gears and encoders deviate by some seconds of arc, 1e-5 rad."""
    clean[:, 2] = np.round(clean[:, 1] / -19.0 + error * np.sin(clean[:, 1]), decimals)
    _, found = gate(clean)
    assert [fault.what for fault in found.faults] == [Observation.COMPUTED] * named
    report = measure(found, NodeParameters.load())
    (check,) = Limits(lost_motion=1.0).judge(report)
    assert (answer(report).what is Observation.COMPUTED) is named
    assert check.holds is not named


def test_a_gear_whose_only_error_is_its_play_is_not_taken_for_computed(gate):
    time = np.arange(3000) * 0.01
    ideal = 4.0 * np.sin(0.4 * time)
    play = math.radians(0.1)
    _, found = gate(np.column_stack([time, -19.0 * ideal, with_play(ideal, play)]))
    report = measure(found, NodeParameters.load())
    assert answer(report).what is not Observation.COMPUTED
    (check,) = Limits(lost_motion=play / 2).judge(report)
    assert check.why.what is Observation.BEYOND_LIMIT


@pytest.mark.parametrize(
    'wrong',
    [
        {(700, 2): 3.0},
        {(700, 1): 0.0},
        {(371, 1): -136.0},
        {(371, 1): -68.8},
        {(100, 2): 3.0, (300, 1): 0.0, (301, 1): 9e3, (900, 2): 9},
    ],
    ids=['output', 'rotor', 'rotor at a reversal', 'rotor by a degree there', 'several'],
)
def test_stray_readings_are_left_out_and_named(clean, gate, wrong):
    for place, value in wrong.items():
        clean[place] = value
    rows = np.delete(np.arange(len(clean)), [row for row, _ in wrong])
    _, found = gate(clean)
    both = found.encoders
    assert both.measured == pytest.approx(clean[rows, 2], abs=1e-9)
    assert both.at_measured(both.rotor.turned) == pytest.approx(clean[rows, 1], abs=1e-6)
    (fault,) = found.faults
    assert fault.what is Observation.STRAY
    assert fault.values['moments'] == pytest.approx(
        0.04 * np.unique([row for row, _ in wrong])[:3]
    )


@pytest.mark.parametrize(('column', 'value'), [(1, -9999.0), (2, 0.0)], ids=['rotor', 'output'])
@pytest.mark.parametrize('every', [97, 25])
def test_many_stray_readings_are_left_out(clean, gate, column, value, every):
    clean[100::every, column] = value
    _, found = gate(clean)
    assert np.ptp(found.encoders.error(RATIO)) < np.radians(0.5)
    assert len(found.encoders.measured) >= len(clean) * (1.0 - 3.0 / every)
    assert found.encoders.rotor_step.size < 0.01


@pytest.mark.parametrize('column', [1, 2], ids=['rotor', 'output'])
def test_a_frozen_encoder_is_named_and_its_readings_are_left_out(clean, gate, column):
    clean[700:760, column] = clean[700, column]
    clean[900:920, column] = clean[900, column]
    _, found = gate(clean)
    assert len(found.encoders.measured) == len(clean) - 80
    assert np.ptp(found.encoders.error(RATIO)) < np.radians(0.5)
    spans = ['28 to 30.36 s', '36 to 36.76 s']
    assert found.faults == (Observation.STOOD_STILL(spans=spans, more=0, count=80),)


@pytest.mark.parametrize(
    ('column', 'size', 'degrees'),
    [(2, np.radians(1.0), 1.0), (2, np.radians(12.0), 12.0), (1, 2.0 * np.pi, 360.0 / 19.0)],
    ids=['slip by 1 degree', 'slip by a tooth', 'rotor jumps by a turn'],
)
def test_a_jump_divides_and_is_named_with_its_moment(clean, gate, column, size, degrees):
    clean[900:, column] += size
    _, found = gate(clean)
    assert found.encoders.measured == pytest.approx(clean[:900, 2], abs=1e-9)
    clean[300:, column] += size
    _, other = gate(clean)
    assert other.encoders.moment[[0, -1]] == pytest.approx([12.0, 35.96])  # of the recording
    jump = found.faults[0].values
    assert (found.faults[0].what, jump['moment']) == (Observation.JUMPED, pytest.approx(36.0))
    assert np.degrees(jump['angle']) == pytest.approx(degrees, abs=0.1)  # and the gear's own error


@pytest.mark.parametrize(('row', 'column', 'size'), [(600, 2, 5e-3), (372, 1, 0.6)])
def test_a_small_slip_and_a_jump_at_a_reversal_are_named(clean, gate, row, column, size):
    """What stays at all angles and ways is no lost motion, however small it is."""
    clean[row:, column] += size
    _, found = gate(clean)
    jump = found.faults[0]
    assert (jump.what, jump.values['moment']) == (Observation.JUMPED, pytest.approx(0.04 * row))
    assert len(found.encoders.measured) == max(row, len(clean) - row)


@pytest.mark.parametrize('way', ['there', 'back'])
@pytest.mark.parametrize(('strokes', 'degrees'), [(2, 0.2), (2, 0.0), (4, 0.12), (4, 0.0)])
def test_a_slip_of_a_tenth_of_a_degree_is_named_if_only_strokes_beside_it_show_it(
    gate, strokes, degrees, way
):
    """A gear's error at an angle is there on the way back, too."""
    drive = Drive(
        errors={1.0: 8.0 * ARC_MINUTE, 4.0: ARC_MINUTE, 19.0: 2.0 * ARC_MINUTE},
        noise=1e-4,
        rotor_step=TURN / 2**14,
        output_step=TURN / 2**17,
    )
    profile = ramped_strokes(math.radians(330.0), 10.0 / strokes, 0.3)
    time, rotor, output = drive.readings(profile, 10.0, 200.0)
    row = 800 if way == 'there' else 1200
    output[row:] += math.radians(degrees)
    _, found = gate(np.column_stack([time, rotor, output]))
    named = [fault for fault in found.faults if fault.what is Observation.JUMPED]
    moments = [jump.values['moment'] for jump in named]
    assert moments == pytest.approx([time[row]] * bool(degrees), abs=0.02)


def test_each_of_many_slips_divides_and_is_told(clean, gate):
    """Five parts of 12 s: no part is a quarter of the recording."""
    for row in (300, 600, 900, 1200):
        clean[row:, 2] += np.radians(5.0)
    _, found = gate(clean)
    assert len(found.encoders.measured) == 300
    named = [fault.values for fault in found.faults if fault.what is Observation.JUMPED]
    assert [jump['moment'] for jump in named] == pytest.approx([12.0, 24.0, 36.0])
    assert Observation.JUMPED_FURTHER(count=1) in found.faults


@pytest.mark.parametrize('size', [0.1, 0.3, 50.0])
def test_a_clock_that_is_set_back_goes_on_and_is_told(clean, gate, size):
    clean[900:, 0] -= size
    recording, _ = gate(clean)
    assert recording.encoders.measured == pytest.approx(clean[:, 2], abs=1e-9)
    assert recording.encoders.seconds == pytest.approx(0.04 * np.arange(len(clean)), abs=1e-6)
    assert recording.faults == (Observation.SET_BACK_AFTER(size=size, seconds=35.96),)


@pytest.mark.parametrize('rows', [[901, 900], [903, 900, 901, 902], [902, 903, 900, 901]])
def test_rows_that_are_written_late_are_no_clock_that_is_set_back(clean, gate, rows):
    clean[900 : 900 + len(rows)] = clean[rows]
    recording, _ = gate(clean)
    assert (recording.faults, len(recording.remarks)) == ((), 1)


def test_lost_motion_within_a_sample_is_no_fault(gate):
    wave = np.abs((np.arange(1200) + 0.3) % 300 - 150)
    ideal = np.radians(2.0 * wave)
    output = ideal + np.radians(0.4) * np.sign(np.gradient(wave))
    before, after = gate(np.column_stack([0.04 * np.arange(1200), -19.0 * ideal, output]))
    assert after is before


@pytest.mark.parametrize(
    ('bits', 'delay', 'degrees', 'seconds', 'play'),
    [(8, -0.005, 330, 2.5, 20), (8, 0.005, 60, 2.5, 3)],
)
def test_a_delay_of_the_output_is_no_slip_at_a_reversal(gate, bits, delay, degrees, seconds, play):
    """Strokes at one speed, recorded at 200 Hz: a delay steps by twice the way meanwhile."""
    drive = Drive(
        play=play * ARC_MINUTE,
        errors={1.0: 8.0 * ARC_MINUTE, 19.0: 2.0 * ARC_MINUTE},
        noise=1e-4,
        delay=delay,
        rotor_step=TURN / 2**bits,
        output_step=TURN / 2**17,
    )
    strokes = even_strokes(math.radians(degrees), seconds)
    before, after = gate(np.column_stack(drive.readings(strokes, 10.0, 200.0)))
    assert after is before


def test_a_late_output_is_no_slip_where_strokes_differ_in_speed(gate):
    """The way during the delay changes at each reversal, as each stroke has its own speed."""
    ends = np.cumsum([0.0, 2.0, 8.0, 4.0, 2.0])
    time = np.arange(0.0, ends[-1], 0.02)
    rotor, late = (np.interp(time + ahead, ends, [0, 4, 0, 4, 0]) for ahead in (0.0, 0.003))
    noise = np.random.default_rng(1).normal(0.0, 2e-5, len(time))
    output = with_play(late, 6.0 * ARC_MINUTE) + noise
    before, after = gate(np.column_stack([time, -19.0 * rotor, output]))
    assert after is before


def test_a_stray_reading_that_hardly_leaves_the_limit_is_no_jump(clean, gate):
    clean[999:1005, 2] -= np.radians(0.1)
    clean[1000, 2] += np.radians(0.35)
    before, after = gate(clean)
    assert not [fault for fault in after.faults if fault.what is Observation.JUMPED]
    assert len(after.encoders.measured) >= len(before.encoders.measured) - 1


@pytest.mark.parametrize('seed', range(4))
def test_late_readings_of_the_rotor_are_no_slips(tmp_path, seed):
    """The stamps of 2 % are 20 to 60 ms late; the output is sampled at other moments."""
    random = np.random.default_rng(seed)
    times = np.arange(6000) / 100.0
    late = np.where(random.random(6000) < 0.02, random.uniform(0.02, 0.06, 6000), 0.0)
    strokes, then = ramped_strokes(math.radians(70.0), 1.6, 0.3), times + 0.0037
    output = with_play(strokes(then), 5.0 * ARC_MINUTE) + random.normal(0.0, 3e-5, 6000)
    columns = {'rotor_time_s': times, 'rotor_rad': -19.0 * strokes(times - late)}
    columns |= {'output_time_s': then, 'output_rad': output}
    write_csv(tmp_path / 'both.csv', **columns)
    after = gated(read_table(tmp_path / 'both.csv', Sources(), RATIO))
    assert {fault.what for fault in after.faults} == {Observation.STRAY}
    assert len(after.encoders.measured) > 5000


@pytest.mark.parametrize('seed', range(3))
def test_late_readings_in_slow_motion_change_no_lost_motion(gate, config, seed):
    """At 0.2 rad/s, readings that are 20 to 60 ms late are wrong by 0.2° to 0.7°."""
    random = np.random.default_rng(seed)
    times = np.arange(6000) / 100.0
    late = np.where(random.random(6000) < 0.02, random.uniform(0.02, 0.06, 6000), 0.0)
    strokes = ramped_strokes(math.radians(70.0), 6.0, 1.5)
    output = np.interp(times - late, times, with_play(strokes(times), 5.0 * ARC_MINUTE))
    output += random.normal(0.0, 3e-5, 6000)
    _, after = gate(np.column_stack([times, -19.0 * strokes(times), output]))
    lost = measure(after, config).transmission.lost_motion
    assert lost.value == pytest.approx(5.0 * ARC_MINUTE, abs=lost.expanded)
    assert lost.expanded < 0.5 * ARC_MINUTE


@pytest.mark.parametrize(('rate', 'play'), [(20.0, 10.0), (100.0, 90.0)])
def test_play_that_is_crossed_slowly_is_no_stray_reading(gate, rate, play):
    times = np.arange(20.0 * rate) / rate
    ideal = ramped_strokes(math.radians(70.0), 7.0, 1.5)(times)
    noise = np.random.default_rng(1).normal(0.0, 1e-5, len(times))
    output = with_play(ideal, play * ARC_MINUTE) + noise
    before, after = gate(np.column_stack([times, -19.0 * ideal, output]))
    assert after is before


@pytest.mark.parametrize('delay', [0.004, -0.008])
def test_short_stops_are_no_stray_readings_where_an_encoder_is_late(gate, delay):
    """Ten stops of 0.05 s; the output or the rotor is late."""
    fine = np.arange(40_000) / 1000.0
    stopped = np.isin(np.arange(40_000) // 50, 33 + 72 * np.arange(10))
    speed = np.where(stopped, 0.0, np.where(fine < 20.0, 1.0, -1.0))
    angle = 1e-3 * np.cumsum(np.convolve(speed, np.full(30, 1.0 / 30.0), 'same'))
    times = fine[20:-20:10]
    output = np.interp(times - delay, fine, with_play(angle, 5.0 * ARC_MINUTE))
    output += np.random.default_rng(1).normal(0.0, 1e-5, len(times))
    before, after = gate(np.column_stack([times, -19.0 * np.interp(times, fine, angle), output]))
    assert after is before


@pytest.mark.parametrize(
    ('rate', 'play', 'delay', 'kept', 'seed'),
    [
        (30.0, 60.0, 0.0, 1.0, 3),
        (200.0, 60.0, 0.0, 0.7, 0),
        (500.0, 60.0, 0.0, 0.7, 2),
        (100.0, 5.0, 0.002, 1.0, 1),
        (100.0, 5.0, 0.002, 1.0, 13),
        (200.0, 60.0, 0.005, 1.0, 2),
        (200.0, 5.0, -0.005, 1.0, 1),
        (500.0, 60.0, 0.005, 1.0, 0),
    ],
)
def test_no_slip_is_seen_where_a_robot_moves_and_stops(gate, rate, play, delay, kept, seed):
    """It speeds up within 10 ms, in play or with a late encoder; some samples may be lost."""
    random = np.random.default_rng(seed)
    ends = np.cumsum(random.uniform(0.1, 1.5, 40))
    moves = random.uniform(-1.0, 1.0, 40) * (np.arange(40) % 2)
    fine = np.arange(0.0, ends[-1], 1e-3)
    angle = np.interp(fine, ends, np.cumsum(moves))
    angle = np.convolve(np.pad(angle, 5, 'edge'), np.full(11, 1.0 / 11.0), 'valid')
    times = np.arange(0.0, ends[-1], 1.0 / rate)
    times = times[random.random(len(times)) < kept]
    output = np.interp(times - delay, fine, with_play(angle, play * ARC_MINUTE))
    output += random.normal(0.0, 1e-4, len(times))
    before, after = gate(np.column_stack([times, -19.0 * np.interp(times, fine, angle), output]))
    assert after is before


@pytest.mark.parametrize(('seed', 'delay'), [(5, 0.0), (14, 0.005), (6, -0.005), (9, -0.005)])
def test_samples_that_are_lost_where_strokes_reverse_are_no_slip(gate, seed, delay):
    random = np.random.default_rng(seed)
    times = np.arange(1000)[random.random(1000) < 0.7] / 50.0
    strokes, fine = even_strokes(math.radians(80.0), 2.7), np.arange(20_000) / 1000.0
    output = np.interp(times - delay, fine, with_play(strokes(fine), 60.0 * ARC_MINUTE))
    output += random.normal(0.0, 1e-4, len(times))
    before, after = gate(np.column_stack([times, -19.0 * strokes(times), output]))
    assert after is before


@pytest.mark.parametrize(('rate', 'width'), [(50.0, 1.0), (200.0, 0.3)])
def test_a_damaged_tooth_is_no_stray_reading(gate, config, rate, width):
    """It shows in one to three samples of each pass, but in all passes."""
    times = np.arange(40.0 * rate) / rate
    ideal = ramped_strokes(math.radians(300.0), 6.0, 0.5)(times)
    tooth = math.radians(1.0) * np.exp(-(((np.degrees(ideal) - 100.0) / width) ** 2))
    output = with_play(ideal, 5.0 * ARC_MINUTE) + tooth
    output += np.random.default_rng(1).normal(0.0, 3e-5, len(times))
    before, after = gate(np.column_stack([times, -19.0 * ideal, output]))
    assert after is before
    output[[999, 1025]] += math.radians(0.5)
    _, after = gate(np.column_stack([times, -19.0 * ideal, output]))
    (fault,) = after.faults
    assert fault.values['moments'] == pytest.approx(times[[999, 1025]])
    assert measure(after, config).transmission.forward.value > math.radians(0.9)


@pytest.mark.parametrize('slip', [0, 3])
@pytest.mark.parametrize(('bits', 'wholes'), [(8, 3.003), (10, 1.001), (12, 5.005), (12, 2.002)])
def test_the_steps_of_an_encoder_are_no_faults_where_few_samples_show_them(
    gate, bits, wholes, slip
):
    """The output turns by nearly whole steps in each sample: its reading seldom goes one more."""
    step = TURN / 2**bits
    drive = Drive(play=ARC_MINUTE, errors={1.0: 5.0 * ARC_MINUTE}, output_step=step)
    strokes = even_strokes(1000 * wholes * step, 10.0)
    time, rotor, output = drive.readings(strokes, 20.0, 100.0)
    output[700:] += slip * step
    before, after = gate(np.column_stack([time, rotor, output]))
    if slip:
        assert after.faults[0].what is Observation.JUMPED
        assert after.faults[0].values['moment'] == pytest.approx(7.0, abs=0.02)
    else:
        assert after is before


def test_a_rotor_that_is_interpolated_where_it_speeds_up_shows_no_jump(tmp_path):
    """In slow messages of two drivers, it is off by a quarter of its period there, and more."""
    random = np.random.default_rng(29)
    ends = np.cumsum(random.uniform(0.1, 1.5, 40))
    path = np.cumsum(random.uniform(-1.0, 1.0, 40) * (np.arange(40) % 2))
    rotor, output = np.arange(0.0, ends[-1], 0.05), np.arange(0.013, ends[-1], 0.05)
    rotor[random.random(len(rotor)) >= 0.9] = math.nan
    columns = {'rotor_time_s': rotor, 'rotor_rad': -19.0 * np.interp(rotor, ends, path)}
    noise = random.normal(0.0, 1e-5, len(output))
    columns |= {'output_time_s': output, 'output_rad': np.interp(output, ends, path) + noise}
    write_csv(tmp_path / 'both.csv', **columns)
    after = gated(read_table(tmp_path / 'both.csv', Sources(), RATIO))
    assert {fault.what for fault in after.faults} <= {Observation.STRAY}


@pytest.mark.parametrize('late', [-6, 6])
def test_a_stray_reading_is_left_out_where_strokes_reverse_at_once(gate, late):
    """At 1 kHz it is beyond the change of the error in 1 ms by a delay, but not in 10 ms."""
    times, row = np.arange(10_000) / 1000.0, 4000 + late
    ideal = even_strokes(math.radians(150.0), 2.0)(times)
    output = with_play(ideal, 5.0 * ARC_MINUTE)
    output += np.random.default_rng(1).normal(0.0, 1e-4, len(times))
    output[row] += math.radians(1.0)
    _, after = gate(np.column_stack([times, -19.0 * ideal, output]))
    (fault,) = after.faults
    assert (fault.what, fault.values['moments']) == (Observation.STRAY, [times[row]])


def test_wraps_of_encoders_of_one_turn_are_no_faults(clean, gate):
    clean[:, 1:] = np.remainder(clean[:, 1:], 2.0 * np.pi)
    before, after = gate(clean)
    assert after is before
    clean[700, 1] = (clean[700, 1] + 1.3) % (2.0 * np.pi)
    _, found = gate(clean)
    assert len(found.encoders.measured) == len(clean) - 1
    assert found.faults[0].values['moments'] == pytest.approx([28.0])


def test_a_calibration_does_not_help_where_the_error_rises(shared_path):
    path = shared_path('data/faults/one_corrupt_rotor_reading_calibrate.csv')
    recording = read_table(path, Sources(), RATIO)  # without the gate
    assert not fit([recording], RATIO).helps


@pytest.mark.parametrize('sign', [1.0, -1.0], ids=['of the load', 'of the gear'])
@pytest.mark.parametrize('yields', [0.0, 0.0005], ids=['locked', 'held by its servo'])
def test_ramps_against_a_rotor_that_hardly_moves_are_measured(tmp_path, config, yields, sign):
    """The rotor follows the output as far as it yields, which both encoders show."""
    gear, noise = Gear(play=0.0, stiffness=600.0, friction=1.0), np.random.default_rng(3)
    torque = ramps(*[(20.0, 400)] * 2)
    rotor = -19.0 * yields * torque / 20.0 + 1e-5 * noise.standard_normal(len(torque))
    output = creep(gear, torque) + yields * torque / 20.0
    columns = {'time_s': 0.01 * np.arange(len(torque)), 'rotor_rad': rotor, 'output_rad': output}
    path = write_csv(tmp_path / 'r.csv', **columns, torque_nm=sign * torque)
    found = measure(read(path, config), config)
    assert (found.wrong_ratio, found.measured) == (None, True)
    assert float(found.figures.hysteresis.value) == pytest.approx(2.0 / 600.0, rel=0.03)
    assert found.figures.stiffness[-1].slope.value == pytest.approx(600.0, rel=0.01)


def test_ramps_against_a_rotor_that_moves_by_a_coarse_count_are_measured(tmp_path, config):
    """Its encoder has 256 counts, so that one is two thirds of the output's whole motion."""
    torque = ramps(*[(20.0, 400)] * 2)
    rotor = 2.0 * np.pi / 256.0 * np.round(-0.6 * torque / 20.0)
    output = creep(Gear(play=0.0, stiffness=600.0, friction=1.0), torque) - rotor / 19.0
    path = write_csv(tmp_path / 'r.csv', rotor_rad=rotor, output_rad=output, torque_nm=torque)
    found = measure(read(path, config), config)
    assert (found.wrong_ratio, found.measured) == (None, True)
    assert float(found.figures.hysteresis.value) == pytest.approx(2.0 / 600.0, rel=0.03)


@pytest.mark.parametrize('amplitude', [0.02, 0.15])
def test_a_rotor_that_moves_its_output_a_little_is_not_held(tmp_path, config, amplitude):
    """The ratio is 10, not the assumed 30, of which the difference would be a twist."""
    time = 0.01 * np.arange(4000)
    phase, noise = 0.5 * time, np.random.default_rng(1)
    rotor = amplitude * np.sin(phase) + 1e-5 * noise.standard_normal(len(time))
    output = -rotor / 10.0 + 1e-6 * noise.standard_normal(len(time))
    torque = 2.0 * np.sign(np.cos(phase)) + 3.0 * np.sin(phase)
    columns = {'time_s': time, 'rotor_rad': rotor, 'output_rad': output, 'torque_nm': torque}
    path, assumed = write_csv(tmp_path / 'r.csv', **columns), replace(config, gear_ratio='-30')
    found = measure(read(path, assumed), assumed).wrong_ratio
    assert found.what is Observation.NOT_THE_RATIO
    assert found.values['why'].values['measured'].value == pytest.approx(-10.0, rel=0.05)


def test_exchanged_columns_are_named(shared_path):
    path = shared_path('data/faults/both_encoders_clean.csv')
    exchanged = read_table(path, Sources(rotor='output_rad', output='rotor_rad'), RATIO)
    with pytest.raises(RecordingError, match='more than the rotor: exchange the two'):
        fit([exchanged], RATIO)


@pytest.mark.parametrize(
    ('column', 'value'),
    [(1, 1.0), (1, 0.02), (2, 1e4), (2, 80.0)],
    ids=['far angle', 'angle', 'far torque', 'torque'],
)
def test_stray_readings_of_ramps_are_left_out(shared_path, config, tmp_path, column, value):
    path = shared_path('data/faults/file_0_reference_ramps.csv')
    table = np.loadtxt(path, delimiter=',', skiprows=1)
    table[300, column] = value
    write_csv(tmp_path / 'r.csv', **dict(zip(('time', 'angle', 'torque'), table.T, strict=True)))
    report = measure(read(tmp_path / 'r.csv', config), config)
    (fault,) = report.recording.faults
    assert (fault.what, fault.values['moments']) == (Observation.STRAY, [15.0])
    assert report.figures.hysteresis.value == pytest.approx(np.radians(13.8 / 60), rel=0.02)
    assert not measure(read(path, config), config).recording.faults


TORQUE = ramps(*[(10.0, 75)] * 3)
TWIST = creep(Gear(play=0.002, stiffness=300.0, friction=1.0), TORQUE)
HYSTERESIS = 0.002 + 2.0 / 300.0


@pytest.mark.parametrize(
    ('angle', 'row', 'degrees', 'rows'),
    [
        ('of a locked shaft', 500, 3.0, 901),
        ('of a locked shaft', 350, -3.0, 901),
        ('of a locked shaft', 700, 15.0, 901),
        ('of a locked shaft', 80, 2.0, 301),
        ('of both encoders', 450, 1.0, 901),
    ],
)
def test_a_slip_under_torque_is_named_and_not_measured_across(
    config, tmp_path, angle, row, degrees, rows
):
    twist = TWIST[:rows].copy()
    twist[row:] += math.radians(degrees)
    columns = {'time_s': 0.01 * np.arange(rows), 'torque_nm': TORQUE[:rows]}
    if angle == 'of both encoders':
        columns |= {'rotor_rad': -19.0 * twist, 'output_rad': np.zeros(rows)}
    else:
        columns['angle_rad'] = twist
    recording = read(write_csv(tmp_path / 'r.csv', **columns), config)
    try:
        report = measure(recording, config)
    except RampError as error:
        assert rows < 500  # without a whole loop on either side
        said = str(error)
    else:
        said = str(report.recording.faults[0])
        assert report.figures.hysteresis.value == pytest.approx(HYSTERESIS, rel=0.02)
    named = re.search('the output jumps by (.*)° against the rotor at (.*) s ', said)
    assert float(named[1]) == pytest.approx(degrees, abs=0.3)  # and the motion meanwhile
    assert float(named[2]) == pytest.approx(0.01 * row, abs=0.011)


@pytest.mark.parametrize('every', [1, 3, 20])
def test_no_slip_is_seen_in_real_ramps(shared_path, config, every):
    paths = sorted(shared_path('data/torque_ramps_more').glob('*.csv'))
    for path in [*paths[5:9], *paths[13:15]]:  # with the fastest motion through their play
        ramps = read(path, config).locked
        assert not gated_ramps(ramps.chosen(slice(1, None, every)))[1]


def test_a_saturated_torque_sensor_is_named(config, tmp_path):
    torque = np.clip(TORQUE, -99.0, 7.0)
    path = write_csv(tmp_path / 'r.csv', torque_nm=torque, angle_rad=TWIST)
    ramps, faults = gated_ramps(read(path, config).locked)
    assert faults == (Observation.SATURATED(timed=False, moment=54.0, count=135),)
    assert np.max(ramps.torque) < 7.0


def test_the_greatest_of_three_levels_of_a_torque_is_no_saturation(config, tmp_path):
    """As of a drive that sends ±40 N·m in 12 bits, and bears much less."""
    coarse = 13.0 * np.round(TORQUE / 13.0)
    path = write_csv(tmp_path / 'r.csv', torque_nm=coarse, angle_rad=TWIST)
    assert not gated_ramps(read(path, config).locked)[1]
