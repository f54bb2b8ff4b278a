# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""What `gearkin watch` shows, whom its server answers, and what init writes, without a node."""

import asyncio
import io
import json
import math
import re
import time
from concurrent.futures import Future
from contextlib import asynccontextmanager, nullcontext
from dataclasses import asdict, replace
from functools import partial
from itertools import pairwise
from pathlib import Path
from types import SimpleNamespace
from unittest.mock import Mock, patch

import pytest
from blocked_bags import refusal, wait_until
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus
from live import rotor_bytes
from rcl_interfaces.msg import ParameterValue
from rclpy.node import Node
from rclpy.serialization import serialize_message
from rich.console import Console
from sensor_msgs.msg import JointState
from watching import DEADLINE, WatcherStandIn

from gear_kinematics.commands import init, joints, output
from gear_kinematics.commands.cli import main
from gear_kinematics.measurement.commissioning.analysis import Channel
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.parameters.arm import load_actuators
from gear_kinematics.ros.graph import Graph
from gear_kinematics.watch import drivers
from gear_kinematics.watch.drivers import DriverTopic
from gear_kinematics.watch.gear import Answer, GearNode, JointValue, Status
from gear_kinematics.watch.page import drawing
from gear_kinematics.watch.text import line, list_drivers, rows_of, show, show_recording, table
from gear_kinematics.watch.view import (
    UNANSWERED,
    Entry,
    View,
    driver_entry,
    status_entry,
    values_of,
    view_of,
)
from gear_kinematics.watch.watcher import Watcher
from gear_kinematics.wire import topics

tornado_websocket = pytest.importorskip('tornado.websocket', reason='no tornado is installed')
from tornado.httpclient import AsyncHTTPClient, HTTPRequest  # noqa: E402, an extra

from gear_kinematics.watch import server  # noqa: E402, needs it
from gear_kinematics.watch.server import Server  # noqa: E402, needs it

JOINT_STATE = 'sensor_msgs/msg/JointState'
HOSTILE = 'm\x1b[2J<img src=x onerror=alert(1)>'
TEXT = 2000 * 'much '
DRIVERS = (
    DriverTopic('/motor/joint_states', ('brake', 'm1'), 999.6),
    DriverTopic('/odd', (), 0.0),
)


# Which topic is which


@pytest.mark.parametrize(
    ('own', 'output'),
    [
        ('output_state mechanism_joint_states other', 'output_state'),
        ('angle mechanism_joint_states', 'angle'),
        ('angle other mechanism_joint_states', None),  # nothing is guessed
        ('joint_states', None),  # a driver can have ~/home, too
    ],
)
def test_node_of_a_gear_is_known_by_its_topics(own, output):
    def end(name):
        return SimpleNamespace(node_name=name, node_namespace='/left', endpoint_gid=name.encode())

    published = {f'/left/{name}': [end('gear')] for name in own.split()}
    published |= {'/left/rotor_state': [end('motor')]}
    graph = Graph(
        SimpleNamespace(
            get_topic_names_and_types=lambda: [(topic, [JOINT_STATE]) for topic in published],
            get_publishers_info_by_topic=published.get,
            get_service_names_and_types=lambda: [('/left/gear/home', ['std_srvs/srv/Trigger'])],
        )
    )
    assert graph.gears == (['/left/gear'] if output else [])
    assert graph.outputs_of('/left/gear').get('output_state') == (output and f'/left/{output}')
    assert graph.publishers_of('/left/gear') == ({b'gear'} if output else set())
    assert '/left/rotor_state' in graph.drivers()
    assert (len(graph.drivers()) == 1) == bool(output)


# Words

NEAREST = '/lefd/gear is not running; did you mean `/left/gear`? there are: /left/gear'


def gear_node(**changes):
    """Stand in for a node that has told everything."""
    joints = {
        topics.OUTPUT_STATE: JointValue(math.radians(-370.0), -1.0, 0.001, 999.6),
        topics.CORRECTED_STATE: JointValue(math.radians(-370.25), None, 0.001),
        topics.CORRECTED_INTERVAL: JointValue(math.radians(0.5 / 60.0), None, 0.001),
        topics.TRANSMISSION_ERROR: JointValue(math.radians(-1.5 / 60.0), None, 0.001),
    }
    values = {'peak to peak (rad)': '0.0002'}
    kept = {'home file': 'lost at restart: set home_file'}
    node = {
        'name': '/left/gear_state_publisher',
        'actuator': '',
        'arm': {},
        'revision': 7,
        'running': True,
        'seen': True,
        'fault': '',
        'parameters': NodeParameters.load(),
        'statuses': {
            'rotor input': Status('rotor input', 0, 'ok', kept, time.monotonic()),
            'transmission error': Status('transmission error', 0, 'ok', values, time.monotonic()),
        },
        'joint': joints.get,
        'earlier': {},
        'homed_zero': None,
    }
    gear = SimpleNamespace(**{**node, **changes})
    gear.label = f'{gear.name} {gear.actuator}'.rstrip()
    return gear


def unconnected(name, actuator=''):
    """Follow a gear without ROS."""
    of_ros = dict.fromkeys(('homing_client', 'Listener', 'Polled', 'AsyncParameterClient'), Mock())
    with patch.multiple('gear_kinematics.watch.gear', **of_ros):
        return GearNode(None, name, actuator)


def client(zero, asked):
    """Stand in for the client of a node with a rotor_zero, and note what it is asked to set."""
    values = [ParameterValue(type=3, double_value=zero)]
    response = SimpleNamespace(result=lambda: SimpleNamespace(values=values))
    return SimpleNamespace(
        get_parameters=lambda _, take: take(response),
        set_parameters_atomically=lambda parameters, _: asked.extend(parameters),
    )


def test_values_are_those_of_the_topics():
    assert list(values_of(gear_node())) == [
        Entry('output angle', '-370.000°', '-6.45772 rad'),
        Entry('rotor angle', '7030.000°', '19.528 turns'),
        Entry('output speed', '-9.55 rpm', 'rotor 181.4 rpm'),
        Entry('output rate', '1000 Hz'),
        Entry('zero', '0.000 rad', 'lost at restart: set home_file'),
        Entry('corrected angle', '-370.250°', '± 30.000″ (95 %)'),
        Entry('transmission error', '-1′ 30.000″', 'peak to peak 0.0002 rad'),
    ]
    assert list(values_of(gear_node(parameters=None))) == []
    unknown = Status('transmission error', 0, 'ok', {'peak to peak (rad)': 'none'}, math.inf)
    *_, last = values_of(gear_node(statuses={'transmission error': unknown}))
    assert last == Entry('transmission error', '-1′ 30.000″')


