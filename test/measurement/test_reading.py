# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Reading recordings: columns, units, stamps, steps, and unusable files."""

import math
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from gear_recordings import Gear, Samples, creep, ramps, write_csv, write_recording
from live import rotor_bytes
from refusals import refused
from simulated_encoders import MS, stepped

from gear_kinematics.bag import BagError, TopicMessages
from gear_kinematics.measurement import dialects, reading
from gear_kinematics.measurement.columns import Sources
from gear_kinematics.measurement.encoder_step import Step
from gear_kinematics.measurement.lost_motion import measure
from gear_kinematics.measurement.reading import read
from gear_kinematics.measurement.recording import RecordingError
from gear_kinematics.measurement.sentences import Observation
from gear_kinematics.measurement.series import held_readings
from gear_kinematics.measurement.stamps import RestoredClock

TURN = 2.0 * math.pi
START = 1_700_000_000 * 10**9
GEAR = Gear(play=0.01, stiffness=300.0, friction=0.8)
TORQUE = ramps(*[(5.0, 200)] * 3)


@pytest.fixture(scope='module')
def angle():
    return creep(GEAR, TORQUE)


@pytest.fixture(scope='module')
def measured(config):
    def figures(recording):
        return measure(recording, config).figures

    return figures


@pytest.mark.parametrize(
    ('angle_name', 'torque_name', 'scale', 'others', 'given'),
    [
        ('angle', 'torque', 1.0, [], {}),
        ('Deflection [deg]', 'Load Torque [Nm]', 180.0 / math.pi, [], {}),
        ('position_rev', 'torque', 1.0 / TURN, [], {}),
        ('angle_mdeg', 'torque', 180_000.0 / math.pi, [], {}),
        ('Twist (arcmin)', 'torque', 10_800.0 / math.pi, [], {}),
        ('twist [arcsec]', 'torque', 648_000.0 / math.pi, [], {}),
        ('POSITION', 'TORQUE', 1.0 / TURN, ['Q_CURRENT', 'CONTROL_TORQUE'], {}),
        ('a', 'b', 1.0 / TURN, ['angle', 'torque'],
         {'angle': 'a', 'torque': 'b [N·m]', 'unit': 'rev'}),
        ('angle_urad', 'torque', 1e3, [], {'angle': 'angle_urad', 'unit': 'mrad'}),
        ('angle', 'output_torque', -19.0, [], {'on_rotor': True}),
        ('Output angle (rad)', 'torque', 1.0, [], {}),
    ],
)  # fmt: skip
def test_columns_and_units(
    tmp_path, config, measured, angle, angle_name, torque_name, scale, others, given
):
    columns = {angle_name: scale * angle, torque_name: TORQUE}
    columns |= dict.fromkeys(others, np.zeros(len(angle)))
    recording = read(write_csv(tmp_path / 'r.csv', **columns), config, Sources(**given))
    expected = GEAR.play + 2.0 * GEAR.friction / GEAR.stiffness
    assert measured(recording).hysteresis.value == pytest.approx(expected, abs=1e-5)
    assert recording.rows == len(angle)
    assert recording.locked.measured == angle_name.startswith('Output')


def test_real_recordings_need_no_renaming(shared_path, config):
    """Spans that their authors state, of the joint and of the printed gear."""
    joint = shared_path('data/dual_encoders/neura_jogging_final_joint1.csv')
    config = replace(config, gear_ratio='121')
    counts = Sources(rotor_counts=2**24, output_counts=2**24)
    both = read(joint, config, counts).both
    assert both.timed
    assert np.ptp(both.measured) == pytest.approx(math.radians(7.76), rel=1e-2)
    with pytest.raises(RecordingError, match=r'motor_inc has counts: .* with --rotor-counts'):
        read(joint, config)
    printed = shared_path('data/dual_encoders/sspg_backlash_sine_vel_2.500tps_2.00s.csv')
    recording = read(printed, config)
    both = recording.both
    assert recording.columns[:3] == (
        'time [s] from time_s',
        'rotor [rad] from odrive_pos_rad',
        'output [rad] from output_pos_rad',
    )
    assert both.output_step.size == pytest.approx(TURN / 2**14, rel=1e-3)
    stiffness = shared_path('data/dual_encoders/transmission_stiffness_sspg.csv')
    recording = read(stiffness, replace(config, gear_ratio='7.2'), Sources(on_rotor=True))
    assert recording.columns[1] == 'angle of the rotor [rad] from encoder_pos_rad'
    assert recording.columns[2] == 'torque at the output [N·m] from output_torque_Nm'


