"""The node as a process of its own, heard, driven and stopped over the middleware."""

import json
import math
import os
import signal
import struct
import subprocess
import sys
import time
import xml.etree.ElementTree as ET
from collections import deque
from contextlib import ExitStack, contextmanager
from itertools import pairwise

import oracle
import pytest
import yaml
from live import LATCHED, PATIENT, SECOND, START, live_node, rotor_bytes, rotor_state, stamp_of
from rclpy.parameter import Parameter
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState
from wire import micro_ros_bytes

from gear_kinematics.parameters import default_config
from gear_kinematics.ros.live import running_node

pytestmark = pytest.mark.live

OK, WARN, ERROR = 0, 1, 2
ACTUATOR = oracle.Numbers(80, 76, 0.0011, ((0.0, 0.04), (math.pi, -0.04)))
BEST_EFFORT = QoSProfile(depth=10, reliability=ReliabilityPolicy.BEST_EFFORT)


@pytest.fixture(scope='module')
def shared(tmp_path_factory):
    """Return a node with default settings for the tests that change none, and its peer."""
    with live_node(tmp_path_factory.mktemp('shared')) as live:
        live.peer.connect()
        yield live


@pytest.fixture
def start(tmp_path):
    """Return what starts a node and its peer; all of them are stopped in the end."""
    with ExitStack() as stack:

        def start(*arguments, connect=True, **options):
            live = stack.enter_context(live_node(tmp_path, *arguments, **options))
            if connect:
                live.peer.connect()
            return live

        yield start


def parameter(name, value) -> tuple[str, str]:
    return '-p', f'{name}:={json.dumps(value)}'


def assert_motion(output, position, *, zero=0.0, direction=1, numbers=ACTUATOR) -> None:
    """Hold an output against the motion at 50 digits."""
    state, poses, joints = output
    exact = oracle.rotor_angle_of(position, zero, direction)
    expected = oracle.expected_motion(numbers, exact)
    spacing = 2.0 * math.ulp(float(expected.output_angle))
    assert oracle.angle_error(state.position[0], expected.output_angle) <= spacing
    branches = expected.branches
    centres = [branch.satellite_centre for branch in branches]
    centres += [branch.oldham_centre for branch in branches]
    assert len(poses.poses) == len(centres)
    for pose, centre in zip(poses.poses, centres, strict=True):
        place = (pose.position.x, pose.position.y)
        assert oracle.point_error(place, centre, numbers.eccentricity) <= 1e-12
        assert pose.position.z == centre[2]
        angle = 2.0 * math.atan2(pose.orientation.z, pose.orientation.w)
        assert oracle.turn_angle_error(angle, expected.output_angle) <= 1e-12
    positions = dict(zip(joints.name, joints.position, strict=True))
    for joint in ('rotor', 'output_shaft'):
        there = exact if joint == 'rotor' else expected.output_angle
        spacing = 2.0 * math.ulp(float(there))
        [angle] = [value for name, value in positions.items() if name.endswith(joint)]
        assert oracle.angle_error(angle, there) <= spacing


# Names and types.


def test_topics_services_and_types_are_those_of_the_contract(shared):
    node, namespace = shared.peer.node, shared.peer.namespace
    name = 'gear_state_publisher', namespace
    published = {
        f'{namespace}/output_state': ['sensor_msgs/msg/JointState'],
        f'{namespace}/body_poses': ['geometry_msgs/msg/PoseArray'],
        f'{namespace}/mechanism_joint_states': ['sensor_msgs/msg/JointState'],
        f'{namespace}/robot_description': ['std_msgs/msg/String'],
        f'{namespace}/markers': ['visualization_msgs/msg/MarkerArray'],
        f'{namespace}/corrected_state': ['sensor_msgs/msg/JointState'],
        f'{namespace}/corrected_interval': ['sensor_msgs/msg/JointState'],
        f'{namespace}/transmission_error': ['sensor_msgs/msg/JointState'],
        '/diagnostics': ['diagnostic_msgs/msg/DiagnosticArray'],
    }
    heard = {
        f'{namespace}/{topic}': ['sensor_msgs/msg/JointState']
        for topic in ('rotor_state', 'output_encoder')
    }
    served = {f'{namespace}/gear_state_publisher/home': ['std_srvs/srv/Trigger']}
    # News of the graph come in their own time, and of a node's name apart from its endpoints.
    shared.peer.wait_until(lambda: name in node.get_node_names_and_namespaces(), 'the name')
    for found, expected in (
        (node.get_publisher_names_and_types_by_node, published),
        (node.get_subscriber_names_and_types_by_node, heard),
        (node.get_service_names_and_types_by_node, served),
    ):
        shared.peer.wait_until(
            lambda found=found, expected=expected: expected.keys() <= dict(found(*name)).keys(),
            ', '.join(expected),
        )
        of_every_node = {'/parameter_events', '/rosout', '/clock'}
        assert {
            topic: types
            for topic, types in found(*name)
            if topic not in of_every_node and 'parameter' not in topic
            and 'get_type_description' not in topic
        } == expected  # fmt: skip


def test_start_line_tells_ratio_and_joint(start):
    live = start(*parameter('ring_teeth', 61), *parameter('satellite_teeth', 58),
                 *parameter('rotor_joint', 'm7'), connect=False)  # fmt: skip
    live.peer.connect(probes=False)
    live.peer.wait_until(lambda: live.lines('INFO'), 'the start line')
    line = live.lines('INFO')[0].text
    assert '-58/3' in line
    assert "'m7'" in line
    assert f'{live.peer.namespace}/rotor_state' in line


def test_start_line_tells_that_the_only_joint_is_taken(start):
    live = start(*parameter('rotor_joint', ''))
    assert 'the only joint' in live.lines('INFO')[0].text


# One output for each valid input.


def test_every_valid_input_has_one_output_with_its_stamp(start):
    peer = start().peer
    stamps = [START + 1_000_003 * n + n * n for n in range(300)]
    peer.send(*(rotor_state(stamp, position=[0.37 * n]) for n, stamp in enumerate(stamps)))
    outputs = peer.outputs(300)
    for messages in zip(*outputs, strict=True):
        assert [stamp_of(message) for message in messages] == stamps
    for number in (0, 1, 151, 299):
        assert_motion(outputs[number], 0.37 * number)


