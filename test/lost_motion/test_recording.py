"""Reading recordings of torque and angle: columns, units, steps, and unusable files."""

import math

import numpy as np
import pytest
from gear_recordings import Gear, Samples, creep, quantised, ramps, write_csv, write_recording

from gear_kinematics.bag import BagError
from gear_kinematics.lost_motion import Columns, CsvError, measure, read_bag, read_csv
from gear_kinematics.lost_motion.recorded.encoder_step import Source, Step

TURN = 2.0 * math.pi
MS = 10**6
START = 1_700_000_000 * 10**9
TRAVEL = math.radians(1.0)
GEAR = Gear(play=0.01, stiffness=300.0, friction=0.8)
TORQUE = ramps(*[(5.0, 200)] * 3)


@pytest.fixture(scope='module')
def angle():
    return creep(GEAR, TORQUE)


def read(path, actuator, **columns):
    return read_csv(path, actuator, Columns(**columns), TRAVEL)


def hysteresis(recording, actuator) -> float:
    return measure(recording, actuator).hysteresis.figures[0].hysteresis.value


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
    tmp_path, actuator, angle, angle_name, torque_name, scale, others, given
):
    columns = {angle_name: scale * angle, torque_name: TORQUE}
    columns |= dict.fromkeys(others, np.zeros(len(angle)))
    recording = read(write_csv(tmp_path / 'r.csv', **columns), actuator, **given)
    expected = GEAR.play + 2.0 * GEAR.friction / GEAR.stiffness
    assert hysteresis(recording, actuator) == pytest.approx(expected, abs=1e-5)
    assert recording.rows == len(angle)
    assert not recording.loading.measured


def test_unit_in_any_name_is_that_of_all_angles(tmp_path, actuator):
    ideal = np.linspace(0.0, 3.0, 500)
    columns = {'rotor': np.degrees(-19.0 * ideal), 'output_deg': np.degrees(ideal + 0.01)}
    recording = read(write_csv(tmp_path / 'r.csv', **columns), actuator)
    np.testing.assert_allclose(recording.motion.error, 0.01, rtol=0, atol=1e-12)
    columns['rotor_rad'] = columns.pop('rotor')
    with pytest.raises(CsvError, match='one unit, not in deg and rad'):
        read(write_csv(tmp_path / 'r.csv', **columns), actuator)


@pytest.mark.parametrize('on_rotor', [False, True])
def test_torque_with_both_encoders_twists_the_gear_alone(tmp_path, actuator, angle, on_rotor):
    bench = TORQUE / 50.0  # twists as well
    path = write_csv(
        tmp_path / 'r.csv',
        rotor=-19.0 * (angle + bench),
        output=bench,
        torque=TORQUE / (-19.0 if on_rotor else 1.0),
        time=np.arange(len(angle)) / 400.0,
    )
    recording = read(path, actuator, on_rotor=on_rotor)
    np.testing.assert_allclose(recording.loading.time, np.arange(len(angle)) / 400.0, atol=1e-12)
    np.testing.assert_allclose(recording.loading.angle, angle, rtol=0, atol=1e-12)
    np.testing.assert_allclose(recording.loading.torque, TORQUE, rtol=1e-12)
    assert recording.loading.measured
    assert len(recording.motion.error) == len(angle)


def test_measured_torque_is_preferred_to_the_commanded(tmp_path, actuator, angle):
    path = write_csv(
        tmp_path / 'r.csv', POSITION=angle, CONTROL_TORQUE=-TORQUE, TORQUE=TORQUE, test_nr=TORQUE
    )
    np.testing.assert_array_equal(read(path, actuator).loading.torque, TORQUE)


def test_rotor_is_taken_to_the_output_by_the_ratio(tmp_path, actuator, angle):
    path = write_csv(tmp_path / 'r.csv', angle=-19.0 * angle, torque=TORQUE / -19.0)
    recording = read(path, actuator, on_rotor=True)
    np.testing.assert_allclose(recording.loading.angle, angle, rtol=1e-12)
    np.testing.assert_allclose(recording.loading.torque, TORQUE, rtol=1e-12)


@pytest.mark.parametrize(
    ('name', 'values'),
    [
        ('TIME', lambda time: time),
        ('time_ms', lambda time: 1e3 * time + 7.0),
        ('stamp', lambda time: 1e9 * (1_721_381_453 + time)),  # ns since 1970
        ('Time [s]', lambda time: np.floor(64.0 * time) / 64.0),
    ],
)
def test_times_of_rows_are_read_if_there_are_any(tmp_path, actuator, angle, name, values):
    time = 0.0025 * np.arange(len(angle))
    path = write_csv(tmp_path / 'r.csv', angle=angle, torque=TORQUE, **{name: values(time)})
    recording = read(path, actuator)
    np.testing.assert_allclose(recording.loading.time, time, rtol=0, atol=0.0026)
    assert recording.columns[-1] == f'time {name}'
    assert read(write_csv(path, angle=angle, torque=TORQUE), actuator).loading.time is None


def test_times_that_cannot_be_used_are_reported_and_not_used(tmp_path, actuator, angle):
    back = np.arange(len(angle), 0.0, -1.0)
    path = write_csv(tmp_path / 'r.csv', angle=angle, torque=TORQUE, T=back)
    recording = read(path, actuator)
    assert len(recording.loading.angle) == len(angle)
    assert recording.loading.time is None
    assert recording.remarks == ('The times in T are not used: they go back.',)
    with pytest.raises(CsvError, match=r'r\.csv: the times in T: they go back'):
        read(path, actuator, time='T')
    clock = [f'12:{row // 60:02d}:{row % 60:02d}' for row in range(len(angle))]
    columns = {'angle': angle, 'torque': TORQUE, 'time': np.array(clock)}
    recording = read(write_csv(path, **columns), actuator)
    assert recording.remarks == ('The times in time are not used: they are not numbers.',)