def test_a_gear_at_rest_has_no_negative_zero():
    joints = {topics.OUTPUT_STATE: JointValue(-1e-9, -1e-9, 0.001, 1000.0)}
    angle, rotor, speed, *_ = values_of(gear_node(joint=joints.get))
    assert angle == Entry('output angle', '0.000°', '0.00000 rad')
    assert rotor == Entry('rotor angle', '0.000°', '0.000 turns')
    assert speed == Entry('output speed', '0.00 rpm', 'rotor 0.0 rpm')


@pytest.mark.parametrize('margin', ['nan', '1e999', 'much'])
def test_what_another_node_says_under_its_name_breaks_no_view(margin):
    values = dict.fromkeys(('margin (N·m)', 'margin (% of the preload)'), margin)
    status = Status('preload', 0, 'ok', values, time.monotonic())
    view = view_of(gear_node(statuses={'preload': status}))
    assert view.margin is None
    json.dumps(asdict(view), allow_nan=False)


def test_only_a_bounded_part_of_diagnostics_is_kept():
    def taken(*subjects):
        statuses = [
            DiagnosticStatus(name=f'left/gear: {subject}', hardware_id='/left/gear', message=TEXT)
            for subject in subjects
        ]
        return [(serialize_message(DiagnosticArray(status=statuses)), 0)]

    node = unconnected('/left/gear')
    for subjects in (['rotor input', *map(str, range(1000))], ['rotor input']):
        node._diagnostics = SimpleNamespace(take=partial(taken, *subjects))
        node.poll()
    assert len(node.statuses) == 50
    assert node.statuses['rotor input'].message == TEXT[:1000]
    node.statuses, node.actuator = {}, 'elbow'
    subjects = 'shoulder: rotor input', 'elbow: rotor input', 'elbow: preload'
    node._diagnostics = SimpleNamespace(take=partial(taken, *subjects))
    node.poll()
    assert [*node.statuses] == ['rotor input', 'preload']


@pytest.mark.parametrize(('margin', 'tone'), [('0.75', ''), ('-0.3', 'bad')])
def test_margin_of_the_preload_is_a_value_and_a_bar(margin, tone):
    values = {
        'margin (N·m)': margin,
        'margin (% of the preload)': str(float(margin) / 0.015),
        'least margin (N·m)': '-0.3',
    }
    status = Status('preload', 0, 'ok', values, time.monotonic())
    view = view_of(gear_node(statuses={'preload': status}))
    assert view.margin == pytest.approx(float(margin) / 1.5)
    [entry] = [entry for entry in view.values if entry.name == 'preload left']
    assert entry == Entry(
        'preload left', f'{margin} N·m', 'least -0.3 N·m in the last second', tone
    )
    old = status._replace(at=time.monotonic() - 10.0)
    assert view_of(gear_node(statuses={'preload': old})).margin is None


def test_values_that_are_out_of_date_say_so_and_move_nothing():
    silent = gear_node(joint={topics.OUTPUT_STATE: JointValue(0.1, None, 90.0)}.get)
    view = view_of(silent)
    assert [entry.tone for entry in view.values[:2]] == ['stale', 'stale']
    assert view.rotor is None
    assert view.question == ''
    view = view_of(gear_node())
    assert (view.output, view.rotor) == pytest.approx((-370.0, 7030.0))
    assert view_of(gear_node(joint={}.get)).rotor is None


@pytest.mark.parametrize(('gear', 'state', 'words'), [
    (None, 'no node', 'No gear_state_publisher is running'),
    (gear_node(seen=False, running=False), 'no node', 'is not running. gearkin init'),
    (gear_node(seen=False, running=False, name='/lefd/gear'), 'no node', NEAREST),
    (gear_node(running=False), 'ended', 'has ended. Waiting'),
    (gear_node(fault='module must be'), 'fault', 'cannot be used: module must be'),
    (gear_node(parameters=None), 'connecting', ''), (gear_node(), 'connected', ''),
    (gear_node(joint={}.get), 'no output', 'There has been no output yet.'),
    (gear_node(joint={topics.OUTPUT_STATE: JointValue(0.0, 0.0, 5.74)}.get), 'no output', '5.7 s'),
])  # fmt: skip
def test_state_of_the_node_is_told(gear, state, words):
    others = [gear_node(name='/left/gear')] if words is NEAREST else []
    view = view_of(gear, others)
    assert view.state == state
    assert words in view.message
    assert words is not NEAREST or words == view.message  # nothing on setting up another
    if state != 'connected':
        assert (view.output, view.question) == (None, '')
    if state in {'no node', 'ended'}:  # nothing of what is gone
        assert view.values == view.diagnostics == ()
    # Nodes that run may not be found yet.
    early = view_of(gear, others, looking=True).state
    assert early == ('connecting' if state == 'no node' else state)


def test_nodes_that_run_are_listed_with_joint_and_ratio():
    parameters = replace(NodeParameters.load(), rotor_joint='m1', gear_ratio='-58/3')
    nodes = [gear_node(parameters=parameters), gear_node(name='/new', parameters=None)]
    assert view_of(None, nodes).nodes == (
        Entry('/left/gear_state_publisher', 'm1, ratio -58/3'),
        Entry('/new', ''),
    )


def test_another_node_is_shown_when_chosen_or_when_the_first_has_ended(monkeypatch):
    def node(_, name, actuator):
        gear = gear_node(name=name, actuator=actuator)
        gear.look = lambda graph, shown: looked.append((name, name in graph.gears, shown))
        return gear

    def look(*gears):
        looked.clear()
        watcher._look(SimpleNamespace(gears=list(gears), drivers=list))
        return looked

    looked = []
    monkeypatch.setattr('gear_kinematics.watch.watcher.GearNode', node)
    watcher = Watcher()
    watcher._drivers, watcher._node = SimpleNamespace(look=lambda _: None), None
    assert look() == []
    assert look('/b') == [('/b', True, True)]
    assert look('/a', '/b') == [('/a', True, False), ('/b', True, True)]
    assert look('/a') == [('/a', True, True), ('/b', False, False)]
    both = SimpleNamespace(gears=['/a', '/b'], drivers=list)
    monkeypatch.setattr('gear_kinematics.watch.watcher.Graph', lambda _: both)
    watcher._do({'do': 'show', 'node': '/b'}, Future())
    assert watcher._gear.name == '/b'
    assert look('/a') == [('/a', True, False), ('/b', False, True)]  # it was asked for
    with pytest.raises(ValueError, match='not possible'):
        watcher._do({'do': 'show', 'node': '/nobody'}, Future())
    # An arm: once its actuators are known, each can be chosen.
    watcher._gear.actuator, watcher._gear.arm = 'shoulder', {'shoulder': None, 'elbow': None}
    watcher._gear.label = '/b shoulder'
    look('/a', '/b')
    assert [gear.label for gear in watcher._gears] == ['/a', '/b shoulder', '/b elbow']
    watcher._do({'do': 'show', 'node': '/b elbow'}, Future())
    assert (watcher._gear.name, watcher._gear.actuator) == ('/b', 'elbow')
    # The node starts again with another file, in which nothing has the name of before.
    for gear in watcher._gears[1:]:
        gear.arm = {'wrist': None}
    look('/b')
    assert [gear.label for gear in watcher._gears] == ['/a', '/b wrist']
    assert watcher._gear.label == '/b wrist'


