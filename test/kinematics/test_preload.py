# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The preload: against an exact solution of the unilateral contact, and the paper's numbers."""

import math
from fractions import Fraction
from itertools import product

import mpmath
import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from gear_kinematics.kinematics import Branch, Mechanism, MechanismError
from gear_kinematics.kinematics.preload import (
    Preload,
    Stiffness,
    braced,
    ring_phase,
    shaft_stiffness,
)
from gear_kinematics.kinematics.vernier import step

stiffnesses = st.builds(
    lambda mantissa, decade: mantissa * 10.0**decade, st.floats(1, 10), st.integers(-1, 5)
)
stiffness_triples = st.builds(Stiffness, stiffnesses, stiffnesses, stiffnesses)


def either_way(most: float):
    """Draw 0, or a number of either sign whose products do not underflow."""
    return st.just(0.0) | st.floats(1e-9, most) | st.floats(-most, -1e-9)


def equilibrium(stiffness: Stiffness, interference: float, load: float) -> tuple[Fraction, ...]:
    """Solve for T_A, T_B and the turn of arm B, exactly, by trying which branches touch.

    Arms A and B turn by a and b. Branch A touches while a < interference and pushes arm A with
    kA (interference - a); branch B touches while b > 0 and pushes arm B back with kB b; the shaft
    pulls both together with ks (a - b).
    """
    kA, kB, ks = (Fraction(k) for k in (stiffness.branch_a, stiffness.branch_b, stiffness.shaft))
    closed, M = Fraction(interference), Fraction(load)
    solutions = set()
    for in_a, in_b in product((1, 0), (1, 0)):
        # [kA + ks, -ks; -ks, ks + kB] [a; b] = [kA interference; M], kA or kB 0 out of mesh
        k11, k22 = in_a * kA + ks, in_b * kB + ks
        if not (determinant := k11 * k22 - ks * ks):
            continue
        a = (in_a * kA * closed * k22 + ks * M) / determinant
        b = (ks * in_a * kA * closed + k11 * M) / determinant
        if (a <= closed if in_a else a >= closed) and (b >= 0 if in_b else b <= 0):
            solutions.add((in_a * kA * (closed - a), in_b * kB * b, b))
    [solution] = solutions
    return solution


def unloaded(stiffness: Stiffness, interference: float) -> Fraction:
    """Position of arm B without load; with play, its middle."""
    if interference <= 0.0:
        return Fraction(interference) / 2
    return equilibrium(stiffness, interference, 0.0)[2]


@pytest.mark.slow
@given(
    stiffness=stiffness_triples,
    interference=either_way(0.1),
    relative=st.lists(either_way(3.0), min_size=1, max_size=6),
)
def test_split_is_the_equilibrium_of_unilateral_contacts(stiffness, interference, relative):
    """Loads of both signs, within the thresholds and far beyond, with preload and with play."""
    preload = Preload(stiffness, interference)
    scale = max(preload.threshold_a, -preload.threshold_b) or 1.0
    loads = np.array([scale * part for part in relative])
    assume(interference > 0.0 or np.all(loads != 0.0))
    split = preload.split(loads)
    start = unloaded(stiffness, interference)
    for load, branch_a, branch_b, turn in zip(loads, *split, strict=True):
        expected_a, expected_b, b = equilibrium(stiffness, interference, load)
        tolerance = 1e-14 * (preload.torque + abs(load))
        assert float(abs(Fraction(branch_a) - expected_a)) <= tolerance
        assert float(abs(Fraction(branch_b) - expected_b)) <= tolerance
        softest = stiffness.compliance * (preload.torque + abs(load)) + abs(interference)
        assert float(abs(Fraction(turn) - (b - start))) <= 1e-14 * softest
        # Out of mesh, arm A is where arm B is; its flank is where the branch would be closed.
        apart = b - Fraction(interference) if not expected_a else 0, -b if not expected_b else 0
        torques, stand_offs = preload.contacts(float(load))
        assert torques == (branch_a, branch_b)
        for torque, stand_off, expected in zip(torques, stand_offs, apart, strict=True):
            assert float(abs(Fraction(stand_off) - expected)) <= 1e-14 * softest
            assert not torque * stand_off