@pytest.mark.parametrize('on_rotor', [False, True])
def test_torque_with_both_encoders_twists_the_gear_alone(tmp_path, config, angle, on_rotor):
    bench = TORQUE / 50.0  # twists as well
    path = write_csv(
        tmp_path / 'r.csv',
        rotor=-19.0 * (angle + bench),
        output=bench,
        torque=TORQUE / (-19.0 if on_rotor else 1.0),
        time=np.arange(len(angle)) / 400.0,
    )
    loading = read(path, config, Sources(on_rotor=on_rotor)).loading(Fraction(-19))
    np.testing.assert_allclose(loading.angle, angle, rtol=0, atol=1e-12)
    np.testing.assert_allclose(loading.torque, TORQUE, rtol=1e-12, atol=1e-15)
    assert loading.measured


@pytest.mark.parametrize(
    ('name', 'values'),
    [
        ('TIME', lambda time: time),
        ('time_ms', lambda time: 1e3 * time + 7.0),
        ('stamp_ns', lambda time: 1e9 * (1_721_381_453 + time)),
    ],
)
def test_times_of_rows_are_read_if_there_are_any(tmp_path, config, name, values):
    time = 0.0025 * np.arange(500)
    path = write_csv(tmp_path / 'r.csv', rotor=time, output=time, **{name: values(time)})
    recording = read(path, config)
    both = recording.both
    np.testing.assert_allclose(both.seconds, time, rtol=0, atol=1e-6)
    assert both.timed
    assert recording.columns[0].endswith(f'] from {name}')


def test_times_that_go_back_end_the_recording_there(tmp_path, config):
    """Interpolated over them, angles were greater than any that was recorded."""
    ideal = 0.1 * np.sin(np.arange(8000) / 300.0)
    time = np.arange(8000) / 1000.0
    time[5500:] -= 2.0
    time[6000:] += 3.0  # so that it is not known by how much the clock was set back
    columns = {'time': time, 'rotor': -19.0 * ideal, 'output': ideal}
    recording = read(write_csv(tmp_path / 'r.csv', **columns), config)
    both = recording.both
    assert len(both.measured) == 5500
    assert np.max(np.abs(both.at_measured(both.ideal(Fraction(-19))))) <= 0.1 + 1e-12
    fault, _ = recording.faults  # and that the output is computed from the rotor
    assert fault == Observation.TIMES_GO_BACK(rows=5500, column='time')


def test_rows_that_are_not_finite_are_left_out_and_reported(tmp_path, config, angle):
    holes = angle.copy()
    holes[[10, 500]] = math.nan, 1e17
    torque = [*TORQUE[:-1], 'N/A']
    recording = read(write_csv(tmp_path / 'r.csv', angle_rad=holes, torque_Nm=torque), config)
    assert len(recording.locked.angle) == len(angle) - 3
    assert recording.remarks == (Observation.ROWS_LEFT_OUT(rows=3),)


@pytest.mark.parametrize(
    ('content', 'complaint'),
    [
        ('', 'no rows of numbers'),
        ('angle,torque\nx,4\n', 'no usable rows'),
        ('a,b\n1,2\n', 'neither an angle and a torque nor a rotor and an output'),
        ('t;motor;output\n0\n1\n2\n', 'among the columns t (0); '),
        ('angle,angle,torque\n1,2,3\n', "more than one column 'angle'"),
        (b'\x00\x01,\x02\n', 'not text'),
        (None, 'No such file or directory'),
        (2**17 * 'angle,', 'the first row is longer than 65536 characters'),
        (','.join(f'column_{k}' for k in range(4000)) + '\n' + 4000 * '1,', ' ... '),
    ],
)
def test_unusable_files_get_one_clear_line(tmp_path, config, content, complaint):
    path = tmp_path / 'bad.csv'
    if content is not None:
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
    with refused(RecordingError, path, complaint) as caught:
        read(path, config)
    assert len(str(caught.value)) < 1000


def test_tiny_numbers_are_zero(tmp_path, config, measured, angle):
    recording = read(write_csv(tmp_path / 'r.csv', angle=1e-300 * angle, torque=TORQUE), config)
    with pytest.raises(ValueError, match='the angle does not grow'):
        measured(recording)


def test_long_files_are_read_in_part(tmp_path, config, monkeypatch):
    monkeypatch.setattr(dialects, '_MOST_ROWS', 300)
    rows = np.arange(1000.0)
    columns = {'angle_rad': rows / 2**12, 'torque_Nm': rows / 2.5, 'time_s': rows}
    recording = read(write_csv(tmp_path / 'r.csv', **columns), config)
    np.testing.assert_array_equal(recording.locked.angle, rows[::4] / 2**12)
    assert recording.remarks == (Observation.ROWS_THINNED(every=4),)
    assert recording.columns[-1] == '250 of 250 rows, one in 4 of the file'