def test_all_angles_of_an_arm_are_in_a_row():
    names = {'shoulder': 'lift', 'elbow': 'bend', 'hand': 'turn', 'wrist': 'roll'}
    arm = {
        name: replace(NodeParameters.load(), actuator=name, output_joint=joint, gear_ratio='-3')
        for name, joint in names.items()
    }
    arm = {name: replace(each, frame_prefix=f'{name}_') for name, each in arm.items()}
    joints = {
        'lift': JointValue(0.5 * math.pi, None, 0.001),
        'bend': JointValue(-1e-9, None, 90.0),
        'roll': JointValue(0.1, None, 0.001),
    }
    gear = gear_node(
        arm=arm,
        actuator='shoulder',
        parameters=arm['shoulder'],
        joint=lambda topic, name='lift': joints.get(name) if topic == 'output_state' else None,
    )
    fault = Status('rotor input', 2, 'not referenced', {}, time.monotonic())
    others = [
        gear_node(actuator=name, statuses={'rotor input': fault}) for name in ('hand', 'wrist')
    ]
    view = view_of(gear, [gear, *others])
    assert view.arm[3] == Entry('wrist', '5.7°', 'error', 'bad')
    assert view.arm[:3] == (
        Entry('shoulder', '90.0°'),
        Entry('elbow', '0.0°', '90.0 s ago', 'stale'),
        Entry('hand', 'none', tone='stale'),
    )
    label = '/left/gear_state_publisher shoulder'
    assert (view.node, view.nodes[0].name) == (label, label)
    said = line(rows_of(view))
    angles = 'shoulder 90.0°   elbow 0.0° (90.0 s ago)   hand none   wrist 5.7° (error)'
    assert said.startswith(f'{label} connected; all {angles}; ')
    terminal = Console(file=io.StringIO(), force_terminal=True, width=200)
    both = replace(view, nodes=(*view.nodes, Entry('/left/gear_state_publisher elbow', '')))
    show(SimpleNamespace(view=both), terminal, iter((False, True)).__next__)
    assert 'n next actuator' in terminal.file.getvalue()


@pytest.mark.live
def test_rate_is_that_of_the_joint_on_a_topic_of_several_gears(context):
    own, other = (JointState(name=[j], position=[float(len(j))]) for j in ('elbow', 'hand'))
    node = Node('rates', context=context)
    gear = GearNode(node, '/gear')
    gear.parameters = replace(NodeParameters.load(), output_joint='elbow')
    gear.arm = {'elbow': gear.parameters, 'hand': gear.parameters}
    gear._topics = {topics.OUTPUT_STATE: '/rates/output_state'}
    gear._outputs.look(gear._topics.values())
    publisher = node.create_publisher(JointState, '/rates/output_state', 100)
    wait_until(publisher.get_subscription_count, 'the subscription')
    for message in 20 * [own, other, other]:
        publisher.publish(message)
    heard = gear._outputs.heard['/rates/output_state']
    taken = []
    wait_until(lambda: taken.extend(heard.take()) or len(taken) >= 20, 'its messages')
    assert len(taken) == 20
    for name in ('', 'elbow', 'hand'):  # the joint of another driver of an arm is known, too
        assert gear.joint(topics.OUTPUT_STATE, name).position == len(name or 'elbow')
    assert gear.joint(topics.OUTPUT_STATE, 'foot') is None
    node.destroy_node()


def test_parameters_of_an_odd_type_are_a_fault():
    node = unconnected('/gear')
    node._take_parameters({'module': 'thick', 'output_joint': 'output'})
    assert node.fault == "module must be of type float, not 'thick'"
    assert not node.parameters


def test_empty_lists_of_a_parameter_file_have_no_type_in_ros():
    node = unconnected('/gear')
    node.fault = 'not asked yet'
    values = [ParameterValue(), ParameterValue(), ParameterValue(type=4, string_value='50')]
    answer = SimpleNamespace(result=lambda: SimpleNamespace(values=values))
    node._client = SimpleNamespace(get_parameters=lambda _, take: take(answer))
    names = ['actuators', 'output_range', 'gear_ratio']
    listed = SimpleNamespace(result=SimpleNamespace(names=names))
    node._ask(SimpleNamespace(result=lambda: listed))
    assert (node.fault, node.parameters) == ('', NodeParameters.of({'gear_ratio': '50'}, ''))


def test_an_actuator_of_an_arm_has_its_own_parameters_and_service():
    """The first that the node has is taken for the one that is not named."""
    made, asked = [], []
    given = {'actuators': ['shoulder', 'elbow'], 'elbow.gear_ratio': '-51', 'rotor_zero': 1.0}
    ros = SimpleNamespace(create_client=lambda _, name: made.append(name), destroy_client=print)
    for actuator, ratio in {'': '', 'elbow': '-51'}.items():
        node = unconnected('/arm', actuator)
        node._node = ros
        node._take_parameters(given)
        assert (node.label, node.fault) == (f'/arm {actuator or "shoulder"}', '')
        assert (node.parameters.gear_ratio, node.parameters.rotor_zero) == (ratio, 1.0)
        node._client = client(1.0, asked)
        node.set({'rotor_zero': 2.0}, 'done', Future())
    assert made == ['/arm/shoulder/home']
    assert [each.name for each in asked] == ['shoulder.rotor_zero', 'elbow.rotor_zero']
    node.actuator = 'elbo'
    node._take_parameters(given)
    assert node.fault.startswith("it has no actuator 'elbo'; did you mean `elbow`?")
    assert node.arm.keys() == {'shoulder', 'elbow'}