@pytest.mark.slow
@given(stiffness=stiffness_triples, interference=st.floats(1e-6, 0.1))
def test_a_branch_leaves_mesh_at_its_threshold(stiffness, interference):
    """Just below it touches, just above it does not."""
    preload = Preload(stiffness, interference)
    for branch, threshold in enumerate((preload.threshold_a, preload.threshold_b)):
        below = equilibrium(stiffness, interference, threshold * (1 - 1e-12))
        beyond = equilibrium(stiffness, interference, threshold * (1 + 1e-12))
        assert below[branch] > 0
        assert beyond[branch] == 0
        assert preload.split(threshold * (1 + 1e-12))[branch] == 0.0
    for load in (preload.limit * (1 - 1e-12), -preload.limit * (1 - 1e-12)):
        assert min(equilibrium(stiffness, interference, load)[:2]) > 0
    outside = (preload.limit * (1 + 1e-12), -preload.limit * (1 + 1e-12))
    assert min(min(equilibrium(stiffness, interference, load)[:2]) for load in outside) == 0


@pytest.mark.slow
@given(stiffness=stiffness_triples, interference=st.floats(1e-6, 0.1))
def test_stiffness_is_the_slope_within_and_beyond_the_thresholds(stiffness, interference):
    preload = Preload(stiffness, interference)
    a, b = preload.threshold_a, preload.threshold_b
    for start, end, expected in (
        (b / 2, a / 2, stiffness.both_in_mesh),
        (2 * a, 3 * a, stiffness.branch_b_alone),
        (3 * b, 2 * b, stiffness.branch_a_alone),
    ):
        turns = [equilibrium(stiffness, interference, load)[2] for load in (start, end)]
        slope = (Fraction(end) - Fraction(start)) / (turns[1] - turns[0])
        assert expected == pytest.approx(float(slope), rel=1e-12)


def test_numbers_of_the_paper(actuator):
    """Its shaft, and the preload of one step of its vernier on rigid branches."""
    shaft = shaft_stiffness(0.012, 0.151)
    assert shaft == pytest.approx(1069.0, abs=0.5)
    with mpmath.workdps(30):
        exact = mpmath.mpf(79.3e9) * mpmath.pi * mpmath.mpf(0.012) ** 4 / 32 / mpmath.mpf(0.151)
    assert shaft == pytest.approx(float(exact), rel=1e-15)
    rigid = Stiffness(math.inf, math.inf, shaft)
    preload = Preload.from_ring_turn(actuator, rigid, step(80))
    assert preload.torque == pytest.approx(0.0266, abs=5e-5)


def test_a_rigid_branch_at_the_output_takes_every_load_itself():
    """The other one then never leaves mesh."""
    stiffness = Stiffness(math.inf, math.inf, 1000.0)
    preload = Preload(stiffness, 0.001)
    assert preload.threshold_a == math.inf
    assert preload.limit == -preload.threshold_b == 1.0
    assert stiffness.both_in_mesh == stiffness.branch_b_alone == math.inf
    assert stiffness.branch_a_alone == 1000.0
    split = [values.tolist() for values in preload.split([0.0, 1e6])]
    assert split == [[1.0, 1.0], [1.0, 1e6 + 1.0], [0.0, 0.0]]
    assert Preload(Stiffness(math.inf, 1000.0, math.inf), 0.001).threshold_b == -math.inf


@given(ring_turn=either_way(0.05), backlash=st.floats(0.0, 0.05), stiffness=stiffness_triples)
def test_preload_begins_where_the_backlash_is_closed(actuator, ring_turn, backlash, stiffness):
    """In either direction; before, the turn reduces the play."""
    preload = Preload.from_ring_turn(actuator, stiffness, ring_turn, backlash)
    net = abs(Fraction(ring_turn)) - Fraction(76, 80) * Fraction(backlash)
    at_output = float(Fraction(80, 76) * net)
    compliance = 1 / Fraction(stiffness.branch_a) + 1 / Fraction(stiffness.branch_b)
    compliance += 1 / Fraction(stiffness.shaft)
    assert preload.torque == pytest.approx(
        max(at_output, 0) / float(compliance), rel=1e-9, abs=1e-12
    )
    assert preload.play == pytest.approx(max(-at_output, 0.0), rel=1e-12, abs=1e-16)
    assert not (preload.torque and preload.play)


@given(
    wanted=st.just(0.0) | st.floats(1e-9, 100.0),
    backlash=st.floats(0.0, 0.05),
    stiffness=stiffness_triples,
)
def test_ring_turns_for_wanted_preloads_and_thresholds_give_them(
    actuator, wanted, backlash, stiffness
):
    for inverse, figure in ((Preload.from_torque, 'torque'), (Preload.from_limit, 'limit')):
        turn = inverse(stiffness, wanted).ring_turn(actuator, backlash)
        given_back = Preload.from_ring_turn(actuator, stiffness, turn, backlash)
        rounding = 1e-15 * (turn + backlash) / stiffness.compliance * 4.0
        assert getattr(given_back, figure) == pytest.approx(wanted, rel=1e-13, abs=4.0 * rounding)


