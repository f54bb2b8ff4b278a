# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The node within the process of the test: parameters, and callbacks without DDS."""

import math
import sys
import time
import xml.etree.ElementTree as ET
from dataclasses import replace
from fractions import Fraction
from random import Random
from types import SimpleNamespace

import pytest
import yaml
from blocked_bags import wait_until
from calibrations import AMPLITUDE, single_order
from diagnostic_msgs.msg import DiagnosticArray
from expected_outputs import Settings, assert_outputs
from geometry_msgs.msg import PoseArray
from live import DEADLINE, SECOND, STATES, rotor_bytes
from rclpy.exceptions import ParameterException
from rclpy.impl.implementation_singleton import rclpy_implementation
from rclpy.parameter import Parameter
from rclpy.publisher import Publisher
from rclpy.qos import QoSProfile
from rclpy.serialization import deserialize_message
from rclpy.subscription import Subscription
from sensor_msgs.msg import JointState
from std_msgs.msg import Bool, String
from std_srvs.srv import Trigger
from visualization_msgs.msg import MarkerArray

from gear_kinematics.correction.calibration_file import Calibration
from gear_kinematics.parameters import ConfigError, NodeParameters, default_config
from gear_kinematics.ros.drivers import DEPTH
from gear_kinematics.ros.node import GearStatePublisher
from gear_kinematics.ros.workarounds.executor import make_executor
from gear_kinematics.state.output_encoder import OutputEncoder
from gear_kinematics.state.statuses import Condition
from gear_kinematics.wire.topics import DIAGNOSTICS

pytestmark = pytest.mark.live

TYPES = dict(zip(STATES, (JointState, PoseArray, JointState), strict=True))
READ_ONLY = {
    'actuators',
    'ring_teeth', 'satellite_teeth', 'eccentricity', 'module', 'branches', 'gear_ratio',
    'a.cam_phase', 'a.axial_position', 'b.cam_phase', 'b.axial_position', 'markers_rate',
    'meshes', 'executor', 'home_file', 'preload', 'branch_stiffness', 'shaft_stiffness',
    'loads.satellite_mass', 'loads.satellite_inertia', 'loads.coupling_mass',
    'loads.coupling_inertia', 'loads.rotor_inertia', 'loads.pressure_angle',
    'output_range',
}  # fmt: skip


@pytest.fixture(scope='module')
def node(context):
    """Return a node for tests that leave it as it was."""
    node = GearStatePublisher(context=context, namespace='in_process')
    yield node
    node.destroy_node()


def test_declared_parameters_are_those_of_the_shipped_file(node):
    shipped = yaml.safe_load(default_config().read_text())['/**']['ros__parameters']
    for group in (*shipped['branches'], 'loads'):
        shipped |= {f'{group}.{name}': value for name, value in shipped.pop(group).items()}
    of_ros = 'qos_overrides', 'use_sim_time', 'start_type_description'
    own = {
        name: parameter.value
        for name, parameter in node.get_parameters_by_prefix('').items()
        if not name.startswith(of_ros)
    }
    assert own == shipped
    descriptors = {name: node.describe_parameter(name) for name in own}
    assert all(d.description for d in descriptors.values())
    assert {name for name, d in descriptors.items() if d.dynamic_typing} == {
        'actuators',
        'output_range',
    }
    assert {name for name, d in descriptors.items() if d.read_only} == READ_ONLY


def test_bounds_and_choices_are_published(node):
    for name, expected in (('ring_teeth', (2, 100_000, 0)), ('rotor_direction', (-1, 1, 2))):
        [bounds] = node.describe_parameter(name).integer_range
        assert (bounds.from_value, bounds.to_value, bounds.step) == expected
    for name, expected in (('eccentricity', (1e-6, 1.0)), ('b.axial_position', (-10.0, 10.0))):
        [bounds] = node.describe_parameter(name).floating_point_range
        assert (bounds.from_value, bounds.to_value) == expected
    constraints = node.describe_parameter('rotor_encoder').additional_constraints
    assert constraints == 'multi_turn, single_turn'


