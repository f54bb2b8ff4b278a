# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The node as a process of its own, with a driver, listeners and clients over DDS."""

import os
import signal
import sys
import time
from collections import deque
from contextlib import ExitStack

import oracle
import pytest
import yaml
from blocked_bags import finished
from expected_outputs import Settings, assert_outputs
from live import DEADLINE, PATIENT, SECOND, START, live_node, parameter, rotor_state, stamp_of
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import JointState

pytestmark = pytest.mark.live

OK, WARN, ERROR = 0, 1, 2
BEST_EFFORT = QoSProfile(depth=10, reliability=ReliabilityPolicy.BEST_EFFORT)


@pytest.fixture(scope='module')
def shared(tmp_path_factory):
    """Return a node and its peer for the tests that leave both as they were."""
    # Its tests send angles in any order, a millisecond apart.
    limits = {'max_rotor_speed': 1e6, 'max_rotor_acceleration': 1e9}
    arguments = (word for limit in limits.items() for word in parameter(*limit))
    with live_node(tmp_path_factory.mktemp('shared'), *PATIENT, *arguments) as live:
        live.peer.connect()
        yield live


@pytest.fixture
def start(tmp_path):
    """Return a function that starts a node and its peer; all are stopped at the end."""
    with ExitStack() as stack:

        def start(*arguments, connect=True, **options):
            live = stack.enter_context(live_node(tmp_path, *arguments, **options))
            if connect:
                live.peer.connect()
            return live

        yield start


# Names and types.


def test_topics_services_and_types_are_those_of_the_contract(shared):
    node, namespace = shared.peer.node, shared.peer.namespace
    name = 'gear_state_publisher', namespace
    joint_state = ['sensor_msgs/msg/JointState']
    published = {
        f'{namespace}/output_state': joint_state,
        f'{namespace}/body_poses': ['geometry_msgs/msg/PoseArray'],
        f'{namespace}/mechanism_joint_states': joint_state,
        f'{namespace}/robot_description': ['std_msgs/msg/String'],
        f'{namespace}/markers': ['visualization_msgs/msg/MarkerArray'],
        f'{namespace}/corrected_state': joint_state,
        f'{namespace}/corrected_interval': joint_state,
        f'{namespace}/transmission_error': joint_state,
        f'{namespace}/branch_loads': joint_state,
        f'{namespace}/joint_loads': ['sensor_msgs/msg/MultiDOFJointState'],
        f'{namespace}/referenced': ['std_msgs/msg/Bool'],
        '/diagnostics': ['diagnostic_msgs/msg/DiagnosticArray'],
    }
    subscribed = {
        f'{namespace}/{topic}': joint_state for topic in ('rotor_state', 'output_encoder')
    }
    served = {f'{namespace}/gear_state_publisher/home': ['std_srvs/srv/Trigger']}
    # The name and the endpoints of a node are discovered one by one.
    shared.peer.wait_until(lambda: name in node.get_node_names_and_namespaces(), 'the name')
    for found, expected in (
        (node.get_publisher_names_and_types_by_node, published),
        (node.get_subscriber_names_and_types_by_node, subscribed),
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
    for topic in published.keys() - {'/diagnostics'}:
        [qos] = shared.peer.endpoints(node.get_publishers_info_by_topic, topic)
        assert qos.reliability == ReliabilityPolicy.RELIABLE
        latched = topic.endswith(('/robot_description', '/markers', '/referenced'))
        assert (qos.durability == DurabilityPolicy.TRANSIENT_LOCAL) == latched


def test_node_of_another_mechanism_with_other_names(start, tmp_path):
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
        'rotor_joint': 'm7',
        'rotor_direction': -1,
        'output_joint': 'shoulder',
        'frame_prefix': 'arm_',
    }
    config.write_text(yaml.safe_dump({'/**': {'ros__parameters': values}}))
    names = {'rotor_state': 'motor/joint_states', 'output_state': 'joint_states',
             'body_poses': 'bodies', 'mechanism_joint_states': 'all_joints',
             'diagnostics': '/health'}  # fmt: skip
    remappings = [
        part
        for old, new in names.items()
        for part in ('-r', f'{"/" if old == "diagnostics" else ""}{old}:={new}')
    ]
    live = start(*PATIENT, '--params-file', str(config), *remappings, connect=False, **names)
    live.peer.connect(joint='m7')
    output = live.peer.answer(rotor_state(START, ['m7'], [7.5]))
    numbers = oracle.Numbers(61, 58, 0.002, tuple(branches.values()))
    settings = Settings(-1, 0.0, 'shoulder', 'arm_')
    assert_outputs(output, 7.5, settings, numbers=numbers, branch_names=tuple(branches))
    assert live.peer.status()[0] == OK
    line = live.lines('INFO')[0]
    assert 'gear ratio -58/3' in line.text
    assert f"listening on {live.peer.namespace}/motor/joint_states for joint 'm7', " in line.text


