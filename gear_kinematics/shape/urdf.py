"""The mechanism as a URDF, for robot_state_publisher, RViz and other tools.

The tree: stator → rotor → satellite → Oldham coupling for each branch, and stator → output shaft.
Each joint has the name of the link it moves. A URDF is a tree, so
the joint positions in mechanism_joint_states close the loops through the arms of the output shaft.
"""

import math
from xml.etree import ElementTree as ET

from gear_kinematics.kinematics import Branch, Gear, Mechanism

_STEEL = 7850.0  # kg/m³
FACE_WIDTH = 0.01
"""Of the gears, m."""
COLOURS = {
    'stator': '0.55 0.57 0.60 0.35',
    'rotor': '0.72 0.45 0.20 1.0',
    'satellite': '0.20 0.45 0.70 1.0',
    'oldham': '0.85 0.65 0.13 1.0',
    'output': '0.35 0.37 0.40 1.0',
}
"""Red, green, blue and opacity of the bodies, in the format of URDF."""


def joint_names(gear: Gear, *, output_joint: str, frame_prefix: str) -> list[str]:
    """Names of all joints of the URDF: rotor, satellites, Oldham couplings, output shaft.

    Of a gear of which only the ratio is known, that of the output shaft alone.

    Raises:
        ValueError: if `output_joint` is empty or the name of another joint, or a name is not
            printable.
    """
    names = []
    if isinstance(gear, Mechanism):
        branches = [branch.name for branch in gear.branches]
        names.append('rotor')
        names += [f'{kind}_{branch}' for kind in ('satellite', 'oldham') for branch in branches]
    if not output_joint or output_joint in names:
        raise ValueError(f'output_joint {output_joint!r} is empty or the name of another joint')
    for parameter, text in (('output_joint', output_joint), ('frame_prefix', frame_prefix)):
        if not text.isprintable():
            raise ValueError(f'{parameter} must be printable, not {text!r}')
    return [frame_prefix + name for name in (*names, output_joint)]


def urdf(mechanism: Mechanism, *, module: float, output_joint: str, frame_prefix: str) -> str:
    """Write the URDF of a mechanism.

    Args:
        mechanism: the mechanism.
        module: of the teeth, m; together with the tooth numbers, it determines the sizes.
        output_joint: the output shaft's joint, without the prefix.
        frame_prefix: put before every link and joint name.

    Raises:
        ValueError: if `output_joint` is empty or the name of another joint.
    """
    joint_names(mechanism, output_joint=output_joint, frame_prefix=frame_prefix)  # to check them
    e = mechanism.eccentricity
    ring_radius = 0.5 * module * mechanism.ring_teeth
    satellite_radius = 0.5 * module * mechanism.satellite_teeth
    half_length = max(abs(b.axial_position) for b in mechanism.branches) + FACE_WIDTH
    robot = ET.Element('robot', name=f'{frame_prefix}gear_kinematics')

    def link(name: str, radius: float, length: float) -> ET.Element:
        return _link(robot, frame_prefix + name, radius, length, _colour(name))

    def joint(kind: str, name: str, parent: str, child: str) -> ET.Element:
        element = ET.SubElement(robot, 'joint', name=frame_prefix + name, type=kind)
        ET.SubElement(element, 'parent', link=frame_prefix + parent)
        ET.SubElement(element, 'child', link=frame_prefix + child)
        ET.SubElement(element, 'axis', xyz='1 0 0' if kind == 'prismatic' else '0 0 1')
        return element

    link('stator', 1.15 * ring_radius, 2.0 * half_length)
    rotor = link('rotor', 0.5 * ring_radius, 1.6 * half_length)
    joint('continuous', 'rotor', 'stator', 'rotor')
    shaft = link('output_shaft', 0.2 * ring_radius, 2.4 * half_length)
    joint('continuous', output_joint, 'stator', 'output_shaft')
    # Cams and arms protrude beyond the faces of satellites and couplings, so that they are seen.
    cam = {'radius': repr(0.6 * ring_radius), 'length': repr(1.3 * FACE_WIDTH)}
    arm = {'size': f'{0.1 * satellite_radius!r} {1.8 * satellite_radius!r} {1.4 * FACE_WIDTH!r}'}
    for branch in mechanism.branches:
        _visual(rotor, 'cylinder', cam, _colour('rotor'), _cam_centre(branch, e))
        _visual(shaft, 'box', arm, _colour('output_shaft'), f'0 0 {branch.axial_position!r}')
        satellite, oldham = f'satellite_{branch.name}', f'oldham_{branch.name}'
        link(satellite, satellite_radius, FACE_WIDTH)
        on_cam = joint('continuous', satellite, 'rotor', satellite)
        ET.SubElement(on_cam, 'origin', xyz=_cam_centre(branch, e), rpy='0 0 0')
        link(oldham, 0.7 * satellite_radius, 1.2 * FACE_WIDTH)
        slide = joint('prismatic', oldham, satellite, oldham)
        ET.SubElement(
            slide, 'limit', lower=repr(-e), upper=repr(e), effort='1000.0', velocity='1000.0'
        )
    ET.indent(robot)
    return ET.tostring(robot, encoding='unicode', xml_declaration=True) + '\n'


def _cam_centre(branch: Branch, eccentricity: float) -> str:
    x, y = branch.cam_direction
    return f'{eccentricity * x!r} {eccentricity * y!r} {branch.axial_position!r}'


def _colour(link: str) -> str:
    return COLOURS[link.partition('_')[0]]


def _link(robot: ET.Element, name: str, radius: float, length: float, colour: str) -> ET.Element:
    """Add a steel cylinder about the link's z axis; further visuals of the link have no mass."""
    link = ET.SubElement(robot, 'link', name=name)
    inertial = ET.SubElement(link, 'inertial')
    mass = _STEEL * math.pi * radius**2 * length
    across = mass * (3.0 * radius**2 + length**2) / 12.0
    along = mass * radius**2 / 2.0
    ET.SubElement(inertial, 'mass', value=repr(mass))
    moments = {'ixx': across, 'iyy': across, 'izz': along, 'ixy': 0.0, 'ixz': 0.0, 'iyz': 0.0}
    ET.SubElement(inertial, 'inertia', {key: repr(value) for key, value in moments.items()})
    _visual(link, 'cylinder', {'radius': repr(radius), 'length': repr(length)}, colour, '0 0 0')
    return link


def _visual(link: ET.Element, shape: str, size: dict[str, str], colour: str, at: str) -> None:
    visual = ET.SubElement(link, 'visual')
    ET.SubElement(visual, 'origin', xyz=at, rpy='0 0 0')
    ET.SubElement(ET.SubElement(visual, 'geometry'), shape, size)
    material = ET.SubElement(visual, 'material', name=f'{link.get("name")}_colour')
    ET.SubElement(material, 'color', rgba=colour)
