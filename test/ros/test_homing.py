# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""~/home and the zero that it keeps, also over a restart of the node."""

import math
import re
import time

import pytest
from live import PATIENT, SECOND, live_node, rotor_bytes, rotor_state
from rclpy.parameter import Parameter
from std_srvs.srv import Trigger

from gear_kinematics.parameters.files import ConfigError
from gear_kinematics.ros.live import running_node

pytestmark = pytest.mark.live

MILLISECOND = SECOND // 1000


@pytest.fixture
def homing(make):
    """Return a function that creates a node whose driver may fall silent."""
    return lambda **values: make('homing', **{'input_timeout': 1000.0, **values})


def drive(node, positions, period=MILLISECOND, velocity=()):
    for number, position in enumerate(positions, start=1):
        node._on_rotor_state(rotor_bytes(number * period, position=[position], velocity=velocity))


def home(node):
    return node._homing.answer(None, Trigger.Response())


def values_of(node, at=0.0):
    now = time.monotonic() + at
    return node._actuators[''].state.report(now, node._connections)['rotor input'].texts


# With the ratio -19: φ5 = -(position - zero)/19, so 61.5° is -20.394 rad at the rotor.
TURNED = -20.394


def test_answer_can_be_checked_by_a_person(homing, tmp_path, capfd):
    node = homing()
    drive(node, [TURNED])
    answer = home(node)
    words = 'the shaft was at 61.5° and is now at 0.0° (rotor_zero -20.394 rad, '
    assert (answer.success, answer.message) == (True, words + 'lost at restart: set home_file)')
    assert f'gear_state_publisher]: {answer.message}\n' in capfd.readouterr().err
    path = tmp_path / 'home.yaml'
    node = homing(home_file=str(path))
    assert values_of(node)['home file'] == 'not homed yet'
    drive(node, [TURNED] * 200)
    assert home(node).message == f'{words}kept in {path})'
    again = 'the shaft was at 0.0° and is now at 0.0° (rotor_zero -20.394 rad, '
    assert home(node).message == f'{again}kept in {path})'


@pytest.mark.parametrize('encoder', ['single_turn', 'multi_turn'])
def test_log_says_at_the_start_that_the_turns_are_unknown(homing, capfd, encoder):
    node = homing(rotor_encoder=encoder)
    drive(node, [TURNED])
    unknown = values_of(node)['referenced'] == 'false'
    logged = 'satellite 76 teeth; turns unknown until it is homed)' in capfd.readouterr().err
    assert unknown is logged is (encoder == 'single_turn')


@pytest.mark.parametrize(
    ('positions', 'period', 'velocity', 'refused'),
    [
        # 0.95 rad/s at the rotor is 0.05 rad/s at the output.
        ([0.0], MILLISECOND, [1.0], '0.0526'),
        ([0.0], MILLISECOND, (), ''),
        ([0.0, 1.9], SECOND, (), '0.1'),
        ([2e-3 * k for k in range(500)], MILLISECOND, (), '0.105'),
        ([2e-3 * k for k in range(500)], MILLISECOND, [0.0], '0.105'),  # zeros are no velocities
        ([*[0.0] * 280, *(4e-3 * k for k in range(80))], MILLISECOND, (), '0.124'),  # started
        ([3.0, *(2e-4 * k for k in range(500))], MILLISECOND, (), ''),  # has come to rest
        ([1.5e-3 * (k % 2) for k in range(500)], MILLISECOND, (), ''),  # a count of 4096
        ([0.0, 0.0], 0, (), ''),
    ],
)
def test_shaft_that_turns_is_not_homed(homing, positions, period, velocity, refused):
    node = homing()
    drive(node, positions, period, velocity)
    answer = home(node)
    assert answer.success != bool(refused), answer.message
    if refused:
        assert answer.message == (
            f'the shaft turns at {refused} rad/s, faster than home_max_speed, 0.05 rad/s; '
            'stop it and home it again'
        )
        assert node.get_parameter('rotor_zero').value == 0.0