QOS_DEPTH = 'qos_overrides./rotor_state.subscription.depth'


@pytest.mark.parametrize(('values', 'words'), [
    ({'max_rotor_speed': 126}, ['max_rotor_speed must be of type float, not 126; write 126.0']),
    ({'gear_ratio': '19', 'output_joint': ''}, ['output_joint', "''"]),
    ({'calibration': '/none.yaml'}, ['/none.yaml', 'No such file or directory']),
    ({'ring_tooth': 90, 'nothing_like_it': 1}, ['`ring_tooth`', '`nothing_like_it`']),
    ({QOS_DEPTH: 2**40}, [QOS_DEPTH, '0', '2147483647']),
], ids=str)  # fmt: skip
def test_unusable_parameters_are_refused_at_the_start(make, values, words):
    with pytest.raises((ParameterException, ValueError)) as caught:
        make(**values)
    assert all(word in str(caught.value) for word in words), str(caught.value)


@pytest.mark.parametrize(('name', 'value', 'words'), [
    ('rotor_direction', 0, ['-1', '1']), ('rotor_zero', math.nan, ['1000000000000000']),
    ('rotor_encoder', 'absolute', ['multi_turn', 'single_turn']),
    ('max_rotor_speed', 'fast', ['DOUBLE']), ('output_joint', 'satellite_a', ["'satellite_a'"]),
    ('calibration', '/none.yaml', ['No such file or directory']),
    ('ring_teeth', 81, ['read-only']),
])  # fmt: skip
def test_refusal_of_a_change_names_the_parameter_once_and_its_cause(node, name, value, words):
    before = node.get_parameter(name).value
    result = node.set_parameters_atomically([Parameter(name, value=value)])
    assert not result.successful
    assert result.reason.count(name) == 1
    assert all(word in result.reason for word in words), result.reason
    assert node.get_parameter(name).value == before


CHOICES = {
    'rotor_direction': (1, -1),
    'rotor_zero': (0.0, 1.25, -0.5),
    'output_joint': ('output_shaft', 'shoulder'),
    'frame_prefix': ('', 'left_'),
}
REFUSED = (
    ('rotor_direction', 0),
    ('rotor_zero', 'far'),
    ('output_joint', 'satellite_a'),
    ('rotor_encoder', 'absolute'),
    ('ring_teeth', 81),
)


def test_parameters_set_together_take_effect_with_the_next_message_or_not_at_all(
    make, monkeypatch
):
    node, published, settings = make('changed'), [], Settings()
    monkeypatch.setattr(node, 'send', published.extend)
    node._actuators[''].state.choose(STATES)
    random = Random(6)  # noqa: S311, no secret
    seen = set()
    for turn in range(150):
        chosen = random.sample(list(CHOICES), random.randint(1, len(CHOICES)))
        changes = {name: random.choice(CHOICES[name]) for name in chosen}
        values = list(changes.items())
        if bad := random.random() < 0.4:
            values.insert(random.randint(0, len(values)), random.choice(REFUSED))
        result = node.set_parameters_atomically([Parameter(n, value=value) for n, value in values])
        assert result.successful == (not bad), result.reason
        settings = settings if bad else settings._replace(**changes)
        seen.add(settings)
        published.clear()  # of robot_description
        position = 0.03 * turn
        node._on_rotor_state(rotor_bytes(1 + turn, position=[position]))
        outputs = [
            deserialize_message(data, TYPES[topic]) for topic, data in published if topic in TYPES
        ]
        assert_outputs(outputs, position, settings)
    assert len(seen) > 12  # of the 24 that there are


def sections(*blocks: tuple[str, str]) -> str:
    """Write a parameter file of blocks of one line."""
    return ''.join(f"'{name}':\n  ros__parameters: {{{values}}}\n" for name, values in blocks)


LEFT, RIGHT = (f'/{side}/gear_state_publisher' for side in ('left', 'right'))
ROOT = '/gear_state_publisher'
TEETH = 'ring_teeth: 81'
OF_ANY_NODE = (
    f'{TEETH}, use_sim_time: false, start_type_description_service: false, '
    'qos_overrides: {/rotor_state: {subscription: {reliability: reliable}}}, '
    'qos_overrides./output_state.publisher.depth: 5'
)


