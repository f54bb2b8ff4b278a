# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Viewers of the mechanism: launch files, RViz's configuration, Foxglove's layout."""

import ast
import json
import runpy
import xml.etree.ElementTree as ET
from collections.abc import Iterator
from pathlib import Path

import pytest
import yaml

from gear_kinematics.ros.node import GearStatePublisher

ROOT = Path(__file__).resolve().parents[2]
LAUNCH_FILES = sorted((ROOT / 'launch').glob('*.launch.py'))


def nodes_of(tree) -> Iterator[dict]:
    """Yield every mapping in a document."""
    if isinstance(tree, dict):
        yield tree
    for child in tree.values() if isinstance(tree, dict) else tree:
        if isinstance(child, (dict, list)):
            yield from nodes_of(child)


@pytest.fixture(scope='module')
def rviz() -> dict:
    return yaml.safe_load((ROOT / 'config/view.rviz').read_text('utf-8'))


@pytest.fixture(scope='module')
def foxglove() -> dict:
    return json.loads((ROOT / 'config/foxglove.json').read_text('utf-8'))


@pytest.fixture(scope='module')
def topics(context) -> dict[str, str]:
    """Return the types of the node's outputs by topic, for a node without a namespace."""
    node = GearStatePublisher(context=context)
    found = {publisher.topic_name: publisher.msg_type.__name__ for publisher in node.publishers}
    node.destroy_node()
    return found


@pytest.mark.live
def test_rviz_listens_to_topics_of_the_node(rviz, topics):
    displays = rviz['Visualization Manager']['Displays']
    kinds = {'MarkerArray': 'MarkerArray', 'RobotModel': 'String'}
    wanted = {
        f'/{topic["Value"]}': kinds[display['Class'].partition('/')[2]]
        for display in displays
        for name, topic in display.items()
        if name.endswith('Topic')
    }
    assert set(wanted) == {'/markers', '/robot_description'}
    assert wanted.items() <= topics.items()


@pytest.mark.live
@pytest.mark.parametrize('topic', ['markers', 'robot_description'])
def test_rviz_gets_what_was_latched(rviz, topic):
    [qos] = [n for n in nodes_of(rviz) if n.get('Value') == topic]
    assert qos['Durability Policy'] == 'Transient Local'


@pytest.mark.live
def test_foxglove_listens_to_topics_of_the_node(foxglove, topics):
    panels = foxglove['configById']
    shown = {topic for panel in panels.values() for topic in panel.get('topics', {})}
    shown |= {panel['topicToRender'] for panel in panels.values() if 'topicToRender' in panel}
    paths = [p['value'] for panel in panels.values() for p in panel.get('paths', [])]
    plotted = {path.partition('.')[0] for path in paths}
    assert shown == {'/markers', '/diagnostics'}
    assert plotted == {'/output_state'}
    assert {path.partition('.')[2] for path in paths} <= {'position[0]', 'velocity[0]'}
    assert shown | plotted <= set(topics)


@pytest.mark.live
def test_plotjuggler_plots_joints_of_topics_of_the_node_and_what_it_computes_of_them(topics):
    root = ET.parse(ROOT / 'config/plotjuggler.xml').getroot()  # noqa: S314, the project's own
    computed = {snippet.get('name') for snippet in root.iter('snippet')}
    sources = {
        element.text
        for path in ('linked_source', 'additional_sources/*')
        for element in root.iterfind(f'customMathEquations/snippet/{path}')
    }
    shown = {curve.get('name') for curve in root.iter('curve')}
    assert computed < shown
    series = {tuple(name.split('/')[1:]) for name in (shown | sources) - computed}
    names = {'rotor_state': 'rotor'}
    assert all(
        (joint, field) == (names.get(topic, 'output_shaft'), 'position')
        for topic, joint, field in series
    )
    [selected] = root.iter('selected_topics')
    heard = selected.get('value').split(';')
    assert set(heard) == {f'/{topic}' for topic, *_ in series}
    assert set(heard) - {'/rotor_state'} <= {t for t, k in topics.items() if k == 'JointState'}


