# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The URDF as read by others: XML, tree, inertias, and the poses of the links."""

import math
import xml.etree.ElementTree as ET

import numpy as np
import pytest
from geometry_msgs.msg import PoseArray
from links import pinocchio_configuration, read
from rclpy.serialization import deserialize_message
from sensor_msgs.msg import JointState
from wire import encoded

from gear_kinematics.kinematics import Branch, Mechanism, RotorSample, split_turns
from gear_kinematics.shape.urdf import joint_names, urdf
from gear_kinematics.state.state_messages import StateMessages

MODULE = 0.0005
NAMES = {'output_joint': 'output_shaft', 'frame_prefix': ''}


@pytest.mark.parametrize(
    ('prefix', 'output'), [('', 'output_shaft'), ('left/', 'shoulder'), ('<', 'a"<&>')]
)
def test_tree_is_as_documented(actuator, prefix, output):
    """With the prefix on every link and joint."""
    names = {'output_joint': prefix + output, 'frame_prefix': prefix}
    links, joints = read(urdf(actuator, module=MODULE, **names))
    tree = {
        ('stator', 'rotor'): 'continuous',
        ('rotor', 'satellite_a'): 'continuous',
        ('rotor', 'satellite_b'): 'continuous',
        ('satellite_a', 'oldham_a'): 'prismatic',
        ('satellite_b', 'oldham_b'): 'prismatic',
        ('stator', 'output_shaft'): 'continuous',
    }
    assert set(links) == {prefix + link for pair in tree for link in pair}
    assert {(joint.parent, joint.child): joint.kind for joint in joints.values()} == {
        (prefix + parent, prefix + child): kind for (parent, child), kind in tree.items()
    }
    assert joints.pop(prefix + output).child == f'{prefix}output_shaft'
    assert all(name == joint.child for name, joint in joints.items())
    robot = ET.fromstring(urdf(actuator, module=MODULE, **names))  # noqa: S314, our own
    limits = [(float(x.get('lower')), float(x.get('upper'))) for x in robot.iterfind('.//limit')]
    assert limits == [(-0.0011, 0.0011)] * 2


def test_joint_names_are_those_of_the_urdf(mechanism):
    names = {'output_joint': 'out', 'frame_prefix': 'p_'}
    _, joints = read(urdf(mechanism, module=MODULE, **names))
    assert sorted(joint_names(mechanism, **names)) == sorted(joints)


@pytest.mark.parametrize('name', ['rotor', 'satellite_a', 'oldham_b'])
@pytest.mark.parametrize('prefix', ['', 'left/'])
def test_output_joint_with_the_name_of_another_joint_is_refused(actuator, name, prefix):
    with pytest.raises(ValueError, match=f'output_joint.*{name}'):
        urdf(actuator, module=MODULE, output_joint=prefix + name, frame_prefix=prefix)


def test_rotor_has_its_cams_and_the_output_shaft_its_arms(mechanism):
    """Cams about the joints of the satellites and wider than the rotor, arms along y."""
    text = urdf(mechanism, module=MODULE, **NAMES)
    robot, (_, joints) = ET.fromstring(text), read(text)  # noqa: S314, our own
    links = {link.get('name'): link for link in robot.iterfind('link')}
    rotor, *cams = links['rotor'].iterfind('visual')
    shaft, *arms = links['output_shaft'].iterfind('visual')
    thickness = float(links['rotor'].find('visual/geometry/cylinder').get('radius'))
    assert origin(rotor) == origin(shaft) == [0.0, 0.0, 0.0]
    for branch, cam, arm in zip(mechanism.branches, cams, arms, strict=True):
        assert origin(cam) == joints[f'satellite_{branch.name}'].origin.tolist()
        assert origin(arm) == [0.0, 0.0, branch.axial_position]
        assert float(cam.find('geometry/cylinder').get('radius')) > thickness
        x, y, z = map(float, arm.find('geometry/box').get('size').split())
        coupling = links[f'oldham_{branch.name}'].find('visual/geometry/cylinder')
        assert y > 2.0 * float(coupling.get('radius')) > x > 0.0
        assert (
            z > float(cam.find('geometry/cylinder').get('length')) > float(coupling.get('length'))
        )


def origin(visual) -> list[float]:
    return [float(number) for number in visual.find('origin').get('xyz').split()]