@pytest.mark.parametrize(('zero', 'done'), [(1.5, True), (3.5, False)])
def test_only_the_present_zero_is_undone(zero, done):
    """Another `gearkin watch` may have homed the node since the diagnostics told its zero."""
    node, asked, answered = unconnected('/gear'), [], Future()
    for known in (0.5, 1.5):
        node._take_parameters({'rotor_zero': known})
    node._client = client(zero, asked)
    node.set(node.earlier, 'Undone.', answered)
    assert [(each.name, each.value) for each in asked] == [('rotor_zero', 0.5)] * done
    assert answered.done() != done
    assert done or answered.result().text == 'Nothing was done: the node has changed.'


@pytest.mark.parametrize(
    ('zeros', 'earlier', 'lost'),
    [
        ([0.0], None, None),
        ([0.0, 28.969], 0.0, None),
        ([0.0, 28.969, 0.0], 28.969, None),  # undone, which can be undone
        ([0.0, 28.969, None, 0.0], None, 28.969),
        ([0.0, 28.969, None, 28.969], None, None),  # kept
        ([0.0, 28.969, None, 0.0, None, 0.0], None, 28.969),
        ([0.0, 28.969, None, 0.0, 3.0], 0.0, None),  # homed again
        ([0.0, None, 1.0], None, None),  # another parameter file, never homed
    ],
)
def test_zero_that_a_node_has_lost_is_known(zeros, earlier, lost):
    """Zeros as they are read, and None where the node starts again."""
    node = unconnected('/gear')
    for before, zero in pairwise([None, *zeros]):
        revision = node.revision
        if zero is None:
            node.parameters, node.earlier = None, {}
        else:
            node._take_parameters({'rotor_zero': zero})
            assert (node.revision != revision) == (before not in (None, zero))
    assert node.earlier == ({} if earlier is None else {'rotor_zero': earlier})
    shown = {'earlier': node.earlier, 'homed_zero': node.homed_zero, 'parameters': node.parameters}
    view = view_of(gear_node(**shown))
    [entry] = [entry for entry in view.values if entry.name == 'zero']
    assert view.undo == ('' if earlier is None else f'rotor_zero {earlier:g}')
    words = 'homed before; the zero is lost: it was 28.969 rad; lost at restart: set home_file'
    assert entry.tone == ('notable' if lost else '')
    assert entry.detail == (words if lost else 'lost at restart: set home_file')


def test_question_before_homing_says_where_the_output_is():
    parameters = replace(NodeParameters.load(), home_angle=math.radians(12.25))
    question = view_of(gear_node(parameters=parameters)).question
    assert question == 'The output is at -370.0°. Set it to 12.2°?'
    assert view_of(gear_node(parameters=None)).question == ''
    single = replace(parameters, rotor_encoder='single_turn')
    assert not view_of(gear_node(parameters=single, earlier={'rotor_zero': 0.0})).undo


def test_status_is_described_with_what_to_do():
    values = {'advice': 'Check the driver.'}
    status = Status('rotor input', 2, 'no input for 3.2 s', values, 100.0)
    told = Entry('rotor input', 'error: no input for 3.2 s', 'Check the driver.', 'bad')
    assert status_entry(status, 101.0) == told
    warning = status._replace(level=1, message='2 drivers', values={})
    assert status_entry(warning, 101.0) == Entry(
        'rotor input', 'warning: 2 drivers', '', 'notable'
    )
    assert status_entry(status._replace(level=0), 101.0) == Entry('rotor input', 'healthy')
    silent = Entry('rotor input', 'no diagnostics for 5.0 s', '', 'bad')
    assert status_entry(status, 105.04) == silent


# The terminal


FULL = View(
    node='/left/gear_state_publisher',
    state='connected',
    tone='pass',
    values=(Entry('output angle', '12.5°', '0.2 rad'), Entry('input', '0 Hz', '', 'bad')),
    diagnostics=(Entry('rotor input', f'error: {HOSTILE}', HOSTILE, 'bad'),),
    message='All is well.',
    drivers=tuple(map(driver_entry, DRIVERS)),
    joints=(('/motor/joint_states', 'brake'), ('/motor/joint_states', 'm1')),
)


def printed(renderable, width: int = 120) -> str:
    stream = io.StringIO()
    Console(file=stream, width=width, force_terminal=True, color_system=None).print(renderable)
    return stream.getvalue()


@pytest.mark.parametrize('kind', ['dumb', 'xterm'])
def test_a_dumb_terminal_gets_lines_as_a_pipe_does(monkeypatch, kind):
    """rich would show nothing of a table on it, until the end."""
    monkeypatch.setenv('TERM', kind)
    shown, stops = io.StringIO(), iter([False, True])
    recorder = SimpleNamespace(poll=lambda: None, absent='', heard={})
    show_recording(recorder, output.Console(file=shown, force_terminal=True), lambda: next(stops))
    lines = re.match(r'[\d-]+T\S+ waiting for a gear_state_publisher\n', shown.getvalue())
    assert bool(lines) == (kind == 'dumb')


@pytest.mark.parametrize(
    ('heard', 'said'),
    [
        ({'/a': SimpleNamespace(rate=0.0, count=1)}, r'/a .*\b1 message\b'),
        ({}, r'waiting +for a gear_state_publisher'),
    ],
)
def test_a_terminal_shows_what_is_recorded_or_waited_for(heard, said):
    stops = iter([False, True])
    recorder = SimpleNamespace(poll=lambda: None, absent='', heard=heard)
    console = Console(file=io.StringIO(), force_terminal=True, color_system=None)
    show_recording(recorder, console, lambda: next(stops))
    assert re.search(said, console.file.getvalue())


def test_line_says_all_of_a_moment():
    assert line([Entry('0%', 'Turn it.'), Entry('heard', '1')]) == '0% Turn it; heard 1'
    assert line(rows_of(FULL)) == (
        '/left/gear_state_publisher connected (All is well.); output angle 12.5° (0.2 rad); '
        'input 0 Hz; rotor input error: m\\x1b[2J<img src=x onerror=alert(1)> '
        '(m\\x1b[2J<img src=x onerror=alert(1)>)'
    )


def test_narrow_table_cuts_nothing():
    rows = rows_of(FULL)[:3]
    said = ''.join(f'{row.name}{row.value}{row.detail}' for row in rows)
    shown = printed(table(rows), width=30)
    assert sorted(''.join(shown.split())) == sorted(''.join(said.split()))


