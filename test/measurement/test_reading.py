"""Reading recordings: columns, units, stamps, steps, and unusable files."""

import math
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from gear_recordings import Gear, Samples, creep, quantised, ramps, write_csv, write_recording

from gear_kinematics.bag import BagError, BagWriter
from gear_kinematics.measurement.columns import Columns
from gear_kinematics.measurement.encoder_step import Source, Step
from gear_kinematics.measurement.lost_motion import Request, measure
from gear_kinematics.measurement.reading import read, read_encoders
from gear_kinematics.measurement.recording import RecordingError
from gear_kinematics.wire.cdr import JointStateTemplate

TURN = 2.0 * math.pi
MS = 10**6
START = 1_700_000_000 * 10**9
GEAR = Gear(play=0.01, stiffness=300.0, friction=0.8)
TORQUE = ramps(*[(5.0, 200)] * 3)


@pytest.fixture(scope='module')
def angle():
    return creep(GEAR, TORQUE)


@pytest.fixture(scope='module')
def measured(config, actuator):
    return lambda recording: measure(recording, actuator, config, Request()).figures.smallest


@pytest.mark.parametrize(
    ('angle_name', 'torque_name', 'scale', 'others', 'given'),
    [
        ('angle', 'torque', 1.0, [], {}),
        ('Position_rad', 'Effort', 1.0, [], {}),
        ('Deflection [deg]', 'Motor Torque [Nm]', 180.0 / math.pi, [], {}),
        ('position_rev', 'torque', 1.0 / TURN, [], {}),
        ('angle_mrad', 'torque', 1e3, [], {}),
        ('POSITION', 'TORQUE', 1.0 / TURN, ['Q_CURRENT'], {}),
        ('a', 'b', 1.0 / TURN, ['angle', 'torque'],
         {'angle': 'a', 'torque': 'b', 'unit': 'rev'}),
        ('angle_deg', 'torque', 1.0, [], {'unit': 'rad'}),
    ],
)  # fmt: skip
def test_columns_and_units(
    tmp_path, config, measured, angle, angle_name, torque_name, scale, others, given
):
    columns = {angle_name: scale * angle, torque_name: TORQUE}
    columns |= dict.fromkeys(others, np.zeros(len(angle)))
    recording = read(write_csv(tmp_path / 'r.csv', **columns), config, Columns(**given))
    expected = GEAR.play + 2.0 * GEAR.friction / GEAR.stiffness
    assert measured(recording).hysteresis.value == pytest.approx(expected, abs=1e-5)
    assert recording.rows == len(angle)
    assert not recording.locked.measured


@pytest.mark.parametrize(
    ('names', 'scale', 'counts'),
    [
        (('odrive_pos_rad', 'output_pos_rad'), 1.0, None),
        (('motor_inc', 'load_inc'), 2**20 / TURN, 2**20),
        (('rotor', 'output_deg'), 180.0 / math.pi, None),
        (('Motor Position [rev]', 'Load encoder (rev)'), 1.0 / TURN, None),
    ],
)
def test_names_of_real_files_tell_both_encoders(tmp_path, config, names, scale, counts):
    ideal = np.linspace(0.0, 3.0, 500)
    values = (-19.0 * ideal * scale, (ideal + 0.01) * scale)
    path = write_csv(tmp_path / 'r.csv', **dict(zip(names, values, strict=True)), Temp=ideal)
    _, both = read_encoders(path, config, Columns(rotor_counts=counts, output_counts=counts))
    np.testing.assert_allclose(both.error(Fraction(-19)), 0.01, rtol=0, atol=1e-11)
    assert not both.timed


def test_real_recordings_need_no_renaming(shared_path, config):
    """Spans that their authors state, of the joint and of the printed gear."""
    joint = shared_path('data/dual_encoders/neura_jogging_final_joint1.csv')
    config = replace(config, gear_ratio='121')
    counts = Columns(rotor_counts=2**24, output_counts=2**24)
    _, both = read_encoders(joint, config, counts)
    assert both.timed
    assert np.ptp(both.measured) == pytest.approx(math.radians(7.76), rel=1e-2)
    with pytest.raises(RecordingError, match=r'motor_inc has counts: .* with --rotor-counts'):
        read(joint, config)
    printed = shared_path('data/dual_encoders/sspg_backlash_sine_vel_2.500tps_2.00s.csv')
    recording, both = read_encoders(printed, config)
    assert recording.columns[:2] == (
        'rotor from odrive_pos_rad in rad',
        'output from output_pos_rad in rad',
    )
    assert both.output_step.size == pytest.approx(TURN / 2**14, rel=1e-3)
    stiffness = shared_path('data/dual_encoders/transmission_stiffness_sspg.csv')
    recording = read(stiffness, replace(config, gear_ratio='7.2'), Columns(on_rotor=True))
    assert recording.columns[0] == 'angle of the rotor from encoder_pos_rad in rad'
    assert recording.columns[1].startswith('torque at the output from output_torque_Nm')


