# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The transmission error and the corrected output of the node as a process of its own."""

import itertools
import math
from dataclasses import replace
from fractions import Fraction

import pytest
from calibrations import AMPLITUDE, single_order
from live import SECOND, START, connected, parameter, rotor_state, stamp_of
from rclpy.qos import QoSProfile
from sensor_msgs.msg import JointState

pytestmark = pytest.mark.live

MS = SECOND // 1000
PLAY = 0.002  # rad
COUNT = 400
QUEUE = QoSProfile(depth=2000)


def encoder_report(peer, condition, what, meanwhile=lambda: None):
    return peer.status(
        lambda s: s.name.endswith(': transmission error') and condition(s), what, meanwhile
    )


def listen(peer, *topics):
    """Return what is received on each topic."""
    listeners = [peer.listen(JointState, topic, QUEUE) for topic in topics]
    for topic, listener in zip(topics, listeners, strict=True):
        peer.wait_until(listener.get_publisher_count, topic)
    return [peer.received[topic] for topic in topics]


def test_error_is_published_with_the_encoders_stamp_and_judged(tmp_path):
    with connected(tmp_path, *parameter('transmission_error_limit', 1e-3)) as peer:
        driver = peer.driver('output_encoder')
        [received] = listen(peer, 'transmission_error')

        def send(stamp, output_angle, rotor_angle):
            driver.publish(rotor_state(stamp, ['shaft'], [output_angle]))
            peer.send(rotor_state(stamp, position=[rotor_angle]))

        probes = itertools.count(MS, MS)

        def compared():
            send(next(probes), 0.0, 0.0)
            peer.outputs(1)
            return received

        peer.wait_until(compared, 'an error')  # the node discovers the listener in its own time
        errors = {}
        for k in range(COUNT):  # swing once, with play
            phase = k * math.tau / COUNT
            angle, stamp = 0.3 * math.sin(phase), START + k * MS
            errors[stamp] = math.copysign(0.5 * PLAY, -math.cos(phase))
            send(stamp, angle + errors[stamp], -19.0 * angle)
        peer.outputs(COUNT)

        # The two streams come in any order, so that the last measured angle may not be known yet.
        def found():
            return {stamp_of(m): m for m in received if stamp_of(m) >= START}

        peer.wait_until(lambda: len(found()) >= COUNT - 1, 'the errors')
        assert found().keys() <= errors.keys()
        for stamp, message in found().items():
            assert message.name == ['output_shaft']
            assert list(message.position) == [pytest.approx(errors[stamp], abs=1e-12)]
            assert not message.velocity
            assert not message.effort
        stamps = itertools.count(START + COUNT * MS, MS)

        def go_on():
            send(next(stamps), 0.0, 0.0)
            peer.outputs(1)

        level, message, values = encoder_report(
            peer, lambda s: 'peak to peak' in s.message, 'a warning', go_on
        )
        assert (level, message) == (1, 'peak to peak 0.002 rad')
        assert float(values['peak to peak (rad)']) == pytest.approx(PLAY)
        assert peer.set(transmission_error_limit=0.1).successful
        _, message, _ = encoder_report(peer, lambda s: s.level == b'\0', 'ok', go_on)
        assert message == 'ok'


def test_output_is_corrected_by_a_calibration_that_can_be_changed(tmp_path):
    file, broken, other = (tmp_path / f'{name}.yaml' for name in ('mine', 'broken', 'other'))
    file.write_text(single_order().text(), 'utf-8')
    broken.write_text('schema: [', 'utf-8')
    another_gear = {'ring_teeth': 61, 'satellite_teeth': 58, 'gear_ratio': Fraction(-58, 3)}
    other.write_text(replace(single_order(), **another_gear).text(), 'utf-8')
    config = tmp_path / 'actuator.yaml'
    parameters = '{calibration: mine.yaml, frame_prefix: left_}'
    config.write_text(f'/**:\n  ros__parameters: {parameters}\n', 'utf-8')
    with connected(tmp_path, '--params-file', str(config)) as peer:
        states, intervals = listen(peer, 'corrected_state', 'corrected_interval')
        stamps = itertools.count(START, MS)

        def corrected(position, **fields):
            """Send until the output is corrected; returns state, interval and ideal state."""
            first = next(stamps)

            def received():
                message = rotor_state(next(stamps), position=[position], **fields)
                [ideal, *_] = peer.answer(message)
                found = [[m for m in ms if stamp_of(m) > first] for ms in (states, intervals)]
                return all(found) and (found[0][-1], found[1][-1], ideal)

            return peer.wait_until(received, 'the corrected output')

        state, interval, ideal = corrected(0.5, velocity=[2.0], effort=[0.1])
        assert state.name == interval.name == ['left_output_shaft']
        assert list(state.position) == [pytest.approx(-0.5 / 19 + AMPLITUDE * math.cos(0.5))]
        # The rotor's rate times the derivative by its angle.
        assert list(state.velocity) == [pytest.approx(2.0 * (-1 / 19 - AMPLITUDE * math.sin(0.5)))]
        assert list(state.effort) == [pytest.approx(-1.9)]
        assert list(interval.position) == [1e-4]
        assert (list(interval.velocity), list(interval.effort)) == ([], [])
        assert list(ideal.position) == [pytest.approx(-0.5 / 19)]
        for path, *causes in (
            (other, 'ratio -58/3 (ring 61, satellite 58 teeth)', 'ratio -19 (ring 80, satellite'),
            (broken, 'not YAML'),
        ):
            result = peer.set(calibration=str(path))
            assert not result.successful
            assert all(words in result.reason for words in ('calibration', str(path), *causes))
        assert peer.get('calibration') == ['mine.yaml']
        # The same name again reads the file again.
        file.write_text(replace(single_order(), constant=0.5).text(), 'utf-8')
        assert peer.set(calibration=str(file)).successful
        state, *_ = corrected(0.0)
        assert list(state.position) == [pytest.approx(0.5 + AMPLITUDE)]
        assert peer.set(calibration='').successful
        without = next(stamps)
        peer.answer(rotor_state(without, position=[0.0]))
        assert peer.set(calibration=str(file)).successful
        corrected(0.0)
        assert without not in map(stamp_of, states)