def test_names_do_not_reach_the_terminal_raw(capsys):
    shown = printed(table(rows_of(FULL))) + line(rows_of(FULL))
    list_drivers([DriverTopic('/odd', (HOSTILE,), 1.0)], Console())
    assert '\x1b' not in shown.replace('\x1b[0m', '') + capsys.readouterr().out


# The thread of ROS


@pytest.mark.live
def test_watcher_goes_on_after_what_it_cannot_show(monkeypatch):
    def broken(*_, **__):
        raise OverflowError('too odd')

    monkeypatch.setattr('gear_kinematics.watch.watcher._SEARCH', 0.0)
    with Watcher() as going_on:
        monkeypatch.setattr('gear_kinematics.watch.watcher.view_of', broken)
        wait_until(lambda: going_on.view.state == 'fault', 'the fault')
        assert going_on.view.message == 'The messages cannot be shown: OverflowError: too odd'
        monkeypatch.undo()
        wait_until(lambda: going_on.view.state == 'no node', 'its end')


@pytest.fixture(scope='module')
def running():
    with Watcher() as watcher:
        yield watcher


@pytest.mark.live
def test_watcher_tells_what_has_ended_it(monkeypatch):
    def broken(_):
        raise RuntimeError('the middleware is gone')

    monkeypatch.setattr('gear_kinematics.watch.watcher.Graph', broken)
    ended = Watcher()
    with pytest.raises(RuntimeError, match='the middleware is gone'), ended:
        wait_until(lambda: ended.ended, 'the end')


def test_watcher_that_cannot_join_says_why(monkeypatch):
    def broken(_):
        raise RuntimeError('no shared memory')

    monkeypatch.setattr('gear_kinematics.watch.watcher.replay_node', broken)
    with pytest.raises(RuntimeError, match='no shared memory'), Watcher():
        pass


JOINTS = {'rotor': ['/j', 'm'], 'output': ['/j', 'o']}


@pytest.mark.live
@pytest.mark.parametrize(('command', 'answer'), [
    ({'do': 'home'}, 'No node is ready.'), ({'do': 'undo'}, 'There is nothing to undo.'),
    ({'do': 'write'}, 'This command is not possible now.'),
    ({'do': 'exit'}, 'This command is not possible now.'),
    ({'do': 'commission', **JOINTS, 'output': []}, 'This command is not possible now.'),
    ([], 'This command is not possible now.'),
    ({'do': 'commission', **JOINTS, 'output': ['/j', 'm']}, 'Choose two joints: that of'),
    ({'do': 'commission', **JOINTS, 'ratio': 'x'}, 'a gear ratio must be an integer'),
])  # fmt: skip
def test_what_cannot_be_done_is_answered(running, command, answer):
    text, done = running.ask(command).result(DEADLINE)
    assert (text[: len(answer)], done) == (answer, False)


@pytest.mark.parametrize(
    ('question', 'keys', 'revisions'),
    [('Home it?', 'hy', [7]), ('Home it?', 'hny', []), ('Home it?', 'y', []), ('', 'h', [0])],
)
def test_keys_home_nothing_without_a_question(monkeypatch, question, keys, revisions):
    watcher = WatcherStandIn(View(question=question, revision=7))
    monkeypatch.setattr(
        'gear_kinematics.watch.text._show', lambda _, __, frame: [*map(frame, keys)]
    )
    show(watcher, Console(), bool)
    assert [asked['revision'] for asked in watcher.asked] == revisions


@pytest.mark.parametrize('revision', [None, 6, 7])
@pytest.mark.parametrize('do', ['home', 'undo', 'apply'])
def test_command_to_another_gear_or_zero_than_its_page_shows_is_refused(do, revision):
    done = []
    watcher = Watcher()
    watcher._gear = gear_node(
        homing=SimpleNamespace(service_is_ready=lambda: True),
        home=lambda _: done.append('home'),
        set=lambda values, *_: done.append(*values),
    )
    watcher.view = View(undo='rotor_zero 0')
    watcher._gear.earlier = {'undo': 0.0}
    watcher._live = SimpleNamespace(changes=lambda _: {'apply': 1.0})
    command = {'do': do} | ({'revision': revision} if revision else {})
    if revision == watcher._gear.revision:
        watcher._do(command, Future())
    else:
        with pytest.raises(ValueError, match='Nothing was done: /left/gear_state_publisher or'):
            watcher._do(command, Future())
    assert done == [do] * (revision == 7)


@pytest.mark.parametrize(
    ('command', 'hears', 'actuator'),
    [({}, True, 'elbow'), ({}, False, ''), ({'actuator': 'wrist'}, True, 'wrist')],
)
def test_file_is_that_of_an_arm_if_the_gear_is_of_one(command, hears, actuator):
    one = replace(NodeParameters.load(), rotor_joint='m1')
    arm = {'shoulder': one, 'elbow': replace(one, rotor_joint='m2')}
    written, watcher = [], Watcher()
    watcher._gears = [gear_node(hears=lambda _: True), gear_node(arm=arm, hears=lambda _: hears)]
    watcher._live = SimpleNamespace(
        request=SimpleNamespace(rotor=Channel('/j', 'm2')), write=written.append
    )
    watcher._do({'do': 'write', **command}, Future())
    assert written == [actuator]


@pytest.mark.live
def test_command_that_fails_in_an_unexpected_way_ends_nothing(running, monkeypatch):
    def broken(*_):
        raise TypeError('no such thing')

    with monkeypatch.context() as patch:
        patch.setattr(Watcher, '_do', broken)
        answer = running.ask({'do': 'home'}).result(DEADLINE)
    assert answer == ('That failed: TypeError: no such thing', False)
    assert running.ask({'do': 'home'}).result(DEADLINE)[0] == 'No node is ready.'


# gearkin init


