# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The mechanism as a URDF, for robot_state_publisher, RViz and other tools.

The tree is stator → rotor → satellite → Oldham coupling by branch, and stator → output shaft.
Each joint has the name of the link that it moves. As a tree cannot contain loops, the positions in
mechanism_joint_states close those through the arms of the output shaft.
"""

import math
import re
from collections.abc import Iterable
from xml.etree import ElementTree as ET

from gear_kinematics.kinematics import Gear, Mechanism
from gear_kinematics.shape.visuals import Cylinder, Visual, cam_centre, cylinders, meshed, simple

MACRO_PREFIX = '${prefix}'  #: the `frame_prefix` of a URDF that `as_macro` takes
_MACRO = """<?xml version="1.0" encoding="utf-8"?>
<!-- Printed by gearkin urdf. The block is the origin of the stator in the parent link:
  <xacro:gear_actuator parent="base" prefix="shoulder_"><origin xyz="0 0 0"/></xacro:gear_actuator>
output_joint names the joint of the output shaft, as messages do.
-->
<robot xmlns:xacro="http://www.ros.org/wiki/xacro">
<xacro:macro name="gear_actuator" params="parent *origin prefix:='' output_joint:=''">
  <joint name="${prefix}stator" type="fixed">
    <parent link="${parent}" />
    <child link="${prefix}stator" />
    <xacro:insert_block name="origin" />
  </joint>