@pytest.mark.parametrize('position', [0.0, 0.1, -0.1, 1e3, -54321.987, 6.28e9])
def test_output_is_that_of_the_mechanism(shared, position):
    output = shared.peer.answer(rotor_state(shared.peer.stamp(), position=[position]))
    assert_motion(output, position)
    state, poses, joints = output
    assert list(state.name) == ['output_shaft']
    assert poses.header.frame_id == 'stator'
    assert sorted(joints.name) == [
        'oldham_a', 'oldham_b', 'output_shaft', 'rotor', 'satellite_a', 'satellite_b'
    ]  # fmt: skip


def test_output_of_another_mechanism(start, tmp_path):
    config = tmp_path / 'actuator.yaml'
    branches = {'left': (0.5, 0.01), 'mid': (2.5, 0.0), 'right': (-2.0, -0.01)}
    values = {
        'ring_teeth': 61,
        'satellite_teeth': 58,
        'eccentricity': 0.002,
        'branches': list(branches),
        **{
            name: {'cam_phase': phase, 'axial_position': z}
            for name, (phase, z) in branches.items()
        },
    }
    config.write_text(yaml.safe_dump({'/**': {'ros__parameters': values}}))
    output = start('--params-file', str(config)).peer.answer(rotor_state(START, position=[7.5]))
    numbers = oracle.Numbers(61, 58, 0.002, tuple(branches.values()))
    assert_motion(output, 7.5, numbers=numbers)
    assert sorted(output[2].name) == [
        'oldham_left', 'oldham_mid', 'oldham_right', 'output_shaft', 'rotor',
        'satellite_left', 'satellite_mid', 'satellite_right',
    ]  # fmt: skip


@pytest.mark.parametrize(
    ('velocity', 'effort'),
    [([], []), ([38.0], []), ([], [0.5]), ([38.0], [0.5])],
    ids=['neither', 'velocity', 'effort', 'both'],
)
def test_fields_of_the_input_are_those_of_the_output(shared, velocity, effort):
    stamp = shared.peer.stamp()
    message = rotor_state(stamp, position=[1.9], velocity=velocity, effort=effort)
    state, _, joints = shared.peer.answer(message)
    assert state.position[0] == pytest.approx(-0.1, abs=1e-16)
    assert list(state.velocity) == ([pytest.approx(-2.0)] if velocity else [])
    assert list(state.effort) == ([pytest.approx(-9.5)] if effort else [])
    velocities = dict(zip(joints.name, joints.velocity, strict=False))
    assert len(velocities) == (len(joints.name) if velocity else 0)
    if velocity:
        assert (velocities['rotor'], velocities['satellite_a']) == (38.0, pytest.approx(-40.0))


def test_rotor_is_one_of_many_joints(shared):
    stamp = shared.peer.stamp()
    message = rotor_state(stamp, ['x', 'rotor', 'y'], [9, 1.9, 9], [8, 3.8, 8], [7, 0.5, 7])
    state, *_ = output = shared.peer.answer(message)
    assert_motion(output, 1.9)
    assert (state.velocity[0], state.effort[0]) == (pytest.approx(-0.2), pytest.approx(-9.5))


def test_empty_rotor_joint_takes_the_only_joint(start):
    peer = start(*parameter('rotor_joint', '')).peer
    ambiguous = rotor_state(START, ['rotor', 'other'], [1.0, 2.0])
    output = peer.answer(ambiguous, rotor_state(START + 1, ['whatever'], [2.5]))
    assert_motion(output, 2.5)


def test_big_endian_driver_is_understood(shared):
    peer, stamp = shared.peer, shared.peer.stamp()
    data = rotor_bytes(stamp, position=[1.25], velocity=[19.0], little_endian=False)
    peer.send(data)
    [output] = peer.outputs(1)
    assert_motion(output, 1.25)
    assert stamp_of(output[0]) == stamp


# Bad input, row by row of the contract.

REJECTED = {
    'joint missing': ('joint missing', rotor_state(START, ['wheel'], [1.0])),
    'no joints': ('joint missing', rotor_state(START, [], [])),
    'position missing': ('position missing', rotor_state(START)),
    'position array too short': ('position missing', rotor_state(START, ['a', 'rotor'], [1.0])),
    'position NaN': ('position not finite', rotor_state(START, position=[math.nan])),
    'position too large': ('position too large', rotor_state(START, position=[1e17])),
    'position infinite': ('position not finite', rotor_state(START, position=[-math.inf])),
    'garbage': ('not a JointState', b'\xde\xad\xbe\xef' * 40),
    'only an encapsulation': ('not a JointState', b'\0\1\0\0'),
    'cut off': ('not a JointState', rotor_bytes(START, position=[1.0])[:-4]),
    'text': ('not a JointState', b'\0\1\0\0' + b'\x0c\0\0\0' + b'hello world\0'),
}


@pytest.mark.parametrize('row', REJECTED)
def test_bad_input_has_no_output_and_the_next_has(shared, row):
    _, bad = REJECTED[row]
    good = rotor_state(shared.peer.stamp(), position=[1.5])
    assert_motion(shared.peer.answer(bad, bad, good), 1.5)


def test_bad_input_is_counted_by_its_cause(start):
    live = start(*PATIENT)
    causes = [cause for cause, bad in REJECTED.values()]
    live.peer.report()  # the next one, a second later, tells of all
    began = time.time_ns()
    live.peer.answer(*(bad for _, bad in REJECTED.values()), rotor_state(START, position=[1.5]))
    level, message, values = live.peer.status(lambda s: s.level == b'\1', 'a warning', since=began)
    assert level == WARN
    counted = {key: value for key, value in values.items() if key.startswith('rejected')}
    assert counted == {f'rejected: {cause}': str(causes.count(cause)) for cause in causes}
    assert all(f'{cause} {causes.count(cause)}' in message for cause in causes)
    [warning] = live.lines('WARN')
    assert 'joint missing' in warning.text