@pytest.mark.parametrize(
    ('text', 'name', 'expected'),
    [
        (sections((LEFT, TEETH), (RIGHT, 'ring_teeth: 82')), RIGHT, (82, 0.0)),
        (sections((LEFT, TEETH), (RIGHT, 'ring_teeth: 82')), ROOT, None),
        (sections(('gear_state_publisher', TEETH)), LEFT, None),
        (sections(('*', TEETH)), LEFT, None),
        (sections(('**', TEETH)), '/robot/left/gear', (81, 0.0)),
        (sections(('/*/gear_state_publisher', TEETH)), LEFT, (81, 0.0)),
        (sections(('/**/gear_state_publisher', TEETH)), ROOT, (81, 0.0)),
        (sections(('/left/*', TEETH)), '/left/of/gear', None),
        # The block that begins later prevails, even if it is the more general one.
        (sections(('/**', 'ring_teeth: 80'), (LEFT, TEETH)), LEFT, (81, 0.0)),
        (sections((LEFT, TEETH), ('/**', 'rotor_zero: 2.0')), LEFT, (81, 2.0)),
        (
            sections(*((n, f'rotor_zero: {k}.0') for k, n in enumerate(['/**', LEFT, '/**']))),
            LEFT,
            (80, 1.0),
        ),
        (sections(('/**', TEETH), ('/**', 'rotor_zero: 15e-1')), LEFT, (81, 1.5)),
        (sections((LEFT, f'{TEETH}, output_joint: !!str 12')), LEFT, (81, 0.0)),
        (sections((LEFT, OF_ANY_NODE)), LEFT, (81, 0.0)),
    ],
)
def test_gearkin_reads_of_a_parameter_file_what_the_node_does(
    context, tmp_path, text, name, expected
):
    """Where nothing is for the node, rclpy passes over the file, and gearkin refuses it."""
    path = tmp_path / 'robot.yaml'
    path.write_text(text)
    namespace, _, last = name.rpartition('/')
    arguments = ['--ros-args', '-r', f'__node:={last}', '--params-file', str(path)]
    node = GearStatePublisher(
        context=context, namespace=namespace, cli_args=arguments, use_global_arguments=False
    )
    assert node.get_fully_qualified_name() == name
    taken = tuple(node.get_parameter(name).value for name in ('ring_teeth', 'rotor_zero'))
    node.destroy_node()
    assert taken == (expected or (80, 0.0))
    if expected:
        loaded = NodeParameters.load(path, name)
        assert (loaded.ring_teeth, loaded.rotor_zero) == expected
    else:
        with pytest.raises(ConfigError, match=f'no parameters of {name} in it, only of'):
            NodeParameters.load(path, name)


@pytest.mark.parametrize('name', ['left//gear', '/left.gear', '/'])
def test_name_of_no_node_is_refused_by_both_readers_of_a_file(context, tmp_path, name):
    path = tmp_path / 'robot.yaml'
    path.write_text(sections((name, 'ring_teeth: 81'), ('/**', 'ring_teeth: 81')))
    arguments = ['--ros-args', '--params-file', str(path)]
    with pytest.raises(rclpy_implementation.RCLInvalidROSArgsError):
        GearStatePublisher(context=context, cli_args=arguments)
    with pytest.raises(ConfigError, match='is not a valid node name'):
        NodeParameters.load(path)


