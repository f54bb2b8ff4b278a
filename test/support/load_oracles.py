# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Expected loads of the mechanism, from sources that know none of its equations of forces.

At 50 digits they are the multipliers of the constraint Jacobian, whose rows are the velocities
that the joints forbid. In double precision they are the inverse dynamics of a robotics library for
the tree of rotor, satellites and couplings: the loops are cut at the meshes and at the slots of
the arms, whose reactions are those for which bearings and slots without a motor carry no load
along their motion. The motion is the oracle's. Nothing of `gear_kinematics` is imported here.
"""

from itertools import chain
from typing import NamedTuple

import numpy as np
from oracle import Derivatives, Numbers, Real, mp

Wrench = tuple[np.ndarray, float]
"""A force (N) with the torque (N·m) that it has about the centre of the body."""


class Masses(NamedTuple):
    """The bodies in plain numbers, in the order of `loads.Bodies`."""

    satellite_mass: float
    satellite_inertia: float
    coupling_mass: float
    coupling_inertia: float
    rotor_inertia: float
    pressure_angle: float


class ExpectedLoads(NamedTuple):
    """Fields as in `loads.Loads`, of one state: lists over the branches, forces as pairs."""

    mesh_tangential: list
    mesh_force: list
    cam_force: list
    satellite_slot_force: list
    arm_slot_force: list
    satellite_couple: list
    arm_couple: list
    rotor_torque: Real


def multipliers(
    numbers: Numbers, motion: Derivatives, rotor: tuple, torques: list[float], masses: Masses
) -> ExpectedLoads:
    """Solve M q'' = Jᵀ λ + Q at 50 digits for λ, the rotor's torque and the load of the shaft.

    The share of each branch in the torque of the shaft is given, as J has redundant rows. A flank
    pushes, and never pulls: which of the two touches follows from the direction of the force.
    """
    radius = mp.mpf(numbers.eccentricity) * numbers.satellite_teeth
    radius /= numbers.ring_teeth - numbers.satellite_teeth
    sides = [1 if torque >= 0.0 else -1 for torque in torques]  # a guess
    for _ in range(2):
        points = _points(numbers, motion, masses, radius, sides)
        solution, rotor_torque = _solve(motion, rotor[2], points, torques, masses)
        pulling = [force[6] < -mp.mpf('1e-40') * max(map(abs, force)) for force in solution]
        if not any(pulling):
            break
        sides = [-side if pulls else side for side, pulls in zip(sides, pulling, strict=True)]
    assert not any(pulling)
    loads = ExpectedLoads([], [], [], [], [], [], [], rotor_torque)
    for force, point in zip(solution, points, strict=True):
        mesh = _times(force[6], point.flank)
        loads.mesh_tangential.append(_dot(mesh, point.tangent))
        loads.mesh_force.append(mesh)
        loads.cam_force.append((force[0], force[1]))
        loads.satellite_couple.append(force[2])
        loads.satellite_slot_force.append(_times(force[3], point.satellite_normal))
        loads.arm_couple.append(force[4])
        loads.arm_slot_force.append(_times(force[5], point.arm_normal))
    return loads


class _Points(NamedTuple):
    """Where the joints of a branch are, and along which directions they hold."""

    satellite: tuple
    coupling: tuple
    pitch_point: tuple
    satellite_normal: tuple
    """Across the slot of the satellite: y of its frame."""
    arm_normal: tuple
    """Across the slot of the arm: x of the output shaft's frame."""
    tangent: tuple
    flank: tuple
    """Directions of the force on the satellite: across touching flanks, and towards the axis."""


def _points(numbers, motion, masses, radius, sides) -> list[_Points]:
    c5, s5 = mp.cos_sin(motion.value.output_angle)
    cos, sin = mp.cos_sin(mp.mpf(masses.pressure_angle))
    points = []
    for branch, side in zip(motion.value.branches, sides, strict=True):
        x, y = branch.satellite_centre[:2]
        ux, uy = x / mp.mpf(numbers.eccentricity), y / mp.mpf(numbers.eccentricity)
        c3, s3 = mp.cos_sin(branch.satellite_angle)
        flank = -side * cos * uy - sin * ux, side * cos * ux - sin * uy
        points.append(
            _Points(
                (x, y),
                branch.oldham_centre[:2],
                (x + radius * ux, y + radius * uy),
                (-s3, c3),
                (c5, s5),
                (-uy, ux),
                flank,
            )
        )
    return points