def test_rejects_are_warned_about_at_most_once_a_second(start):
    live = start()
    stamps = iter(range(START, START + 10**9))
    sent = 0

    def three_warnings():
        nonlocal sent
        live.peer.send(rotor_state(next(stamps), ['wheel'], [1.0]))
        sent += 1
        return len(live.lines('WARN')) >= 3

    live.peer.wait_until(three_warnings, 'three warnings')
    times = [line.time for line in live.lines('WARN')]
    assert sent > 20
    assert min(b - a for a, b in pairwise(times)) > 0.95


def test_missing_joint_is_warned_about_with_the_joints_that_there_are(start):
    live = start(*PATIENT)
    live.peer.send(rotor_state(START, ['wheel', 'rotor_1'], [1.0, 2.0]))
    live.peer.wait_until(lambda: live.lines('WARN'), 'a warning')
    [warning] = live.lines('WARN')
    assert warning.text == (
        "rotor_state rejected: joint missing: no joint 'rotor' in it; did you mean `rotor_1`? "
        'there are: rotor_1, wheel'
    )


def test_topic_without_a_publisher_is_warned_about_with_those_that_there_are(start):
    live = start(connect=False, rotor_state='motor/joint_states')
    peer = live.peer

    def warned():
        peer.send(rotor_state(peer.stamp(), ['wheel', 'motor_1'], [0.0, 1.0]))
        return live.lines('WARN')

    [warning] = peer.wait_until(warned, 'a warning')
    [*_, begun] = live.lines('INFO')
    assert 4.9 < warning.time - begun.time < 20.0
    topic = f'{peer.namespace}/motor/joint_states'
    # Others run at the same time.
    assert warning.text.startswith(f'{peer.namespace}/rotor_state has no publisher; there are: ')
    assert f'{topic} (joints motor_1, wheel)' in warning.text
    assert f'{peer.namespace}/output_state' not in warning.text
    arguments = f'-r rotor_state:={topic} -p rotor_joint:=motor_1'
    assert warning.text.endswith(f'did you mean `--ros-args {arguments}`?')
    peer.wait_until(lambda: not peer.matches()[0], 'the end of its listening')


@pytest.mark.parametrize('field', ['velocity', 'effort'])
@pytest.mark.parametrize('values', [[], [5.0], [5.0, math.nan], [5.0, math.inf]])
def test_unusable_velocity_or_effort_leaves_only_that_field_empty(shared, field, values):
    other = {'velocity': 'effort', 'effort': 'velocity'}[field]
    arrays = {field: values, other: [0.0, 1.0]}
    message = rotor_state(shared.peer.stamp(), ['x', 'rotor'], [0.0, 1.9], **arrays)
    state, *_ = output = shared.peer.answer(message)
    assert_motion(output, 1.9)
    assert len(getattr(state, field)) == 0
    assert len(getattr(state, other)) == 1


def test_same_stamp_is_published_and_counted(start):
    peer = start(*PATIENT).peer
    peer.send(rotor_state(START, position=[1.0]), rotor_state(START, position=[2.0]))
    first, second = peer.outputs(2)
    assert stamp_of(first[0]) == stamp_of(second[0]) == START
    assert_motion(first, 1.0)
    assert_motion(second, 2.0)
    level, _, values = peer.status()
    assert (level, values['duplicate stamps']) == (OK, '1')


def test_stamp_older_by_up_to_a_second_is_dropped(start):
    peer = start(*PATIENT).peer
    peer.answer(rotor_state(START, position=[1.0]))
    peer.report()  # the next one, a second later, tells of both
    began = time.time_ns()
    output = peer.answer(
        rotor_state(START - 1, position=[2.0]),
        rotor_state(START - SECOND, position=[2.0]),
        rotor_state(START + 1, position=[3.0]),
    )
    assert_motion(output, 3.0)
    level, message, values = peer.status(lambda s: s.level == b'\1', 'a warning', since=began)
    assert level == WARN
    assert 'out of order 2' in message
    assert values['rejected: out of order'] == '2'


def test_stamp_older_by_more_than_a_second_resets(start):
    peer = start(*PATIENT).peer
    peer.answer(rotor_state(START, position=[1.0]))
    assert_motion(peer.answer(rotor_state(START - SECOND - 1, position=[2.0])), 2.0)
    assert_motion(peer.answer(rotor_state(START - SECOND, position=[2.5])), 2.5)
    level, _, values = peer.status()
    assert (level, values['clock resets']) == (OK, '1')


def test_zero_stamp_becomes_the_clock_and_is_counted(start):
    peer = start().peer
    before = peer.node.get_clock().now().nanoseconds
    peer.send(rotor_state(0, position=[1.0]))
    [output] = peer.outputs(1)
    after = peer.node.get_clock().now().nanoseconds
    stamps = {stamp_of(message) for message in output}
    assert len(stamps) == 1
    assert before <= stamps.pop() <= after
    assert peer.status()[2]['zero stamps'] == '1'


def test_unnormalised_stamp_is_published_normalised_and_counted(start):
    peer = start(*PATIENT).peer
    data = rotor_bytes(START, position=[1.5])
    peer.send(data[:4] + struct.pack('<iI', 100, 3_000_000_007) + data[12:])
    [output] = peer.outputs(1)
    assert_motion(output, 1.5)
    stamps = {(m.header.stamp.sec, m.header.stamp.nanosec) for m in output}
    assert stamps == {(103, 7)}
    level, _, values = peer.status()
    assert (level, values['unnormalised stamps']) == (OK, '1')


def test_driver_on_micro_ros_that_names_nothing_is_answered(start):
    peer = start(*parameter('rotor_joint', '')).peer
    peer.send(micro_ros_bytes(START, [''], [1.5], [3.8]))
    [output] = peer.outputs(1)
    assert_motion(output, 1.5)
    assert list(output[0].velocity) == [3.8 / -19.0]


def test_extreme_numbers_do_not_end_the_node(start):
    peer = start(*parameter('rotor_encoder', 'single_turn')).peer
    extremes = [
        rotor_state(START, position=[1.0], velocity=[0.0]),
        rotor_state(START + SECOND, position=[1.0], velocity=[1e200], effort=[1.7e308]),
        rotor_state(START + 2 * SECOND, position=[1e16], velocity=[-1.7e308]),
    ]
    peer.send(*extremes, rotor_state(START + 3 * SECOND, position=[0.5]))
    peer.wait_until(
        lambda: any(stamp_of(m) == START + 3 * SECOND for m in peer.received['output_state']),
        'an output',
    )


