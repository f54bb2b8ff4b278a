# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The fast model against statics by hand, the audited preload, and energy."""

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from gear_kinematics.kinematics import MechanismError
from gear_kinematics.kinematics.preload import Preload, Stiffness
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.twin.fast_model import FastModel
from gear_kinematics.twin.gear import TwinGear
from gear_kinematics.twin.model import TwinModel
from gear_kinematics.twin.parameters import TwinParameters

VALUES = {'play': 1e-3, 'friction': 0.0, 'rotor_damping': 0.0, 'output_inertia': 0.005}
SHARED = {
    'preload': 1.5,
    'branch_stiffness': [3000.0],
    'shaft_stiffness': 1000.0,
    'loads.rotor_inertia': 1e-5,
}
RATIO = -19.0


def gear(shared=(), **values) -> TwinGear:
    own = TwinParameters.of({**VALUES, **values})
    return TwinGear.of(NodeParameters.of({**SHARED, **dict(shared)}), own)


def branch(**values) -> TwinGear:
    """A gear with one branch of 3000 N·m/rad without play."""
    return gear({'branches': ['a'], 'preload': 0.0}, play=0.0, **values)


def ramp(model: TwinModel, *loads: float, seconds: float = 1.0, rotor: float = 0.0) -> None:
    """Ramp the load from each value to the next."""
    steps = round(1000 * seconds)
    for begin, end in pairwise(loads):
        for step in range(steps):
            model.advance(1e-3, rotor, begin + (end - begin) * (step + 1) / steps)


@pytest.mark.parametrize(
    ('load', 'torques'),
    # kAe = 750: A is relieved of a fifth of the load, and leaves at 7.5; B leaves at -1.875.
    [
        (0.0, (1.5, -1.5)),
        (1.0, (1.3, -2.3)),
        (-1.0, (1.7, -0.7)),
        (7.0, (0.1, -7.1)),
        (9.0, (0.0, -9.0)),
        (-3.0, (3.0, 0.0)),
    ],
)
@pytest.mark.parametrize('sign', [1.0, -1.0])
def test_branches_share_a_load_as_by_hand(load, torques, sign):
    model = FastModel(gear({'preload': 1.5 * sign}, play=0.1))
    model.rotor_locked = True
    ramp(model, 0.0, sign * load)
    assert model.branch_torques == pytest.approx([sign * each for each in torques], abs=0.02)


@pytest.mark.parametrize('interference', [2e-3, -2e-3])
def test_output_turns_as_the_preload_says(interference):
    """Beyond both thresholds, or through the play that is left."""
    braced = replace(gear(play=4e-3), interference=interference)
    loads = np.linspace(0.0, 6.0, 13)
    expected = Preload(Stiffness(3000.0, 3000.0, 1000.0), interference).split(loads).output_turn
    model = FastModel(replace(braced, friction=1e-3))  # ends the oscillation
    model.rotor_locked = True
    found = []
    for before, load in zip([0.0, *loads], loads, strict=False):
        ramp(model, before, load, load, seconds=0.5)
        found.append(model.output_angle)
    assert found[1:] == pytest.approx(expected[1:].tolist(), rel=0.01)


def test_motor_holds_a_load_by_the_ratio():
    model = FastModel(gear(friction=0.1))
    for step in range(1000):
        load = 1.9 * (step + 1) / 1000
        model.advance(1e-3, load / -RATIO, load)
    assert model.rotor_velocity == pytest.approx(0.0, abs=0.1)
    assert sum(model.branch_torques) == pytest.approx(-1.9, abs=0.12)  # friction holds the rest


def test_oscillation_has_its_frequency_and_keeps_its_energy():
    stiff, rotor, output = 3000.0, 1e-5, 0.005
    model = FastModel(branch())
    model.output_angle = 1e-3
    crossings, energies, before = [], [], 1e-3
    for k in range(20_000):
        model.advance(1e-4, 0.0, 0.0)
        twist = model.rotor_angle / RATIO - model.output_angle
        if before > 0.0 >= twist:
            crossings.append(k * 1e-4)
        before = twist
        energies.append(
            0.5 * stiff * twist**2
            + 0.5 * rotor * model.rotor_velocity**2
            + 0.5 * output * model.output_velocity**2
        )
    frequency = math.tau / np.diff(crossings).mean()
    assert frequency == pytest.approx(
        math.sqrt(stiff / (RATIO**2 * rotor) + stiff / output), rel=0.01
    )
    first, last = np.mean(energies[:2000]), np.mean(energies[-2000:])
    assert last == pytest.approx(first, rel=1e-3)
    assert first == pytest.approx(0.5 * stiff * 1e-6, rel=0.05)


def test_friction_holds_until_it_slides_and_opens_the_loop_by_twice_its_torque():
    model = FastModel(branch(friction=0.5))
    model.rotor_locked = True
    ramp(model, 0.0, 0.499)
    assert model.output_angle == 0.0
    ramp(model, 0.499, 4.0)
    assert 3000.0 * model.output_angle == pytest.approx(3.5, rel=2e-3)
    ramp(model, 4.0, 3.001)
    assert 3000.0 * model.output_angle == pytest.approx(3.5, rel=2e-3)
    ramp(model, 3.001, 1.0)
    assert 3000.0 * model.output_angle == pytest.approx(1.5, rel=2e-3)


def test_a_gear_that_is_too_stiff_for_its_inertia_is_refused():
    with pytest.raises(MechanismError, match='give more inertia or less stiffness'):
        FastModel(gear(output_inertia=1e-6))
