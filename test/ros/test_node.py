"""The node within the test's own process: what needs no middleware between two processes."""

import itertools
import math
import re
import sys
import time
from types import SimpleNamespace

import pytest
from live import rotor_bytes
from rclpy.exceptions import ParameterException
from rclpy.impl.implementation_singleton import rclpy_implementation
from rclpy.parameter import Parameter
from rclpy.publisher import Publisher
from rclpy.serialization import deserialize_message
from rclpy.subscription import Subscription
from sensor_msgs.msg import JointState

from gear_kinematics.kinematics import MechanismError
from gear_kinematics.parameters import ConfigError, NodeParameters
from gear_kinematics.ros.node import GearStatePublisher
from gear_kinematics.ros.process import make_executor
from gear_kinematics.state.output_encoder import OutputEncoder

pytestmark = pytest.mark.live

READ_ONLY = (
    'ring_teeth', 'satellite_teeth', 'eccentricity', 'module', 'branches', 'gear_ratio',
    'a.cam_phase', 'a.axial_position', 'b.cam_phase', 'b.axial_position', 'markers_rate',
    'meshes', 'executor',
)  # fmt: skip
INTEGER_BOUNDS = {
    'ring_teeth': (2, 100_000, 0),
    'satellite_teeth': (1, 99_999, 0),
    'rotor_direction': (-1, 1, 2),
    'output_encoder_direction': (-1, 1, 2),
}
BOUNDS = {
    'eccentricity': (1e-6, 1.0),
    'module': (1e-6, 0.1),
    'rotor_zero': (-1e15, 1e15),
    'home_angle': (-1e9, 1e9),
    'max_rotor_speed': (1e-3, 1e6),
    'max_rotor_acceleration': (1e-3, 1e9),
    'input_timeout': (1e-3, 1e6),
    'markers_rate': (0.0, 1000.0),
    'output_encoder_zero': (-1e15, 1e15),
    'transmission_error_window': (0.1, 60.0),
    'transmission_error_limit': (1e-9, 10.0),
    'transmission_error_max_gap': (1e-6, 10.0),
    'transmission_error_travel': (1e-9, 10.0),
    'a.cam_phase': (-2.0 * math.pi, 2.0 * math.pi),
    'b.axial_position': (-10.0, 10.0),
}


@pytest.fixture(scope='module')
def node(context):
    """Return a node for tests that leave it as it was."""
    node = GearStatePublisher(context=context, namespace='in_process')
    yield node
    node.destroy_node()


def refusal(context, **values) -> str:
    """Give the reason why there is no node with these parameters."""
    overrides = [Parameter(name, value=value) for name, value in values.items()]
    with pytest.raises((ParameterException, ValueError)) as caught:
        GearStatePublisher(context=context, parameter_overrides=overrides)
    return str(caught.value)


def test_every_parameter_has_a_type_and_a_description(node):
    own = [
        name
        for name in node.get_parameters_by_prefix('')
        if not name.startswith(('qos_overrides', 'use_sim_time', 'start_type_description'))
    ]
    assert len(own) == 31
    for name in own:
        descriptor = node.describe_parameter(name)
        assert descriptor.description
        assert not descriptor.dynamic_typing


def test_what_is_settled_at_the_start_is_read_only_and_nothing_else(node):
    found = {
        name
        for name in node.get_parameters_by_prefix('')
        if not name.startswith(('qos_overrides', 'start_type_description'))
        and node.describe_parameter(name).read_only
    }
    assert found == set(READ_ONLY)


@pytest.mark.parametrize('name', INTEGER_BOUNDS)
def test_bounds_of_integers_are_published(node, name):
    [bounds] = node.describe_parameter(name).integer_range
    assert (bounds.from_value, bounds.to_value, bounds.step) == INTEGER_BOUNDS[name]


@pytest.mark.parametrize('name', BOUNDS)
def test_bounds_of_numbers_are_published(node, name):
    [bounds] = node.describe_parameter(name).floating_point_range
    assert (bounds.from_value, bounds.to_value) == BOUNDS[name]


def test_choices_are_published(node):
    constraints = node.describe_parameter('rotor_encoder').additional_constraints
    assert 'multi_turn' in constraints
    assert 'single_turn' in constraints