def test_long_bags_are_read_in_part(tmp_path, config, monkeypatch):
    monkeypatch.setattr(reading, '_MOST_STATES', 6000)
    rows = np.arange(10_000)
    samples = Samples(START + MS * rows, 0.1 * rows)
    recording = read(write_recording(tmp_path / 'bag', samples, samples), config)
    np.testing.assert_array_equal(recording.encoders.rotor.stamp, samples.stamps[::4])
    np.testing.assert_array_equal(recording.encoders.measured, samples.positions[::4])
    assert recording.remarks == tuple(
        Observation.STATES_THINNED(topic=topic, every=4)
        for topic in ('/rotor_state', '/output_encoder')
    )


def test_a_bag_without_messages_is_refused(tmp_path, config):
    path = write_recording(tmp_path / 'bag', Samples([], []))
    with pytest.raises(BagError, match='no usable rotor states on /rotor_state'):
        read(path, config)


# Steps of an encoder


def test_steps_can_be_given(tmp_path, config, angle):
    path = write_csv(tmp_path / 'r.csv', angle=angle, torque=TORQUE)
    recording = read(path, config, Sources(rotor_counts=4096))
    assert recording.locked.angle_step == Step(TURN / 4096, seen=False)


# Bags


def ramps_on_rotor(path, angle, **changes):
    stamps = START + np.arange(len(angle)) * 2 * MS
    rotor = Samples(stamps, stepped(-19.0 * angle, TURN / 2**14), TORQUE / -19.0)
    return write_recording(path, rotor._replace(**changes))


def test_efforts_of_the_rotor_are_torque_at_the_output(tmp_path, config, measured, angle):
    recording = read(ramps_on_rotor(tmp_path / 'ramps', angle), config)
    assert not recording.locked.measured
    assert recording.locked.angle_step.size == pytest.approx(TURN / 2**14 / 19, rel=1e-6)
    np.testing.assert_allclose(recording.locked.torque, TORQUE, rtol=0, atol=1e-12)
    expected = GEAR.play + 2.0 * GEAR.friction / GEAR.stiffness
    assert measured(recording).hysteresis.value == pytest.approx(expected, abs=5e-5)


def test_a_joint_of_a_bag_that_moves_freely_is_no_torque_ramp(tmp_path, config):
    """A pendulum's torque rises with its angle, and friction opens a loop."""
    time = np.arange(0.0, 40.0, 0.01)
    angle = math.radians(50.0) * np.sin(TURN * time / 8.0)
    torque = 5.0 * np.sin(angle) + 0.4 * np.sign(np.gradient(angle))
    stamps = START + np.round(time * 1e9).astype(np.int64)
    path = write_recording(tmp_path / 'free', Samples(stamps, -19.0 * angle, torque / -19.0))
    with pytest.raises(RecordingError, match='the output turns by 100° under torque: it is not l'):
        read(path, config)


def test_bag_without_torque_and_output_is_refused(tmp_path, config, angle):
    path = ramps_on_rotor(tmp_path / 'bare', angle, efforts=None)
    with pytest.raises(BagError, match='/rotor_state has no effort, and no output_enc'):
        read(path, config)


def test_an_encoder_without_stamps_has_the_times_of_reception(tmp_path, config):
    """As in the node."""
    ideal = np.linspace(0.0, 1.0, 2000)
    stamps = START + np.arange(2000) * MS
    encoder = Samples(0 * stamps, ideal + 0.01, received=stamps)
    path = write_recording(tmp_path / 'unstamped', Samples(stamps, -19.0 * ideal), encoder)
    both = read(path, config).both
    assert len(both.measured) == 2000
    np.testing.assert_allclose(both.error(Fraction(-19)), 0.01, rtol=0, atol=1e-9)


@pytest.mark.parametrize('step', [0.04, 0.3, 2.5])
def test_a_clock_that_is_set_back_is_restored_and_named(tmp_path, config, step):
    ideal = np.linspace(0.0, 1.0, 4000) ** 2
    stamps = START + np.arange(4000) * MS
    late = stamps.copy()
    late[3000:] -= round(1000 * step) * MS
    late[[1000, 1001]] = late[[1001, 1000]]  # disorder is no step
    rotor = Samples(late, -19.0 * ideal, received=stamps)
    write_recording(tmp_path / 'back', rotor, Samples(late, ideal, received=stamps))
    recording = read(tmp_path / 'back', config)
    both = recording.both
    fault, _ = recording.faults  # and that the output is computed from the rotor
    assert fault == Observation.SET_BACK_AT(size=step, stamp=stamps[2999])
    assert recording.remarks == (
        Observation.REJECTED(topic='/rotor_state', count=1, cause='out of order'),
        Observation.STATES_OUT_OF_ORDER(topic='/output_encoder', count=1),
    )
    assert len(both.measured) == 3999
    assert np.ptp(both.error(Fraction(-19))) < 1e-6
    assert len(both.starts(None)) == 2  # the motion in the step is unknown