def test_every_panel_of_foxglove_has_its_place(foxglove):
    halves = [n[side] for n in nodes_of(foxglove['layout']) for side in ('first', 'second')]
    panels = [half for half in halves if isinstance(half, str)]
    assert sorted(panels) == sorted(foxglove['configById'])


def test_both_look_from_the_frame_of_the_stator(rviz, foxglove):
    assert rviz['Visualization Manager']['Global Options']['Fixed Frame'] == 'stator'
    assert foxglove['configById']['3D!mechanism']['followTf'] == 'stator'


def started_packages(path: Path) -> set[str]:
    """The packages whose nodes a launch file starts."""
    return {
        keyword.value.value
        for node in ast.walk(ast.parse(path.read_text('utf-8')))
        if isinstance(node, ast.Call) and getattr(node.func, 'id', '') == 'Node'
        for keyword in node.keywords
        if keyword.arg == 'package'
    }


def test_packages_that_launch_files_start_are_dependencies():
    manifest = ET.parse(ROOT / 'package.xml').getroot()  # noqa: S314, the project's own file
    declared = {element.text for element in manifest.iterfind('exec_depend')}
    started = set().union(*map(started_packages, LAUNCH_FILES))
    assert started == {'gear_kinematics', 'robot_state_publisher', 'rviz2'}
    assert started - {'gear_kinematics'} <= declared


@pytest.mark.parametrize('path', LAUNCH_FILES, ids=lambda path: path.name)
def test_launch_file_loads(path):
    """Needs a system ROS: the wheels have no launch."""
    pytest.importorskip('launch_ros', reason='launch is not installed')
    description = runpy.run_path(str(path))['generate_launch_description']()
    assert description.entities


TWO_NODES = """
/left/gear_state_publisher:
  ros__parameters: {frame_prefix: left_}
/right/gear_state_publisher:
  ros__parameters: {frame_prefix: right_}
"""


@pytest.fixture
def launched(tmp_path):
    """A context with the launch files' arguments; needs a system ROS."""
    pytest.importorskip('launch_ros', reason='launch_ros is not installed')
    context = pytest.importorskip('launch', reason='launch is not installed').LaunchContext()
    config = tmp_path / 'two.yaml'
    config.write_text(TWO_NODES)
    context.launch_configurations.update(
        config=str(config), frame_prefix='', namespace='left', rotor_joint='',
        rotor_state='rotor_state',
        rviz='false', rviz_config='view.rviz', publish_frequency='100',
    )  # fmt: skip
    return context


def described(context, file: str, function: str) -> list:
    """The nodes that a function of a launch file returns."""
    return runpy.run_path(str(ROOT / 'launch' / file))[function](context)


def parameters_of(context, node) -> tuple[dict, ...]:
    """The parameters that a node is started with."""
    launch_ros = pytest.importorskip('launch_ros')
    return launch_ros.utilities.evaluate_parameters(context, node._Node__parameters)


def fixed_frame(context, rviz) -> str:
    """The fixed frame of RViz."""
    launch = pytest.importorskip('launch')
    words = [launch.utilities.perform_substitutions(context, part) for part in rviz.cmd[1:]]
    return words[words.index('-f') + 1]


@pytest.mark.parametrize('side', ['left', 'right'])
def test_viewers_show_the_node_of_their_namespace(launched, side):
    launched.launch_configurations['namespace'] = side
    publisher, rviz = described(launched, 'view.launch.py', 'start_viewers')
    [given] = parameters_of(launched, publisher)
    if not given.get('use_robot_description_topic'):
        robot = ET.fromstring(given['robot_description'])  # noqa: S314, our own
        assert {link.get('name').partition('_')[0] for link in robot.iter('link')} == {side}
    frequency = given['publish_frequency']
    assert (frequency, type(frequency)) == (100.0, float)  # it refuses an integer
    assert fixed_frame(launched, rviz) == f'{side}_stator'
    assert not rviz.condition.evaluate(launched)


def test_simulator_has_the_joint_of_the_node_beside_it(launched):
    launched.launch_configurations.update(rotor_joint='1', executable='gear_simulator')
    [simulator] = described(launched, 'gear_state_publisher.launch.py', 'start_node')
    _, given = parameters_of(launched, simulator)
    assert given == {'rotor_joint': '1'}