"""
_STEEL = 7850.0  # kg/m³


def joint_names(gear: Gear, *, output_joint: str, frame_prefix: str) -> list[str]:
    """List the joints of the URDF: rotor, satellites, Oldham couplings, output shaft.

    If only the ratio of the gear is known, the output shaft's joint is the only one. The name
    `output_joint` is complete; the others get the prefix. Raises ValueError if `output_joint` is
    empty or the name of another joint, or a name is not printable.
    """
    names = []
    if isinstance(gear, Mechanism):
        branches = [branch.name for branch in gear.branches]
        names.append(f'{frame_prefix}rotor')
        for kind in ('satellite', 'oldham'):
            names += [f'{frame_prefix}{kind}_{branch}' for branch in branches]
    own = output_joint.removeprefix(frame_prefix)
    if not own or output_joint in names:
        raise ValueError(f'output_joint {own!r} is empty or the name of another joint')
    for parameter, text in (('output_joint', own), ('frame_prefix', frame_prefix)):
        if not text.isprintable():
            raise ValueError(f'{parameter} must be printable, not {text!r}')
    return [*names, output_joint]


def urdf(
    mechanism: Mechanism, *, module: float, output_joint: str, frame_prefix: str, meshes: str = ''
) -> str:
    """Write the URDF of a mechanism; ValueError for names that `joint_names` refuses.

    The module of the teeth, m, determines the sizes. `output_joint` is the complete name of the
    output shaft's joint; the prefix is before all other names. `meshes` is the URI below which
    viewers find the `solids` as STL; '' shows simple shapes, which always give the inertias.
    """
    joint_names(mechanism, output_joint=output_joint, frame_prefix=frame_prefix)  # checks them
    e = mechanism.eccentricity
    robot = ET.Element('robot', name=f'{frame_prefix}gear_kinematics')
    links = {
        name: _link(robot, frame_prefix + name, cylinder)
        for name, cylinder in cylinders(mechanism, module).items()
    }
    shown = meshed(mechanism, module, meshes) if meshes else simple(mechanism, module)
    for visual in shown:
        _show(links[visual.link], visual)

    def joint(kind: str, name: str, parent: str, child: str) -> ET.Element:
        element = ET.SubElement(robot, 'joint', name=name, type=kind)
        ET.SubElement(element, 'parent', link=frame_prefix + parent)
        ET.SubElement(element, 'child', link=frame_prefix + child)
        ET.SubElement(element, 'axis', xyz='1 0 0' if kind == 'prismatic' else '0 0 1')
        return element

    joint('continuous', f'{frame_prefix}rotor', 'stator', 'rotor')
    joint('continuous', output_joint, 'stator', 'output_shaft')
    for branch in mechanism.branches:
        satellite, oldham = f'satellite_{branch.name}', f'oldham_{branch.name}'
        on_cam = joint('continuous', frame_prefix + satellite, 'rotor', satellite)
        _place(on_cam, cam_centre(branch, e))
        slide = joint('prismatic', frame_prefix + oldham, satellite, oldham)
        ET.SubElement(
            slide, 'limit', lower=repr(-e), upper=repr(e), effort='1000.0', velocity='1000.0'
        )
    return _text_of(robot)


def side_by_side(urdfs: Iterable[str], spacing: float) -> str:
    """Join the URDFs of several actuators in one, which has the single root that a URDF needs.

    All their links and joints have different names. The stators are fixed to the link `base`, with
    a spacing along x, m.
    """
    robot = ET.Element('robot', name='gear_kinematics')
    ET.SubElement(robot, 'link', name='base')
    for number, text in enumerate(urdfs):
        elements = [*ET.fromstring(text)]  # noqa: S314, our own
        stator = elements[0].get('name', '')
        fixed = ET.SubElement(robot, 'joint', name=stator, type='fixed')
        ET.SubElement(fixed, 'parent', link='base')
        ET.SubElement(fixed, 'child', link=stator)
        _place(fixed, (number * spacing, 0.0, 0.0))
        robot.extend(elements)
    return _text_of(robot)


def as_macro(urdf: str, joint: str) -> str:
    """Wrap a URDF in the xacro macro `gear_actuator`, which fixes the stator to a link of a robot.

    The URDF has the `frame_prefix` `MACRO_PREFIX`. `joint` is the default name of the output
    shaft's joint, as an expression of xacro.
    """
    robot = ET.fromstring(urdf)  # noqa: S314, our own
    child = f'child[@link="{MACRO_PREFIX}output_shaft"]/..'
    for element in robot.iterfind(f'joint/{child}'):
        element.set('name', f'${{output_joint or {joint}}}')
    _, _, *elements, end = _text_of(robot).splitlines(keepends=True)
    # Nobody edits inertials and visuals, so each is one line.
    joined = re.sub(r'\n {6,}|\n {4}(?=</)', '', ''.join(elements))
    return f'{_MACRO}{joined}</xacro:macro>\n{end}'


def _text_of(robot: ET.Element) -> str:
    ET.indent(robot)
    return ET.tostring(robot, encoding='unicode', xml_declaration=True) + '\n'


def _link(robot: ET.Element, name: str, cylinder: Cylinder) -> ET.Element:
    """Add a link with the inertia of a steel cylinder."""
    link = ET.SubElement(robot, 'link', name=name)
    inertial = ET.SubElement(link, 'inertial')
    radius, length = cylinder
    mass = _STEEL * math.pi * radius**2 * length
    across = mass * (3.0 * radius**2 + length**2) / 12.0
    along = mass * radius**2 / 2.0
    ET.SubElement(inertial, 'mass', value=repr(mass))
    moments = {'ixx': across, 'iyy': across, 'izz': along, 'ixy': 0.0, 'ixz': 0.0, 'iyz': 0.0}
    ET.SubElement(inertial, 'inertia', {key: repr(value) for key, value in moments.items()})
    return link


def _show(link: ET.Element, visual: Visual) -> None:
    element = ET.SubElement(link, 'visual')
    _place(element, visual.xyz, visual.yaw)
    ET.SubElement(ET.SubElement(element, 'geometry'), visual.shape, dict(visual.size))
    opacity = '_opaque' if visual.opaque else ''
    material = ET.SubElement(element, 'material', name=f'{link.get("name")}_colour{opacity}')
    ET.SubElement(material, 'color', rgba=visual.colour)


def _place(element: ET.Element, xyz: tuple[float, float, float], yaw: float = 0.0) -> None:
    turn = f'0 0 {yaw!r}' if yaw else '0 0 0'
    ET.SubElement(element, 'origin', xyz=' '.join(map(repr, xyz)), rpy=turn)
