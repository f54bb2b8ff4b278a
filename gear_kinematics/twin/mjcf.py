# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""A simulated gear as a model of MuJoCo: one XML, in SI units.

Bodies, joints and frames are those of the URDF. A URDF is a tree; here, each coupling is welded to
a body that slides in the slot of the arm, which closes the loops. Each spring is a fixed tendon,
whose length is a sum of joint angles, because tendons can have a dead band in MuJoCo.
"""

import math
from collections import defaultdict
from collections.abc import Mapping, Sequence
from pathlib import PurePath
from xml.etree import ElementTree as ET
from xml.sax.saxutils import quoteattr

import numpy as np

from gear_kinematics.kinematics import MechanismError
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.parameters.meshes import NONE
from gear_kinematics.shape.solids import Solid, solids, triangles
from gear_kinematics.shape.visuals import Visual, cam_centre, meshed, simple
from gear_kinematics.twin.gear import TwinGear
from gear_kinematics.wire import topics

_MILLISECOND = 1e-3  # s
_LONGEST_STEP = 1e-4  # s
_PHASE = 0.7  # rad by which the fastest oscillation may advance in a step; beyond 2, it grows
_UNREACHED_WIND_UP = 1e6  # rad, greater than all wind-ups
_ARM_DAMPING = 0.05  # share of critical damping: the arm rests within ms, slow motions remain


def mjcf(
    gear: TwinGear,
    remarks: Sequence[str] = (),
    *,
    shown: bool = True,
    single_precision: bool = False,
) -> str:
    """Write the model, at rest without load at a rotor angle of 0.

    The remarks are lines of the comment in the file. The bodies are `shown` with their teeth,
    unless the parameter `meshes` is none. With `single_precision`, the closed loops are softer, as
    MuJoCo Warp requires. Raises MechanismError if only the ratio of the gear is known, or its
    satellites or couplings have no masses, and ModuleNotFoundError without the extra `mesh`, which
    teeth need.
    """
    mechanism, loads = gear.parameters.mechanism, gear.parameters.loads
    needed = 'satellite_mass', 'satellite_inertia', 'coupling_mass', 'coupling_inertia'
    if missing := [f'loads.{name}' for name in needed if not getattr(loads, name)]:
        raise MechanismError([f'MuJoCo needs more than 0 for {", ".join(missing)}'])
    step, error = _time_step(gear), gear.error(0.0)
    parts: defaultdict[str, str] = defaultdict(str)
    if shown:
        _add_shapes(gear.parameters, parts)
    for number in range(len(mechanism.branches)):
        _add_branch(gear, number, parts, 1 if single_precision else 200)
    orders = ''.join(
        f'<numeric name={quoteattr(order.name)}'
        f' data="{float(order.cycles)!r} {order.cos!r} {order.sin!r}"/>'
        for order in gear.errors
    )
    comment = '\n  '.join(remarks).replace('--', '- -')
    return _indented(f"""
<mujoco model="gear_kinematics">
<!--
  A gear of gear_kinematics for MuJoCo, in SI units; bodies and frames are those of the URDF.
  The length of the tendon branch_NAME is the wind-up of the branch,

      rotor angle / gear ratio - angle of its arm,

  and its springlength the play of the flanks. Positive torques push the output forwards. In the
  sensors of the branches, the third value is the torque on the output, from MuJoCo 3.14 on: older
  ones read a hundredth of it. MuJoCo Warp makes NaN of welds with a torquescale of 200. There is
  no gravity, and the arms weigh nothing: their inertia is that of the output. A spring that bends
  is several tendons. Of friction that depends on the load, the mean is given. MuJoCo has no
  kinematic errors: a program has to subtract them from springlength of all branches at each step.
  Numbers of its orders, if any, are cycles per turn of the rotor, and their cos and sin, rad.
  {comment}
-->
<compiler angle="radian"/>
<!--
  In a step, the fastest oscillation on the springs goes on by less than {_PHASE} rad.
  MuJoCo's constraints are soft. Their stiffest settings, and a torquescale of 200, make those
  that close the loops add less than 0.01 % to the compliance of the gear; one of 1, 0.04 %.
-->
<option timestep="{step!r}" integrator="implicitfast" gravity="0 0 0" iterations="10"
 tolerance="1e-12" jacobian="dense"><flag contact="disable" island="disable"/></option>
<visual><headlight ambient="0.5 0.5 0.5"/></visual>
<default>
  <equality solref="{2.0 * step!r} 1" solimp="0.9999 0.9999"/>
  <joint solreffriction="{2.0 * step!r} 1" solimpfriction="0.9999 0.9999"/>
  <geom contype="0" conaffinity="0" mass="0"/>
  <site size="5e-4"/>
