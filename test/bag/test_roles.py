# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Finding the topics of a recording by their names and types."""

from functools import partial
from pathlib import Path
from types import SimpleNamespace

import pytest
from live import rotor_bytes
from shipped_bags import write_bag

from gear_kinematics.bag import Bag, BagError
from gear_kinematics.bag.roles import (
    Topics,
    find_encoder_topic,
    find_rotor_topic,
    find_topics,
    joints_on,
)
from gear_kinematics.bag.writing import BagWriter

JOINT_STATE, POSE_ARRAY = 'sensor_msgs/msg/JointState', 'geometry_msgs/msg/PoseArray'


def described(topics: dict[str, str]) -> SimpleNamespace:
    """What a bag says about its topics, which have no messages."""
    bag = SimpleNamespace(path=Path('some.mcap'), topics=topics, not_cdr=(), joints={})
    bag.messages = lambda _: iter(())
    bag.type_of = partial(Bag.type_of, bag)
    return bag


def bag_with(joint_states: str, pose_arrays: str = '') -> SimpleNamespace:
    kinds = dict.fromkeys(joint_states.split(), JOINT_STATE)
    kinds |= dict.fromkeys(pose_arrays.split(), POSE_ARRAY)
    return described(kinds | {'/rosout': 'rcl/msg/Log'})


@pytest.mark.parametrize(
    ('joint_states', 'pose_arrays', 'given', 'found'),
    [
        ('/rotor_state /output_state', '/body_poses', {}, Topics()),
        (
            '/arm/rotor_state /arm/output_state /arm/mechanism_joint_states /joint_states',
            '/arm/body_poses /markers',
            {},
            Topics('/arm/rotor_state', '/arm/output_state', '/arm/body_poses'),
        ),
        # By type alone.
        ('/motor /output_state', '/p', {}, Topics('/motor', '/output_state', '/p')),
        ('/rotor_state /shaft', '/p', {}, Topics('/rotor_state', '/shaft', '/p')),
        # Those that are named are none of the others.
        ('/a /b', '/p', {'rotor': '/a'}, Topics('/a', '/b', '/p')),
        ('/a /b', '/p', {'output': '/a'}, Topics('/b', '/a', '/p')),
        ('/a /b', '/p /q', {'rotor': '/a', 'poses': '/q'}, Topics('/a', '/b', '/q')),
        (
            '/rotor_state /output_state /old/output_state',
            '/body_poses',
            {'output': '/old/output_state'},
            Topics('/rotor_state', '/old/output_state', '/body_poses'),
        ),
        # Two drivers: the one beside the outputs.
        (
            '/left/m /right/m /left/output_state',
            '',
            {},
            Topics('/left/m', '/left/output_state', ''),
        ),
        # Two nodes: those beside the one that is named.
        (
            '/left/rotor_state /left/output_state /right/rotor_state /right/output_state',
            '/left/body_poses /right/body_poses',
            {'rotor': '/right/rotor_state'},
            Topics('/right/rotor_state', '/right/output_state', '/right/body_poses'),
        ),
        (
            '/left/rotor_state /left/output_state /output_state',
            '/left/body_poses',
            {'rotor': '/left/rotor_state', 'output': '/output_state'},
            Topics('/left/rotor_state', '/output_state', '/left/body_poses'),
        ),
    ],
)
def test_topics_are_found_by_name_then_by_type(joint_states, pose_arrays, given, found):
    assert find_topics(bag_with(joint_states, pose_arrays), given) == found
    if not given:
        assert find_topics(bag_with(joint_states, pose_arrays)) == found


