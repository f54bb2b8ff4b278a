"""The URDF as its readers see it: XML, tree, inertias, and where its joints put the links."""

import math
import xml.etree.ElementTree as ET
from typing import NamedTuple

import numpy as np
import pytest
from geometry_msgs.msg import PoseArray
from hypothesis import given
from hypothesis import strategies as st
from properties import mechanisms
from rclpy.serialization import deserialize_message
from sensor_msgs.msg import JointState

from gear_kinematics.description import joint_names, urdf
from gear_kinematics.kinematics import Branch, Mechanism, split_turns
from gear_kinematics.rotor_input import RotorSample
from gear_kinematics.state_messages import StateMessages

MODULE = 0.0005
NAMES = {'output_joint': 'output_shaft', 'frame_prefix': ''}


class Joint(NamedTuple):
    kind: str
    parent: str
    child: str
    origin: np.ndarray
    axis: np.ndarray


def read(text: str) -> tuple[list[str], dict[str, Joint]]:
    """Read links and joints the way URDF readers do, with the defaults of the format."""
    robot = ET.fromstring(text)  # noqa: S314, the project's own
    assert robot.tag == 'robot'
    joints = {}
    for element in robot.iterfind('joint'):
        origin = element.find('origin')
        xyz = '0 0 0' if origin is None else origin.get('xyz')
        assert origin is None or origin.get('rpy', '0 0 0') == '0 0 0'
        assert element.get('name') not in joints
        joints[element.get('name')] = Joint(
            element.get('type'),
            element.find('parent').get('link'),
            element.find('child').get('link'),
            np.array([float(number) for number in xyz.split()]),
            np.array([float(number) for number in element.find('axis').get('xyz').split()]),
        )
    return [element.get('name') for element in robot.iterfind('link')], joints


def link_poses(joints: dict[str, Joint], positions: dict[str, float]) -> dict[str, np.ndarray]:
    """Forward kinematics: the 4×4 pose of every link in the root's frame."""
    children = {joint.child for joint in joints.values()}
    [root] = {joint.parent for joint in joints.values()} - children
    poses = {root: np.eye(4)}
    while missing := {name for name, joint in joints.items() if joint.child not in poses}:
        for name in missing:
            joint = joints[name]
            if joint.parent in poses:
                poses[joint.child] = poses[joint.parent] @ displacement(joint, positions[name])
    return poses


def displacement(joint: Joint, position: float) -> np.ndarray:
    pose = np.eye(4)
    pose[:3, 3] = joint.origin
    if joint.kind == 'prismatic':
        pose[:3, 3] += position * joint.axis
    else:
        assert joint.axis.tolist() == [0.0, 0.0, 1.0]
        cosine, sine = math.cos(position), math.sin(position)
        pose[:2, :2] = [[cosine, -sine], [sine, cosine]]
    return pose


def test_tree_is_as_documented(actuator):
    links, joints = read(urdf(actuator, module=MODULE, **NAMES))
    assert sorted(links) == [
        'oldham_a', 'oldham_b', 'output_shaft', 'rotor', 'satellite_a', 'satellite_b', 'stator'
    ]  # fmt: skip
    tree = {(joint.parent, joint.child): joint.kind for joint in joints.values()}
    assert tree == {
        ('stator', 'rotor'): 'continuous',
        ('rotor', 'satellite_a'): 'continuous',
        ('rotor', 'satellite_b'): 'continuous',
        ('satellite_a', 'oldham_a'): 'prismatic',
        ('satellite_b', 'oldham_b'): 'prismatic',
        ('stator', 'output_shaft'): 'continuous',
    }
    assert all(name == joint.child for name, joint in joints.items())


def test_prefix_is_on_every_link_and_joint(actuator):
    options = {'output_joint': 'shoulder', 'frame_prefix': 'left/'}
    plain_links, plain_joints = read(urdf(actuator, module=MODULE, **NAMES))
    links, joints = read(urdf(actuator, module=MODULE, **options))
    assert links == ['left/' + link for link in plain_links]
    expected = {'shoulder' if name == 'output_shaft' else name for name in plain_joints}
    assert set(joints) == {'left/' + name for name in expected}
    assert all(j.parent.startswith('left/') for j in joints.values())
    assert joints['left/shoulder'].child == 'left/output_shaft'


def test_names_are_escaped(actuator):
    links, joints = read(urdf(actuator, module=MODULE, output_joint='a"<&>', frame_prefix='<'))
    assert '<stator' in links
    assert '<a"<&>' in joints


def test_joint_names_are_those_of_the_urdf(mechanism):
    names = {'output_joint': 'out', 'frame_prefix': 'p_'}
    _, joints = read(urdf(mechanism, module=MODULE, **names))
    assert sorted(joint_names(mechanism, **names)) == sorted(joints)


@pytest.mark.parametrize('name', ['rotor', 'satellite_a', 'oldham_b'])
@pytest.mark.parametrize('prefix', ['', 'left/'])
def test_output_joint_of_another_joints_name_is_refused(actuator, name, prefix):
    with pytest.raises(ValueError, match=f'output_joint.*{name}'):
        urdf(actuator, module=MODULE, output_joint=name, frame_prefix=prefix)