def test_default_joint_of_the_contract(node):
    assert node.get_parameter('rotor_joint').value == 'rotor'


@pytest.mark.parametrize(
    ('values', 'words'),
    [
        ({'ring_teeth': 100_001}, ['ring_teeth', '100000']),
        ({'satellite_teeth': 0}, ['satellite_teeth', '1']),
        ({'satellite_teeth': 81}, ['satellite_teeth (81)', 'ring_teeth (80)']),
        ({'satellite_teeth': 76.0}, ['satellite_teeth', 'INTEGER']),
        ({'eccentricity': math.inf}, ['eccentricity', '1.0']),
        ({'branches': ['a', '']}, ['branch name', "''"]),
        ({'branches': ['a', 'b', 'a']}, ["'a'"]),
        ({'branches': ['left', 'stator!']}, ["'stator!'"]),
        ({'gear_ratio': '0'}, ['gear_ratio', 'must not be 0']),
        ({'gear_ratio': '19:1'}, ['gear_ratio', 'such as -19, 1457/26', "'19:1'"]),
        ({'gear_ratio': -19}, ['gear_ratio', 'STRING']),
        ({'gear_ratio': '19', 'output_joint': ''}, ['output_joint', "''"]),
        ({'rotor_joint': 1}, ['rotor_joint', 'STRING']),
        ({'rotor_encoder': ''}, ['rotor_encoder', 'multi_turn', 'single_turn']),
        ({'rotor_zero': math.nan}, ['rotor_zero']),
        ({'home_angle': -1.1e9}, ['home_angle', '1000000000']),
        ({'input_timeout': 0.0}, ['input_timeout', '0.001']),
        ({'output_joint': 'oldham_b'}, ['output_joint', 'oldham_b']),
    ],
)
def test_unusable_parameter_makes_no_node(context, values, words):
    reason = refusal(context, **values)
    assert all(word in reason for word in words), reason


def sections(*blocks: tuple[str, str]) -> str:
    """Write a parameter file of blocks of one line."""
    return ''.join(f"'{name}':\n  ros__parameters: {{{values}}}\n" for name, values in blocks)


LEFT, RIGHT = (f'/{side}/gear_state_publisher' for side in ('left', 'right'))
TWO_NODES = sections((LEFT, 'ring_teeth: 81'), (RIGHT, 'ring_teeth: 82'))
NESTED = """
left:
  gear_state_publisher:
    ros__parameters: {ring_teeth: 81}
  other:
    ros__parameters: {ring_teeth: 70}
right:
  gear_state_publisher:
    ros__parameters: {ring_teeth: 82}
"""