@pytest.mark.parametrize(('ring_teeth', 'satellite_teeth', 'cam_phases', 'pitches'), [
    (80, 76, (0.0, 0.0), 0.0), (80, 76, (0.0, math.pi), 0.0), (80, 78, (0.0, math.pi), 0.0),
    (61, 58, (0.0, math.pi), 0.5), (61, 58, (0.0, -math.pi), 0.5),
    (61, 58, (0.0, math.pi / 3), 0.5), (61, 58, (0.0, math.pi / 6), 0.25),
    (80, 76, (1.0, 1.0 + math.pi / 8), 0.25), (80, 76, (math.pi / 8, 0.0), -0.25),
])  # fmt: skip
def test_ring_phase_makes_branch_b_mesh_as_branch_a(
    ring_teeth, satellite_teeth, cam_phases, pitches
):
    """The meshing condition of both branches, at any rotor angle, with satellites alike."""
    branches = (Branch('a', cam_phases[0]), Branch('b', cam_phases[1]))
    mechanism = Mechanism(ring_teeth, satellite_teeth, 0.001, branches)
    phase = ring_phase(mechanism)
    assert abs(phase) <= math.pi / ring_teeth
    off = phase * ring_teeth / (2.0 * math.pi) - pitches
    assert off - round(off) == pytest.approx(0.0, abs=1e-14)
    for rotor_angle in (0.0, 0.7, 5.0):
        output_angle = rotor_angle / float(mechanism.gear_ratio)
        meshing = [
            ring_teeth * (rotor_angle + cam - ring)
            - satellite_teeth * (rotor_angle + cam - output_angle)
            for cam, ring in zip(cam_phases, (0.0, phase), strict=True)
        ]
        turns = (meshing[1] - meshing[0]) / (2.0 * math.pi)
        assert turns - round(turns) == pytest.approx(0.0, abs=1e-12)


def test_only_two_branches_are_braced(mechanism):
    if len(mechanism.branches) == 2:
        assert braced(mechanism) == mechanism.branches
        return
    count = len(mechanism.branches)
    for refusing in (braced, ring_phase):
        with pytest.raises(MechanismError, match=f'two branches .* not {count}'):
            refusing(mechanism)


@pytest.mark.parametrize(
    ('values', 'causes'),
    [
        ((0.0, -1.0, 5.0), ['branch a must be greater than 0', 'branch b must be greater than 0']),
        ((1.0, 1.0, math.nan), ['shaft must be greater than 0, not nan']),
        ((math.inf, math.inf, math.inf), ['must neither all be rigid']),
        ((1.0, 1e-320, 1.0), ['nor have infinite compliance']),
    ],
)
def test_impossible_stiffnesses_are_refused(values, causes):
    with pytest.raises(MechanismError) as refused:
        Stiffness(*values)
    assert len(refused.value.faults) == len(causes)
    for fault, cause in zip(refused.value.faults, causes, strict=True):
        assert cause in fault


@pytest.mark.parametrize('value', [0.0, -0.012, math.inf, math.nan])
def test_impossible_shafts_are_refused(value):
    for place, name in enumerate(('diameter', 'length', 'shear modulus')):
        sizes = [0.012, 0.151, 79.3e9]
        sizes[place] = value
        with pytest.raises(MechanismError, match=f'{name} must be finite and greater than 0'):
            shaft_stiffness(*sizes)


@pytest.mark.parametrize('value', [-1e-9, math.inf, math.nan])
def test_impossible_requests_are_refused(value, actuator):
    stiffness = Stiffness(1.0, 1.0, 1.0)
    for name, wish in (
        ('preload', lambda: Preload.from_torque(stiffness, value)),
        ('threshold', lambda: Preload.from_limit(stiffness, value)),
        ('backlash', lambda: Preload.from_ring_turn(actuator, stiffness, 0.0, value)),
        ('backlash', lambda: Preload(stiffness, 0.0).ring_turn(actuator, value)),
    ):
        with pytest.raises(MechanismError, match=f'{name} must be finite and not negative'):
            wish()
    with pytest.raises(MechanismError, match='interference must be finite'):
        Preload.from_ring_turn(actuator, stiffness, math.inf)