def _forbidden(twists: list, points: list[_Points]) -> tuple[list, list[list]]:
    """Give the velocities that the joints forbid: of rotor and shaft, and of each branch.

    Twists are (x', y', angle') of rotor, shaft, and of each branch satellite and coupling.
    """
    rotor, shaft, *rest = twists
    at_axis = [*rotor[:2], *shaft[:2]]
    of_branches = []
    for k, point in enumerate(points):
        satellite, coupling = rest[2 * k : 2 * k + 2]
        on_satellite = _velocity(satellite, point.satellite, point.coupling)
        on_arm = _velocity(shaft, (0, 0), point.coupling)
        cam = _velocity(rotor, (0, 0), point.satellite)
        mesh = _velocity(satellite, point.satellite, point.pitch_point)
        of_branches.append(
            [
                satellite[0] - cam[0],
                satellite[1] - cam[1],
                coupling[2] - satellite[2],
                _dot(point.satellite_normal, _minus(coupling, on_satellite)),
                coupling[2] - shaft[2],
                _dot(point.arm_normal, _minus(coupling, on_arm)),
                _dot(point.flank, mesh),
            ]
        )
    return at_axis, of_branches


def _solve(
    motion: Derivatives, rotor_acceleration: float, points, torques, masses
) -> tuple[list[list[Real]], Real]:
    """Give the multipliers of each branch, and the torque of the rotor."""
    count = len(points)
    size, shaft_angle = 3 * (2 + 2 * count), 5
    unknowns = size + count  # 4 + 7 B multipliers, the rotor's torque, the load of the shaft
    matrix, right = mp.zeros(unknowns), mp.zeros(unknowns, 1)
    for row in range(size):
        unit = [[mp.mpf(3 * body + axis == row) for axis in range(3)] for body in range(size // 3)]
        at_axis, of_branches = _forbidden(unit, points)
        for column, entry in enumerate(chain(at_axis, *of_branches)):
            matrix[row, column] = entry
        if row == shaft_angle:
            for k, entries in enumerate(of_branches):
                for n, entry in enumerate(entries):
                    matrix[size + k, 4 + 7 * k + n] = entry
                right[size + k] = mp.mpf(torques[k])
    matrix[2, unknowns - 2] = matrix[shaft_angle, unknowns - 1] = mp.one
    turning = motion.second.output_angle
    right[2] = mp.mpf(masses.rotor_inertia) * rotor_acceleration
    for k, branch in enumerate(motion.second.branches):
        x, y = branch.satellite_centre[:2]
        right[6 + 6 * k] = masses.satellite_mass * x
        right[7 + 6 * k] = masses.satellite_mass * y
        right[8 + 6 * k] = masses.satellite_inertia * turning
        x, y = branch.oldham_centre[:2]
        right[9 + 6 * k] = masses.coupling_mass * x
        right[10 + 6 * k] = masses.coupling_mass * y
        right[11 + 6 * k] = masses.coupling_inertia * turning
    found = list(mp.lu_solve(matrix, right))
    return [found[4 + 7 * k : 11 + 7 * k] for k in range(count)], found[unknowns - 2]


def _velocity(twist: list, centre: tuple, point: tuple) -> tuple:
    """Velocity of a point of a body whose centre moves with the twist."""
    return twist[0] - twist[2] * (point[1] - centre[1]), twist[1] + twist[2] * (
        point[0] - centre[0]
    )


def _dot(left, right):
    return left[0] * right[0] + left[1] * right[1]


def _minus(left, right) -> tuple:
    return left[0] - right[0], left[1] - right[1]


def _times(factor, vector) -> tuple:
    return factor * vector[0], factor * vector[1]


def inverse_dynamics(
    pin, numbers: Numbers, motion: Derivatives, rotor: tuple, torques: list[float], masses: Masses
) -> ExpectedLoads:
    """Find the loads by Pinocchio.

    Args:
        pin: its module.
        numbers: of the mechanism.
        motion: of it, by the oracle.
        rotor: its angle, velocity and acceleration.
        torques: of each branch on the shaft, N·m.
        masses: for the pressure angle.
    """
    tree, count = PinocchioTree(pin, numbers, masses), len(torques)
    tree.move(*_joints(motion, rotor))
    output = float(motion.value.output_angle)
    arm = np.array([np.cos(output), np.sin(output)])  # x of the output shaft: across its slot
    radius = numbers.eccentricity * numbers.satellite_teeth
    radius /= numbers.ring_teeth - numbers.satellite_teeth
    cos, sin = np.cos(masses.pressure_angle), np.sin(masses.pressure_angle)
    units, bodies = [], motion.value.branches
    for branch in bodies:
        x, y = (float(value) / numbers.eccentricity for value in branch.satellite_centre[:2])
        units.append((np.array([-y, x]), np.array([x, y])))
    levers = [_cross([float(value) for value in b.oldham_centre[:2]], arm) for b in bodies]

    def wrenches(pushes, sides, slots, shares):
        """Give the wrenches of the rings on the satellites, then of the arms on the couplings."""
        flanks = [
            side * cos * along - sin * away
            for side, (along, away) in zip(sides, units, strict=True)
        ]
        at_rings = [
            (push * flank, radius * push * _cross(away, flank))
            for push, flank, (_, away) in zip(pushes, flanks, units, strict=True)
        ]
        at_arms = [
            (slot * arm, -share - slot * lever)
            for slot, share, lever in zip(slots, shares, levers, strict=True)
        ]
        return at_rings, at_arms

    sides, zero, unit = np.ones(count), np.zeros(count), np.eye(count)
    for _ in range(2):  # a flank pushes: which of the two touches follows from the force
        free = tree.torques(*wrenches(zero, sides, zero, torques))
        nothing = tree.torques(*wrenches(zero, sides, zero, zero))
        columns = [tree.torques(*wrenches(e, sides, zero, zero)) - nothing for e in unit]
        columns += [tree.torques(*wrenches(zero, sides, e, zero)) - nothing for e in unit]
        matrix = np.transpose(columns)[1:]  # all joints but the rotor's
        found = np.linalg.solve(matrix, -free[1:])
        pulling = found[:count] < 0.0
        sides = np.where(pulling, -sides, sides)
    pushes, slots = found[:count], found[count:]
    at_rings, at_arms = wrenches(pushes, sides, slots, torques)
    turned, slid = tree.joints(at_rings, at_arms)
    return ExpectedLoads(
        [_dot(force, along) for (force, _), (along, _) in zip(at_rings, units, strict=True)],
        [force for force, _ in at_rings],
        [force for force, _ in turned],
        [force for force, _ in slid],
        [force for force, _ in at_arms],
        [torque for _, torque in slid],
        [torque for _, torque in at_arms],
        tree.torques(at_rings, at_arms)[0],
    )


def _cross(left, right) -> float:
    return left[0] * right[1] - left[1] * right[0]


def _joints(motion: Derivatives, rotor: tuple) -> tuple[list[float], ...]:
    """Positions, velocities and accelerations: the rotor, then satellite and slide per branch."""
    orders = []
    for values, own in zip(motion, rotor, strict=True):
        joints = [float(own)]
        for branch in values.branches:
            joints += [float(values.output_angle - own), float(branch.satellite_slide)]
        orders.append(joints)
    return tuple(orders)


class PinocchioTree:
    """Rotor, satellites and couplings in Pinocchio."""

    def __init__(self, pin, numbers: Numbers, masses: Masses) -> None:
        self._pin, self._model = pin, pin.Model()
        model, e = self._model, numbers.eccentricity

        def attach(parent, joint, place, mass, inertia, name):
            added = model.addJoint(parent, joint, pin.SE3(np.eye(3), np.array(place)), name)
            body = pin.Inertia(mass, np.zeros(3), inertia * np.eye(3))
            model.appendBodyToJoint(added, body, pin.SE3.Identity())
            return added

        model.gravity.linear = np.zeros(3)
        rotor = attach(0, pin.JointModelRZ(), [0, 0, 0], 0.0, masses.rotor_inertia, 'rotor')
        for k, (phase, axial) in enumerate(numbers.branches):
            cam = [-e * np.sin(phase), e * np.cos(phase), axial]
            satellite = attach(rotor, pin.JointModelRZ(), cam, *masses[:2], f'satellite {k}')
            attach(satellite, pin.JointModelPX(), [0, 0, 0], *masses[2:4], f'coupling {k}')
        self._data = model.createData()

    def move(self, q, v, a) -> None:
        self._state = np.array(q), np.array(v), np.array(a)
        self._pin.forwardKinematics(self._model, self._data, *self._state)

    def torques(self, at_rings, at_arms) -> np.ndarray:
        """Give what the motors of the joints would have to give."""
        pin, placed = self._pin, self._data.oMi
        outside = [pin.Force.Zero() for _ in range(self._model.njoints)]
        for joint, (force, torque) in zip(self._order(), [*at_rings, *at_arms], strict=True):
            world = pin.Force(np.array([*force, 0.0]), np.array([0.0, 0.0, torque]))
            outside[joint] = pin.SE3(placed[joint].rotation, np.zeros(3)).actInv(world)
        return pin.rnea(self._model, self._data, *self._state, outside).copy()

    def joints(self, at_rings, at_arms) -> tuple[list[Wrench], list[Wrench]]:
        """Give what cams do to satellites, and satellites to couplings."""
        self.torques(at_rings, at_arms)
        found = []
        for joint in self._order():
            turn, carried = self._data.oMi[joint].rotation, self._data.f[joint]
            found.append(((turn @ carried.linear)[:2], (turn @ carried.angular)[2]))
        return found[: len(at_rings)], found[len(at_rings) :]

    def _order(self) -> list[int]:
        """All satellites, then all couplings."""
        return [*range(2, self._model.njoints, 2), *range(3, self._model.njoints, 2)]
