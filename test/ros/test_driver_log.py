# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""What the node logs of the rotor's driver; without DDS."""

import contextlib
import math
from types import SimpleNamespace

import pytest
from live import SECOND, rotor_bytes

from gear_kinematics.parameters import NodeParameters
from gear_kinematics.ros.driver_log import DriverLog
from gear_kinematics.state.losses import Publishers
from gear_kinematics.state.rotor_input import RotorInput
from gear_kinematics.wire.joint_reader import RejectedInputError
from gear_kinematics.wire.topics import JOINT_STATE

MISSING = (
    '/rotor_state has no publisher; there are: /motor, /wheels; choose one with '
    '-r rotor_state:=<topic>, or with ros2 launch rotor_state:=<topic>'
)
STOPPED = '/rotor_state has stopped: no input for 1.5 s'
NOW = '/rotor_state is heard now'
BOTH = 'if both run, stop one; if the drive restarted, home it (gearkin home or ~/home)'
CHECK = 'check whether the drive restarted; then home it (gearkin home or ~/home)'
AWAY = f'/rotor_state is heard again, but the rotor is {{}}° from where it was: {CHECK}'
ANOTHER = (
    f'/rotor_state comes from another driver, but the rotor is {{}}° from where it was: {BOTH}'
)
SEVERAL = (
    'several drivers send this joint. Stop all but one, such as a joint_state_publisher, '
    'or give them different topics.'
)
GEARS = {'/output_state', '/transmission_error', '/left/angle', '/left/transmission_error'}


class Graph:
    """Stands in for the node, and the topics around it, two of which drivers publish."""

    def __init__(self, *topics) -> None:
        self._topics, self.logged, self.moved = topics, [], {}
        self.get_logger = lambda: SimpleNamespace(warning=self.log('W'), info=self.log('I'))
        self.input = RotorInput(NodeParameters.load())
        self.driver_log = DriverLog(self, {'': self.input})
        self.publishers, self.last = Publishers(), None

    def update(self, publishers):
        """Report as the node does once a second."""
        self.publishers.update()
        self.driver_log.update(publishers, 0.1, [''] * self.publishers.several)

    def log(self, level):
        return lambda text: self.logged.append((level, text))

    def resolve_topic_name(self, name):
        return f'/{name}'

    def get_topic_names_and_types(self):
        joint_states = [*self._topics, *GEARS, '/rotor_state', '/subscribed']
        return [('/chatter', ['std_msgs/msg/String']), *((t, [JOINT_STATE]) for t in joint_states)]

    def get_service_names_and_types(self):
        return [(f'{name}/home', ['std_srvs/srv/Trigger']) for name in ('/gear', '/left/gear')]

    def get_publishers_info_by_topic(self, topic):
        name = 'gear' if topic in GEARS else 'motor'
        end = SimpleNamespace(node_name=name, node_namespace=topic.rpartition('/')[0])
        return [] if topic in {'/rotor_state', '/subscribed'} else [end]

    def hear(self, stamp, position, number=None, **fields):
        """Take a message as the node does, with the number that its publisher gives it."""
        fields = {name: [value] for name, value in fields.items()}
        data, last = rotor_bytes(round(stamp * SECOND), position=[position], **fields), self.last
        self.last = sample = self.input.accept(data, lambda: SECOND)
        if self.publishers.note(number):
            self.driver_log.replaced('', last)
        if self.driver_log.awaited:
            self.moved |= self.driver_log.heard({'': sample})


def test_topics_of_drivers_are_named_once_until_one_is_heard():
    graph = Graph('/wheels', '/motor')
    for publishers in (0, 0, 0):  # s, after which a driver that runs is discovered
        graph.driver_log.update(publishers, 0.0)
    assert not graph.logged
    for publishers in (0, 0, 1, 0):
        graph.driver_log.update(publishers, 0.0)
    assert graph.logged == [('W', MISSING)]
    graph.hear(1.0, 5.0)
    assert graph.logged[1:] == [('I', NOW)]


def test_nothing_is_said_where_no_driver_has_a_topic():
    graph = Graph()
    for _ in range(5):
        graph.driver_log.update(0, 0.0)
    assert not graph.logged


