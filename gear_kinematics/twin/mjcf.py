# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""A simulated gear as a model of MuJoCo: one XML, in SI units.

Bodies, joints and frames are those of the URDF. A URDF is a tree; here, each coupling is welded to
a body that slides in the slot of the arm, which closes the loops. Each spring is a tendon, because
those have a dead band in MuJoCo: a fixed tendon, whose length is a sum of joint angles.
"""

import math
from pathlib import PurePath
from typing import Any
from xml.etree import ElementTree as ET

import numpy as np

from gear_kinematics.kinematics import Branch, MechanismError
from gear_kinematics.parameters.meshes import NONE
from gear_kinematics.shape.solids import solids, triangles
from gear_kinematics.shape.visuals import Point, cam_centre, meshed, simple
from gear_kinematics.twin.gear import TwinGear, greatest_stiffness

_MILLISECOND = 1e-3  # s
_LONGEST_STEP = 1e-4  # s
_PHASE = 0.7  # rad by which the fastest oscillation may advance in a step; beyond 2, it grows
_IMPEDANCE = 0.9999  # of constraints: the greatest that MuJoCo takes
_ARM_DAMPING = 0.05  # of critical: the arm comes to rest in ms, and slower motions hardly notice
_TORQUE_SCALE = 20.0  # of welds; couples wind them up by 400 times less than with MuJoCo's 1
_NO_MASS = 1e-9  # kg or kg·m²; MuJoCo wants some of every moving body
_DIGITS = 6  # of the coordinates of meshes
_AXIS = '0 0 1'

_ABOUT = """
  A gear of gear_kinematics for MuJoCo 3.0 or newer. SI units, angles in rad; the bodies and their
  frames are those of `gearkin urdf`. The length of the tendon branch_<name> is its wind-up,

      rotor angle / gear ratio - angle of the arm,

  and its springlength the play of the flanks. Positive torques push the output forwards. Sensors
  and actuators have the names of the topics of the node gear_simulator.
"""
_STEP = f"""
  The step is short for the fastest oscillation of the bodies on their springs: it advances by less
  than {_PHASE} rad. MuJoCo's constraints are soft. The stiffest settings and torquescale make those
  that close the loops add less than 0.001 % to the compliance of a branch.
"""
_ERRORS = """
  MuJoCo has no element for kinematic errors. The output should deviate by the sum of these orders,
  cos cos(cycles φ2) + sin sin(cycles φ2), each with its cycles per turn of the rotor, cos and sin.
  To simulate that, subtract the deviation from springlength of every branch at each step, as
  gear_kinematics.twin.mujoco_model does.