@pytest.mark.parametrize('name', ['angle [µrad]', 'angle_urad', 'winkel_grad', 'angle_mdeg'])
def test_units_that_are_not_known_are_refused_with_the_list(tmp_path, config, name):
    path = write_csv(tmp_path / 'r.csv', **{name: [1.0, 2.0], 'torque': [1.0, 2.0]})
    with pytest.raises(RecordingError, match=r'known: .*deg, .*mrad, .*rad, rev'):
        read(path, config)
    with pytest.raises(RecordingError, match=r'the unit .* is not known'):
        read(path, config, Columns(angle=name))


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
    loading = read(path, config, Columns(on_rotor=on_rotor)).loading(Fraction(-19))
    np.testing.assert_allclose(loading.time, np.arange(len(angle)) / 400.0, atol=1e-9)
    np.testing.assert_allclose(loading.angle, angle, rtol=0, atol=1e-12)
    np.testing.assert_allclose(loading.torque, TORQUE, rtol=1e-12, atol=1e-15)
    assert loading.measured


def test_measured_torque_is_preferred_to_the_commanded(tmp_path, config, angle):
    path = write_csv(
        tmp_path / 'r.csv', POSITION=angle, CONTROL_TORQUE=-TORQUE, TORQUE=TORQUE, test_nr=TORQUE
    )
    np.testing.assert_array_equal(read(path, config).locked.torque, TORQUE)


def test_rotor_is_taken_to_the_output_by_the_ratio(tmp_path, config, angle):
    path = write_csv(tmp_path / 'r.csv', angle=-19.0 * angle, torque=TORQUE / -19.0)
    recording = read(path, config, Columns(on_rotor=True))
    np.testing.assert_allclose(recording.locked.angle, angle, rtol=1e-12)
    np.testing.assert_allclose(recording.locked.torque, TORQUE, rtol=1e-12)


@pytest.mark.parametrize(
    ('name', 'values'),
    [
        ('TIME', lambda time: time),
        ('time_ms', lambda time: 1e3 * time + 7.0),
        ('stamp', lambda time: 1e9 * (1_721_381_453 + time)),  # ns since 1970
        ('Time [s]', lambda time: np.floor(64.0 * time) / 64.0),
    ],
)
def test_times_of_rows_are_read_if_there_are_any(tmp_path, config, angle, name, values):
    time = 0.0025 * np.arange(len(angle))
    path = write_csv(tmp_path / 'r.csv', angle=angle, torque=TORQUE, **{name: values(time)})
    recording = read(path, config)
    np.testing.assert_allclose(recording.locked.time, time, rtol=0, atol=0.0026)
    assert recording.columns[-1].startswith(f'time from {name}')
    assert read(write_csv(path, angle=angle, torque=TORQUE), config).locked.time is None


def test_times_that_cannot_be_used_are_reported_and_not_used(tmp_path, config, angle):
    back = np.arange(len(angle), 0.0, -1.0)
    path = write_csv(tmp_path / 'r.csv', angle=angle, torque=TORQUE, T=back)
    recording = read(path, config)
    assert len(recording.locked.angle) == len(angle)
    assert recording.locked.time is None
    assert recording.remarks == ('the times in T are not used: they go back',)
    with pytest.raises(RecordingError, match=r'r\.csv: the times in T: they go back'):
        read(path, config, Columns(time='T'))
    clock = [f'12:{row // 60:02d}:{row % 60:02d}' for row in range(len(angle))]
    columns = {'angle': angle, 'torque': TORQUE, 'time': np.array(clock)}
    recording = read(write_csv(path, **columns), config)
    assert recording.remarks == ('the times in time are not used: they are not numbers',)