@pytest.mark.parametrize('stall', [40, 100, 400])
def test_a_stall_is_no_step_of_the_clock(tmp_path, config, stall):
    """What came meanwhile is received at once, as from a driver on a busy machine."""
    ideal = np.linspace(0.0, 1.0, 4000) ** 2
    stamps = START + np.arange(4000) * MS
    received = stamps.copy()
    received[2000 : 2000 + stall] = stamps[2000 + stall] + np.arange(stall) * 1000
    received = np.maximum.accumulate(received)
    rotor = Samples(stamps, -19.0 * ideal, received=received)
    write_recording(tmp_path / 'bag', rotor, Samples(stamps, ideal, received=received))
    recording = read(tmp_path / 'bag', config)
    both = recording.both
    assert not any(fault.what is Observation.SET_BACK_AT for fault in recording.faults)
    assert np.ptp(both.error(Fraction(-19))) < 1e-6


def test_delays_of_a_busy_machine_are_no_steps_of_the_clock():
    """In small batches, as they come to live commissioning."""
    random, clock = np.random.default_rng(1), RestoredClock()
    stamps = START + np.arange(4000) * MS
    delays = np.cumsum(random.exponential(30.0, 4000) * (random.random(4000) < 0.02))
    received = stamps + np.round(delays * MS).astype(np.int64)
    data = [rotor_bytes(stamp, position=[0.0]) for stamp in stamps.tolist()]
    for first in range(0, 4000, 10):
        rows = slice(first, first + 10)
        clock.restored(TopicMessages(data[rows], received[rows].tolist()))
    assert clock.steps == []


def test_one_clock_of_two_that_is_set_back_is_restored(tmp_path, config):
    ideal = np.linspace(0.0, 1.0, 4000)
    stamps = START + np.arange(4000) * MS
    late = stamps.copy()
    late[3000:] -= 2500 * MS
    write_recording(
        tmp_path / 'back', Samples(stamps, -19.0 * ideal), Samples(late, ideal, received=stamps)
    )
    both = read(tmp_path / 'back', config).both
    assert len(both.measured) == 4000
    assert np.ptp(both.error(Fraction(-19))) < 1e-9


@pytest.mark.parametrize('held', [(10, 1), (1, 10), (10, 10)])
def test_readings_that_a_driver_repeats_are_used_once(tmp_path, config, held):
    """Messages come ten times as often as an encoder is read; the gear has no error."""
    angle, late = np.sin(np.arange(4000) / 640.0), 3  # samples of the other
    rotor, output = (
        factor * np.repeat(np.roll(angle, shift)[::each], each)[50:-50]
        for factor, each, shift in zip((-19.0, 1.0), held, (0, -late), strict=True)
    )
    stamps = START + np.arange(len(rotor)) * MS
    write_recording(tmp_path / 'held', Samples(stamps, rotor), Samples(stamps + late * MS, output))
    both = read(tmp_path / 'held', config).both
    # Used in each message, a held reading would be up to 10 ms late at 1.6 rad/s.
    assert np.ptp(both.error(Fraction(-19))) < 1e-4


def test_faults_of_a_clock_change_no_figure(shared_path, config):
    path = shared_path('data/faults/clock_set_back_by_0.3_s.mcap')
    measured = measure(read(path, config), config)
    assert not measured.wrong_ratio
    lost = measured.transmission.lost_motion
    # As the file says: 6.9 arcmin.
    assert abs(lost.value - math.radians(6.9 / 60.0)) < math.radians(0.035 / 60.0)
    assert lost.uncertainty < math.radians(0.302 / 60.0)


def test_readings_that_flicker_by_a_step_are_held_nevertheless():
    """Each third one does in the fifth of its eight rows, which is no new reading."""
    remarks, swung = [], 3.0 * np.sin(np.arange(800) / 160.0)
    rotor = np.repeat(np.round(swung[::8], 2), 8)
    rotor[4::24] += 0.01
    held = held_readings({'rotor': rotor}, {'rotor': swung}, remarks)
    assert remarks == [Observation.READINGS_HELD(role='rotor', every=8)]
    assert held['rotor'][::8].all()
    assert np.count_nonzero(held['rotor']) == 168  # with two changes of each flicker