@pytest.mark.parametrize('publishers', [0, 1], ids=['ended', 'hangs'])
@pytest.mark.parametrize(
    ('position', 'said'),
    [(5.001, ('I', NOW)), (0.0, ('W', AWAY.format(-286))), (500.0, ('W', AWAY.format(28361)))],
)
def test_driver_that_stops_and_its_return_are_a_line_each(publishers, position, said):
    graph = Graph('/wheels')
    graph.hear(1.0, 5.0)
    for silence in (0.1, 0.9, 1.5, 2.5, 3.5):
        graph.driver_log.update(publishers, silence)
    assert graph.logged == [('W', STOPPED)]
    for number in range(4):
        graph.hear(5.0 + 0.001 * number, position)
    graph.driver_log.update(1, 0.0)
    assert graph.logged[1:] == [said]
    assert graph.moved == ({'': position - 5.0} if said[0] == 'W' else {})


def test_a_new_driver_is_compared_with_the_last_unless_two_take_turns():
    """It can replace the last within the timeout, where a gap explains where the rotor is."""
    graph = Graph()
    for second in range(1, 20):
        graph.hear(second, 5.0, number=100 + second)
        if second > 1:
            graph.hear(second + 0.3, 0.0, number=second)
        graph.update(2)
    assert graph.logged == [('W', ANOTHER.format(-286)), ('W', SEVERAL)]


@pytest.mark.parametrize('numbers', [(70, 71, 1, 2, 1), (1, 2, 1, 2, 3, 1)])
def test_each_of_two_restarts_within_seconds_is_compared_with_the_last_position(numbers):
    """It counts from 2 rad less each time, also where it ran longer than the time before."""
    graph, position = Graph(), 7.0
    for second, number in enumerate(numbers, start=1):
        position -= 2.0 * (number == 1)
        graph.hear(second, position, number=number)
        graph.update(1)
    assert graph.logged == [('W', ANOTHER.format(-115))] * 2


def test_drivers_of_two_joints_that_send_in_turn_are_no_other_drivers():
    """The rotor turns by 0.6 rad between two messages of its driver, as at 30 rad/s and 50 Hz.

    The other driver begins later, and its numbers are behind, or ahead.
    """
    for ahead in (-100, 100):
        graph = Graph()
        for number in range(9):
            graph.hear(1.0 + 0.02 * number, 0.6 * number, number=200 + number)
            if number > 3:
                with pytest.raises(RejectedInputError):
                    graph.hear(1.01 + 0.02 * number, 5.0, names='wheel', number=number + ahead)
            graph.update(2)
        assert not graph.logged


def test_a_driver_that_takes_over_at_once_with_another_zero_is_said():
    """Its first position is near enough for the rotor to reach it at its greatest speed."""
    graph = Graph()
    for number in range(10):
        old = number < 5
        graph.hear(1.0 + 0.01 * number, 5.0 if old else 4.0, number=50 * old + number)
    assert graph.logged == [('W', ANOTHER.format(-57))]
    assert graph.moved == {'': pytest.approx(-1.0)}


def test_several_drivers_of_a_joint_are_one_warning():
    graph = Graph()
    graph.hear(1.0, 5.0)
    for several in ([], [''], [''], []):
        graph.driver_log.update(2, 0.1, several)
    assert graph.logged == [('W', SEVERAL)]


def test_several_drivers_of_all_joints_of_an_arm_are_one_warning():
    """As of an arm's driver that was started twice; later, another joint has two drivers, too."""
    graph, arm = Graph(), ['shoulder', 'elbow', 'wrist']
    inputs = {name: RotorInput(NodeParameters.load()) for name in arm}
    graph.driver_log = DriverLog(graph, inputs)
    for several in (arm[:2], arm[:2], arm):
        graph.driver_log.update(2, 0.1, several)
    said = 'several drivers send this joint. Stop all but one, '
    begun = [text.partition(said)[0] for _, text in graph.logged]
    assert begun == ['shoulder, elbow: ', 'wrist: ']


def test_jump_of_the_encoder_is_one_warning():
    graph = Graph()
    for number in range(9):
        with contextlib.suppress(RejectedInputError):
            graph.hear(1.0 + 0.001 * number, 5.0 + 100.0 * (number > 3))
    graph.driver_log.update(1, 0.0)
    graph.driver_log.update(1, 0.0)
    said = "the rotor's encoder jumped by 100 rad at 1.004 s. Check whether the drive restarted "
    assert [(level, text[: len(said)]) for level, text in graph.logged] == [('W', said)]