# Diagnostics.


def test_diagnostics_come_once_a_second_under_their_name(start):
    peer = start().peer
    before = peer.node.get_clock().now().nanoseconds
    message, status = peer.report()
    assert status.name == f'{peer.namespace[1:]}/gear_state_publisher: rotor input'
    assert status.hardware_id == f'{peer.namespace}/gear_state_publisher'
    # On a busy machine one comes late now and then.
    stamps = deque([stamp_of(message)], maxlen=3)

    def steady():
        stamps.append(stamp_of(peer.report()[0]))
        return stamps[-1] - stamps[0] == pytest.approx(2 * SECOND, rel=0.25)

    peer.wait_until(steady, 'three reports in two seconds')
    assert stamps[0] < stamps[1] < stamps[2]
    assert before < stamps[2] < peer.node.get_clock().now().nanoseconds


def test_diagnostics_go_from_no_input_by_ok_and_warning_back_to_ok(start):
    peer = start(connect=False).peer
    level, message, values = peer.status(lambda s: s.level == b'\2', 'no input')
    assert level == ERROR
    assert 'no input' in message
    assert (values['received'], values['age of last input (s)']) == ('0', 'none')
    peer.connect()

    def while_sending(wanted, since=None):
        def send():
            peer.send(rotor_state(peer.stamp(), position=[1.0]))

        return peer.status(lambda s: s.level == wanted, f'level {wanted}', send, since)

    _, message, values = while_sending(b'\0')
    assert message == 'ok'
    assert int(values['received']) == int(values['published']) > 0
    assert float(values['rate (Hz)']) > 1.0
    assert float(values['age of last input (s)']) < 1.0
    assert values['referenced'] == 'true'
    assert float(values['loop-closure residual (m)']) < 1e-15
    began = time.time_ns()
    peer.send(rotor_state(peer.stamp(), ['wheel'], [1.0]))
    _, message, _ = while_sending(b'\1', began)
    assert 'joint missing 1' in message
    _, message, _ = while_sending(b'\0')
    assert message == 'ok'


def test_silence_beyond_the_timeout_is_an_error(start):
    peer = start(*parameter('input_timeout', 0.3)).peer
    level, message, _ = peer.status(lambda s: s.level == b'\2', 'an error')
    assert level == ERROR
    assert 'no input' in message


def test_single_turn_encoder_is_an_error_until_home(start):
    peer = start(*parameter('rotor_encoder', 'single_turn')).peer
    level, message, values = peer.status()
    assert level == ERROR
    assert 'not referenced' in message
    assert values['referenced'] == 'false'
    assert_motion(peer.answer(rotor_state(START, position=[1.0])), 1.0)
    assert peer.home().success
    # More than half a turn's time later the turns are unknown again.
    level, message, values = peer.status(lambda s: 'not referenced' not in s.message, 'referenced')
    assert values['referenced'] == 'true'
    peer.answer(rotor_state(START + SECOND, position=[1.0]))
    level, message, _ = peer.status(lambda s: 'not referenced' in s.message, 'not referenced')
    assert level == ERROR


def test_subscriber_that_wants_old_outputs_is_reported_as_long_as_it_is_there(start):
    live = start(*PATIENT)
    peer = live.peer
    fault = f'incompatible QoS on output_state: DURABILITY (listener {peer.namespace}/peer)'
    latched = peer.listen(JointState, 'latched', LATCHED, 'output_state')
    level, _, _ = peer.status(lambda s: s.message == fault, 'a warning')
    assert level == WARN
    peer.status(lambda s: s.message == fault, 'another')
    peer.node.destroy_subscription(latched)
    level, message, _ = peer.status(lambda s: 'incompatible' not in s.message, 'its end')
    assert (level, message) == (OK, 'ok')
    assert [line.text for line in live.lines('WARN')].count(fault) == 1


def test_volatile_subscriber_to_the_description_is_no_fault(start):
    peer = start(*PATIENT).peer
    peer.listen(JointState, 'plain', QoSProfile(depth=1), 'output_state')
    peer.answer(rotor_state(START, position=[1.0]))
    assert peer.status()[0] == OK


def best_effort_driver(peer):
    return peer.node.create_publisher(JointState, 'rotor_state', BEST_EFFORT)


def qos_override(topic, end, **policies) -> list[str]:
    prefix = f'qos_overrides.{topic}.{end}'
    return [
        part
        for policy, value in policies.items()
        for part in parameter(f'{prefix}.{policy}', value)
    ]


def test_driver_that_does_best_effort_is_reported_where_reliable_is_asked_for(start):
    namespace = f'/strict_{os.getpid()}'
    live = start(
        *PATIENT,
        *qos_override(f'{namespace}/rotor_state', 'subscription', reliability='reliable'),
        namespace=namespace,
    )
    fault = f'incompatible QoS on rotor_state: RELIABILITY (driver {namespace}/peer)'
    driver = best_effort_driver(live.peer)
    level, _, _ = live.peer.status(lambda s: s.message == fault, 'an error')
    assert level == ERROR
    live.peer.node.destroy_publisher(driver)
    level, message, _ = live.peer.status(lambda s: 'incompatible' not in s.message, 'its end')
    assert (level, message) == (OK, 'ok')
    assert [line.text for line in live.lines('WARN')].count(fault) == 1


@pytest.mark.parametrize('reliable_first', [True, False])
def test_driver_that_does_best_effort_is_heard(start, reliable_first):
    peer = start(*PATIENT, connect=reliable_first).peer
    driver = best_effort_driver(peer)
    stamps = iter(range(START, START + 10**9))

    def heard():
        driver.publish(rotor_state(next(stamps), position=[1.5]))
        return all(
            any(stamp_of(message) >= START for message in peer.received[name])
            for name in ('output_state', 'body_poses', 'mechanism_joint_states')
        )

    peer.wait_until(heard, 'outputs')
    newest = [peer.received[name][-1] for name in ('output_state', 'body_poses')]
    assert_motion((*newest, peer.received['mechanism_joint_states'][-1]), 1.5)
    level, message, _ = peer.status(lambda s: 'incompatible' not in s.message)
    assert 'incompatible' not in message
    assert level != ERROR


