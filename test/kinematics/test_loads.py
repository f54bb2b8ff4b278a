# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The loads: against multipliers at 50 digits, a robotics library, power, and by hand."""

import math
import re
from dataclasses import fields
from functools import partial

import load_oracles
import numpy as np
import oracle
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp
from properties import SHAPES, assert_close, assert_same, mechanisms, numbers_of, speed_up

from gear_kinematics.kinematics import Branch, Mechanism, MechanismError, solve, split_turns
from gear_kinematics.kinematics import loads as loading
from gear_kinematics.kinematics.loads import Bodies, LoadEquations, TorqueSharing
from gear_kinematics.kinematics.motion import closed_form
from gear_kinematics.kinematics.preload import Preload, Stiffness


def either_way(most: float):
    """Draw 0, or a number of either sign that is not lost beside others."""
    return st.just(0.0) | st.floats(1e-3, most) | st.floats(-most, -1e-3)


amounts = st.just(0.0) | st.builds(
    lambda mantissa, decade: mantissa * 10.0**decade, st.floats(1.0, 10.0), st.integers(-6, 2)
)
pressure_angles = st.just(0.0) | st.floats(0.0, 1.4)
all_bodies = st.builds(Bodies, *[amounts] * 5, pressure_angles)


@st.composite
def loaded(draw, max_branches: int = 4):
    """Draw a mechanism, the rotor's angle, velocity and acceleration, torques and bodies."""
    mechanism = draw(mechanisms(max_branches))
    rotor = draw(st.floats(-20.0, 20.0)), draw(either_way(1e3)), draw(either_way(1e5))
    torques = draw(hnp.arrays(np.float64, len(mechanism.branches), elements=either_way(1e3)))
    return mechanism, rotor, torques, draw(all_bodies)


def scales(mechanism, rotor, torques, bodies) -> dict[str, np.ndarray]:
    """Give for each field the sum of what may cancel in it, per branch; cf. `speed_up`."""
    radius, e = mechanism.satellite_rolling_radius, mechanism.eccentricity
    fastest = speed_up(mechanism) * max(abs(rotor[1]), math.sqrt(abs(rotor[2])), 1e-3)
    spin = max(abs(rotor[2]), 1e-6) / abs(float(mechanism.gear_ratio))
    orbit = (bodies.satellite_mass + bodies.coupling_mass) * e * fastest**2
    couple = np.abs(torques) + (bodies.satellite_inertia + bodies.coupling_inertia) * spin
    couple = couple + e * orbit
    tangential = couple / radius
    force = tangential / math.cos(bodies.pressure_angle) + orbit
    at_rotor = bodies.rotor_inertia * abs(rotor[2]) + np.sum(e * (tangential + orbit))
    return {
        'mesh_tangential': tangential,
        'mesh_force': force,
        'cam_force': force,
        'satellite_slot_force': np.full(couple.shape, orbit),
        'arm_slot_force': np.full(couple.shape, orbit),
        'satellite_couple': couple,
        'arm_couple': couple,
        'rotor_torque': at_rotor,
    }


def assert_expected(actual, expected, tolerances) -> None:
    """Compare loads of one state with those of an oracle, within 1e-12 of the scales."""
    rounding = 1e-40 * max(np.max(scale) for scale in tolerances.values())  # of 50 digits
    for name, scale in tolerances.items():
        values = np.array(getattr(expected, name), dtype=object).astype(float)
        tolerance = 1e-12 * (scale[:, np.newaxis] if values.ndim == 2 else scale) + rounding
        assert_close(getattr(actual, name), values, tolerance)


def of_oracle(find, mechanism, rotor, torques, bodies) -> load_oracles.ExpectedLoads:
    """Give what an oracle finds for plain numbers and the motion at 50 digits."""
    numbers, exact = numbers_of(mechanism), oracle.rotor_angle_of(rotor[0])
    motion = oracle.expected_derivatives(numbers, exact, *rotor[1:])
    masses = load_oracles.Masses(*(getattr(bodies, field.name) for field in fields(bodies)))
    return find(numbers, motion, rotor, torques, masses)


@pytest.mark.slow
@settings(max_examples=40)
@given(loaded(max_branches=3))
def test_loads_are_the_multipliers_of_the_constraint_jacobian(case):
    """At 50 digits, over the whole range of mechanisms."""
    mechanism, rotor, torques, bodies = case
    actual = loading.solve(mechanism, solve(mechanism, *rotor), torques, bodies)
    expected = of_oracle(load_oracles.multipliers, *case)
    assert_expected(actual, expected, scales(*case))