def test_rows_without_a_time_do_not_lose_their_angle(tmp_path, actuator, angle):
    time = 0.01 * np.arange(len(angle))
    time[7] = math.nan
    recording = read(write_csv(tmp_path / 'r.csv', angle=angle, torque=TORQUE, t=time), actuator)
    assert len(recording.loading.angle) == len(angle)
    assert recording.loading.time is None


@pytest.mark.parametrize('delimiter', [';', '\t'])
def test_other_delimiters_byte_order_marks_and_line_ends(tmp_path, actuator, angle, delimiter):
    path = write_csv(tmp_path / 'r.csv', angle=angle, torque=TORQUE)
    text = path.read_text('utf-8').replace(',', delimiter).replace('\n', '\r\n')
    path.write_text(text, 'utf-8-sig')
    assert len(read(path, actuator).loading.angle) == len(angle)


def test_rows_that_are_not_finite_are_left_out_and_reported(tmp_path, actuator, angle):
    holes = angle.copy()
    holes[[10, 500]] = math.nan, 1e17
    recording = read(write_csv(tmp_path / 'r.csv', angle=holes, torque=TORQUE), actuator)
    assert len(recording.loading.angle) == len(angle) - 2
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
def test_unusable_files_get_one_clear_line(tmp_path, actuator, content, complaint):
    path = tmp_path / 'bad.csv'
    if content is not None:
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
    with pytest.raises(CsvError) as caught:
        read(path, actuator)
    assert str(caught.value).startswith(str(path))
    assert complaint in str(caught.value)
    assert '\n' not in str(caught.value)


def test_column_that_is_not_there_is_named(tmp_path, actuator):
    path = write_csv(tmp_path / 'r.csv', angle=[1.0], torque=[2.0])
    with pytest.raises(CsvError, match="no column 'phi'; there are: angle, torque"):
        read(path, actuator, angle='phi')


# Steps of an encoder


def test_steps_can_be_given(tmp_path, actuator, angle):
    path = write_csv(tmp_path / 'r.csv', angle=angle, torque=TORQUE)
    recording = read_csv(path, actuator, Columns(), TRAVEL, counts=4096)
    assert recording.loading.angle_step == Step(TURN / 4096, Source.GIVEN)


# Bags


def ramps_on_rotor(path, angle, **changes):
    stamps = START + np.arange(len(angle)) * 2 * MS
    rotor = Samples(stamps, quantised(-19.0 * angle, TURN / 2**14), TORQUE / -19.0)
    return write_recording(path, rotor._replace(**changes))


def test_efforts_of_the_rotor_are_torque_at_the_output(tmp_path, config, actuator, angle):
    recording = read_bag(ramps_on_rotor(tmp_path / 'ramps', angle), config)
    assert not recording.loading.measured
    assert recording.loading.angle_step.size == pytest.approx(TURN / 2**14 / 19, rel=1e-6)
    np.testing.assert_allclose(recording.loading.torque, TORQUE, rtol=0, atol=1e-12)
    np.testing.assert_allclose(recording.loading.time, 0.002 * np.arange(len(angle)), atol=1e-9)
    expected = GEAR.play + 2.0 * GEAR.friction / GEAR.stiffness
    assert hysteresis(recording, actuator) == pytest.approx(expected, abs=5e-5)


def test_turns_of_a_single_turn_rotor_encoder_are_counted(tmp_path, config, angle):
    many = 2.0 * np.sin(np.arange(len(angle)) / 300.0)  # 6 turns of the rotor either way
    path = ramps_on_rotor(tmp_path / 'wrapped', angle, positions=(-19.0 * many) % TURN)
    single = {**config, 'rotor_encoder': 'single_turn'}
    recording = read_bag(path, single)
    found = recording.loading.angle
    np.testing.assert_allclose(found - found[0], many - many[0], rtol=0, atol=1e-9)


def test_bag_without_torque_and_output_is_refused(tmp_path, config, angle):
    path = ramps_on_rotor(tmp_path / 'bare', angle, efforts=None)
    with pytest.raises(BagError, match='/rotor_state has no effort, and there is no output_enc'):
        read_bag(path, config)


@pytest.mark.parametrize('option', ['rotor_topic', 'encoder_topic'])
def test_topics_that_are_not_there_are_named(tmp_path, config, angle, option):
    path = ramps_on_rotor(tmp_path / 'ramps', angle)
    with pytest.raises(BagError, match=r'no topic /nowhere of type sensor_msgs/msg/JointState'):
        read_bag(path, config, **{option: '/nowhere'})


def test_bag_is_read_up_to_the_damage(tmp_path, config, actuator, angle):
    (file,) = ramps_on_rotor(tmp_path / 'ramps', angle).glob('*.mcap')
    cut = tmp_path / 'cut.mcap'
    cut.write_bytes(file.read_bytes()[: file.stat().st_size * 2 // 3])
    recording = read_bag(cut, config)
    assert recording.error.startswith(str(cut))
    assert 0 < recording.rows < len(angle)
    assert measure(recording, actuator).hysteresis.figures[0].loops >= 1