def test_times_that_go_back_end_the_recording_there(tmp_path, config):
    """Interpolated over them, angles were greater than any that was recorded."""
    ideal = 0.1 * np.sin(np.arange(8000) / 300.0)
    time = np.arange(8000) / 1000.0
    time[5500:] -= 2.0
    columns = {'time': time, 'rotor': -19.0 * ideal, 'output': ideal}
    recording, both = read_encoders(write_csv(tmp_path / 'r.csv', **columns), config)
    assert len(both.measured) == 5500
    assert np.max(np.abs(both.at_measured(both.ideal(Fraction(-19))))) <= 0.1 + 1e-12
    assert 'the time in time goes back after 5500 rows: the others are left out' in (
        recording.remarks
    )


def test_a_clock_that_stands_still_is_not_used(tmp_path, config):
    ideal = np.sin(np.arange(3000) / 100.0)
    columns = {'time': np.full(3000, 7.0), 'rotor': -19.0 * ideal, 'output': ideal}
    recording, both = read_encoders(write_csv(tmp_path / 'r.csv', **columns), config)
    assert recording.remarks == ('the times in time are not used: they stand still',)
    assert not both.timed


def test_rows_without_a_time_do_not_lose_their_angle(tmp_path, config, angle):
    time = 0.01 * np.arange(len(angle))
    time[7] = math.nan
    recording = read(write_csv(tmp_path / 'r.csv', angle=angle, torque=TORQUE, t=time), config)
    assert len(recording.locked.angle) == len(angle)
    assert recording.locked.time is None


@pytest.mark.parametrize('delimiter', [';', '\t'])
def test_other_delimiters_byte_order_marks_and_line_ends(tmp_path, config, angle, delimiter):
    path = write_csv(tmp_path / 'r.csv', angle=angle, torque=TORQUE)
    text = path.read_text('utf-8').replace(',', delimiter).replace('\n', '\r\n')
    path.write_text(text, 'utf-8-sig')
    assert len(read(path, config).locked.angle) == len(angle)


def test_rows_that_are_not_finite_are_left_out_and_reported(tmp_path, config, angle):
    holes = angle.copy()
    holes[[10, 500]] = math.nan, 1e17
    recording = read(write_csv(tmp_path / 'r.csv', angle=holes, torque=TORQUE), config)
    assert len(recording.locked.angle) == len(angle) - 2
    assert recording.remarks == ('2 rows were left out: not finite, or too large',)


@pytest.mark.parametrize(
    ('content', 'complaint'),
    [
        ('', 'no samples in it'),
        ('angle,torque\n', 'no samples in it'),
        ('angle,torque\n1,2\n3\n', 'line 3: too few columns'),
        ('angle,torque\n1,2\nx,4\n', "line 3: could not convert string to float: 'x'"),
        ('a,b\n1,2\n', 'neither an angle and a torque nor a rotor and an output'),
        ('angle,angle,torque\n1,2,3\n', "more than one column 'angle'"),
        (b'\xff\xfe\x00\x01', 'not text in UTF-8'),
        (None, 'No such file or directory'),
    ],
)
def test_unusable_files_get_one_clear_line(tmp_path, config, content, complaint):
    path = tmp_path / 'bad.csv'
    if content is not None:
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
    with pytest.raises(RecordingError) as caught:
        read(path, config)
    assert str(caught.value).startswith(str(path))
    assert complaint in str(caught.value)
    assert '\n' not in str(caught.value)


def test_column_that_is_not_there_is_named(tmp_path, config):
    path = write_csv(tmp_path / 'r.csv', angle=[1.0], torque=[2.0])
    with pytest.raises(RecordingError, match="no column 'phi'; there are: angle, torque"):
        read(path, config, Columns(angle='phi'))


# Steps of an encoder


def test_steps_can_be_given(tmp_path, config, angle):
    path = write_csv(tmp_path / 'r.csv', angle=angle, torque=TORQUE)
    recording = read(path, config, Columns(rotor_counts=4096))
    assert recording.locked.angle_step == Step(TURN / 4096, Source.GIVEN)


# Bags


def ramps_on_rotor(path, angle, **changes):
    stamps = START + np.arange(len(angle)) * 2 * MS
    rotor = Samples(stamps, quantised(-19.0 * angle, TURN / 2**14), TORQUE / -19.0)
    return write_recording(path, rotor._replace(**changes))