# One output for each valid input.


def test_every_valid_input_has_one_output_with_its_stamp(shared):
    peer = shared.peer
    positions = [0.0, 0.1, -0.1, 1e3, -321.987, 628.0, *(0.37 * n for n in range(294))]
    stamps = [peer.stamp() + n for n in range(300)]
    peer.send(*(rotor_state(s, position=[p]) for s, p in zip(stamps, positions, strict=True)))
    outputs = peer.outputs(300)
    for messages in zip(*outputs, strict=True):
        assert [stamp_of(message) for message in messages] == stamps
    for number in (*range(8), 151, 299):
        assert_outputs(outputs[number], positions[number])


def test_rejected_input_has_no_output_and_is_a_warning_in_the_next_report(shared):
    """`test/state/test_faults.py` has all causes."""
    peer, began = shared.peer, time.time_ns()
    bad, good = rotor_state(START), rotor_state(peer.stamp(), position=[1.5])
    assert_outputs(peer.answer(bad, good), 1.5)
    level, text, values = peer.status(lambda s: s.level == b'\1', 'a warning', since=began)
    assert (level, text) == (WARN, 'rejected: position missing 1')
    assert values['rejected: position missing'] == '1'
    assert peer.status(lambda s: s.level != b'\1', 'the report after it')[:2] == (OK, 'ok')
    [warning] = [line.text for line in shared.lines('WARN') if 'rejected' in line.text]
    assert warning == 'rotor_state rejected: position missing'


# Diagnostics.


def test_diagnostics_are_published_once_a_second(shared):
    peer = shared.peer
    before = peer.node.get_clock().now().nanoseconds
    message, status = peer.report()
    assert status.name == f'{peer.namespace[1:]}/gear_state_publisher: rotor input'
    assert [s.name for s in message.status] == [status.name]  # nothing of an absent encoder
    # On a busy machine one comes late now and then.
    stamps = deque([stamp_of(message)], maxlen=3)

    def steady():
        stamps.append(stamp_of(peer.report()[0]))
        third = len(stamps) == 3  # the second can have been lost
        return third and stamps[-1] - stamps[0] == pytest.approx(2 * SECOND, rel=0.25)

    peer.wait_until(steady, 'three reports in two seconds')
    assert stamps[0] < stamps[1] < stamps[2]
    assert before < stamps[2] < peer.node.get_clock().now().nanoseconds


# Quality of service.


def test_quality_can_be_overridden_and_what_does_not_match_is_reported(start):
    namespace = f'/quality_{os.getpid()}'
    outputs = [
        f'{namespace}/{name}'
        for name in ('output_state', 'body_poses', 'mechanism_joint_states', 'robot_description')
    ] + ['/diagnostics']
    overrides = {f'{namespace}/rotor_state.subscription.reliability': 'reliable'}
    for topic in outputs:
        reliability = 'reliable' if topic == '/diagnostics' else 'best_effort'
        overrides |= {f'{topic}.publisher.reliability': reliability, f'{topic}.publisher.depth': 7}
    arguments = [
        part
        for name, value in overrides.items()
        for part in parameter(f'qos_overrides.{name}', value)
    ]
    live = start(*PATIENT, *arguments, namespace=namespace, connect=False)
    peer = live.peer
    peer.connect(probes=False)
    for topic in outputs:
        [qos] = peer.endpoints(peer.node.get_publishers_info_by_topic, topic)
        best_effort = topic != '/diagnostics'
        assert (qos.reliability == ReliabilityPolicy.BEST_EFFORT) == best_effort
        assert peer.get(f'qos_overrides.{topic}.publisher.depth') == [7]
    # The peer subscribes to three of them as reliable.
    faults = [
        f'incompatible QoS on {topic}: RELIABILITY (listener {namespace}/peer)'
        for topic in ('output_state', 'body_poses', 'mechanism_joint_states')
    ]
    message = '; '.join(faults)
    level, _, _ = peer.status(lambda s: s.message == message, 'a warning of three topics')
    assert level == WARN
    fault = f'incompatible QoS on rotor_state: RELIABILITY (driver {namespace}/peer)'
    driver = peer.node.create_publisher(JointState, 'rotor_state', BEST_EFFORT)
    level, _, _ = peer.status(lambda s: fault in s.message, 'an error')
    assert level == ERROR
    peer.node.destroy_publisher(driver)
    level, _, _ = peer.status(lambda s: s.message == message, 'its end')
    assert level == WARN
    assert [line.text for line in live.lines('WARN')].count(fault) == 1


