"""The calibrated output of the node as a process of its own, beside the drivers."""

import itertools
import math
from contextlib import ExitStack
from dataclasses import replace
from fractions import Fraction

import pytest
from calibrations import AMPLITUDE, calibration, single_order
from live import SECOND, START, connected, live_node, rotor_state, stamp_of
from rclpy.qos import QoSProfile
from sensor_msgs.msg import JointState

pytestmark = pytest.mark.live

MS = SECOND // 1000
TOPICS = ('corrected_state', 'corrected_interval')
MADE = single_order()


@pytest.fixture
def file(tmp_path):
    """Write a calibration, changed."""

    def write(name='calibration.yaml', **changes):
        path = tmp_path / name
        path.write_text(replace(MADE, **changes).text(), 'utf-8')
        return path

    return write


@pytest.fixture
def start(tmp_path):
    """Give a function that runs a node, and a peer that listens to all that is corrected."""
    with ExitStack() as stack:

        def start(*arguments):
            peer = stack.enter_context(connected(tmp_path, *arguments))
            for topic in TOPICS:
                listener = peer.listen(JointState, topic, QoSProfile(depth=2000))
                peer.wait_until(listener.get_publisher_count, topic)
            return peer

        yield start


def heard(peer, message):
    """Send until it is corrected; gives the state and the interval."""
    stamp = stamp_of(message)

    def corrected():
        found = [[m for m in peer.received[topic] if stamp_of(m) == stamp] for topic in TOPICS]
        if all(found):
            return [messages[0] for messages in found]
        peer.answer(message)
        return None

    return peer.wait_until(corrected, 'the corrected output')


def test_output_is_corrected_beside_the_ideal_one(start, file):
    peer = start('-p', f'calibration:={file()}', '-p', 'frame_prefix:=left_')
    message = rotor_state(START, position=[0.5], velocity=[2.0], effort=[0.1])
    state, interval = heard(peer, message)
    assert state.name == interval.name == ['left_output_shaft']
    assert list(state.position) == [pytest.approx(-0.5 / 19 + AMPLITUDE * math.cos(0.5))]
    # The rotor's rate times the derivative by its angle.
    assert list(state.velocity) == [pytest.approx(2.0 * (-1 / 19 - AMPLITUDE * math.sin(0.5)))]
    assert list(state.effort) == [pytest.approx(-1.9)]
    assert list(interval.position) == [1e-4]
    assert (list(interval.velocity), list(interval.effort)) == ([], [])
    [ideal, *_] = peer.answer(rotor_state(START + MS, position=[0.5]))
    assert list(ideal.position) == [pytest.approx(-0.5 / 19)]


def test_calibration_is_set_changed_and_taken_away_while_the_node_runs(start, file):
    peer = start()
    peer.answer(rotor_state(START, position=[0.0]))
    assert peer.set(calibration=str(file())).successful
    state, _ = heard(peer, rotor_state(START + MS, position=[0.0]))
    assert stamp_of(peer.received['corrected_state'][0]) == START + MS
    assert list(state.position) == [pytest.approx(AMPLITUDE)]
    # The same name again reads the file again.
    assert peer.set(calibration=str(file(constant=0.5))).successful
    state, _ = heard(peer, rotor_state(START + 2 * MS, position=[0.0]))
    assert list(state.position) == [pytest.approx(0.5 + AMPLITUDE)]
    assert peer.set(calibration='').successful
    peer.answer(rotor_state(START + 3 * MS, position=[0.0]))
    assert peer.set(calibration=str(file())).successful
    heard(peer, rotor_state(START + 4 * MS, position=[0.0]))
    assert START + 3 * MS not in map(stamp_of, peer.received['corrected_state'])