@pytest.mark.parametrize('direct', [True, False], ids=['publish_raw', 'publish'])
def test_message_that_the_middleware_refuses_is_counted_and_the_others_go_on(
    make, monkeypatch, direct
):
    published = {}

    def publish(topic, message):
        # As it does for history keep_all, when a listener is stuck and everything is full.
        if topic == '/refused/output_state':
            raise rclpy_implementation.RCLError('full')
        published[topic] = message

    monkeypatch.setattr(Publisher, 'publish', lambda self, data: publish(self.topic_name, data))
    handle = rclpy_implementation.Publisher
    if direct:
        monkeypatch.setattr(
            handle, 'publish_raw', lambda self, data: publish(self.get_topic_name(), data)
        )
    else:  # as in a release of rclpy without it
        monkeypatch.delattr(handle, 'publish_raw')
    monkeypatch.setattr(Publisher, 'get_subscription_count', lambda _: 1)
    node = make('refused')
    node._on_rotor_state(rotor_bytes(1, position=[1.0]))
    assert {'/refused/body_poses', '/refused/mechanism_joint_states'} <= set(published)
    node._report()
    [status] = deserialize_message(published['/diagnostics'], DiagnosticArray).status
    assert 'not sent 1' in status.message


def test_status_is_named_after_the_node_and_found_by_the_aggregator(node, monkeypatch):
    published = []
    monkeypatch.setattr(node, 'send', published.extend)
    node._on_output_encoder(rotor_bytes(1, position=[1.0]))
    node._report()
    [(_, data)] = published
    names = [status.name for status in deserialize_message(data, DiagnosticArray).status]
    own = 'in_process/gear_state_publisher'
    assert names == [f'{own}: rotor input', f'{own}: transmission error']
    file = yaml.safe_load(default_config().with_name('diagnostic_analyzers.yaml').read_text())
    analyzer = file['analyzers']['ros__parameters']['gears']
    assert analyzer['type'] == 'diagnostic_aggregator/GenericAnalyzer'
    assert all(part in name for part in analyzer['contains'] for name in names)


def test_rejected_input_is_warned_about_once_a_second_for_each_cause(make, monkeypatch, capfd):
    node, now = make('warned'), 1000.0
    monkeypatch.setattr(time, 'monotonic', lambda: now)
    warnings = []
    for _ in range(30):
        now += 0.1
        node._on_rotor_state(b'')
        node._on_rotor_state(rotor_bytes(1, ['rotor'], []))
        node._on_output_encoder(rotor_bytes(1, ['a', 'b'], [1.0, 2.0]))
        said = capfd.readouterr().err
        missing = 'joint missing: more than one joint in it; there are: a, b'
        rejections = (
            'rotor_state rejected: not a JointState',
            'rotor_state rejected: position missing',
            f'output_encoder rejected: {missing}; set output_encoder_joint',
        )
        warnings.append([said.count(each) for each in rejections])
    assert [sum(each) for each in zip(*warnings, strict=True)] == [3, 3, 3]
    assert warnings[0] == warnings[10] == warnings[20] == [1, 1, 1]


@pytest.mark.parametrize('kind', ['events', 'single_threaded'])
def test_inputs_that_overflow_the_queue_of_a_blocked_node_are_lost(make, context, kind):
    node = make(f'blocked_{kind}')
    driver = node.create_publisher(JointState, 'rotor_state', QoSProfile(depth=10))
    executor = make_executor(kind, context)
    executor.add_node(node)

    def send(count):
        for _ in range(count):
            driver.publish(rotor_bytes(1, position=[1.0]))

    def receive(number):
        deadline = time.monotonic() + DEADLINE
        while node._actuators[''].state.input.received < number and time.monotonic() < deadline:
            executor.spin_once(timeout_sec=0.1)
        node._rotor_driver.count_losses()
        return node._actuators[''].state.input.received, node._connections.rotor.lost

    wait_until(driver.get_subscription_count, 'the subscription')
    send(3)
    assert receive(3) == (3, 0)
    send(DEPTH + 500)  # while nothing is received
    send(1)  # numbers stay contiguous
    assert receive(3 + DEPTH) == (3 + DEPTH, 501)
    executor.shutdown()