def test_best_effort_driver_is_heard_and_so_is_a_reliable_one_beside_it(start):
    peer = start(*PATIENT, connect=False).peer
    driver = peer.node.create_publisher(JointState, 'rotor_state', BEST_EFFORT)

    def outputs():
        driver.publish(rotor_state(peer.stamp(), position=[1.5]))
        output = [messages[-1] for messages in list(peer.received.values())[:3] if messages]
        return output if len(output) == 3 else None

    assert_outputs(peer.wait_until(outputs, 'outputs'), 1.5)
    peer.connect()
    said = 'losses unknown'  # as the other has sent only what the last one sent before it
    assert peer.status(lambda s: s.message == said, said)[0] == OK

    def both():
        peer.send(rotor_state(peer.stamp(), position=[1.5]))
        outputs()

    said = 'several drivers send this joint; losses unknown'
    assert peer.status(lambda s: s.message == said, said, both)[0] == WARN


# The end, and starts that fail.


@pytest.mark.parametrize(
    ('number', 'executor'), [(signal.SIGINT, 'events'), (signal.SIGTERM, 'single_threaded')]
)
def test_signal_ends_the_node_cleanly(start, number, executor):
    live = start(*PATIENT, *parameter('executor', executor))
    live.peer.answer(rotor_state(START, position=[1.0]))
    before = live.text()
    live.process.send_signal(number)
    assert live.process.wait(DEADLINE) == 0
    assert live.text() == before


@pytest.mark.parametrize(
    ('arguments', 'words'),
    [
        (
            ['--params-file', 'others.yaml', '-r', '__ns:=/left'],
            ['others.yaml: no parameters of /left/gear_state_publisher in it',
             'only of /left/gear_state; did you mean `/left/gear_state`?'],
        ),
        (['--no-such-option'], ['unknown arguments', '--no-such-option']),
    ],
    ids=['parameters of another node', 'unknown option'],
)  # fmt: skip
def test_unusable_arguments_end_the_start_with_2_and_one_line(tmp_path, arguments, words):
    file = '/left/gear_state:\n  ros__parameters: {ring_teeth: 90}\n'
    (tmp_path / 'others.yaml').write_text(file)
    command = [sys.executable, '-m', 'gear_kinematics.ros', '--ros-args', *arguments]
    done = finished(command, cwd=tmp_path, env={**os.environ, 'ROS_LOG_DIR': str(tmp_path)})
    assert (done.returncode, done.stdout) == (2, ''), done.stderr
    assert 'Traceback' not in done.stderr
    # rcl may have logged before it raised.
    [line] = [line for line in done.stderr.splitlines() if not line.startswith('[')]
    assert line.startswith('gear_state_publisher: ')
    assert all(word in line for word in words), line


def test_node_imports_nothing_heavy():
    modules = 'gear_kinematics.ros.node, gear_kinematics.ros.process'
    code = f'import sys, {modules}; print(*sorted(sys.modules))'
    done = finished([sys.executable, '-c', code])
    imported = {name.partition('.')[0] for name in done.stdout.split()}
    assert {'gear_kinematics', 'rclpy'} <= imported
    assert not imported & {'rosbags', 'matplotlib', 'plotly', 'rich', 'scipy', 'pandas', 'mpmath'}