@pytest.mark.parametrize('again', [True, False])
def test_shaft_that_turns_is_not_homed_after_another_zero_or_clock(homing, again):
    """2 rad/s at the rotor are 0.105 rad/s at the output."""
    node = homing()
    drive(node, [2e-3 * k for k in range(2000)], MILLISECOND)
    if again:
        drive(node, [4.0])  # at 1 ms, as of a clock that was set back
    else:
        node.set_parameters([Parameter('rotor_zero', value=1.0)])
        drive(node, [4.0], 2001 * MILLISECOND)
    assert home(node).message.startswith('the shaft turns at 0.105 rad/s')


@pytest.mark.parametrize(('step', 'refused'), [(1.0, '1.05'), (0.0, '')])
def test_shaft_that_turns_is_not_homed_where_each_gap_could_hide_a_turn(homing, step, refused):
    """A single-turn encoder at 20 Hz; 20 rad/s at the rotor are 1.05 rad/s at the output."""
    node = homing(rotor_encoder='single_turn')
    drive(node, [step * k % math.tau for k in range(10)], 50 * MILLISECOND)
    answer = home(node)
    assert answer.success != bool(refused), answer.message
    assert answer.message.startswith(f'the shaft turns at {refused} rad/s') == bool(refused)


@pytest.mark.parametrize('numbered', [True, False])
def test_a_shaft_that_several_drivers_report_on_is_not_homed(homing, numbered):
    """The second one counts from another zero, and either may have sent the last message.

    Without numbers, it may be a gripper on a shared topic that is silent just now.
    """
    node = homing()
    driver = node._connections.rotor
    driver.publishers = 2
    for stamp in range(1, 200):
        driver.number = stamp + 200 * (stamp % 2) if numbered else None
        node._on_rotor_state(rotor_bytes(stamp * MILLISECOND, position=[1.0]))
    values_of(node, at=1.0)
    answer = home(node)
    said = 'several drivers send its joint; stop all but one'
    assert (not answer.success, said in answer.message) == (numbered, numbered), answer.message
    driver.publishers = 1
    for second in range(2, 7):  # reports, in which one driver is left
        values_of(node, at=float(second))
    assert home(node).success


def test_a_shaft_at_rest_is_homed_after_its_driver_was_silent(homing):
    node = homing(output_encoder_reference='absolute', input_timeout=0.5)
    drive(node, [1.0, 1.0], SECOND)
    assert home(node).success


def test_turns_that_the_output_encoder_adds_are_no_speed(homing):
    node = homing(rotor_encoder='single_turn', output_encoder_reference='absolute')
    answers = []
    for number in range(1, 500):
        shaft = rotor_bytes(number * MILLISECOND, ['shaft'], [2.0])
        node._on_output_encoder(shaft)
        drive(node, [-38.0 % math.tau], number * MILLISECOND)
        if node._actuators[''].state.input.referenced:
            answers.append(node._actuators['']._speed)
    assert len(answers) > 100
    assert set(answers) == {0.0}
    assert home(node).message.startswith('the shaft was at 114.6° and is now at 0.0°')


@pytest.mark.parametrize(
    ('speed', 'age', 'then', 'refused'),
    [
        (0.0, 1234.5, (), True),
        (50.0, 1234.5, (), True),  # how fast it turned then says nothing
        (0.0, 5.5, (), False),
        (0.0, 5.5, [math.nan], True),  # rejected messages do not show where the shaft is
        (0.2, 5.5, (), True),  # it turned, at less than home_max_speed
    ],
)
def test_position_that_is_old_is_not_homed(homing, speed, age, then, refused):
    node = homing()
    drive(node, [1.0 + 1e-3 * speed * k for k in range(200)])
    actuator = node._actuators['']
    actuator._seen = actuator.state.monitor.last_input = actuator._seen - age
    drive(node, then)
    answer = home(node)
    assert answer.success != refused, answer.message
    words = f'the last valid rotor_state came {age} s ago; check the driver'
    assert refused == (answer.message == words)


