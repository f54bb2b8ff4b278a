"""The URDF as read by others: XML, tree, inertias, and the poses of the links."""

import math
import xml.etree.ElementTree as ET
from contextlib import suppress

import numpy as np
import pytest
from geometry_msgs.msg import PoseArray
from hypothesis import given
from hypothesis import strategies as st
from links import link_poses, read
from properties import mechanisms
from rclpy.serialization import deserialize_message
from sensor_msgs.msg import JointState

from gear_kinematics.kinematics import Branch, Mechanism, RotorSample, split_turns
from gear_kinematics.shape.urdf import joint_names, urdf
from gear_kinematics.state.state_messages import StateMessages

MODULE = 0.0005
NAMES = {'output_joint': 'output_shaft', 'frame_prefix': ''}


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
def test_output_joint_with_the_name_of_another_joint_is_refused(actuator, name, prefix):
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


def test_thin_mechanism_has_sizes():
    # The axial position of a branch is 0 by default.
    thin = Mechanism(80, 76, 0.0011, (Branch('a'),))
    robot = ET.fromstring(urdf(thin, module=MODULE, **NAMES))  # noqa: S314, our own
    lengths = [float(x.get('length')) for x in robot.iterfind('link/visual/geometry/cylinder')]
    masses = [float(x.get('value')) for x in robot.iterfind('link/inertial/mass')]
    assert (len(lengths), len(masses)) == (6, 5)  # the rotor's cam has no mass of its own
    assert min(lengths + masses) > 0.0


def test_slide_is_limited_by_the_eccentricity(actuator):
    robot = ET.fromstring(urdf(actuator, module=MODULE, **NAMES))  # noqa: S314, our own
    limits = [joint.find('limit') for joint in robot.iterfind("joint[@type='prismatic']")]
    assert len(limits) == 2
    assert all((float(x.get('lower')), float(x.get('upper'))) == (-0.0011, 0.0011) for x in limits)


def messages_at(mechanism, rotor_angle, names):
    sample = RotorSample(5, split_turns(rotor_angle), 1.0, None)
    encoded = dict(StateMessages(mechanism, **names).encode(sample))
    poses, states = encoded['body_poses'], encoded['mechanism_joint_states']
    return deserialize_message(poses, PoseArray), deserialize_message(states, JointState)


def assert_links_are_where_the_bodies_are(mechanism, rotor_angle, names=NAMES) -> None:
    """Compare the links, moved by the joint states, with the poses of the bodies."""
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


def pinocchio():
    return pytest.importorskip('pinocchio', reason='Pinocchio is not installed')


def drawn_mechanism(generator, ring_teeth, satellite_teeth, count) -> Mechanism:
    """Random cam phases and axial positions."""
    branches = tuple(
        Branch('abc'[k], generator.uniform(-math.pi, math.pi), generator.uniform(-0.1, 0.1))
        for k in range(count)
    )
    return Mechanism(ring_teeth, satellite_teeth, generator.uniform(0.0005, 0.005), branches)


@pytest.mark.slow
@pytest.mark.parametrize('prefix', ['', 'left/'])
@pytest.mark.parametrize(
    ('ring_teeth', 'satellite_teeth', 'count'), [(80, 76, 2), (80, 78, 1), (61, 58, 3), (7, 2, 2)]
)
def test_pinocchio_puts_the_links_where_the_bodies_are(ring_teeth, satellite_teeth, count, prefix):
    """Independent kinematics, at random angles of many turns."""
    pin = pinocchio()
    generator = np.random.default_rng(ring_teeth)
    mechanism = drawn_mechanism(generator, ring_teeth, satellite_teeth, count)
    names = {'output_joint': 'shoulder', 'frame_prefix': prefix}
    model = pin.buildModelFromXML(urdf(mechanism, module=MODULE, **names))
    data = model.createData()
    kinds = ('satellite', 'oldham')
    bodies = [f'{prefix}{kind}_{branch.name}' for kind in kinds for branch in mechanism.branches]
    links = [model.getFrameId(name, pin.FrameType.BODY) for name in bodies]
    shaft = model.getFrameId(f'{prefix}output_shaft', pin.FrameType.BODY)
    assert max(*links, shaft) < model.nframes  # the index of a frame that does not exist

    # Some hundred turns, which the angles of the joints count, leave them 12 digits of a turn.
    fastest = max(1.0, 1.0 + 1.0 / abs(mechanism.gear_ratio))
    angles = generator.uniform(-2000.0, 2000.0, 400) / fastest
    found, expected = np.zeros((2, len(angles), len(links), 3, 3))
    for n, angle in enumerate(angles):
        poses, states = messages_at(mechanism, float(angle), names)
        positions = dict(zip(states.name, states.position, strict=True))
        assert set(positions) == set(model.names[1:])
        pin.framesForwardKinematics(model, data, configuration(model, positions))
        # Position in units of e, and as everywhere the direction of the x axis; z as it is.
        for k, (link, pose) in enumerate(zip(links, poses.poses, strict=True)):
            place = data.oMf[link]
            p, q = pose.position, pose.orientation
            turn = pin.Quaternion(q.w, q.x, q.y, q.z).matrix()
            found[n, k] = place.translation, place.rotation[:, 0], place.rotation[:, 2]
            expected[n, k] = (p.x, p.y, p.z), turn[:, 0], turn[:, 2]
            np.testing.assert_allclose(
                place.rotation, data.oMf[shaft].rotation, rtol=0.0, atol=1e-12
            )
    scale = np.ones((3, 3))
    scale[0, :2] = mechanism.eccentricity
    np.testing.assert_allclose(found / scale, expected / scale, rtol=0.0, atol=1e-12)


def configuration(model, positions: dict[str, float]) -> np.ndarray:
    """Configuration of Pinocchio: continuous joints have cosine and sine of their angle."""
    q = np.zeros(model.nq)
    for name, position in positions.items():
        joint = model.joints[model.getJointId(name)]
        if joint.nq == 2:
            q[joint.idx_q : joint.idx_q + 2] = math.cos(position), math.sin(position)
        else:
            q[joint.idx_q] = position
    return q


def test_urdfdom_does_not_complain(mechanism, capfd):
    """The parser of robot_state_publisher and RViz; Pinocchio's too. It complains on stderr."""
    pin = pinocchio()
    branches = len(mechanism.branches)
    model = pin.buildModelFromXML(urdf(mechanism, module=MODULE, **NAMES))
    assert (model.njoints - 1, model.nframes) == (2 + 2 * branches, 2 * (3 + 2 * branches))
    assert capfd.readouterr() == ('', '')


@pytest.mark.parametrize(
    ('element', 'attribute'),
    [
        ('joint/parent', 'link'),
        ('joint', 'type'),
        ('joint/limit', 'velocity'),
        ('link/inertial/mass', 'value'),
        ('link/inertial/inertia', 'ixy'),
        ('link/visual/geometry/cylinder', 'length'),
        ('link/visual/material', 'name'),
    ],
)
def test_urdfdom_complains_of_missing_elements(actuator, element, attribute, capfd):
    pin = pinocchio()
    robot = ET.fromstring(urdf(actuator, module=MODULE, **NAMES))  # noqa: S314, our own
    del robot.find(element).attrib[attribute]
    with suppress(ValueError):
        pin.buildModelFromXML(ET.tostring(robot, encoding='unicode'))
    assert capfd.readouterr().err.startswith('Error:')


def test_links_are_of_steel_and_balanced(actuator):
    """As Pinocchio reads them: cylinders about the axis, of the volumes that are shown first."""
    pin = pinocchio()
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