def test_losses_are_counted_by_the_numbers_of_one_driver(make, monkeypatch):
    node, drivers = make('lossy'), 1
    monkeypatch.setattr(Subscription, 'get_publisher_count', lambda _: drivers)

    def lost(*numbers):
        for number in numbers:
            about = number and {'publication_sequence_number': number}
            node._rotor_driver._take(rotor_bytes(1, position=[1.0]), about)
        node._rotor_driver.count_losses()
        return node._connections.rotor.lost, node._connections.rotor.losses_known

    assert lost() == (0, True)
    assert lost(7, 8, 10) == (1, True)  # 1 to 6 were sent before the two were connected
    assert lost(11, 15) == (4, True)
    drivers = 0
    for _ in range(2):
        assert lost() == (4, True)
    drivers = 1
    assert lost(300, 301) == (4, False)  # of another driver
    assert lost(1, 3) == (5, True)
    drivers = 2
    assert lost(302, 4, 303, 5) == (5, False)
    drivers = 1
    assert lost(304, 6) == (5, False)  # the other may have ended just now
    assert lost(8, 9) == (5, True)
    assert lost(11, None) == (6, False)  # other middlewares do not number the messages


def test_only_the_joint_that_two_drivers_send_has_several_drivers(make, monkeypatch, capfd):
    """One driver sends both joints, one the elbow alone, and one a joint of no actuator."""
    node = make('mixed', actuators=['shoulder', 'elbow'])
    monkeypatch.setattr(Subscription, 'get_publisher_count', lambda _: 3)
    for each in node._drivers:
        each.count_losses()
    stamp = 0
    for number in range(1, 9):
        for joints, ahead in ((['shoulder', 'elbow'], 0), (['elbow'], 100), (['wheel'], 200)):
            stamp += SECOND // 1000
            data = rotor_bytes(stamp, joints, [1.0] * len(joints))
            for each in node._drivers:
                each._take(data, {'publication_sequence_number': number + ahead})
    reports = node._arm.report(time.monotonic() + 1.0, node._connections)
    mixed = Condition.SEVERAL_DRIVERS()
    assert [name for name, report in reports.items() if mixed in report.facts] == [
        'elbow: rotor input',
        'elbow: transmission error',
    ]
    node._report()
    assert f'elbow, elbow: output_encoder: {mixed}. Stop all but one' in capfd.readouterr().err


def test_unexpected_error_in_a_change_refuses_it_and_is_logged(node, monkeypatch, capfd):
    monkeypatch.setattr(Calibration, 'load', lambda *_: 1 / 0)
    result = node.set_parameters_atomically([Parameter('calibration', value='a.yaml')])
    assert result.reason == 'calibration: unexpected ZeroDivisionError: division by zero'
    assert 'Traceback' in capfd.readouterr().err
    assert node.get_parameter('calibration').value == ''


def test_home_that_is_refused_changes_nothing(make):
    node = make('refused_home', rotor_encoder='single_turn', home_angle=1e9, gear_ratio='2000000')
    node._on_rotor_state(rotor_bytes(1, position=[1.0]))
    response = node._homing.answer(None, Trigger.Response())
    assert not response.success
    assert 'rotor_zero' in response.message
    assert not node._actuators[''].state.input.referenced


def test_markers_cost_nothing_without_viewers_and_can_be_switched_off(node, make):
    timer = node._display.markers[''].timer
    [other] = [one for one in node.timers if one is not timer]
    assert timer.is_canceled()
    assert not other.is_canceled()
    topics = {publisher.topic_name for publisher in make('off', markers_rate=0.0).publishers}
    assert '/off/output_state' in topics
    assert '/off/markers' not in topics


def test_description_and_markers_follow_the_prefix_and_are_sent_when_they_change(
    make, monkeypatch
):
    node, published = make('described'), []
    monkeypatch.setattr(node, 'send', published.extend)
    node.set_parameters([Parameter('rotor_zero', value=1.0)])
    assert not published
    node.set_parameters([Parameter('frame_prefix', value='arm_')])
    [(topic, data)] = published
    assert topic == 'robot_description'
    robot = ET.fromstring(deserialize_message(data, String).data)  # noqa: S314, our own
    bodies = 'stator rotor satellite_a satellite_b oldham_a oldham_b output_shaft'
    links = {f'arm_{body}' for body in bodies.split()}
    assert {link.get('name') for link in robot.iter('link')} == links
    node._display.markers[''].publish()
    markers = deserialize_message(published[1][1], MarkerArray).markers
    assert {marker.header.frame_id for marker in markers} == links