NO_OUTPUT = f'no topic output_state of type {JOINT_STATE} in it; there are: '
NO_ROTOR = f'no topic rotor_state of type {JOINT_STATE} in it; there are: '
NO_MOTOR = f'no topic /motor of type {JOINT_STATE} in it; there are: '
NEARLY = f'no topic /rotor_stat of type {JOINT_STATE} in it; did you mean `/rotor_state`? '
NEARLY += 'there are: '
NO_POSES = f'topic /output_state is of type {JOINT_STATE}, not {POSE_ARRAY}; '
NO_POSES += 'there are: '
WHICH_OUTPUT = 'which topic is output_state? /left/output_state, /output_state; name it with '
WHICH_OUTPUT += '--output-topic, or its node with --node'
WHICH_ROTOR = 'which topic is rotor_state? /left/rotor_state, /right/rotor_state; name it with '
WHICH_ROOT = 'which topic is rotor_state? /a/m, /m; name it with '
WHICH_POSES = 'which topic is body_poses? /elbow/body_poses, /hand/body_poses; name it with '
WHICH_POSES += '--poses-topic, or give the parameter file of an arm with --config'
BOTH = '/rotor_state /output_state'
LEFT = '/output_state, /rotor_state, /body_poses, /rosout'


@pytest.mark.parametrize(
    ('joint_states', 'poses', 'given', 'error'),
    [
        ('/rotor_state', '/p', {}, f'{NO_OUTPUT}/rotor_state, /p, /rosout'),
        ('/output_state', '/p', {}, f'{NO_ROTOR}/output_state, /p, /rosout'),
        ('/arm/m /left/output_state /output_state', '/p', {}, WHICH_OUTPUT),
        ('/left/rotor_state /right/rotor_state /o', '/p', {}, f'{WHICH_ROTOR}--rotor-topic'),
        ('/b /a', '/p', {}, 'which topic is rotor_state? /a, /b; name it with --rotor-topic'),
        (BOTH, '/elbow/body_poses /hand/body_poses', {}, WHICH_POSES),
        ('/m /a/m /output_state', '/p', {}, f'{WHICH_ROOT}--rotor-topic'),
        (BOTH, '/body_poses', {'rotor': '/motor'}, NO_MOTOR + LEFT),
        (BOTH, '/body_poses', {'rotor': '/rotor_stat'}, NEARLY + LEFT),
        (
            BOTH,
            '/body_poses',
            {'poses': '/output_state'},
            f'{NO_POSES}/body_poses, /output_state, /rosout, /rotor_state',
        ),
    ],
)
def test_a_topic_that_is_not_found_is_named_with_its_bag(joint_states, poses, given, error):
    with pytest.raises(BagError) as raised:
        find_topics(bag_with(joint_states, poses), given)
    assert str(raised.value) == f'some.mcap: {error}'


def test_outputs_are_no_rotor_where_only_that_is_wanted():
    names = '/output_state /motor /mechanism_joint_states'
    assert find_topics(bag_with(names), outputs=False).rotor == '/motor'


def test_poses_are_not_looked_for_where_there_are_none():
    found = find_topics(bag_with('/m/rotor_state /m/output_state'), poses=False)
    assert (found.rotor, found.output) == ('/m/rotor_state', '/m/output_state')


@pytest.mark.parametrize(
    ('name', 'cause'), [('/b', ' in it;'), ('/motor', f'of unknown type, not {JOINT_STATE};')]
)
def test_topics_without_a_type_are_said_to_have_none(name, cause):
    bag = described({'/motor': '', '/a': JOINT_STATE})
    missing = f'{cause} there are: /a, /motor; some have no recorded type, as channels .*$'
    with pytest.raises(BagError, match=missing):
        bag.type_of(name, JOINT_STATE)


@pytest.mark.parametrize(
    ('given', 'error'),
    [
        ({}, f'{NO_ROTOR}/rotor_state (not CDR), /rosout'),
        ({'rotor': '/rotor_state'}, f'of type {JOINT_STATE} (not CDR), not {JOINT_STATE};'),
    ],
)
def test_that_the_messages_of_a_topic_are_json_is_the_cause(given, error):
    bag = bag_with('/rotor_state')
    bag.not_cdr = {'/rotor_state', '/rosout'}  # as most topics of ROS 1
    with pytest.raises(BagError) as raised:
        find_topics(bag, given, outputs=False)
    assert error in str(raised.value)