@pytest.mark.slow
@pytest.mark.parametrize(
    ('ring_teeth', 'satellite_teeth', 'count', 'prefix'),
    [(80, 76, 2, ''), (80, 76, 2, 'left/'), (80, 78, 1, ''), (61, 58, 3, 'left/'), (7, 2, 2, '')],
)
def test_pinocchio_puts_the_links_where_the_bodies_are(ring_teeth, satellite_teeth, count, prefix):
    """Independent kinematics, at random angles of many turns."""
    pin = pytest.importorskip('pinocchio', reason='Pinocchio is not installed')
    generator = np.random.default_rng(ring_teeth)
    branches = tuple(
        Branch(name, generator.uniform(-math.pi, math.pi), generator.uniform(-0.1, 0.1))
        for name in 'abc'[:count]
    )
    e = generator.uniform(0.0005, 0.005)
    mechanism = Mechanism(ring_teeth, satellite_teeth, e, branches)
    names = {'output_joint': 'shoulder', 'frame_prefix': prefix}
    model = pin.buildModelFromXML(urdf(mechanism, module=MODULE, **names))
    data = model.createData()
    kinds = ('satellite', 'oldham')
    bodies = [f'{prefix}{kind}_{branch.name}' for kind in kinds for branch in branches]
    links = [model.getFrameId(name, pin.FrameType.BODY) for name in bodies]
    shaft = model.getFrameId(f'{prefix}output_shaft', pin.FrameType.BODY)
    assert max(*links, shaft) < model.nframes  # the index of a frame that does not exist
    # Some hundred turns, which the angles of the joints count, leave them 12 digits of a turn.
    fastest = max(1.0, 1.0 + 1.0 / abs(mechanism.gear_ratio))
    errors = []
    for angle in generator.uniform(-2000.0, 2000.0, 400) / fastest:
        sample = RotorSample(5, split_turns(float(angle)), 1.0, None)
        messages = encoded(StateMessages(mechanism, **names), sample)
        poses = deserialize_message(messages['body_poses'], PoseArray).poses
        states = deserialize_message(messages['mechanism_joint_states'], JointState)
        positions = dict(zip(states.name, states.position, strict=True))
        assert set(positions) == set(model.names[1:])
        pin.framesForwardKinematics(model, data, pinocchio_configuration(model, positions))
        for link, pose in zip(links, poses, strict=True):
            place, p, q = data.oMf[link], pose.position, pose.orientation
            turn = pin.Quaternion(q.w, q.x, q.y, q.z).matrix()
            errors.append(np.subtract(place.translation, (p.x, p.y, p.z)) / [e, e, 1.0])
            errors += [*(place.rotation - turn), *(place.rotation - data.oMf[shaft].rotation)]
    assert np.shape(errors) == (400 * len(bodies) * 7, 3)
    np.testing.assert_allclose(errors, 0.0, atol=1e-12)


def test_urdfdom_does_not_complain(mechanism, capfd):
    """The parser of robot_state_publisher and RViz; Pinocchio's too. It complains on stderr."""
    pin = pytest.importorskip('pinocchio', reason='Pinocchio is not installed')
    branches = len(mechanism.branches)
    model = pin.buildModelFromXML(urdf(mechanism, module=MODULE, **NAMES))
    assert (model.njoints - 1, model.nframes) == (2 + 2 * branches, 2 * (3 + 2 * branches))
    assert capfd.readouterr() == ('', '')


def test_links_are_of_steel_and_balanced(actuator):
    """As Pinocchio reads them: cylinders about the axis, of the volumes that are shown first."""
    pin = pytest.importorskip('pinocchio', reason='Pinocchio is not installed')
    text = urdf(actuator, module=MODULE, **NAMES)
    model = pin.buildModelFromXML(text)
    robot = ET.fromstring(text)  # noqa: S314, our own
    moving = [link for link in robot.iterfind('link') if link.get('name') != 'stator']
    assert len(moving) == len(model.inertias) - 1
    for link in moving:
        cylinder = link.find('visual/geometry/cylinder')
        radius, length = (float(cylinder.get(key)) for key in ('radius', 'length'))
        frame = model.frames[model.getFrameId(link.get('name'), pin.FrameType.BODY)]
        inertia = model.inertias[frame.parentJoint]
        mass = 7850.0 * math.pi * radius**2 * length
        across = mass * (radius**2 / 4.0 + length**2 / 12.0)
        assert inertia.mass == pytest.approx(mass, rel=1e-12)
        assert inertia.lever.tolist() == [0.0, 0.0, 0.0]
        assert inertia.inertia == pytest.approx(
            np.diag([across, across, mass * radius**2 / 2.0]), rel=1e-12
        )