def test_loads_are_the_inverse_dynamics_of_another_library():
    """The machines have usual sizes, as the library solves in double precision."""
    pin = pytest.importorskip('pinocchio', reason='Pinocchio is not installed')
    generator = np.random.default_rng(37)
    for _ in range(60):
        ring_teeth = int(generator.integers(20, 200))
        branches = tuple(
            Branch(name, generator.uniform(-math.pi, math.pi), generator.uniform(-0.1, 0.1))
            for name in 'abcd'[: generator.integers(1, 5)]
        )
        satellite_teeth = int(generator.integers(ring_teeth // 2, ring_teeth))
        e = generator.uniform(0.0005, 0.005)
        mechanism = Mechanism(ring_teeth, satellite_teeth, e, branches)
        rotor = tuple(float(x) for x in generator.uniform(-1.0, 1.0, 3) * (20.0, 650.0, 1e4))
        torques = generator.uniform(-5.0, 5.0, len(branches))
        sizes = generator.uniform(0.1, 1.0, 6) * (0.5, 1e-4, 0.1, 1e-5, 1e-4, 1.0)
        case = mechanism, rotor, torques, Bodies(*map(float, sizes))
        expected = of_oracle(partial(load_oracles.inverse_dynamics, pin), *case)
        actual = loading.solve(mechanism, solve(mechanism, *rotor), *case[2:])
        assert_expected(actual, expected, scales(*case))


def power_of(force, velocity) -> np.ndarray:
    return np.sum(force * velocity, axis=-1)


def turned(arm, rate) -> np.ndarray:
    """Give the velocity of the end of an arm that turns at a rate."""
    return rate * np.stack([-arm[..., 1], arm[..., 0]], axis=-1)


@given(loaded())
def test_power_is_what_changes_the_kinetic_energy(case):
    """Forces act at the velocity of their points; the balance holds for each body and for all."""
    mechanism, (_, w, a), torques, bodies = case
    state = solve(mechanism, *case[1])
    loads = loading.solve(mechanism, state, torques, bodies)
    spin, centre, middle = state.output_velocity, state.satellite_centre, state.oldham_centre
    orbiting, drifting = state.satellite_velocity, state.oldham_velocity
    pitch_arm = centre / mechanism.eccentricity * mechanism.satellite_rolling_radius
    rolling = orbiting + turned(pitch_arm, spin)
    in_satellite, in_arm = orbiting + turned(middle - centre, spin), turned(middle, spin)
    energy_of_satellite = bodies.satellite_mass * power_of(state.satellite_acceleration, orbiting)
    energy_of_satellite += bodies.satellite_inertia * state.output_acceleration * spin
    energy_of_coupling = bodies.coupling_mass * power_of(state.oldham_acceleration, drifting)
    energy_of_coupling += bodies.coupling_inertia * state.output_acceleration * spin
    motor, of_rotor = loads.rotor_torque * w, bodies.rotor_inertia * a * w
    of_satellite_slot = power_of(loads.satellite_slot_force, drifting)
    sums = {
        # The mesh rolls, and what slides does so without friction.
        'mesh': power_of(loads.mesh_force, rolling),
        'slot of the satellite': of_satellite_slot
        - power_of(loads.satellite_slot_force, in_satellite),
        'slot of the arm': power_of(loads.arm_slot_force, drifting - in_arm),
        'satellite': power_of(loads.mesh_force, rolling)
        + power_of(loads.cam_force, orbiting)
        - power_of(loads.satellite_slot_force, in_satellite)
        - loads.satellite_couple * spin
        - energy_of_satellite,
        'coupling': of_satellite_slot
        + power_of(loads.arm_slot_force, drifting)
        + (loads.satellite_couple + loads.arm_couple) * spin
        - energy_of_coupling,
        'shaft': -power_of(loads.arm_slot_force, in_arm) - (loads.arm_couple + torques) * spin,
        'rotor': motor - power_of(loads.cam_force, turned(centre, w)).sum() - of_rotor,
        'all': motor
        - (torques * spin + energy_of_satellite + energy_of_coupling).sum()
        - of_rotor,
    }
    scale, fastest = scales(*case), speed_up(mechanism) * abs(w)
    most = fastest * (mechanism.eccentricity * scale['cam_force'] + scale['satellite_couple'])
    whole = np.sum(most) + scale['rotor_torque'] * abs(w)
    for rest in sums.values():
        assert_close(rest, np.zeros(np.shape(rest)), 1e-12 * (most if np.ndim(rest) else whole))


@pytest.mark.parametrize(('angle', 'torque'), [(0.0, 1.0), (2.0, 1.0), (-1.0, -3.0)])
def test_static_loads_of_the_default_actuator_by_hand(actuator, angle, torque):
    """F_t = T/rs, rs = 1.1 mm · 76/4 = 20.9 mm; tan 20° = 0.36397; i = -19."""
    bodies = Bodies(pressure_angle=math.radians(20.0))
    loads = loading.solve(actuator, solve(actuator, angle), [torque, 0.0], bodies)
    force = torque / 0.0209
    assert loads.mesh_tangential == pytest.approx([force, 0.0], rel=1e-14)
    theta, radial = angle, 0.3639702342662024 * abs(force)
    along_ring = np.array([-math.cos(theta), -math.sin(theta)])  # u'(θ)
    outwards = np.array([-math.sin(theta), math.cos(theta)])
    mesh = force * along_ring - radial * outwards
    assert loads.mesh_force[0] == pytest.approx(mesh, rel=1e-13)
    assert loads.cam_force[0] == pytest.approx(-mesh, rel=1e-13)
    assert loads.satellite_couple.tolist() == [torque, 0.0]
    assert loads.arm_couple.tolist() == [-torque, 0.0]
    assert not np.any(loads.satellite_slot_force)
    assert not np.any(loads.arm_slot_force)
    assert loads.rotor_torque == pytest.approx(-torque / 19.0, rel=1e-14)


def test_centrifugal_loads_by_hand(actuator):
    """Steady, and a satellite of 100 g: the cam holds it with m e w² = 0.1 · 0.0011 · 300²."""
    state = solve(actuator, 0.0, 300.0)
    loads = loading.solve(actuator, state, [0.0, 0.0], Bodies(satellite_mass=0.1))
    assert_close(loads.cam_force, [[0.0, -9.9], [0.0, 9.9]], 1e-13)
    assert loads.rotor_torque == 0.0


STIFFNESS = Stiffness(2000.0, 1000.0, 2000.0)  # kAe = kB = 1000 N·m/rad


@pytest.mark.parametrize('direction', [1, -1])
@pytest.mark.parametrize(('output', 'torque_a', 'torque_b', 'stand_off_a', 'stand_off_b'), [
    (0.0, 1.5, -1.5, 0.0, 0.0), (-1.0, 1.0, -2.0, 0.0, 0.0), (-3.0, 0.0, -3.0, 0.0, 0.0),
    (-4.0, 0.0, -4.0, 0.001, 0.0), (5.0, 5.0, 0.0, 0.0, 0.002),
])  # fmt: skip
def test_braced_branches_share_the_torque_by_hand(
    actuator, direction, output, torque_a, torque_b, stand_off_a, stand_off_b
):
    """T0 = 1.5 N·m: a branch leaves mesh at 3 N·m, beyond which the other yields 1 mrad/N·m."""
    preload = Preload.from_torque(STIFFNESS, 1.5)
    shares = TorqueSharing(actuator, preload, direction).branches(direction * output)
    assert_close(shares[0], direction * np.array([torque_a, torque_b]), 1e-14)
    assert_close(shares[1], [stand_off_a, stand_off_b], 1e-17)


@given(
    st.floats(-0.01, 0.01),
    hnp.arrays(np.float64, 5, elements=either_way(1e3)),
    st.sampled_from((1, -1)),
)
def test_shares_add_up_and_only_branches_in_mesh_carry(interference, outputs, direction):
    mechanism = Mechanism(80, 76, 0.0011, (Branch('a'), Branch('b')))
    preload = Preload(Stiffness(2000.0, 3000.0, 1000.0), interference)
    sharing = TorqueSharing(mechanism, preload, direction)
    torque, stand_off = (np.stack(values, axis=-1) for values in sharing.branches(outputs))
    assert_close(torque.sum(axis=-1), outputs, 1e-14 * (np.abs(outputs) + preload.torque))
    assert np.all(direction * torque * [1.0, -1.0] >= 0.0)
    assert np.all(stand_off >= 0.0)
    assert not np.any(torque * stand_off)
    for output, *row in zip(outputs.tolist(), torque, stand_off, strict=True):
        alone = sharing.branches(output)
        assert all(isinstance(value, float) for pair in alone for value in pair)
        np.testing.assert_array_equal(row, alone)


def test_branches_without_preload_have_equal_shares(mechanism):
    count = len(mechanism.branches)
    torques, stand_offs = TorqueSharing(mechanism).branches(np.array([6.0, -12.0]))
    assert_close(torques, [[6.0 / count, -12.0 / count]] * count, 1e-15)
    assert stand_offs == (0.0,) * count


@pytest.mark.slow
@settings(max_examples=60)
@given(loaded())
def test_arrays_and_floats_agree_to_the_last_bit(case):
    """`solve` of one sample among others, and the equations with plain floats."""
    mechanism, rotor, torques, bodies = case
    inputs = [[0.3, value] for value in rotor]
    among = loading.solve(mechanism, solve(mechanism, *inputs), [0.0 * torques, torques], bodies)
    form, ratio = closed_form(mechanism), mechanism.gear_ratio
    equations = LoadEquations(mechanism, bodies)
    turns, rest = split_turns(rotor[0])
    _, output = ratio.output_angle(turns, rest, math)
    turning = ratio.output_rate(rotor[2])
    positions, arm = form.branches(rest, output, math), (-math.sin(output), math.cos(output))
    inertias = [
        equations.inertia(position, arm, turning, a3, a4)
        for position, (*_, a3, a4) in zip(
            positions, form.rates(positions, *rotor[1:]), strict=True
        )
    ]
    branches = equations.branches(positions, torques.tolist(), inertias)
    names = [field.name for field in fields(among)[:-1]]
    for name, values in zip(names, zip(*branches, strict=True), strict=True):
        np.testing.assert_array_equal(getattr(among, name)[1], values, name)
    shares = [share for *_, share in inertias]
    assert among.rotor_torque[1] == equations.rotor_torque(shares, turning, torques.sum())


@pytest.mark.parametrize('shape', SHAPES, ids=str)
def test_shapes_and_types_are_those_of_the_contract(mechanism, shape):
    count = len(mechanism.branches)
    state, bodies = solve(mechanism, np.zeros(shape), 1.0), Bodies(1.0, 1.0)
    loads = loading.solve(mechanism, state, np.zeros((*shape, count)), bodies)
    for field in fields(loads):
        array = getattr(loads, field.name)
        ending = (count, 2) if field.name.endswith('force') else (count,)
        assert array.shape == (shape if field.name == 'rotor_torque' else (*shape, *ending))
        assert array.dtype == np.float64
        assert not array.flags.writeable
    assert_same(loads, loading.solve(mechanism, state, [0] * count, bodies))


def test_torques_and_state_broadcast(actuator):
    torques = np.arange(6.0).reshape(3, 1, 2)
    loads = loading.solve(actuator, solve(actuator, [0.1, 0.2]), torques)
    assert (loads.cam_force.shape, loads.rotor_torque.shape) == ((3, 2, 2, 2), (3, 2))
    alone = loading.solve(actuator, solve(actuator, 0.2), torques[2, 0])
    np.testing.assert_array_equal(loads.cam_force[2, 1], alone.cam_force)


def test_what_is_not_finite_gives_nan_where_it_matters(actuator):
    state = solve(actuator, 0.5, math.inf)
    assert np.all(np.isfinite(loading.solve(actuator, state, [1.0, 2.0]).cam_force))
    massive = loading.solve(actuator, state, [1.0, 2.0], Bodies(coupling_mass=1.0))
    assert np.all(np.isnan(massive.cam_force))
    loads = loading.solve(actuator, solve(actuator, 0.5), [math.nan, 2.0])
    assert np.isnan(loads.rotor_torque)
    assert np.isnan(loads.mesh_force).tolist() == [[True, True], [False, False]]


@pytest.mark.parametrize(
    ('shape', 'cause'),
    [
        ((), 'of 2 branches, not of the shapes (5, 2) and ()'),
        ((2, 3), 'of 2 branches, not of the shapes (5, 2) and (2, 3)'),
        ((4, 2), 'shape (5, 2) and arg 1 with shape (4, 2)'),
    ],
)
def test_torques_that_do_not_fit_are_refused(actuator, shape, cause):
    with pytest.raises(ValueError, match=re.escape(cause)):
        loading.solve(actuator, solve(actuator, np.zeros(5)), np.zeros(shape))


def test_what_belongs_to_another_mechanism_is_refused(actuator):
    three = Mechanism(80, 76, 0.0011, tuple(map(Branch, 'abc')))
    with pytest.raises(ValueError, match='must be of 3 branches'):
        loading.solve(three, solve(actuator, 0.0), np.zeros(3))
    with pytest.raises(MechanismError, match='exactly two branches are needed, not 3'):
        TorqueSharing(three, Preload.from_torque(STIFFNESS, 1.0))
    with pytest.raises(ValueError, match='direction must be 1 or -1, not 0'):
        TorqueSharing(actuator, direction=0)


def test_impossible_bodies_are_refused():
    with pytest.raises(MechanismError) as refused:
        Bodies(-1.0, coupling_mass='1', rotor_inertia=math.inf, pressure_angle=math.nan)
    names = [fault.split()[0] for fault in refused.value.faults]
    assert names == ['satellite_mass', 'coupling_mass', 'rotor_inertia', 'pressure_angle']
    with pytest.raises(MechanismError, match=r'pressure_angle must be less than π/2, not 1\.6'):
        Bodies(pressure_angle=1.6)
