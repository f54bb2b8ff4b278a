# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The arguments with which the launch files start the node, and those they refuse."""

import pytest

from gear_kinematics.parameters import ConfigError, NodeParameters, default_config
from gear_kinematics.ros.launch_arguments import node_arguments, reads_description_topic

NODES = {
    '/gear_state_publisher': 81,
    '/left/gear_state_publisher': 82,
    '/robot/left/gear_state_publisher': 83,
}


@pytest.fixture
def config(tmp_path) -> str:
    path = tmp_path / 'nodes.yaml'
    path.write_text(
        ''.join(
            f"{name}:\n  ros__parameters: {{ring_teeth: {teeth}, frame_prefix: 'own_'}}\n"
            for name, teeth in NODES.items()
        )
    )
    return str(path)


def arguments(config, namespace='', frame_prefix='', rotor_joint='', **above):
    """The arguments of the node in a launch with these configurations, which are all text."""
    given = {'namespace': namespace, 'frame_prefix': frame_prefix, 'rotor_joint': rotor_joint}
    return node_arguments({'config': str(config), **given, **above})


def test_defaults_start_the_default_actuator():
    config, actuators, given = arguments(default_config())
    assert not given
    assert config == default_config()
    assert actuators == {'': NodeParameters.load()}


@pytest.mark.parametrize(
    ('above', 'namespace', 'node'),
    [
        # As launch_ros.utilities.prefix_namespace and make_namespace_absolute make the name.
        (None, '', '/gear_state_publisher'),
        (None, 'left/', '/left/gear_state_publisher'),
        (None, 'robot/left', '/robot/left/gear_state_publisher'),
        ('robot', 'left', '/robot/left/gear_state_publisher'),
        ('/robot/left', '', '/robot/left/gear_state_publisher'),
        ('/robot', '/left', '/left/gear_state_publisher'),
    ],
)
def test_parameters_are_those_of_the_node_in_its_namespace(config, above, namespace, node):
    ros_namespace = {} if above is None else {'ros_namespace': above}
    parameters = arguments(config, namespace, **ros_namespace).actuators['']
    assert parameters.ring_teeth == NODES[node]


def test_given_values_replace_that_of_the_file(config, tmp_path):
    assert arguments(config, 'left').actuators[''].frame_prefix == 'own_'
    found = arguments(config, 'left', 'my_', rotor_joint='0')
    assert (found.actuators[''].frame_prefix, found.actuators[''].rotor_joint) == ('my_', '0')
    assert found.given == {'frame_prefix': 'my_', 'rotor_joint': '0'}
    arm = tmp_path / 'arm.yaml'
    arm.write_text('/**: {ros__parameters: {actuators: [shoulder, elbow]}}')
    assert list(arguments(arm).actuators) == ['shoulder', 'elbow']
    with pytest.raises(ConfigError, match='give frame_prefix of an arm in the file'):
        arguments(arm, frame_prefix='my_')


def test_home_directory_may_be_written_as_in_a_shell(config, tmp_path, monkeypatch):
    monkeypatch.setenv('HOME', str(tmp_path))
    found = arguments('~/nodes.yaml', 'left')
    assert str(found.config) == config
    assert found.actuators[''].ring_teeth == NODES['/left/gear_state_publisher']


def test_file_that_is_not_there_or_without_parameters_of_the_node_is_refused(config):
    with pytest.raises(ConfigError, match=r'nowhere\.yaml: No such file or directory$'):
        arguments('nowhere.yaml')
    with pytest.raises(ConfigError, match='no parameters of /right/gear_state_publisher in it'):
        arguments(config, 'right')


@pytest.mark.parametrize(
    ('version', 'reads'),
    # Of Jazzy, of Kilted before and since its backport, and of Rolling before and since the change
    [('3.3.3', False), ('3.4.3', False), ('3.4.4', True), ('3.5.2', False), ('3.10.0', True)],
)
def test_robot_state_publisher_is_told_how_to_get_the_description(tmp_path, version, reads):
    (tmp_path / 'package.xml').write_text(f'<package><version>{version}</version></package>')
    assert reads_description_topic(tmp_path) == reads