"""


def mjcf(gear: TwinGear, *, shown: bool = True) -> str:
    """Write the model, at rest without load at a rotor angle of 0.

    Args:
        gear: of a known mechanism, whose satellites and couplings have masses.
        shown: whether to draw the bodies: with their teeth, unless the parameter `meshes` is none.

    Raises:
        MechanismError: if it is of another gear.
        ModuleNotFoundError: if the extra `mesh` is not installed, which teeth need.
    """
    mechanism, loads = gear.parameters.mechanism, gear.parameters.loads
    needed = 'satellite_mass', 'satellite_inertia', 'coupling_mass', 'coupling_inertia'
    if faults := [
        f'loads.{name} must be greater than 0 in a model of MuJoCo'
        for name in needed
        if not getattr(loads, name)
    ]:
        raise MechanismError(faults)
    step = _time_step(gear)
    root = ET.Element('mujoco', model='gear_kinematics')
    root.append(ET.Comment(_ABOUT))
    _add(root, 'compiler', angle='radian', autolimits='true')
    root.append(ET.Comment(_STEP))
    option = _add(
        root,
        'option',
        timestep=step,
        integrator='implicitfast',
        gravity='0 0 0',
        iterations='10',
        tolerance='1e-12',
    )
    _add(option, 'flag', contact='disable')
    default = _add(root, 'default')
    reference, impedance = (2.0 * step, 1.0), (_IMPEDANCE, _IMPEDANCE)  # the stiffest
    _add(default, 'equality', solref=reference, solimp=impedance)
    _add(default, 'joint', solreffriction=reference, solimpfriction=impedance)
    _add(default, 'geom', contype='0', conaffinity='0', mass='0')
    if gear.errors:
        root.append(ET.Comment(_ERRORS))
        custom = _add(root, 'custom')
        for order in gear.errors:
            data = float(order.cycles), order.cos, order.sin
            _add(custom, 'numeric', name=order.name, data=data)
    links = _bodies(gear, _add(root, 'worldbody'))
    _constraints(gear, _add(root, 'equality'))
    _springs(gear, _add(root, 'tendon'))
    actuators, sensors = _add(root, 'actuator'), _add(root, 'sensor')
    _add(actuators, 'motor', name='rotor_command', joint='rotor')
    _add(actuators, 'motor', name='load_torque', joint='output_shaft')
    _add(sensors, 'jointpos', name='rotor_state_position', joint='rotor')
    _add(sensors, 'jointvel', name='rotor_state_velocity', joint='rotor')
    _add(sensors, 'jointpos', name='output_encoder', joint='output_shaft')
    for branch in mechanism.branches:
        # About z, the third value: what the coupling gives the arm.
        _add(sensors, 'torque', name=f'branch_loads_{branch.name}', site=f'slot_arm_{branch.name}')
    if shown:
        _draw(gear, links, _add(root, 'asset'))
    ET.indent(root)
    return ET.tostring(root, encoding='unicode') + '\n'


def branch_tendons(gear: TwinGear, branch: int) -> list[str]:
    """The names of the tendons of a branch, one for each of its springs."""
    name = gear.parameters.branches[branch].name
    return [f'branch_{name}{f"_{k}" if k else ""}' for k in range(len(gear.springs[branch]))]


def _time_step(gear: TwinGear) -> float:
    """The time step, s: a whole number of them is a millisecond."""
    loads, count, turning = gear.parameters.loads, len(gear.springs), _turning_inertia(gear)
    stiffness = [greatest_stiffness(springs) for springs in gear.springs]
    reflected = sum(stiffness) / gear.ratio**2 / loads.rotor_inertia
    sliders = sum(each.stiffness for each in gear.friction if math.isfinite(each.stiffness))
    if gear.has_shaft:
        shaft = gear.shaft_stiffness
        arm = (stiffness[0] + shaft) / turning
        output = (stiffness[1] + shaft + sliders) / (turning + gear.output_inertia)
    else:
        arm, output = 0.0, (sum(stiffness) + sliders) / (count * turning + gear.output_inertia)
    # The trace of the matrix whose eigenvalues are the squares of the frequencies bounds them.
    frequency = math.sqrt(reflected + arm + output)
    longest = min(_LONGEST_STEP, _PHASE / frequency)
    return _MILLISECOND / math.ceil(_MILLISECOND / longest - 1e-9)


def _turning_inertia(gear: TwinGear) -> float:
    """Of what turns with each arm: J3 + J4, kg·m²."""
    return gear.parameters.loads.satellite_inertia + gear.parameters.loads.coupling_inertia


# Bodies


def _bodies(gear: TwinGear, world: ET.Element) -> dict[str, ET.Element]:
    """Add the bodies; returns those that are links of the URDF, by their names."""
    loads, branches = gear.parameters.loads, gear.parameters.branches
    stator = _add(world, 'body', name='stator')
    rotor = _body(world, 'rotor', _NO_MASS, loads.rotor_inertia)
    _add(rotor, 'joint', name='rotor', axis=_AXIS, damping=gear.rotor_damping)
    shaft = _body(world, 'output_shaft', _NO_MASS, gear.output_inertia, turn=gear.error(0.0))
    rigid = sum(each.torque for each in gear.friction if math.isinf(each.stiffness))
    _hinge(shaft, 'output_shaft', gear.error(0.0), frictionloss=rigid)
    links = {'stator': stator, 'rotor': rotor, 'output_shaft': shaft}
    for number, branch in enumerate(branches):
        turn, arm = gear.error(0.0), shaft
        if gear.has_shaft and not number:
            turn += gear.shaft_twist
            arm = _body(world, f'arm_{branch.name}', _NO_MASS, _NO_MASS, turn=turn)
            _hinge(arm, f'arm_{branch.name}', turn)
        links |= _branch(gear, branch, rotor, arm, turn)
    for number, slider in enumerate(gear.friction):
        if math.isfinite(slider.stiffness):
            # As light as the time step allows.
            inertia = slider.stiffness * (_time_step(gear) / _PHASE) ** 2
            body = _body(world, f'friction_{number}', _NO_MASS, inertia)
            _hinge(body, f'friction_{number}', 0.0, frictionloss=slider.torque)
    return links


def _branch(
    gear: TwinGear, branch: Branch, rotor: ET.Element, arm: ET.Element, turn: float
) -> dict[str, ET.Element]:
    """Add satellite, coupling and the body in the slot of the arm, which is turned by an angle.

    Coupling and slot are one body: each has half of its mass. All three turn by the same angle:
    their inertia is halved between both sides of the weld, where it yields the least to couples.
    """
    e, loads, name = gear.parameters.eccentricity, gear.parameters.loads, branch.name
    mass, inertia = 0.5 * loads.coupling_mass, 0.5 * _turning_inertia(gear)
    x, y = e * math.sin(branch.cam_phase - turn), e * math.cos(branch.cam_phase - turn)
    centre = cam_centre(branch, e)
    satellite = _body(rotor, f'satellite_{name}', loads.satellite_mass, inertia, centre, turn)
    _hinge(satellite, f'satellite_{name}', turn)
    _add(satellite, 'site', name=f'cam_{name}')
    coupling = _body(satellite, f'oldham_{name}', mass, _NO_MASS, (x, 0.0, 0.0))
    _add(coupling, 'joint', name=f'oldham_{name}', type='slide', axis='1 0 0', ref=x)
    _add(coupling, 'site', name=f'slot_satellite_{name}')
    slot = _body(arm, f'slot_arm_{name}', mass, inertia, (0.0, y, branch.axial_position))
    _add(slot, 'joint', name=f'slot_arm_{name}', type='slide', axis='0 1 0', ref=y)
    _add(slot, 'site', name=f'slot_arm_{name}', euler=(math.pi, 0.0, 0.0))
    # Where the rolling circles touch; it turns with the rotor.
    reach = gear.parameters.mechanism.ring_rolling_radius / e
    pitch = reach * centre[0], reach * centre[1], centre[2]
    _add(rotor, 'site', name=f'mesh_{name}', pos=pitch)
    return {f'satellite_{name}': satellite, f'oldham_{name}': coupling}


def _body(
    parent: ET.Element,
    name: str,
    mass: float,
    inertia: float,
    pos: Point = (0.0, 0.0, 0.0),
    turn: float = 0.0,
) -> ET.Element:
    """Add a body with a moment of inertia, which counts about z alone."""
    body = _add(parent, 'body', name=name, pos=pos, euler=(0.0, 0.0, turn))
    _add(body, 'inertial', pos='0 0 0', mass=mass, diaginertia=(inertia,) * 3)
    return body


def _hinge(body: ET.Element, name: str, angle: float, **attributes: float) -> None:
    """Add a hinge about z, which is at an angle as the body is placed."""
    _add(body, 'joint', name=name, axis=_AXIS, ref=angle, **attributes)


def _draw(gear: TwinGear, links: dict[str, ET.Element], assets: ET.Element) -> None:
    """Add the shapes of all links, and the meshes that they need."""
    mechanism, module = gear.parameters.mechanism, gear.parameters.module
    if gear.parameters.meshes == NONE:
        visuals = simple(mechanism, module)
    else:
        visuals = meshed(mechanism, module, '')
        for name, solid in solids(mechanism, module).items():
            vertices, faces = np.unique(
                triangles(solid).reshape(-1, 3), axis=0, return_inverse=True
            )
            rows = (f'{value:.{_DIGITS}g}' for value in vertices.ravel().tolist())
            _add(
                assets,
                'mesh',
                name=name,
                vertex=' '.join(rows),
                face=' '.join(map(str, faces.ravel())),
            )
    for visual in visuals:
        geom = _add(links[visual.link], 'geom', type=visual.shape, pos=visual.xyz)
        if visual.yaw:
            geom.set('euler', _text((0.0, 0.0, visual.yaw)))
        geom.set('rgba', visual.colour)
        size = dict(visual.size)
        if 'filename' in size:
            geom.set('mesh', PurePath(size['filename']).stem)
        elif 'radius' in size:
            geom.set('size', f'{size["radius"]} {0.5 * float(size["length"])!r}')
        else:
            geom.set('size', _text(0.5 * float(side) for side in size['size'].split()))


# Constraints and springs


def _constraints(gear: TwinGear, equality: ET.Element) -> None:
    """Add what closes the loops, and the locks of rotor and output, which do not act."""
    for branch in gear.parameters.branches:
        coupling, slot = f'oldham_{branch.name}', f'slot_arm_{branch.name}'
        _add(
            equality, 'weld', name=coupling, body1=coupling, body2=slot, torquescale=_TORQUE_SCALE
        )
    for joint in ('rotor', 'output_shaft'):
        _add(equality, 'joint', name=f'{joint}_lock', joint1=joint, active='false')


def _springs(gear: TwinGear, tendon: ET.Element) -> None:
    """Add branches, shaft and elastic friction."""
    for number, branch in enumerate(gear.parameters.branches):
        low, high = gear.dead_bands[number]
        for name, spring in zip(branch_tendons(gear, number), gear.springs[number], strict=True):
            ends = low - spring.beyond, high + spring.beyond
            # The arm turns with the satellite, and that by its joint more than the rotor.
            joints = {'rotor': 1.0 / gear.ratio - 1.0, f'satellite_{branch.name}': -1.0}
            _fixed(tendon, name, joints, spring.stiffness, ends)
    if gear.has_shaft:
        joints = {f'arm_{gear.parameters.branches[0].name}': 1.0, 'output_shaft': -1.0}
        shaft = _fixed(tendon, 'shaft', joints, gear.shaft_stiffness)
        stiffness = gear.shaft_stiffness + greatest_stiffness(gear.springs[0])
        critical = 2.0 * math.sqrt(stiffness * _turning_inertia(gear))
        shaft.set('damping', _text(_ARM_DAMPING * critical))
    for number, slider in enumerate(gear.friction):
        if math.isfinite(slider.stiffness):
            joints = {'output_shaft': 1.0, f'friction_{number}': -1.0}
            _fixed(tendon, f'friction_{number}', joints, slider.stiffness)


def _fixed(
    tendon: ET.Element,
    name: str,
    joints: dict[str, float],
    stiffness: float,
    ends: tuple[float, float] = (0.0, 0.0),
) -> ET.Element:
    fixed = _add(tendon, 'fixed', name=name, stiffness=stiffness, springlength=ends)
    for joint, coefficient in joints.items():
        _add(fixed, 'joint', joint=joint, coef=coefficient)
    return fixed


# XML


def _add(parent: ET.Element, tag: str, **attributes: Any) -> ET.Element:
    """Add an element; numbers and sequences of numbers become text."""
    return ET.SubElement(parent, tag, {name: _text(each) for name, each in attributes.items()})


def _text(value: Any) -> str:
    if isinstance(value, str):
        return value
    if not isinstance(value, (int, float)):
        return ' '.join(map(_text, value))
    short = f'{value + 0.0:g}'  # no -0
    return short if float(short) == value else repr(value)