def test_every_link_has_a_possible_inertia(mechanism):
    robot = ET.fromstring(urdf(mechanism, module=MODULE, **NAMES))  # noqa: S314, our own
    for link in robot.iterfind('link'):
        assert float(link.find('inertial/mass').get('value')) > 0.0
        inertia = link.find('inertial/inertia')
        xx, yy, zz, xy, xz, yz = (
            float(inertia.get(key)) for key in ('ixx', 'iyy', 'izz', 'ixy', 'ixz', 'iyz')
        )
        moments = np.linalg.eigvalsh([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
        assert moments[0] > 0.0
        assert moments[2] <= (moments[0] + moments[1]) * (1.0 + 1e-12)


def test_every_link_is_shown_and_has_sizes(mechanism):
    robot = ET.fromstring(urdf(mechanism, module=MODULE, **NAMES))  # noqa: S314, our own
    for link in robot.iterfind('link'):
        cylinder = link.find('visual/geometry/cylinder')
        assert float(cylinder.get('radius')) > 0.0
        assert float(cylinder.get('length')) > 0.0


def test_mechanism_that_is_thin_has_sizes_too():
    # A branch is at 0 unless it is told to be elsewhere.
    thin = Mechanism(80, 76, 0.0011, (Branch('a'),))
    robot = ET.fromstring(urdf(thin, module=MODULE, **NAMES))  # noqa: S314, our own
    lengths = [float(x.get('length')) for x in robot.iterfind('link/visual/geometry/cylinder')]
    masses = [float(x.get('value')) for x in robot.iterfind('link/inertial/mass')]
    assert len(lengths) == len(masses) == 5
    assert min(lengths + masses) > 0.0


def test_slide_is_limited_by_the_eccentricity(actuator):
    robot = ET.fromstring(urdf(actuator, module=MODULE, **NAMES))  # noqa: S314, our own
    limits = [joint.find('limit') for joint in robot.iterfind("joint[@type='prismatic']")]
    assert len(limits) == 2
    assert all((float(x.get('lower')), float(x.get('upper'))) == (-0.0011, 0.0011) for x in limits)


def messages_at(mechanism, rotor_angle, names=NAMES):
    sample = RotorSample(5, split_turns(rotor_angle), 1.0, None)
    encoded = dict(StateMessages(mechanism, **names).encode(sample))
    poses, states = encoded['body_poses'], encoded['mechanism_joint_states']
    return deserialize_message(poses, PoseArray), deserialize_message(states, JointState)


def assert_links_are_where_the_bodies_are(mechanism, rotor_angle, names=NAMES) -> None:
    """Hold the links, moved by the joint states, against the poses of the bodies."""
    _, joints = read(urdf(mechanism, module=MODULE, **names))
    poses, states = messages_at(mechanism, rotor_angle, names)
    assert sorted(states.name) == sorted(joints)
    links = link_poses(joints, dict(zip(states.name, states.position, strict=True)))
    prefix = names['frame_prefix']
    bodies = [
        f'{prefix}{body}_{branch.name}'
        for body in ('satellite', 'oldham')
        for branch in mechanism.branches
    ]
    assert len(poses.poses) == len(bodies)
    for body, pose in zip(bodies, poses.poses, strict=True):
        link = links[body]
        expected = [pose.position.x, pose.position.y, pose.position.z]
        scale = np.array([mechanism.eccentricity] * 2 + [1.0])
        np.testing.assert_allclose(link[:3, 3] / scale, expected / scale, rtol=0.0, atol=1e-12)
        z, w = pose.orientation.z, pose.orientation.w
        rotation = [[w * w - z * z, -2.0 * w * z], [2.0 * w * z, w * w - z * z]]
        np.testing.assert_allclose(link[:2, :2], rotation, rtol=0.0, atol=1e-12)
        # Couplings, satellites and output shaft have one angle.
        shaft = links[prefix + 'output_shaft']
        np.testing.assert_allclose(link[:2, :2], shaft[:2, :2], rtol=0.0, atol=1e-12)


@given(mechanisms(), st.floats(-100.0, 100.0))
def test_links_are_where_the_bodies_are(mechanism, rotor_angle):
    # Cams at many turns would cost digits in the URDF itself.
    branches = tuple(
        Branch(b.name, math.remainder(b.cam_phase, math.tau), b.axial_position)
        for b in mechanism.branches
    )
    teeth = mechanism.ring_teeth, mechanism.satellite_teeth
    mechanism = Mechanism(*teeth, mechanism.eccentricity, branches)
    # The output turns up to 400 times as fast: so many digits are lost to its turns.
    speed_up = max(1.0, abs(1.0 / mechanism.gear_ratio))
    assert_links_are_where_the_bodies_are(mechanism, rotor_angle / speed_up)


@pytest.mark.parametrize('rotor_angle', [0.0, 0.3, -2.0, 59.0, -119.0])
def test_links_are_where_the_bodies_are_with_prefix(actuator, rotor_angle):
    names = {'output_joint': 'shoulder', 'frame_prefix': 'left/'}
    assert_links_are_where_the_bodies_are(actuator, rotor_angle, names)