def test_of_a_gear_with_only_a_ratio_the_output_alone_is_published(make, monkeypatch, tmp_path):
    calibration = tmp_path / 'calibration.yaml'
    gear = {'gear_ratio': Fraction(1457, 26), 'ring_teeth': None, 'satellite_teeth': None}
    calibration.write_text(replace(single_order(), **gear).text(), 'utf-8')
    node = make('ratio', gear_ratio='1457/26', home_angle=0.5, calibration=str(calibration))
    topics = {publisher.topic_name for publisher in node.publishers}
    assert {'/ratio/output_state', '/ratio/transmission_error', '/diagnostics'} <= topics
    bodies = {'body_poses', 'mechanism_joint_states', 'robot_description', 'markers'}
    assert not {f'/ratio/{name}' for name in bodies} & topics
    published = []
    monkeypatch.setattr(node, 'send', published.extend)
    node._actuators[''].state.choose(['output_state', 'corrected_state'])
    node._on_rotor_state(rotor_bytes(1, position=[1457.0]))
    assert node._homing.answer(None, SimpleNamespace()).success
    node._on_rotor_state(rotor_bytes(2, position=[1457.0]))
    positions = [
        deserialize_message(data, JointState).position[0]
        for topic, data in published
        if topic != 'referenced'
    ]
    error = AMPLITUDE * math.cos(1457.0)
    assert positions[:3] == pytest.approx([26.0, 26.0 + error, 0.5], abs=1e-12)


def test_nothing_is_compared_before_there_is_an_encoder_or_a_reference(make, monkeypatch):
    node, followed = make('compared', rotor_encoder='single_turn'), []
    monkeypatch.setattr(
        OutputEncoder, 'follow', lambda _, sample, __: followed.append(sample) or []
    )
    node._on_rotor_state(rotor_bytes(1, position=[1.0]))
    node._on_output_encoder(rotor_bytes(1, position=[1.0]))
    node._on_rotor_state(rotor_bytes(2, position=[1.0]))
    assert not followed
    assert node._homing.answer(None, SimpleNamespace()).success
    node._on_rotor_state(rotor_bytes(3, position=[1.0]))
    assert [sample.stamp for sample in followed] == [3]


@pytest.mark.parametrize('outputs', ['publish', 'withhold'])
def test_outputs_of_unknown_turns_are_marked_or_withheld(make, monkeypatch, outputs):
    node = make('marked', rotor_encoder='single_turn', unreferenced_outputs=outputs)
    published = []
    monkeypatch.setattr(node, 'send', published.extend)
    node._actuators[''].state.choose(['output_state'])

    def topics_after(stamp, position=1.0):
        published.clear()
        node._on_rotor_state(rotor_bytes(stamp, position=[position]))
        return [
            deserialize_message(data, Bool).data if topic == 'referenced' else topic
            for topic, data in published
        ]

    given = ['output_state'] if outputs == 'publish' else []
    assert topics_after(1) == [False, *given]
    assert topics_after(2) == given
    assert node._homing.answer(None, SimpleNamespace()).success
    assert topics_after(3) == [True, DIAGNOSTICS, 'output_state']  # diagnostics come at once
    # In a second it may have turned unseen.
    assert topics_after(SECOND) == [False, DIAGNOSTICS, *given]
    assert node._actuators[''].state.monitor.unreferenced == 3


@pytest.mark.parametrize(('kind', 'available', 'name'), [
    ('auto', True, 'EventsExecutor'), ('single_threaded', True, 'SingleThreadedExecutor'),
    ('auto', False, 'SingleThreadedExecutor'), ('events', False, None),
])  # fmt: skip
def test_executor_is_the_one_asked_for_if_the_release_has_it(
    context, monkeypatch, kind, available, name
):
    if not available:  # None makes the import fail
        monkeypatch.setitem(sys.modules, 'rclpy.experimental.events_executor', None)
    if name is None:
        with pytest.raises(ValueError, match='executor must not be events'):
            make_executor(kind, context)
        return
    executor = make_executor(kind, context)
    assert type(executor).__name__ == name
    executor.shutdown()