</default>
<custom>{orders}</custom>
<worldbody>
  <body name="stator">{_inertial()}{parts['stator']}</body>
  <body name="rotor">
    {_inertial(loads.rotor_inertia)}
    <joint name="rotor" damping="{gear.rotor_damping!r}"/>
    {parts['on_rotor']}{parts['rotor']}
  </body>
  {parts['arm']}
  <body name="output_shaft" euler="0 0 {error!r}">
    {_inertial(gear.output_inertia)}
    <joint name="output_shaft" ref="{error!r}" frictionloss="{gear.friction!r}"/>
    {parts['on_shaft']}{parts['output_shaft']}
  </body>
</worldbody>
<equality>
  {parts['equality']}
  <joint name="rotor_lock" joint1="rotor" active="false"/>
  <joint name="output_shaft_lock" joint1="output_shaft" active="false"/>
</equality>
<tendon>{parts['tendon']}</tendon>
<actuator>
  <motor name="{topics.ROTOR_COMMAND}" joint="rotor"/>
  <motor name="{topics.LOAD_TORQUE}" joint="output_shaft"/>
</actuator>
<sensor>
  <jointpos name="{topics.ROTOR_STATE}_position" joint="rotor"/>
  <jointvel name="{topics.ROTOR_STATE}_velocity" joint="rotor"/>
  <jointpos name="{topics.OUTPUT_ENCODER}" joint="output_shaft"/>
  {parts['sensor']}
</sensor>
<asset>{parts['asset']}</asset>
</mujoco>
""")


def _time_step(gear: TwinGear) -> float:
    """Choose the time step, s; a whole number of steps makes a millisecond."""
    stiffness = sum(gear.stiffness)
    reflected = stiffness / gear.ratio**2 / gear.parameters.loads.rotor_inertia
    lightest = gear.turning_inertia + gear.output_inertia
    if gear.has_shaft:
        stiffness += gear.shaft_stiffness
        lightest = gear.turning_inertia
    longest = min(_LONGEST_STEP, _PHASE / math.sqrt(reflected + stiffness / lightest))
    return _MILLISECOND / math.ceil(_MILLISECOND / longest - 1e-9)


def _add_branch(gear: TwinGear, number: int, parts: dict[str, str], torquescale: int) -> None:
    """Add the bodies of a branch with their joints, springs and sensors.

    Two welded bodies, oldham and slot, make up the coupling, each with half of its mass. They turn
    with the satellite: each side of the weld has half of the whole inertia, with which the weld
    yields least. The site in the slot of the arm is upside down, so that its sensor gives the
    torque on the arm.
    """
    mechanism, loads = gear.parameters.mechanism, gear.parameters.loads
    branch, e = mechanism.branches[number], mechanism.eccentricity
    name, turn, behind_shaft = branch.name, gear.error(0.0), gear.has_shaft and not number
    if behind_shaft:
        turn += gear.shaft_twist  # to the angle of the arm
    across, along = e * math.sin(branch.cam_phase - turn), e * math.cos(branch.cam_phase - turn)
    x, y, z = cam_centre(branch, e)
    reach = mechanism.ring_rolling_radius / e
    parts['on_rotor'] += f"""
<site name="mesh_{name}" pos="{reach * x!r} {reach * y!r} {z!r}"/>
<body name="satellite_{name}" pos="{x!r} {y!r} {z!r}" euler="0 0 {turn!r}">
  {_inertial(0.5 * gear.turning_inertia, loads.satellite_mass)}
  <joint name="satellite_{name}" ref="{turn!r}"/>
  <site name="cam_{name}"/>
  <body name="oldham_{name}" pos="{across!r} 0 0">
    {_inertial(mass=0.5 * loads.coupling_mass)}
    <joint name="oldham_{name}" type="slide" axis="1 0 0" ref="{across!r}"/>
    <site name="slot_satellite_{name}"/>
    {parts[f'oldham_{name}']}
  </body>
  {parts[f'satellite_{name}']}
</body>"""
    slot = f"""
<body name="slot_arm_{name}" pos="0 {along!r} {z!r}">
  {_inertial(0.5 * gear.turning_inertia, 0.5 * loads.coupling_mass)}
  <joint name="slot_arm_{name}" type="slide" axis="0 1 0" ref="{along!r}"/>
  <site name="slot_arm_{name}" euler="{math.pi!r} 0 0"/>