def test_zero_that_cannot_be_written_holds_and_the_answer_says_why(homing, tmp_path, monkeypatch):
    path = tmp_path / 'home.yaml'
    node = homing(home_file=str(path))
    drive(node, [TURNED])

    def refuse(*_):
        raise OSError(30, 'Read-only file system')

    with monkeypatch.context() as patch:
        patch.setattr('gear_kinematics.parameters.atomic_file.os.fsync', refuse)
        answer = home(node)
        assert answer.success
        words = f'lost at restart: {path}: Read-only file system'
        assert answer.message.endswith(f'(rotor_zero -20.394 rad, {words})')
        assert values_of(node)['home file'] == words
    assert not list(tmp_path.iterdir())
    assert node.get_parameter('rotor_zero').value == TURNED
    assert f'kept in {path}' in home(node).message


def test_restored_zero_wins_over_the_parameter_and_follows_what_is_set(homing, tmp_path, capfd):
    path = tmp_path / 'home.yaml'
    node = homing(home_file=str(path))
    drive(node, [TURNED])
    assert home(node).success
    node = homing(home_file=str(path), rotor_zero=1.5)
    log = rf'rotor_zero -20\.394 rad restored from {path}, homed [\d-]{{10}} \d\d:\d\d UTC'
    assert re.search(log, capfd.readouterr().err)
    assert node.get_parameter('rotor_zero').value == TURNED
    node.set_parameters([Parameter('rotor_zero', value=2.5)])  # as Undo of gearkin watch
    assert homing(home_file=str(path)).get_parameter('rotor_zero').value == 2.5
    with pytest.raises(ConfigError, match="its rotor_joint is 'rotor', not 'm1'"):
        homing(home_file=str(path), rotor_joint='m1')


def test_output_angle_is_the_same_after_the_node_was_killed(tmp_path, monkeypatch):
    # What is killed while it holds a lock in shared memory would block its peer.
    monkeypatch.setenv('FASTDDS_BUILTIN_TRANSPORTS', 'UDPv4')
    config = tmp_path / 'actuator.yaml'
    values = 'home_file: home.yaml, rotor_zero: 0.0, home_angle: -12.5, rotor_direction: -1'
    config.write_text(f'/**: {{ros__parameters: {{{values}}}}}\n')
    arguments = [*PATIENT, '--params-file', str(config)]
    angles = []
    with live_node(tmp_path, *arguments) as first:
        first.peer.connect()
        first.peer.answer(rotor_state(first.peer.stamp(), position=[TURNED]))
        answer = first.peer.home()
        assert f'kept in {tmp_path}/home.yaml' in answer.message, answer.message
        angles.append(first.peer.answer(rotor_state(first.peer.stamp(), position=[-20.3]))[0])
        first.process.kill()
        first.process.wait()
        first.process.returncode = 0  # that is no failure here
    with live_node(tmp_path, *arguments, namespace=first.peer.namespace) as second:
        second.peer.connect()
        angles.append(second.peer.answer(rotor_state(second.peer.stamp(), position=[-20.3]))[0])
        assert 'restored from' in second.text()
    # By hand: φ5 = -12.5 + (-20.3 + 20.394)/19.
    expected = 2 * [-12.5 + 0.094 / 19.0]
    assert [angle.position[0] for angle in angles] == pytest.approx(expected, abs=1e-12)
    (tmp_path / 'home.yaml').write_text('rotor_zero: 1.0')
    with running_node(['--ros-args', *arguments], stderr=-1) as process:
        _, error = process.communicate(timeout=60.0)
    assert process.returncode == 2
    assert error == (
        f'gear_state_publisher: {tmp_path}/home.yaml: its schema is None, not '
        "'gear_kinematics/home/1'; to start without it, delete it and home again\n"
    )