def test_topics_of_the_wanted_type_are_named_first():
    bag = described({'/a': 'x/msg/X', '/wheel': JOINT_STATE, '/moto': 'x/msg/X'})
    with pytest.raises(BagError, match=r'in it; there are: /wheel, /a, /moto$'):
        bag.type_of('/motor', JOINT_STATE)
    assert bag.type_of('/wheel', JOINT_STATE) == bag.type_of('/wheel') == JOINT_STATE


@pytest.mark.parametrize(
    ('joint_states', 'given', 'found'),
    [
        ('/arm/rotor_state', None, ''),
        ('/arm/rotor_state /output_encoder', None, '/output_encoder'),
        ('/arm/rotor_state /output_encoder /arm/output_encoder', None, '/arm/output_encoder'),
        ('/arm/rotor_state /shaft', '/shaft', '/shaft'),
    ],
)
def test_the_encoder_at_the_output_is_found_by_name(joint_states, given, found):
    assert find_encoder_topic(bag_with(joint_states), '/arm/rotor_state', given) == found


@pytest.mark.parametrize(
    ('joint', 'found'), [('shaft', '/encoder'), ('m1', ''), ('', ''), ('both', '')]
)
def test_an_encoder_of_another_topic_is_found_by_its_joint(tmp_path, joint, found):
    """But not by one that is the rotor's as well, as in commands to a motor."""
    joints = {'/motor': 'm1', '/command': 'm1', '/encoder': 'shaft', '/a': 'both', '/b': 'both'}
    messages = [(topic, 1, rotor_bytes(1, [name], [0.0])) for topic, name in joints.items()]
    with Bag(write_bag(tmp_path / 'bag', messages, dict.fromkeys(joints, JOINT_STATE))) as bag:
        assert find_encoder_topic(bag, '/motor', None, joint) == found


def test_outputs_of_another_node_are_not_those_of_the_one_that_is_named():
    bag = bag_with('/m /output_state /right/output_state', '/body_poses')
    found = find_topics(bag, namespace='/right')
    assert found == Topics('/m', '/right/output_state', '')
    with pytest.raises(BagError, match=r'no topic /left/output_state .* there are'):
        find_topics(bag, namespace='/left')
    # Others can be those of the node, by other names.
    assert find_topics(bag_with('/rotor_state /shaft'), namespace='/left').output == '/shaft'


def test_joints_are_looked_up_once(tmp_path):
    """In the whole recording, as no message is on one of the topics."""
    messages = [('/motor', 1, rotor_bytes(1, ['m1'], [0.0]))]
    topics = {'/motor': ['m1'], '/silent': []}
    bag = Bag(write_bag(tmp_path / 'bag', messages, dict.fromkeys(topics, JOINT_STATE)))
    assert joints_on(bag, [*topics]) == topics
    bag.messages = None
    assert joints_on(bag, [*topics]) == topics
    assert joints_on(bag, []) == {}


def test_the_topic_with_most_rotors_is_theirs_even_if_each_message_has_one(tmp_path):
    """Encoders at two outputs have the names of their rotors."""
    with BagWriter(tmp_path / 'arm') as writer:
        for topic in ('/encoders', '/motors'):
            writer.add_topic(topic, JOINT_STATE)
        for number, name in enumerate(['m1', 'm2', 'm3']):
            both = rotor_bytes(number, ['m1', 'm3'], [0.0, 0.0])
            one = rotor_bytes(number, [name], [0.0])
            writer.write_all([('/encoders', number, both), ('/motors', number, one)])
    with Bag(tmp_path / 'arm') as bag:
        assert find_rotor_topic(bag, None, 'm1', 'm2', 'm3') == '/motors'
        which = r'\? /encoders \(joints m1, m3\), /motors \(joints m1, m2, m3\)'
        with pytest.raises(BagError, match=which):
            find_rotor_topic(bag, None, 'm3')