@contextmanager
def another_node(live, *arguments):
    """Run another node in the namespace of a first one, and give the path of its log."""
    log = live.log.with_suffix('.another.log')
    command = ['--ros-args', '-r', f'__ns:={live.peer.namespace}', *PATIENT, *arguments]
    environment = {**os.environ, 'ROS_LOG_DIR': str(log.parent)}
    with (
        log.open('w', encoding='utf-8') as stream,
        running_node(command, stdout=stream, stderr=stream, env=environment),
    ):
        yield log


def test_two_nodes_of_one_name_both_warn_until_one_ends(start):
    live = start(*PATIENT)
    peer = live.peer
    fault = f'another node is named {peer.namespace}/gear_state_publisher'
    with another_node(live) as log:
        peer.wait_until(
            lambda: fault in live.text() and fault in log.read_text(), 'warnings in both logs'
        )
        for new in (True, False):

            def concerns(status, new=new):
                values = {pair.key: pair.value for pair in status.values}
                return fault in status.message and (values['received'] == '0') == new

            level, message, _ = peer.status(concerns, 'a warning of either')
            assert (level, message) == (WARN, fault)
    level, message, _ = peer.status(lambda s: fault not in s.message, 'the end of the other')
    assert (level, message) == (OK, 'ok')
    assert [line.text for line in live.lines('WARN')].count(fault) == 1


def test_two_nodes_that_publish_on_one_topic_name_each_other_until_one_ends(start):
    live = start(*PATIENT)
    peer = live.peer
    remapped = ('-r', '__node:=second', '-r', 'output_state:=elsewhere')
    with another_node(live, *remapped) as log:
        for node, other in (
            ('gear_state_publisher', 'second'),
            ('second', 'gear_state_publisher'),
        ):
            fault = f'{peer.namespace}/{other} also publishes body_poses, mechanism_joint_states'
            level, _, _ = peer.status(lambda s, f=fault: s.message == f, fault, node=node)
            assert level == WARN
        assert fault in log.read_text()
    level, message, _ = peer.status(lambda s: 'publishes' not in s.message, 'the end of it')
    assert (level, message) == (OK, 'ok')


# Homing.


def test_home_before_any_input_fails_and_says_why(start):
    peer = start(connect=False).peer
    answer = peer.home()
    assert not answer.success
    assert 'rotor_state' in answer.message
    assert peer.get('rotor_zero') == [0.0]