def test_positions_in_degrees_are_one_warning():
    graph = Graph()
    for number in range(200):
        with contextlib.suppress(RejectedInputError):
            graph.hear(1.0 + 0.005 * number, math.degrees(100.0 * 0.005 * number))
        graph.driver_log.update(1, 0.0)
    said = '5730 rad/s exceed max_rotor_speed. Let the driver send rad, stamped in s and ns, or '
    assert graph.logged == [('W', f'{said}set the limit to that of the motor.')]


def test_velocities_that_contradict_the_positions_are_one_warning():
    graph = Graph()
    for number in range(200):
        graph.hear(1.0 + 0.01 * number, 0.5 * number, velocity=50.0 * 30.0 / math.pi)
        graph.driver_log.update(1, 0.0)
    said = (
        'the velocities contradict the positions: they seem to be rpm. Let the driver send rad/s '
    )
    assert graph.logged == [('W', f'{said}of the rotor, or no velocities.')]


def test_positions_that_wrap_are_named_once_instead_of_every_jump():
    graph = Graph()
    for number in range(200):
        with contextlib.suppress(RejectedInputError):
            graph.hear(1.0 + 0.01 * number, math.fmod(0.2 * number, math.tau))
        graph.driver_log.update(1, 0.0)
    jumps, wraps = graph.logged[:-1], graph.logged[-1]
    assert ['jumped by -6.283 rad' in text for _, text in jumps] == [True, True]
    said = 'the positions wrap every 6.283 rad: set rotor_encoder to single_turn. Move the output '
    assert (wraps[0], wraps[1][: len(said)]) == ('W', said)


@pytest.mark.parametrize(
    ('position', 'said'),
    [
        (5.0, ('I', 'elbow: /rotor_state is heard now')),
        (0.0, ('W', AWAY.format(-286).replace('the rotor', 'elbow: the rotor'))),
    ],
)
def test_joint_of_an_arm_that_stops_and_its_return_are_a_line_each(position, said):
    graph = Graph()
    inputs = {name: RotorInput(NodeParameters.load()) for name in ('shoulder', 'elbow')}
    graph.driver_log = DriverLog(graph, inputs, lambda: ['rotor'])
    for stamp in range(1, 12):
        heard = {}
        for name, each in inputs.items():
            if name == 'elbow' and 2 < stamp < 9:
                each.received, each.of_others = each.received + 1, each.of_others + 1
            else:
                data = rotor_bytes(stamp * SECOND, position=[position if stamp > 2 else 5.0])
                heard[name] = each.accept(data, lambda: SECOND)
        if graph.driver_log.awaited:
            graph.driver_log.heard(heard)
        graph.driver_log.update(2, 0.0)
    stopped = "elbow: no more messages of 'rotor' on /rotor_state; other joints are still heard"
    assert graph.logged == [('W', stopped), said]


def test_joint_of_an_arm_that_begins_late_is_heard():
    graph = Graph()
    inputs = {name: RotorInput(NodeParameters.load()) for name in ('shoulder', 'elbow')}
    graph.driver_log = DriverLog(graph, inputs, lambda: ['m1'])
    for _ in range(3):
        for each in inputs.values():
            each.received, each.of_others = (
                each.received + 1,
                each.of_others + (each is inputs['elbow']),
            )
        graph.driver_log.update(2, 0.0)
    sample = inputs['elbow'].accept(rotor_bytes(SECOND, position=[5.0]), lambda: SECOND)
    for _ in range(2):
        graph.driver_log.heard({'elbow': sample})
    said = "elbow: no joint 'rotor' on /rotor_state; there are: m1"
    assert graph.logged == [('W', said), ('I', 'elbow: /rotor_state is heard now')]
    assert not graph.driver_log.awaited


@pytest.mark.live
def test_node_logs_silence_of_its_joint_on_a_shared_topic(make, capfd):
    node = make('/shared')
    for stamp, name, position in ((1, 'rotor', 5.0), (2, 'wheel', 0.0), (9, 'rotor', 0.0)):
        node._on_rotor_state(rotor_bytes(stamp * SECOND, [name], [position]))
        if name == 'rotor':
            node._actuators[''].state.monitor.last_input -= 1.5
        node._report()
    said = capfd.readouterr().err
    assert said.count('/shared/rotor_state has stopped: no input for ') == 2
    assert said.count('is heard again, but the rotor is -286° from where it was') == 1