def test_efforts_of_the_rotor_are_torque_at_the_output(tmp_path, config, measured, angle):
    recording = read(ramps_on_rotor(tmp_path / 'ramps', angle), config)
    assert not recording.locked.measured
    assert recording.locked.angle_step.size == pytest.approx(TURN / 2**14 / 19, rel=1e-6)
    np.testing.assert_allclose(recording.locked.torque, TORQUE, rtol=0, atol=1e-12)
    np.testing.assert_allclose(recording.locked.time, 0.002 * np.arange(len(angle)), atol=1e-9)
    expected = GEAR.play + 2.0 * GEAR.friction / GEAR.stiffness
    assert measured(recording).hysteresis.value == pytest.approx(expected, abs=5e-5)


def test_turns_of_a_single_turn_rotor_encoder_are_counted(tmp_path, config, angle):
    many = 2.0 * np.sin(np.arange(len(angle)) / 300.0)  # 6 turns of the rotor either way
    path = ramps_on_rotor(tmp_path / 'wrapped', angle, positions=(-19.0 * many) % TURN)
    single = replace(config, rotor_encoder='single_turn')
    recording = read(path, single)
    found = recording.locked.angle
    np.testing.assert_allclose(found - found[0], many - many[0], rtol=0, atol=1e-9)


def test_bag_without_torque_and_output_is_refused(tmp_path, config, angle):
    path = ramps_on_rotor(tmp_path / 'bare', angle, efforts=None)
    with pytest.raises(BagError, match='/rotor_state has no effort, and no output_enc'):
        read(path, config)


@pytest.mark.parametrize('option', ['rotor_topic', 'encoder_topic'])
def test_topics_that_are_not_there_are_named(tmp_path, config, angle, option):
    path = ramps_on_rotor(tmp_path / 'ramps', angle)
    with pytest.raises(BagError, match=r'no topic /nowhere of type sensor_msgs/msg/JointState'):
        read(path, config, **{option: '/nowhere'})


def test_bag_is_read_up_to_the_damage(tmp_path, config, measured, angle):
    (file,) = ramps_on_rotor(tmp_path / 'ramps', angle).glob('*.mcap')
    cut = tmp_path / 'cut.mcap'
    cut.write_bytes(file.read_bytes()[: file.stat().st_size * 2 // 3])
    recording = read(cut, config)
    assert recording.damage.startswith(str(cut))
    assert 0 < recording.rows < len(angle)
    assert measured(recording).loops >= 1


def test_an_encoder_without_stamps_has_the_times_of_reception(tmp_path, config):
    """As in the node."""
    ideal = np.linspace(0.0, 1.0, 2000)
    stamps = START + np.arange(2000) * MS
    path = tmp_path / 'unstamped'
    with BagWriter(path) as writer:
        writer.add_topic('/rotor_state', 'sensor_msgs/msg/JointState')
        writer.add_topic('/output_encoder', 'sensor_msgs/msg/JointState')
        for received, angle in zip(stamps.tolist(), ideal.tolist(), strict=True):
            rotor, output = (
                JointStateTemplate([joint], velocity=False, effort=False)
                for joint in ('rotor', 'output_shaft')
            )
            writer.write('/rotor_state', received, rotor.encode(received, [-19.0 * angle]))
            writer.write('/output_encoder', received, output.encode(0, [angle + 0.01]))
    _, both = read_encoders(path, config)
    assert len(both.measured) == 2000
    np.testing.assert_allclose(both.error(Fraction(-19)), 0.01, rtol=0, atol=1e-9)


def test_a_clock_of_the_encoder_that_is_set_back_ends_the_recording_there(tmp_path, config):
    ideal = np.linspace(0.0, 1.0, 4000)
    stamps = START + np.arange(4000) * MS
    late = stamps.copy()
    late[3000:] -= 2500 * MS
    late[[1000, 1001]] = late[[1001, 1000]]  # disorder is no reset
    rotor = Samples(stamps, -19.0 * ideal)
    with BagWriter(tmp_path / 'back') as writer:
        for topic in ('/rotor_state', '/output_encoder'):
            writer.add_topic(topic, 'sensor_msgs/msg/JointState')
        for k, received in enumerate(stamps.tolist()):
            for topic, joint, stamp, angle in (
                ('/rotor_state', 'rotor', received, rotor.positions[k]),
                ('/output_encoder', 'output_shaft', int(late[k]), ideal[k]),
            ):
                template = JointStateTemplate([joint], velocity=False, effort=False)
                writer.write(topic, received, template.encode(stamp, [float(angle)]))
    recording, both = read_encoders(tmp_path / 'back', config)
    assert recording.remarks == (
        '/output_encoder: 1 angles out of order',
        '/output_encoder: the clock was set back; the last 1000 angles are left out',
    )
    assert len(both.measured) == 2999