@pytest.fixture
def listening(monkeypatch, tmp_path):
    """Run in an empty folder, beside two drivers."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(drivers, 'listen', lambda: list(DRIVERS))
    return tmp_path


JOINTS = 'Repeat with --joint, and its topic if needed: brake, m1 on /motor/joint_states'
JOINTS += '; gearkin init --arm sets up all'
ROTOR = f'which joint is the rotor? {JOINTS}'
MEANT = 'did you mean `/motor/joint_states`?'
RATIO = '--ratio wrist 1=-19 or --teeth 80/76; if it is no motor, name the motors by --joint'
RATIOS = '--arm', '--ratio'
SHOULDER = 'did you mean `shoulder`? there are: 2, shoulder, wrist 1'
REMAP = 'Repeat with --topic, or remap all drivers to one: '
TOPICS = '/arm/motors, /left/output_state'
ARM = (
    DriverTopic('/arm/motors', ('shoulder', 'wrist 1', '2'), 250.0),
    DriverTopic('/left/output_state', ('shoulder',), 250.0),
)
OTHER = DriverTopic('/b', ('m2',), 9.0)
ALIKE = DriverTopic('/b', ('m.2', 'm_2'), 9.0)


@pytest.mark.parametrize(
    ('heard', 'arguments', 'cause'),
    [
        ([], [], 'is the driver running, with the same ROS_DOMAIN_ID?'),
        (DRIVERS, [], ROTOR),
        (DRIVERS, ['--joint', 'm11'], f"no joint 'm11'; did you mean `m1`? {JOINTS}"),
        (DRIVERS, ['--topic', 'motor/joint_state'], f'on /motor/joint_state; {MEANT} {JOINTS}'),
        (DRIVERS, ['--topic', '/odd'], f'no joint on /odd. {JOINTS}'),
        (DRIVERS, ['--joint', 'm1', 'brake'], '--joint takes several joints only with --arm'),
        (DRIVERS, ['--joint', 'm1'], 'gear? Give it, such as --ratio -19 or --teeth 80/76'),
        (ARM, [*RATIOS, 'shoulder=-3'], f'of wrist 1? Give it, such as {RATIO}'),
        (ARM, [*RATIOS, 'sholder=-3'], f"--ratio: no joint 'sholder'; {SHOULDER}"),
        (ARM, [*RATIOS, '-3', '-5'], 'one for each, such as m1=-19'),
        (ARM, ['--arm', '--actuator', 'shoulder'], 'leave out --actuator'),
        (ARM, ['--arm', '--joint', 'sholder'], f"no joint 'sholder'; {SHOULDER}"),
        (DRIVERS[1:], [*RATIOS, '3'], f'of the arm? {REMAP}none with joints'),
        ([DRIVERS[0], OTHER], [*RATIOS, '3'], f'{REMAP}/b, /motor/joint_states'),
        (ARM, [*RATIOS, '3', '--topic', '/arm'], f'did you mean `/arm/motors`? {REMAP}{TOPICS}'),
        ([ALIKE], [*RATIOS, '3'], 'nearly the same name: add each with --actuator'),
    ],
)
def test_init_says_why_it_writes_nothing(listening, monkeypatch, heard, arguments, cause):
    monkeypatch.setattr(drivers, 'listen', lambda: list(heard))
    assert refusal('init', *arguments, report='.*').endswith(cause)
    assert not list(listening.iterdir())


@pytest.mark.usefixtures('listening')
def test_init_names_a_missing_folder_before_it_listens():
    named = ['-o', 'nowhere/a.yaml', '--joint', 'm1', '--ratio', '-19']
    assert refusal('init', *named) == 'nowhere/a.yaml: No such file or directory'


def test_init_writes_what_is_named(listening, capsys):
    joint = '--topic', '/motor/joint_states', '--joint', 'm1'
    assert main(['init', *joint, '-o', 'a b.yaml', '--ratio', '50.5']) == 0
    written = NodeParameters.load(listening / 'a b.yaml')
    assert (written.rotor_joint, written.gear_ratio) == ('m1', '101/2')
    command = "gear_state_publisher --ros-args --params-file 'a b.yaml' -r rotor_state:="
    said = capsys.readouterr().out
    assert '/motor/joint_states: brake, m1 at 1000 Hz\n' in said
    assert f'{command}/motor/joint_states\n' in said


def test_joints_of_a_topic_are_those_of_all_its_drivers(monkeypatch):
    """Whichever of them is heard first, or last."""
    heard = [['m5', 'm6'], ['m1', 'm2'], ['m5', 'm6']]
    messages = [('/motors', 1, rotor_bytes(1, names, [0.0, 0.0])) for names in heard]
    listener = SimpleNamespace(
        look=list, poll=lambda: messages, heard={'/motors': SimpleNamespace(mean_rate=300.0)},
        drivers=lambda: [DriverTopic('/motors', ('m5', 'm6'), 100.0)],
    )  # fmt: skip
    monkeypatch.setattr(drivers, 'Listener', lambda _: listener)
    monkeypatch.setattr(drivers, 'replay_node', nullcontext)
    monkeypatch.setattr(drivers, 'Graph', lambda _: SimpleNamespace(drivers=list))
    [found] = drivers.listen(0.01)
    assert (found.joints, found.rate) == (('m1', 'm2', 'm5', 'm6'), 300.0)


def test_init_sets_up_all_motors_of_an_arm(listening, monkeypatch, capsys):
    monkeypatch.setattr(drivers, 'listen', lambda: list(ARM))
    file, ratios = listening / 'arm.yaml', ['-101', 'wrist 1=50.5']
    all_motors = ['init', '--arm', '-o', 'arm.yaml', '--ratio', *ratios]
    assert main(all_motors) == 0
    assert {
        name: (each.rotor_joint, each.gear_ratio) for name, each in load_actuators(file).items()
    } == {
        'shoulder': ('shoulder', '-101'),
        'wrist_1': ('wrist 1', '101/2'),
        'joint_2': ('2', '-101'),
    }
    command = 'gear_state_publisher --ros-args --params-file arm.yaml -r rotor_state:=/arm/motors'
    assert command in (said := capsys.readouterr().out)
    assert 'arm.yaml: added shoulder, wrist_1, joint_2. Start the node:' in said
    assert f'{command}\n' in file.read_text('utf-8')
    one = ['init', '--actuator', 'hand', '--topic', '/left/output_state', '-o', 'arm.yaml']
    told = refusal(*one, '--teeth', '11/10', report='.*')
    assert "rotor_joint 'shoulder' belongs to shoulder and hand" in told
    monkeypatch.setattr(drivers, 'listen', lambda: list(DRIVERS))
    one = ['init', '--actuator', 'hand', '--joint', 'm1', '-o', 'arm.yaml']
    assert main([*one, '--teeth', '11/10']) == 0
    hand = load_actuators(file)['hand']
    assert (hand.rotor_joint, hand.gear.gear_ratio, hand.ring_teeth) == ('m1', -10, 11)
    assert '# The joint m1 on /motor/joint_states, with the gear ratio -10' in file.read_text()
    both = '/arm/motors, /motor/joint_states'
    assert f'remap the drivers of {both}\n' in capsys.readouterr().err
    monkeypatch.setattr(drivers, 'listen', lambda: list(ARM))
    again = [*all_motors, '--joint', 'shoulder', 'wrist 1']
    assert main(again) == 2
    assert 'arm.yaml: shoulder, wrist_1 are in it already' in capsys.readouterr().err
    before = file.read_text('utf-8')
    monkeypatch.setattr(drivers, 'listen', None)  # before anything is listened to
    assert 'arm.yaml: hand is in it already' in refusal(*one, '--ratio', '3')
    assert file.read_text('utf-8') == before


def test_init_names_no_actuator_like_a_branch_or_a_parameter(listening, monkeypatch):
    axes = DriverTopic('/axes', ('a', 'c', 'loads'), 100.0)
    monkeypatch.setattr(drivers, 'listen', lambda: [axes])
    assert main(['init', '--arm', '--ratio', '-101']) == 0
    made = load_actuators(listening / 'actuator.yaml')
    assert {name: each.rotor_joint for name, each in made.items()} == {
        'joint_a': 'a', 'c': 'c', 'joint_loads': 'loads',
    }  # fmt: skip


def test_init_leaves_out_what_is_no_motor(listening, monkeypatch):
    others = DriverTopic('/hand', ('finger',), 100.0)
    monkeypatch.setattr(drivers, 'listen', lambda: [*ARM, others])
    assert main(['init', '--arm', '--ratio', 'shoulder=-101', '--joint', 'shoulder']) == 0
    made = load_actuators(listening / 'actuator.yaml')
    assert [each.rotor_joint for each in made.values()] == ['shoulder']


def test_init_asks_for_the_ratio_of_each_joint(listening, monkeypatch, capsys):
    """Enter repeats the last one; after a typing error it asks again."""
    monkeypatch.setattr(drivers, 'listen', lambda: list(ARM))
    monkeypatch.setattr(init, 'can_ask', lambda: True)
    answers = iter(['', 'abc', '-101', '', '0', '50.5'])
    monkeypatch.setattr('builtins.input', lambda question: print(question) or next(answers))
    assert main(['init', '--arm']) == 0
    told = capsys.readouterr()
    assert 'ratio of the gear of wrist 1, such as 1457/26, negative if' in told.out
    assert told.out.count(' (Enter: -101): ') == 3
    assert re.findall("a gear ratio must .*, not '(.*)'", told.err) == ['', 'abc', '0']
    ratios = [each.gear_ratio for each in load_actuators(listening / 'actuator.yaml').values()]
    assert ratios == ['-101', '-101', '101/2']


@pytest.mark.parametrize('answers', [['2'], ['m1'], ['m2', '3', '2']])
def test_init_takes_the_number_or_the_name_of_a_joint(listening, monkeypatch, capsys, answers):
    monkeypatch.setattr(joints, 'can_ask', lambda: True)
    given = iter(answers)
    monkeypatch.setattr('builtins.input', lambda _: next(given))
    assert main(['init', '--ratio', '-19']) == 0
    told = capsys.readouterr()
    assert '  2  m1 on /motor/joint_states\n' in told.out
    assert re.findall("'(.*)' is not a number from 1 to 2", told.err) == answers[:-1]
    [written] = listening.iterdir()
    assert NodeParameters.load(written).rotor_joint == 'm1'


def test_init_without_an_answer_writes_nothing(listening, monkeypatch):
    monkeypatch.setattr(init, 'can_ask', lambda: True)
    monkeypatch.setattr('sys.stdin', io.StringIO())  # as after Ctrl-D
    told = refusal('init', '--joint', 'm1', report='.*')
    assert 'no answer was given, and nothing is written' in told
    assert not list(listening.iterdir())


@pytest.mark.usefixtures('listening')
def test_init_questions_velocities_that_contradict_the_positions(monkeypatch, capsys):
    moving = [
        ('/motor', t, rotor_bytes(t, ['m1'], [5e-8 * t], [-50.0 / 19.0]))
        for t in range(10_000_000, 2_000_000_000, 10_000_000)
    ]
    monkeypatch.setattr(drivers, 'listen', lambda: [DriverTopic('/motor', ('m1',), 99.0, moving)])
    assert main(['init', '--joint', 'm1', '--ratio', '-19']) == 0
    seem = 'the velocities contradict the positions: they seem to be the velocity of the output'
    assert capsys.readouterr().err == f'gearkin: /motor: {seem}\n'


FEW = (
    ': 100 Hz is too slow to count turns at a max_rotor_speed of 650 rad/s: lower it to 251 rad/s'
)


@pytest.mark.usefixtures('listening')
@pytest.mark.parametrize(
    ('speed', 'period', 'written', 'said'),
    [
        (40.0, math.tau, ('single_turn', 0.0), [': 13 wraps of a turn', FEW]),
        (99.0, 25.0, ('multi_turn', 25.0), [': 8 wraps of 25 rad']),
        (0.5, math.tau, ('multi_turn', 0.0), ['to be multi_turn: the rotor turned 0.1']),
        (
            900.0,
            359.99,
            ('multi_turn', 0.0),
            ['multi_turn: 5 wraps of 360, as if in degrees: let the driver send rad'],
        ),
        (40.0, 1e6, ('multi_turn', 0.0), []),
    ],
)
def test_init_finds_the_encoder_where_the_rotor_turned_enough(
    monkeypatch, capsys, speed, period, written, said
):
    moving = [
        ('/motor', stamp, rotor_bytes(stamp, ['m1'], [math.remainder(speed * 0.01 * k, period)]))
        for k in range(1, 200)
        if (stamp := k * 10_000_000)
    ]
    monkeypatch.setattr(drivers, 'listen', lambda: [DriverTopic('/motor', ('m1',), 99.0, moving)])
    assert main(['init', '--joint', 'm1', '--ratio', '-19']) == 0
    config = NodeParameters.load(Path('actuator.yaml'))
    assert (config.rotor_encoder, config.rotor_encoder_range) == written
    lines = capsys.readouterr().err.splitlines()
    assert [text in line for line, text in zip(lines, said, strict=True)] == [True] * len(said)


# The server


@pytest.fixture
def watcher() -> WatcherStandIn:
    return WatcherStandIn(FULL)


@asynccontextmanager
async def serving(watcher):
    server = Server(watcher)
    ended = False
    task = asyncio.create_task(server.run(lambda: ended))
    try:
        yield server.address
    finally:
        ended = True
        await task


async def fetch(url, **headers) -> tuple[int, str, dict]:
    request = HTTPRequest(url, headers=headers, request_timeout=DEADLINE)
    answer = await AsyncHTTPClient().fetch(request, raise_error=False)
    return answer.code, answer.body.decode(), answer.headers


@asynccontextmanager
async def connected(address):
    url = address.replace('http', 'ws', 1) + 'live'
    request = HTTPRequest(url, headers={'Origin': origin_of(address)})
    connection = await tornado_websocket.websocket_connect(request)
    yield connection
    connection.close()
    while connection.close_code is None and await connection.read_message() is not None:
        pass


async def answer_to(command, connection):
    await connection.write_message(command, binary=isinstance(command, bytes))
    while 'answer' not in (message := json.loads(await connection.read_message())):
        pass
    return message['answer']


async def refused(address, **headers) -> bool:
    """Whether neither the page nor the WebSocket is to be had."""
    code, text, _ = await fetch(address, **headers)
    assert (code == 403) == ('script' not in text)
    return code == 403 == await handshake(address, **headers)


async def handshake(address, **headers) -> int:
    """Ask for a WebSocket, and give the status of the answer."""
    asked = {'Upgrade': 'websocket', 'Connection': 'Upgrade', 'Sec-WebSocket-Version': '13'}
    asked |= {'Sec-WebSocket-Key': 'dGhlIHNhbXBsZSBub25jZQ=='}
    return (await fetch(f'{address}live', **asked, **headers))[0]


def origin_of(address: str) -> str:
    return address.rsplit('/', 2)[0]


def served(check):
    """Make a test of a coroutine that takes the address of a server."""

    def test(watcher):
        async def run():
            async with serving(watcher) as address:
                await check(address)

        asyncio.run(run())

    return test


@served
async def test_page_comes_with_the_token_of_its_address(address):
    assert re.fullmatch(r'http://127\.0\.0\.1:\d+/[\w-]{32}/', address)
    code, page, _ = await fetch(address)
    assert code == 200
    assert '<title>gearkin watch</title>' in page
    assert f'connect-src ws://{origin_of(address)[7:]}' in page
    assert not re.findall(r'(?:src|href)="(?!data:,")', page)
    again = Server(WatcherStandIn(FULL))
    assert again.address.split('/')[3] != address.split('/')[3]
    again._socket.close()


@served
async def test_wrong_token_is_refused(address):
    origin = origin_of(address)
    for token in ('wrong', address.split('/')[3][:-1], '%00', 'é'):
        assert await refused(f'{origin}/{token}/', Origin=origin)
    assert (await fetch(f'{origin}/'))[0] == 404


@served
async def test_other_origin_is_refused(address):
    origin = origin_of(address)
    for other in ('http://evil.example', 'null', 'http://127.0.0.1:1', f'{origin}.evil'):
        assert await refused(address, Origin=other)
    assert await handshake(address) == 403  # a browser names its origin
    async with connected(address):
        pass


@served
async def test_other_host_is_refused(address):
    port = origin_of(address).rpartition(':')[2]
    for host in ('evil.example', f'evil.example:{port}', '127.0.0.1.evil.example', '['):
        assert await refused(address, Host=host, Origin=f'http://{host}')
    # As through a forwarded port.
    for host in ('localhost:8000', f'127.0.0.1:{port}'):
        code, page, _ = await fetch(address, Host=host)
        assert code == 200
        assert f'connect-src ws://{host}"' in page


@served
async def test_page_is_neither_kept_nor_framed(address):
    for path in (address, f'{origin_of(address)}/wrong/'):
        _, _, headers = await fetch(path)
        assert headers['Cache-Control'] == 'no-store'
        assert headers['Content-Security-Policy'] == "frame-ancestors 'none'"
        assert headers['Referrer-Policy'] == 'no-referrer'
        assert 'Server' not in headers


@served
async def test_views_come_at_most_thirty_times_a_second_after_the_drawing(address):
    async with connected(address) as connection:
        first = json.loads(await connection.read_message())
        assert first['drawing'].count('<use ') == 5
        view = json.loads(await connection.read_message())['view']
        assert view['values'][0] == {
            'name': 'output angle', 'value': '12.5°', 'detail': '0.2 rad', 'tone': '',
        }  # fmt: skip
        assert view['joints'] == [['/motor/joint_states', 'brake'], ['/motor/joint_states', 'm1']]
        begin, count = time.monotonic(), 0
        while count < 10:
            count += 'view' in json.loads(await connection.read_message())
        assert count <= 1 + 30.0 * (time.monotonic() - begin)


def test_buttons_ask_the_watcher_and_show_its_answer(watcher):
    home = {'do': 'home'}

    async def run():
        async with serving(watcher) as address, connected(address) as connection:
            answer = await answer_to(json.dumps(home), connection)
            assert answer == {'text': 'home.', 'done': True}
            for command in ('', b'\xff', 4000 * '['):
                answer = await answer_to(command, connection)
                assert answer == {'text': 'There is no such command.', 'done': False}
            assert watcher.asked == [home]
            await connection.write_message(json.dumps({'do': 5000 * 'x'}))
            while await connection.read_message() is not None:
                pass
            assert connection.close_code == 1009  # too large

    asyncio.run(run())


@served
async def test_large_body_is_refused_before_it_is_read(address):
    _, host, port = origin_of(address).split(':')
    reader, writer = await asyncio.open_connection(host[2:], int(port))
    writer.write(b'POST /wrong/ HTTP/1.1\r\nHost: localhost\r\nContent-Length: 5000\r\n\r\n')
    assert (await reader.read()).startswith(b'HTTP/1.1 400')
    writer.close()


def test_node_that_does_not_answer_is_said(watcher, monkeypatch):
    monkeypatch.setattr(server, '_ANSWER', 0.1)
    watcher.ask = lambda _: Future()

    async def run():
        async with serving(watcher) as address, connected(address) as connection:
            answer = await answer_to('{"do": "home"}', connection)
            assert answer == {'text': UNANSWERED, 'done': False}

    asyncio.run(run())


def test_page_that_is_closed_before_the_answer_leaves_no_trace(watcher, caplog):
    pending = Future()
    watcher.ask = lambda command: watcher.asked.append(command) or pending

    def running(name):
        return any(name in repr(task) for task in asyncio.all_tasks())

    async def until(condition):
        while not condition():  # noqa: ASYNC110, the server says nothing
            await asyncio.sleep(0.01)

    async def run():
        async with serving(watcher) as address, connected(address) as connection:
            await connection.write_message('{"do": "home"}')
            await until(lambda: watcher.asked)
            connection.protocol.stream.close()
            await until(lambda: not running('_send'))
            pending.set_result(Answer('done', done=True))
            await until(lambda: not running('on_message'))

    asyncio.run(run())
    assert not caplog.records


def test_of_a_ratio_there_is_no_drawing():
    assert drawing(None, 0.0) == ''  # which leaves its room to the curve