@pytest.mark.parametrize('encoder', ['multi_turn', 'single_turn'])
@pytest.mark.parametrize(('home_angle', 'direction'), [(0.0, 1), (0.75, 1), (-12.5, -1)])
def test_home_makes_the_position_the_home_angle(start, encoder, home_angle, direction):
    peer = start(
        *parameter('rotor_encoder', encoder),
        *parameter('home_angle', home_angle),
        *parameter('rotor_direction', direction),
    ).peer
    peer.answer(rotor_state(START, position=[2.25]))
    answer = peer.home()
    assert answer.success, answer.message
    # By hand, 80/76: φ2 = -19 φ5 = direction (2.25 - zero).
    zero = 2.25 + direction * 19.0 * home_angle
    [given] = peer.get('rotor_zero')
    assert given == pytest.approx(zero, abs=1e-12)
    output = peer.answer(rotor_state(START + SECOND // 1000, position=[2.25]))
    assert output[0].position[0] == pytest.approx(home_angle, abs=1e-13)
    assert_motion(output, 2.25, zero=given, direction=direction)
    onward = peer.answer(rotor_state(START + 2 * SECOND // 1000, position=[2.5]))
    moved = onward[0].position[0] - output[0].position[0]
    assert moved == pytest.approx(-0.25 * direction / 19.0, abs=1e-13)
    assert peer.status()[2]['referenced'] == 'true'


# Parameters.


def test_declared_defaults_are_those_of_the_shipped_file(start):
    peer = start(connect=False).peer
    shipped = yaml.safe_load(default_config().read_text())['/**']['ros__parameters']
    for branch in shipped['branches']:
        values = shipped.pop(branch)
        shipped |= {f'{branch}.{name}': value for name, value in values.items()}
    names = peer.list_parameters()
    own = {
        name
        for name in names
        if not name.startswith('qos_overrides.')
        and name not in {'use_sim_time', 'start_type_description_service'}
    }
    assert own == set(shipped)
    assert dict(zip(shipped, peer.get(*shipped), strict=True)) == shipped
    assert all(descriptor.description for descriptor in peer.describe(*shipped))


def test_direction_and_zero_take_effect_while_the_node_runs(start):
    peer = start().peer
    assert_motion(peer.answer(rotor_state(START, position=[3.0])), 3.0)
    assert peer.set(rotor_direction=-1).successful
    assert_motion(peer.answer(rotor_state(START + 1, position=[3.0])), 3.0, direction=-1)
    assert peer.set(rotor_zero=1.25).successful
    output = peer.answer(rotor_state(START + 2, position=[3.0], velocity=[19.0], effort=[1.0]))
    assert_motion(output, 3.0, zero=1.25, direction=-1)
    assert output[0].velocity[0] == pytest.approx(1.0)
    assert output[0].effort[0] == pytest.approx(19.0)
    assert peer.get('rotor_direction', 'rotor_zero') == [-1, 1.25]


def test_home_angle_takes_effect_while_the_node_runs(start):
    peer = start().peer
    peer.answer(rotor_state(START, position=[3.0]))
    assert peer.set(home_angle=0.5).successful
    assert peer.home().success
    output = peer.answer(rotor_state(START + 1, position=[3.0]))
    assert output[0].position[0] == pytest.approx(0.5, abs=1e-14)


REFUSED = [
    ('rotor_direction', 0, ['-1', '1']),
    ('rotor_direction', 2, ['-1', '1']),
    ('rotor_direction', 1.0, ['INTEGER']),
    ('rotor_zero', 2e15, ['1000000000000000']),
    ('rotor_zero', math.nan, ['1000000000000000']),
    ('rotor_zero', 'x', ['DOUBLE']),
    ('home_angle', -2e9, ['1000000000']),
    ('rotor_encoder', 'absolute', ['multi_turn', 'single_turn']),
    ('rotor_encoder', 3, ['STRING']),
    ('max_rotor_speed', 0.0, ['0.001', '1000000']),
    ('input_timeout', -1.0, ['0.001', '1000000']),
    ('ring_teeth', 81, ['read-only']),
    ('eccentricity', 0.002, ['read-only']),
    ('module', 0.001, ['read-only']),
    ('branches', ['a'], ['read-only']),
    ('a.cam_phase', 1.0, ['read-only']),
]


@pytest.mark.parametrize(('name', 'value', 'bounds'), REFUSED)
def test_unusable_value_is_refused_and_nothing_changes(shared, name, value, bounds):
    peer = shared.peer
    [before] = peer.get(name)
    result = peer.set(**{name: value})
    assert not result.successful
    assert name in result.reason
    assert all(bound in result.reason for bound in bounds)
    assert peer.get(name) == [before]
    assert_motion(peer.answer(rotor_state(peer.stamp(), position=[3.0])), 3.0)


@pytest.mark.parametrize('name', ['rotor', 'satellite_a', 'oldham_b'])
def test_output_joint_of_another_joints_name_is_refused(start, name):
    peer = start().peer
    result = peer.set(output_joint=name)
    assert not result.successful
    assert 'output_joint' in result.reason
    assert name in result.reason
    assert peer.get('output_joint') == ['output_shaft']
    output = peer.answer(rotor_state(START, position=[3.0]))
    assert list(output[0].name) == ['output_shaft']


def test_refused_value_does_not_keep_others_out(start):
    peer = start().peer
    values = [('rotor_zero', 1.0), ('rotor_direction', 5), ('home_angle', 0.25)]
    results = peer.set_all([Parameter(name, value=value) for name, value in values])
    assert [result.successful for result in results] == [True, False, True]
    assert peer.get('rotor_zero', 'rotor_direction', 'home_angle') == [1.0, 1, 0.25]


def test_change_of_encoder_takes_effect_while_the_node_runs(start):
    peer = start().peer
    assert peer.set(rotor_encoder='single_turn').successful
    level, message, _ = peer.status()
    assert level == ERROR
    assert 'not referenced' in message


# Quality of service.


def test_default_quality(shared):
    peer = shared.peer
    for topic in ('output_state', 'body_poses', 'mechanism_joint_states'):
        [qos] = peer.endpoints(peer.node.get_publishers_info_by_topic, f'{peer.namespace}/{topic}')
        assert qos.reliability == ReliabilityPolicy.RELIABLE
        assert qos.durability == DurabilityPolicy.VOLATILE
    [qos] = peer.endpoints(
        peer.node.get_publishers_info_by_topic, f'{peer.namespace}/robot_description'
    )
    assert qos.reliability == ReliabilityPolicy.RELIABLE
    assert qos.durability == DurabilityPolicy.TRANSIENT_LOCAL


@pytest.mark.parametrize(
    'topic',
    ['output_state', 'body_poses', 'mechanism_joint_states', 'robot_description', '/diagnostics'],
)
def test_quality_of_an_output_can_be_overridden(start, topic):
    namespace = f'/quality_{os.getpid()}_{topic.strip("/")}'
    if not topic.startswith('/'):
        topic = f'{namespace}/{topic}'
    override = qos_override(topic, 'publisher', reliability='best_effort', depth=7)
    peer = start(*override, namespace=namespace, connect=False).peer
    [qos] = peer.endpoints(peer.node.get_publishers_info_by_topic, topic)
    assert qos.reliability == ReliabilityPolicy.BEST_EFFORT
    assert peer.get(f'qos_overrides.{topic}.publisher.depth') == [7]


@pytest.mark.parametrize('reliability', ['reliable', 'best_effort'])
def test_quality_of_the_input_can_be_overridden(start, reliability):
    namespace = f'/quality_{os.getpid()}_{reliability}'
    topic = f'{namespace}/rotor_state'
    override = qos_override(topic, 'subscription', reliability=reliability)
    peer = start(*override, namespace=namespace, connect=False).peer
    [qos] = peer.endpoints(peer.node.get_subscriptions_info_by_topic, topic)
    assert qos.reliability == ReliabilityPolicy[reliability.upper()]


# Names, frames, description.


def test_topics_can_be_remapped(start):
    new = {'rotor_state': 'motor/joint_states', 'output_state': 'joint_states',
           'body_poses': 'bodies', 'mechanism_joint_states': 'all_joints',
           'diagnostics': '/health'}  # fmt: skip
    remap = [
        part
        for old, name in new.items()
        for part in ('-r', f'{"/" if old == "diagnostics" else ""}{old}:={name}')
    ]
    peer = start(*PATIENT, *remap, **new).peer
    assert_motion(peer.answer(rotor_state(START, position=[1.5])), 1.5)
    assert peer.status()[0] == OK


def test_two_nodes_side_by_side(start):
    left = start(*PATIENT, *parameter('frame_prefix', 'left/'), *parameter('rotor_joint', 'l'),
                 connect=False)  # fmt: skip
    right = start(*PATIENT, *parameter('frame_prefix', 'right/'), *parameter('ring_teeth', 78),
                  *parameter('rotor_direction', -1))  # fmt: skip
    left.peer.connect(joint='l')
    output = left.peer.answer(rotor_state(START, ['l'], [1.0]))
    assert (output[0].name, output[1].header.frame_id) == (['left/output_shaft'], 'left/stator')
    assert_motion(output, 1.0)
    output = right.peer.answer(rotor_state(START, position=[1.0]))
    assert output[1].header.frame_id == 'right/stator'
    assert_motion(output, 1.0, direction=-1, numbers=ACTUATOR._replace(ring_teeth=78))
    # Both report, each of its own input.
    assert left.peer.status()[0] == right.peer.status()[0] == OK


def test_frame_prefix_is_on_frames_and_joints(start):
    peer = start(*parameter('frame_prefix', 'arm_'), *parameter('output_joint', 'shoulder')).peer
    state, poses, joints = peer.answer(rotor_state(START, position=[1.0]))
    assert list(state.name) == ['arm_shoulder']
    assert poses.header.frame_id == 'arm_stator'
    assert sorted(joints.name) == [
        'arm_oldham_a', 'arm_oldham_b', 'arm_rotor', 'arm_satellite_a', 'arm_satellite_b',
        'arm_shoulder',
    ]  # fmt: skip


def names_in(description, kind) -> set[str]:
    robot = ET.fromstring(description)  # noqa: S314, the project's own
    return {element.get('name') for element in robot.iterfind(kind)}


def test_description_is_latched_and_names_the_published_joints(start):
    peer = start().peer
    output = peer.answer(rotor_state(START, position=[1.0]))
    # Only now does anybody listen.
    description = peer.description()
    assert names_in(description, 'joint') == set(output[2].name)
    assert names_in(description, 'link') == {
        'stator', 'rotor', 'satellite_a', 'satellite_b', 'oldham_a', 'oldham_b', 'output_shaft'
    }  # fmt: skip


def test_change_of_prefix_publishes_the_description_anew(start):
    peer = start().peer
    assert 'stator' in names_in(peer.description(), 'link')
    [name] = [name for name in peer.received if name.startswith('robot_description')]
    assert peer.set(frame_prefix='arm_').successful
    peer.wait_until(lambda: len(peer.received[name]) == 2, 'a new description')
    assert 'arm_stator' in names_in(peer.received[name][1].data, 'link')
    # Late joiners get the new one only.
    assert 'arm_stator' in names_in(peer.description(), 'link')
    output = peer.answer(rotor_state(START, position=[1.0]))
    assert output[1].header.frame_id == 'arm_stator'
    assert set(output[2].name) == names_in(peer.received[name][1].data, 'joint')
    # What does not change the description does not publish it either.
    assert peer.set(rotor_zero=1.0).successful
    peer.answer(rotor_state(START + 1, position=[1.0]))
    peer.status()
    assert len(peer.received[name]) == 2


# Simulated time.


def test_simulated_time_stamps_inputs_without_stamp_and_diagnostics(start):
    live = start('-p', 'use_sim_time:=true', connect=False)
    peer = live.peer
    clock = peer.node.create_publisher(Clock, '/clock', QoSProfile(depth=1))
    now = Clock()
    now.clock.sec, now.clock.nanosec = 4321, 5

    def stamped():
        clock.publish(now)
        peer.send(rotor_state(0, position=[1.0]))
        return [m for m in peer.received['body_poses'] if stamp_of(m) == 4321 * SECOND + 5]

    peer.wait_until(stamped, 'the simulated time')
    message, _ = peer.report()
    assert stamp_of(message) == 4321 * SECOND + 5
    # The simulated clock stands still, and yet silence is noticed.
    _, message, _ = peer.status(lambda s: 'no input' in s.message, 'silence')
    assert 'no input' in message


# The end, and beginnings that fail.


@pytest.mark.parametrize('executor', ['events', 'single_threaded'])
@pytest.mark.parametrize('number', [signal.SIGINT, signal.SIGTERM])
def test_signal_ends_the_node_cleanly(start, number, executor):
    live = start(*parameter('executor', executor))
    live.peer.answer(rotor_state(START, position=[1.0]))
    live.process.send_signal(number)
    assert live.process.wait(20.0) == 0
    # No traceback and no last words: the start line is all.
    assert [line.level for line in live.lines()] == ['INFO']
    assert len(live.text().splitlines()) == 1


def test_signal_ends_the_node_cleanly_under_load(start):
    live = start()
    peer = live.peer
    peer.send(*(rotor_state(START + n, position=[1.0]) for n in range(500)))
    live.process.send_signal(signal.SIGINT)
    assert live.process.wait(20.0) == 0
    assert 'Traceback' not in live.text()


def refusal(tmp_path, *arguments) -> list[str]:
    """Start a node that must not start; returns what it says, by line."""
    environment = {**os.environ, 'ROS_LOG_DIR': str(tmp_path)}
    done = subprocess.run(
        [sys.executable, '-m', 'gear_kinematics.ros', *arguments],
        check=False, capture_output=True, text=True, timeout=30.0, env=environment,
    )  # fmt: skip
    assert done.returncode == 2, done.stderr
    assert 'Traceback' not in done.stderr
    assert done.stdout == ''
    return done.stderr.splitlines()


BAD_STARTS = [
    (['ring_teeth:=1'], ['ring_teeth', '2', '100000']),
    (['ring_teeth:=80.0'], ['ring_teeth', 'INTEGER']),
    (['ring_teeth:=many'], ['ring_teeth', 'INTEGER']),
    (['satellite_teeth:=80'], ['satellite_teeth (80)', 'ring_teeth (80)']),
    (['satellite_teeth:=90'], ['satellite_teeth (90)', 'ring_teeth (80)']),
    (['eccentricity:=.nan'], ['eccentricity', '1e-06', '1.0']),
    (['eccentricity:=0.0'], ['eccentricity', '1e-06', '1.0']),
    (['module:=-1.0'], ['module', '1e-06', '0.1']),
    (['branches:=[]'], ['branches']),
    (['branches:=[a,a]'], ["'a'", 'more than once']),
    (['branches:=[1st]'], ['1st', 'branch']),
    (['a.cam_phase:=9.0'], ['a.cam_phase', '6.28']),
    (['b.axial_position:=high'], ['b.axial_position', 'DOUBLE']),
    (['rotor_direction:=0'], ['rotor_direction', '-1', '1']),
    (['rotor_encoder:=absolute'], ['rotor_encoder', 'multi_turn', 'single_turn']),
    (['max_rotor_speed:=-5.0'], ['max_rotor_speed', '0.001', '1000000']),
    (['output_joint:=rotor'], ['output_joint', 'rotor']),
    (['output_joint:=satellite_a'], ['output_joint', 'satellite_a']),
    (['frame_prefix:=5'], ['frame_prefix', 'STRING']),
    (['executor:=multi_threaded'], ['executor', 'auto', 'events', 'single_threaded']),
    (['calibration:=/none.yaml'], ['/none.yaml', 'No such file or directory']),
    (['rotor_jiont:=m1'], ['unknown parameter `rotor_jiont`; did you mean `rotor_joint`?']),
    (['rotor_joints:=m1'], ['unknown parameter `rotor_joints`; did you mean `rotor_joint`?']),
    (['ring_tooth:=90', 'nothing_like_it:=1'], ['`ring_tooth`', '`nothing_like_it`']),
    (['branches:=[a]', 'b.cam_phase:=1.0'], ['`b.cam_phase`', '`b` is not in `branches`']),
    *(
        ([f'{name}:={depth}'], [name, '0', '2147483647'])
        for name in (
            'qos_overrides./rotor_state.subscription.depth',
            'qos_overrides./output_state.publisher.depth',
        )
        for depth in (2**40, -1)
    ),
]


@pytest.mark.parametrize(('values', 'words'), BAD_STARTS, ids=lambda x: x[0])
def test_unusable_parameter_is_refused_at_the_start(tmp_path, values, words):
    options = [part for value in values for part in ('-p', value)]
    [line] = refusal(tmp_path, '--ros-args', *options)
    assert line.startswith('gear_state_publisher: ')
    assert all(word in line for word in words), line


def test_unknown_parameter_of_a_file_is_refused_at_the_start(tmp_path):
    config = tmp_path / 'my.yaml'
    config.write_text('/**:\n  ros__parameters:\n    rotor_jiont: m1\n')
    [line] = refusal(tmp_path, '--ros-args', '--params-file', str(config))
    assert line.startswith(
        'gear_state_publisher: unknown parameter `rotor_jiont`; did you mean `rotor_joint`?; '
        'there are: ring_teeth, '
    )


EMPTY = {
    'nothing': '',
    'a comment': '# ring_teeth: 90\n',
    'no nodes': '{}\n',
    'no parameters': '/**: {}\n',
}


@pytest.mark.parametrize('text', EMPTY.values(), ids=EMPTY)
def test_empty_file_is_refused_at_the_start(tmp_path, text):
    used, empty = tmp_path / 'used.yaml', tmp_path / 'empty.yaml'
    used.write_text('/**:\n  ros__parameters: {}\n')
    empty.write_text(text)
    [line] = refusal(
        tmp_path, '--ros-args', '--params-file', str(used), '--params-file', str(empty)
    )
    assert line == f'gear_state_publisher: {empty}: no ros__parameters in it'


@pytest.mark.parametrize(
    ('arguments', 'node'),
    [
        ([], '/gear_state_publisher'),
        (['-r', '__ns:=/left'], '/left/gear_state_publisher'),
        (['-r', '__node:=gear'], '/gear'),
    ],
    ids=['as it is', 'namespace', 'renamed'],
)
def test_files_of_other_nodes_only_are_refused_at_the_start(tmp_path, arguments, node):
    files = [tmp_path / 'left.yaml', tmp_path / 'other.yaml']
    for file, name in zip(files, ('left/gear_state', 'other'), strict=True):
        file.write_text(f'/{name}:\n  ros__parameters: {{ring_teeth: 90}}\n')
    options = [part for file in files for part in ('--params-file', str(file))]
    [line] = refusal(tmp_path, '--ros-args', *options, *arguments)
    hint = '; did you mean `/left/gear_state`?' if node.startswith('/left') else ''
    assert line == (
        f'gear_state_publisher: {files[0]}: no parameters of {node} in it, only of '
        f'/left/gear_state{hint}; {files[1]}: no parameters of {node} in it, only of /other'
    )


def test_file_of_other_nodes_is_passed_over_beside_one_of_this_node(start, tmp_path):
    options = []
    for name in ('other', 'named/gear_state_publisher'):
        file = tmp_path / f'{name.partition("/")[0]}.yaml'
        file.write_text(f'/{name}:\n  ros__parameters: {{ring_teeth: 90}}\n')
        options += ['--params-file', str(file)]
    peer = start(*options, namespace='/named', connect=False).peer
    peer.connect(probes=False)
    assert peer.get('ring_teeth') == [90]


@pytest.mark.parametrize(
    ('arguments', 'words'),
    [
        (['--params-file', 'nowhere.yaml'], ['nowhere.yaml']),
        (['--params-file', 'torn.yaml'], ['torn.yaml']),
        (['-r', 'rotor_state:='], ['rotor_state:=']),
        (['-r', 'a:=b:=c'], ['a:=b:=c']),
        (['-r', '__ns:=bad//ns'], ['bad//ns']),
        (['--no-such-option'], ['--no-such-option', 'argument']),
    ],
    ids=lambda x: x[0] if isinstance(x, list) else '',
)
def test_unusable_argument_is_refused_at_the_start(tmp_path, monkeypatch, arguments, words):
    (tmp_path / 'torn.yaml').write_text('/**:\n  ros__parameters:\n    ring_teeth: [80\n')
    monkeypatch.chdir(tmp_path)
    lines = refusal(tmp_path, '--ros-args', *arguments)
    # rcl may have logged before it raised.
    [line] = [line for line in lines if not line.startswith('[')]
    assert line.startswith('gear_state_publisher: ')
    assert all(word in line for word in words), line


@pytest.mark.parametrize(
    'text',
    [
        'qos_overrides:\n      /rotor_state: {subscription: {reliability: reliable}}',
        'use_sim_time: false',
        'start_type_description_service: false',
        'eccentricity: 15e-4',
    ],
)
def test_file_that_gearkin_must_take_too_is_taken(start, tmp_path, text):
    # test_parameters.py expects the same of the file's other reader.
    config = tmp_path / 'actuator.yaml'
    config.write_text(f'/**:\n  ros__parameters:\n    {text}\n')
    peer = start('--params-file', str(config), connect=False).peer
    peer.connect(probes=False)
    expected = 0.0015 if 'eccentricity' in text else 0.0011
    assert peer.get('eccentricity') == [expected]


def test_node_imports_nothing_heavy():
    code = 'import sys, gear_kinematics.ros.process; print(*sorted(sys.modules))'
    done = subprocess.run(
        [sys.executable, '-c', code], check=True, capture_output=True, text=True, timeout=30.0
    )
    imported = {name.partition('.')[0] for name in done.stdout.split()}
    assert {'gear_kinematics', 'rclpy'} <= imported
    assert not imported & {'rosbags', 'matplotlib', 'plotly', 'rich', 'scipy', 'pandas', 'mpmath'}