</body>"""
    if behind_shaft:
        parts['arm'] = f"""
<body name="arm_{name}" euler="0 0 {turn!r}">
  {_inertial()}
  <joint name="arm_{name}" ref="{turn!r}"/>
  {slot}
</body>"""
        stiffness = gear.stiffness[0] + gear.shaft_stiffness
        damping = 2.0 * _ARM_DAMPING * math.sqrt(stiffness * gear.turning_inertia)
        joints = {f'arm_{name}': 1.0, 'output_shaft': -1.0}
        parts['tendon'] += _spring('shaft', gear.shaft_stiffness, joints, damping=damping)
    else:
        parts['on_shaft'] += slot
    # The arm turns with the satellite, whose joint is on the rotor.
    joints = {'rotor': 1.0 / gear.ratio - 1.0, f'satellite_{name}': -1.0}
    for stage, (low, high, stiffness) in enumerate(gear.springs(number)):
        tendon = f'branch_{name}.{stage}' if stage else f'branch_{name}'
        parts['tendon'] += _spring(
            tendon,
            stiffness,
            joints,
            (max(low, -_UNREACHED_WIND_UP), min(high, _UNREACHED_WIND_UP)),
        )
    parts['equality'] += f"""
<weld name="oldham_{name}" body1="oldham_{name}" body2="slot_arm_{name}"
 torquescale="{torquescale}"/>"""
    parts['sensor'] += f"""
<torque name="{topics.BRANCH_LOADS}_{name}" site="slot_arm_{name}"/>"""


def _inertial(inertia: float = 1e-9, mass: float = 1e-9) -> str:
    """Write moment of inertia about z, kg·m², and mass, kg; MuJoCo needs both to be positive."""
    moments = f'{inertia!r} {inertia!r} {inertia!r}'
    return f'<inertial pos="0 0 0" mass="{mass!r}" diaginertia="{moments}"/>'


def _spring(
    name: str,
    stiffness: float,
    joints: Mapping[str, float],
    ends: tuple[float, float] = (0.0, 0.0),
    damping: float = 0.0,
) -> str:
    """Write a tendon whose length is a weighted sum of joint angles, slack between two lengths."""
    terms = ''.join(f'<joint joint="{each}" coef="{joints[each]!r}"/>' for each in joints)
    low, high = ends
    return f"""
<fixed name="{name}" springlength="{low!r} {high!r}" stiffness="{stiffness!r}"
 damping="{damping!r}">{terms}</fixed>"""


def _add_shapes(parameters: NodeParameters, parts: dict[str, str]) -> None:
    """Add the shapes of all links, and their meshes."""
    mechanism, module = parameters.mechanism, parameters.module
    if parameters.meshes == NONE:
        visuals = simple(mechanism, module)
    else:
        visuals = meshed(mechanism, module, '')
        parts['asset'] = ''.join(
            _mesh(name, solid) for name, solid in solids(mechanism, module).items()
        )
    for visual in visuals:
        place = ' '.join(map(repr, visual.xyz))
        parts[visual.link] += f"""
<geom {_shape(visual)} pos="{place}" euler="0 0 {visual.yaw!r}" rgba="{visual.colour}"/>"""


def _shape(visual: Visual) -> str:
    """Write type and size of a geom; except for radii, MuJoCo takes half of the size in a URDF."""
    size = visual.size
    if visual.shape == 'mesh':
        return f'type="mesh" mesh="{PurePath(size["filename"]).stem}"'
    if visual.shape == 'cylinder':
        return f'type="cylinder" size="{size["radius"]} {0.5 * float(size["length"])!r}"'
    sides = ' '.join(repr(0.5 * float(side)) for side in size['size'].split())
    return f'type="box" size="{sides}"'


def _mesh(name: str, solid: Solid) -> str:
    """Write a mesh with each of its corners once, to 1 part in a million."""
    corners, faces = np.unique(triangles(solid).reshape(-1, 3), axis=0, return_inverse=True)
    vertex = ' '.join(f'{value:.6g}' for value in corners.ravel().tolist())
    face = ' '.join(map(str, faces.ravel().tolist()))
    return f'<mesh name="{name}" vertex="{vertex}" face="{face}"/>'


def _indented(text: str) -> str:
    """Indent an XML, with its comments."""
    builder = ET.TreeBuilder(insert_comments=True)
    root = ET.fromstring(text, ET.XMLParser(target=builder))  # noqa: S314, our own
    ET.indent(root)
    return ET.tostring(root, encoding='unicode', xml_declaration=True) + '\n'