@pytest.mark.parametrize(
    ('text', 'name', 'expected'),
    [
        (TWO_NODES, LEFT, (81, 0.0)),
        (TWO_NODES, RIGHT, (82, 0.0)),
        (TWO_NODES, '/gear_state_publisher', None),
        (TWO_NODES, '/left/gear', None),
        (NESTED, LEFT, (81, 0.0)),
        (NESTED, RIGHT, (82, 0.0)),
        (sections(('gear_state_publisher', 'ring_teeth: 81')), LEFT, None),
        (sections(('left/gear_state_publisher', 'ring_teeth: 81')), LEFT, (81, 0.0)),
        (sections(('*', 'ring_teeth: 81')), '/gear_state_publisher', (81, 0.0)),
        (sections(('*', 'ring_teeth: 81')), LEFT, None),
        (sections(('**', 'ring_teeth: 81')), '/robot/left/gear', (81, 0.0)),
        (sections(('/*/gear_state_publisher', 'ring_teeth: 81')), LEFT, (81, 0.0)),
        (
            sections(('/*/gear_state_publisher', 'ring_teeth: 81')),
            '/gear_state_publisher',
            None,
        ),
        (
            sections(('/**/gear_state_publisher', 'ring_teeth: 81')),
            '/gear_state_publisher',
            (81, 0.0),
        ),
        (sections(('/left/**', 'ring_teeth: 81')), LEFT, (81, 0.0)),
        (sections(('/left/**', 'ring_teeth: 81')), RIGHT, None),
        (sections(('/left/*', 'ring_teeth: 81')), '/left/of/gear', None),
        # The later block prevails, be it the more general one, ...
        (sections(('/**', 'ring_teeth: 80'), (LEFT, 'ring_teeth: 81')), LEFT, (81, 0.0)),
        (sections((LEFT, 'ring_teeth: 81'), ('/**', 'ring_teeth: 82')), LEFT, (82, 0.0)),
        (sections((LEFT, 'ring_teeth: 81'), ('/**', 'rotor_zero: 2.0')), LEFT, (81, 2.0)),
        # ... and later is what begins later.
        (
            sections(
                ('/**', 'rotor_zero: 1.0'), (LEFT, 'rotor_zero: 2.0'), ('/**', 'rotor_zero: 3.0')
            ),
            LEFT,
            (80, 2.0),
        ),
        (sections(('/**', 'ring_teeth: 81'), ('/**', 'rotor_zero: 1.0')), LEFT, (81, 1.0)),
        (
            sections(
                ('gear_state_publisher', 'rotor_zero: 1.0'),
                ('/**', 'rotor_zero: 2.0'),
                ('/gear_state_publisher', 'rotor_zero: 3.0'),
            ),
            '/gear_state_publisher',
            (80, 3.0),
        ),
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
    names = ('ring_teeth', 'rotor_zero')
    taken = tuple(node.get_parameter(parameter).value for parameter in names)
    node.destroy_node()
    assert taken == (expected or (80, 0.0))
    if expected:
        assert tuple(NodeParameters.load(path, name)[parameter] for parameter in names) == expected
    else:
        with pytest.raises(ConfigError, match=f'no parameters of {name} in it, only of'):
            NodeParameters.load(path, name)


@pytest.mark.parametrize('name', ['left//gear', '/left*', '/left.gear', '/1st', '/'])
def test_name_of_no_node_is_refused_by_both_readers_of_a_file(context, tmp_path, name):
    path = tmp_path / 'robot.yaml'
    path.write_text(sections((name, 'ring_teeth: 81'), ('/**', 'ring_teeth: 81')))
    arguments = ['--ros-args', '--params-file', str(path)]
    with pytest.raises(rclpy_implementation.RCLInvalidROSArgsError):
        GearStatePublisher(context=context, cli_args=arguments)
    with pytest.raises(ConfigError, match='is not a valid node name'):
        NodeParameters.load(path)


def test_every_fault_of_the_mechanism_is_told(context):
    overrides = [
        Parameter('satellite_teeth', value=80),
        Parameter('branches', value=['a', 'a']),
    ]
    with pytest.raises(MechanismError) as caught:
        GearStatePublisher(context=context, parameter_overrides=overrides)
    assert 'satellite_teeth' in str(caught.value)
    assert 'more than once' in str(caught.value)


def test_parameters_set_together_are_set_together_or_not_at_all(node):
    values = {'rotor_zero': 1.0, 'rotor_direction': 3, 'home_angle': 0.5}
    result = node.set_parameters_atomically(
        [Parameter(name, value=value) for name, value in values.items()]
    )
    assert not result.successful
    assert 'rotor_direction' in result.reason
    assert [node.get_parameter(name).value for name in values] == [0.0, 1, 0.0]


@pytest.mark.parametrize(
    ('name', 'value'),
    [('rotor_direction', 3), ('rotor_direction', 1.0), ('rotor_zero', math.nan), ('ring_teeth', 9),
     ('rotor_encoder', 'x'), ('max_rotor_speed', 'fast')],
)  # fmt: skip
def test_refusal_names_the_parameter_only_once(node, name, value):
    result = node.set_parameters_atomically([Parameter(name, value=value)])
    assert not result.successful
    assert result.reason.count(name) == 1


def test_nodes_may_live_together(context):
    nodes = [
        GearStatePublisher(context=context, namespace=namespace) for namespace in ('n1', 'n2')
    ]
    assert len({node.get_fully_qualified_name() for node in nodes}) == 2
    for node in nodes:
        node.destroy_node()


@pytest.mark.parametrize('direct', [True, False], ids=['publish_raw', 'publish'])
def test_message_that_the_middleware_refuses_is_counted_and_the_others_go_on(
    context, monkeypatch, direct
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
    node = GearStatePublisher(context=context, namespace='refused')
    node._on_rotor_state(rotor_bytes(1, position=[1.0]))
    assert {'/refused/body_poses', '/refused/mechanism_joint_states'} <= set(published)
    node._report()
    [status] = published['/diagnostics'].status
    assert 'not sent 1' in status.message
    node.destroy_node()


@pytest.mark.parametrize(('namespace', 'prefix'), [('', ''), ('left', 'left/')])
def test_status_is_named_after_node_and_namespace(context, monkeypatch, namespace, prefix):
    node = GearStatePublisher(context=context, namespace=namespace)
    published = []
    monkeypatch.setattr(Publisher, 'publish', lambda _, message: published.append(message))
    node._on_output_encoder(rotor_bytes(1, position=[1.0]))
    node._report()
    assert [status.name for status in published[-1].status] == [
        f'{prefix}gear_state_publisher: rotor input',
        f'{prefix}gear_state_publisher: transmission error',
    ]
    node.destroy_node()


class Losses:
    """What the middleware says it has lost, in place of what it knows."""

    def __init__(self) -> None:
        self.new = 0

    def __enter__(self) -> None:
        pass

    def __exit__(self, *_) -> None:
        pass

    def take_event(self):
        status = SimpleNamespace(total_count_change=self.new)
        self.new = 0
        return status

    def destroy_when_not_in_use(self) -> None:
        pass


def test_losses_are_counted_once_a_driver_is_connected(context, monkeypatch):
    node = GearStatePublisher(context=context, namespace='unheard')
    losses = Losses()
    node._rotor_driver.losses = losses
    now, drivers = 1000.0, 1
    monkeypatch.setattr(time, 'monotonic', lambda: now)
    monkeypatch.setattr(Subscription, 'get_publisher_count', lambda _: drivers)
    monkeypatch.setattr(Publisher, 'publish', lambda *_: None)
    stamps = itertools.count(1)

    def lost(new, happens):
        losses.new += new
        happens()
        return node._monitor.lost

    def message():
        node._on_rotor_state(rotor_bytes(next(stamps), position=[1.0]))

    # The driver has been there for long, but was silent.
    assert lost(3, node._report) == 0
    now += 60.0
    assert lost(3, node._report) == 0
    # What was lost during the connection may be reported soon after the first message.
    assert lost(4, message) == 0
    assert lost(5, node._report) == 0
    now += 0.8
    assert lost(2, node._report) == 0
    now += 0.2
    assert lost(6, message) == 0
    assert lost(0, node._report) == 6
    assert lost(5, node._report) == 11
    # The driver has ended, and another begins.
    drivers = 0
    assert lost(7, node._report) == 18
    drivers = 1
    assert lost(8, node._report) == 18
    now += 1.1
    assert lost(9, message) == 18
    assert lost(1, node._report) == 18
    now += 1.1
    assert lost(10, node._report) == 28
    # Another one joins it, such as a new one while the killed one is still in the graph.
    drivers = 2
    assert lost(2, node._report) == 28
    now += 1.1
    assert lost(20, node._report) == 48
    drivers = 1
    assert lost(30, node._report) == 78
    node.destroy_node()


def test_timer_of_the_markers_stands_still_before_somebody_looks(node):
    timer = node._display._timer
    [other] = [one for one in node.timers if one is not timer]
    assert timer.is_canceled()
    assert not other.is_canceled()


def test_markers_can_be_switched_off(context):
    overrides = [Parameter('markers_rate', value=0.0)]
    node = GearStatePublisher(context=context, namespace='unmarked', parameter_overrides=overrides)
    topics = {publisher.topic_name for publisher in node.publishers}
    assert '/unmarked/output_state' in topics
    assert '/unmarked/markers' not in topics
    node.destroy_node()


def test_description_shows_the_meshes_that_are_asked_for(context):
    def described(**values):
        overrides = [Parameter(name, value=value) for name, value in values.items()]
        node = GearStatePublisher(
            context=context, namespace='meshes', parameter_overrides=overrides
        )
        text = node._display._description.data
        node.destroy_node()
        return set(re.findall('filename="(.*)/satellite.stl"', text))

    assert described() == {'package://gear_kinematics/meshes/80_76_0_0011_0_0005'}
    assert described(module=0.00051) == described(meshes='none') == set()
    assert described(meshes='package://my_robot/meshes') == {'package://my_robot/meshes'}
    with pytest.raises(ParameterException, match='meshes: must be auto, none or a URI'):
        described(meshes='my_robot/meshes')


def test_of_a_gear_with_only_a_ratio_the_output_alone_is_published(context, monkeypatch):
    overrides = [Parameter('gear_ratio', value='1457/26'), Parameter('home_angle', value=0.5)]
    node = GearStatePublisher(context=context, namespace='ratio', parameter_overrides=overrides)
    topics = {publisher.topic_name for publisher in node.publishers}
    assert {'/ratio/output_state', '/ratio/transmission_error', '/diagnostics'} <= topics
    bodies = {'body_poses', 'mechanism_joint_states', 'robot_description', 'markers'}
    assert not {f'/ratio/{name}' for name in bodies} & topics
    published = []
    monkeypatch.setattr(node._outputs, 'send', published.extend)
    node._listened_to = ['output_state']
    node._on_rotor_state(rotor_bytes(1, position=[1457.0], velocity=[5.6], effort=[2.0]))
    [(_, data)] = published
    output = deserialize_message(data, JointState)
    assert output.position[0] == pytest.approx(26.0, abs=1e-13)
    assert output.velocity[0] == pytest.approx(5.6 * 26 / 1457, rel=1e-15)
    assert output.effort[0] == pytest.approx(2.0 * 1457 / 26, rel=1e-15)
    response = node._home(None, SimpleNamespace())
    assert response.success
    node._on_rotor_state(rotor_bytes(2, position=[1457.0]))
    [position] = deserialize_message(published[-1][1], JointState).position
    assert position == pytest.approx(0.5, abs=1e-12)
    report = node._monitor.report(node._input, node._gear, 1.0, time.monotonic())
    assert report.values['loop-closure residual (m)'] == 'none'
    node.destroy_node()


def test_log_says_what_is_not_published_of_a_gear_with_only_a_ratio(context, capfd):
    overrides = [Parameter('gear_ratio', value='-58/3')]
    node = GearStatePublisher(context=context, namespace='logged', parameter_overrides=overrides)
    node.destroy_node()
    assert re.search(
        r'gear ratio -58/3 \(bodies unknown: no body_poses, mechanism_joint_states, '
        r"robot_description, markers\), listening for joint 'rotor' on /logged/rotor_state",
        capfd.readouterr().err,
    )


def test_nothing_is_compared_before_there_is_an_encoder(context, monkeypatch):
    node = GearStatePublisher(context=context, namespace='compared')
    followed = []
    monkeypatch.setattr(OutputEncoder, 'follow', lambda _, sample: followed.append(sample) or [])
    node._on_rotor_state(rotor_bytes(1, position=[1.0]))
    assert not followed
    node._on_output_encoder(rotor_bytes(1, position=[1.0]))
    node._on_rotor_state(rotor_bytes(2, position=[1.0]))
    assert [sample.stamp for sample in followed] == [2]
    node.destroy_node()


@pytest.mark.parametrize(
    ('kind', 'name'),
    [
        ('auto', 'EventsExecutor'),
        ('events', 'EventsExecutor'),
        ('single_threaded', 'SingleThreadedExecutor'),
    ],
)
def test_executor_is_the_one_that_is_asked_for(context, kind, name):
    executor = make_executor(kind, context)
    assert type(executor).__name__ == name
    executor.shutdown()


@pytest.fixture
def no_events_executor(monkeypatch):
    # Not every release has it; None in sys.modules makes the import fail.
    monkeypatch.setitem(sys.modules, 'rclpy.experimental.events_executor', None)


@pytest.mark.usefixtures('no_events_executor')
def test_executor_is_found_in_every_release(context):
    executor = make_executor('auto', context)
    assert type(executor).__name__ == 'SingleThreadedExecutor'
    executor.shutdown()


@pytest.mark.usefixtures('no_events_executor')
def test_executor_that_a_release_lacks_is_refused(context):
    with pytest.raises(ValueError, match='executor must not be events'):
        make_executor('events', context)