def test_unusable_calibration_is_refused_and_nothing_changes(start, file, tmp_path):
    peer = start('-p', f'calibration:={file()}')
    other = file('other.yaml', ring_teeth=61, satellite_teeth=58, gear_ratio=Fraction(-58, 3))
    broken = tmp_path / 'broken.yaml'
    broken.write_text('schema: [', 'utf-8')
    for path, *causes in (
        (other, 'ratio -58/3 (ring 61, satellite 58 teeth)', 'ratio -19 (ring 80, satellite 76'),
        (broken, 'not YAML'),
        (tmp_path / 'none.yaml', 'No such file or directory'),
    ):
        result = peer.set(calibration=str(path))
        assert not result.successful
        assert str(path) in result.reason
        assert all(words in result.reason for words in ('calibration', *causes))
    assert peer.get('calibration') == [str(tmp_path / 'calibration.yaml')]
    state, _ = heard(peer, rotor_state(START, position=[0.0]))
    assert list(state.position) == [pytest.approx(AMPLITUDE)]


def test_calibration_of_the_parameter_file_is_found_beside_it(start, file, tmp_path):
    file('mine.yaml')
    config = tmp_path / 'actuator.yaml'
    config.write_text('/**:\n  ros__parameters:\n    calibration: mine.yaml\n', 'utf-8')
    state, _ = heard(start('--params-file', str(config)), rotor_state(START, position=[0.0]))
    assert list(state.position) == [pytest.approx(AMPLITUDE)]


def test_homing_leaves_the_play_unknown_until_the_next_travel(start, file):
    made = calibration(orders=(), compliance=None, constant=0.0)
    path = file(hysteresis=made.hysteresis, orders=(), covariance=made.covariance)
    peer = start('-p', f'calibration:={path}', '-p', 'home_angle:=0.2')
    for k, position in enumerate([0.0, 1.0]):
        _, interval = heard(peer, rotor_state(START + k * MS, position=[position], velocity=[1.0]))
    assert list(interval.position) == [1e-4]
    assert peer.home().success
    _, interval = heard(peer, rotor_state(START + 2 * MS, position=[1.0], velocity=[1.0]))
    assert list(interval.position) == [pytest.approx(1e-4 + 0.6 * 4e-4 + 0.2 * 2e-3)]


def test_gear_of_which_only_the_ratio_is_known_is_corrected_too(tmp_path, file):
    path = file(gear_ratio=Fraction(1457, 26), ring_teeth=None, satellite_teeth=None)
    arguments = ('-p', f'calibration:={path}', '-p', "gear_ratio:='1457/26'")
    with live_node(tmp_path, *arguments) as live:
        peer = live.peer
        listeners = [peer.listen(JointState, topic, QoSProfile(depth=2000)) for topic in TOPICS]
        for listener in listeners:
            peer.wait_until(listener.get_publisher_count, 'the node')
        stamps = itertools.count(START, MS)

        def corrected():
            peer.send(rotor_state(next(stamps), position=[0.5], velocity=[1.0]))
            return peer.received['corrected_state']

        position = peer.wait_until(corrected, 'the corrected output')[0].position
    assert list(position) == [pytest.approx(0.5 * 26 / 1457 + AMPLITUDE * math.cos(0.5))]


@pytest.mark.parametrize(('amplitude', 'level'), [(AMPLITUDE, 0), (0.0, 1)])
def test_diagnostics_judge_the_calibration_by_a_measured_angle(start, file, amplitude, level):
    peer = start('-p', f'calibration:={file()}')
    encoder = peer.node.create_publisher(JointState, 'output_encoder', QoSProfile(depth=2000))
    peer.wait_until(encoder.get_subscription_count, 'a subscription to output_encoder')
    number = 0

    def turn():
        nonlocal number
        for _ in range(20):
            number += 1
            angle = 0.05 * number
            # Noise that no two neighbours share.
            error = 0.3 + amplitude * math.cos(angle) + 2e-5 * (-1) ** number
            encoder.publish(rotor_state(START + number * MS, ['shaft'], [-angle / 19 + error]))
            peer.send(rotor_state(START + number * MS, position=[angle], velocity=[50.0]))
            peer.receive()

    found, message, values = peer.status(
        lambda s: (
            s.name.endswith('transmission error')
            and any('explained' in pair.key for pair in s.values)
            and any(pair.key == 'samples' and int(pair.value) > 1000 for pair in s.values)
        ),
        'a judgement',
        turn,
    )
    assert found == level
    assert message == ('calibration no longer fits' if level else 'ok')
    assert (float(values['explained by the calibration (%)']) > 99.0) == (not level)
    assert (float(values['outside the interval (%)']) > 5.0) == bool(level)
