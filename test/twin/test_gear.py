# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""A simulated gear: where its branches touch, its errors, and how it is loaded."""

import math
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest

from gear_kinematics.correction.calibration_file import Order
from gear_kinematics.kinematics import Branch
from gear_kinematics.kinematics.loads import TorqueSharing
from gear_kinematics.kinematics.preload import Preload, Stiffness
from gear_kinematics.parameters import ConfigError, NodeParameters
from gear_kinematics.twin.gear import TwinGear
from gear_kinematics.twin.parameters import default_config

STIFFNESS = 3000.0, 2000.0, 1000.0
"""kA, kB, ks, N·m/rad."""


@pytest.fixture(scope='module')
def default() -> TwinGear:
    return TwinGear.load(default_config())


@pytest.fixture
def braced(default) -> TwinGear:
    """A preload of 3 N·m twists it by 3/3000 + 3/2000 + 3/1000 rad."""
    kA, kB, ks = STIFFNESS
    return replace(default, stiffness=(kA, kB), shaft_stiffness=ks, interference=5.5e-3, play=1e-3)


def mirrored(gear: TwinGear) -> TwinGear:
    return replace(gear, parameters=replace(gear.parameters, preload=-1.0))


def with_branches(gear: TwinGear, count: int) -> TwinGear:
    branches = tuple(Branch(name) for name in 'abc'[:count])
    parameters = replace(gear.parameters, branches=branches, preload=0.0)
    return replace(gear, parameters=parameters, stiffness=gear.stiffness[:1] * count)


# Where the branches touch.


def test_dead_bands_by_hand(braced):
    assert braced.preload == pytest.approx(3.0, rel=1e-14)
    bands = (-5e-3, -4e-3), (1.5e-3, 2.5e-3)
    assert np.array(braced.dead_bands) == pytest.approx(np.array(bands), rel=1e-14)
    turned = mirrored(braced)
    assert turned.preload == pytest.approx(-3.0, rel=1e-14)
    bands = (4e-3, 5e-3), (-2.5e-3, -1.5e-3)
    assert np.array(turned.dead_bands) == pytest.approx(np.array(bands), rel=1e-14)


def test_play_that_is_left_is_centred(braced):
    loose = replace(braced, interference=-4e-4)
    assert loose.preload == loose.shaft_twist == 0.0
    assert np.array(loose.dead_bands) == pytest.approx(
        np.array([(-8e-4, 2e-4), (-2e-4, 8e-4)]), rel=1e-12
    )


@pytest.mark.parametrize('count', [1, 3])
def test_branches_that_are_not_braced_have_their_play_around_no_load(braced, count):
    gear = with_branches(braced, count)
    assert gear.dead_bands == ((-5e-4, 5e-4),) * count
    ends = 4.9e-4, -4.9e-4, 1.5e-3, -1.5e-3
    torques = [gear.torques((end,) * count)[0][0] for end in ends]
    assert torques == pytest.approx([0.0, 0.0, 3.0, -3.0])
    assert gear.preload == 0.0
    assert not gear.has_shaft


def test_wear_takes_from_the_preload_and_then_leaves_play(braced):
    assert braced.worn(1.1e-3).preload == pytest.approx(2.4, rel=1e-13)
    worn = braced.worn(7.5e-3)
    assert worn.preload == 0.0
    (_, high_a), (low_b, _) = worn.dead_bands
    assert high_a - low_b == pytest.approx(2e-3, rel=1e-12)
    assert worn.play == pytest.approx(8.5e-3)


@pytest.mark.parametrize('sign', [1.0, -1.0])
@pytest.mark.parametrize('interference', [5.5e-3, -4e-4])
def test_statics_are_those_of_the_audited_preload(braced, sign, interference):
    """The output is turned, and what holds it there is the load."""
    from scipy.optimize import brentq  # noqa: PLC0415, takes long

    gear = replace(braced, interference=interference, play=0.1)
    gear = gear if sign > 0.0 else mirrored(gear)
    ks = gear.shaft_stiffness
    preload = Preload(Stiffness(*STIFFNESS), interference)
    sharing = TorqueSharing(gear.parameters.mechanism, preload, int(sign))
    for output in np.linspace(-6e-3, 6e-3, 41):

        def excess(arm, output=output):
            return gear.torques((-arm, 0.0))[0][0] - ks * (arm - output)

        arm = brentq(excess, -0.1, 0.1, xtol=1e-16)
        torques, _ = gear.torques((-arm, -output))
        load = -sum(torques)
        shared, _ = sharing.branches(-load)
        assert torques == pytest.approx(shared, abs=1e-10)
        expected = sign * float(preload.split(sign * load).output_turn)
        if load:
            assert output == pytest.approx(expected, abs=1e-13)
        else:
            assert abs(output) <= abs(interference) / 2.0 + 1e-15


# Errors.


def test_error_is_the_sum_of_its_orders(default):
    orders = Order('cam', Fraction(1), 3e-4, 4e-4), Order('output', Fraction(-1, 19), 0.0, 1e-4)
    gear = replace(default, errors=orders)
    assert gear.error(0.0) == pytest.approx(3e-4)
    assert gear.error(math.pi / 2.0) == pytest.approx(4e-4 - 1e-4 * math.sin(math.pi / 38.0))


# Loading.


def test_the_default_gear_is_as_its_file_says(default):
    assert default.preload == pytest.approx(2.0)
    assert default.interference == pytest.approx(2.0 * (2.0 / 3000.0 + 1.0 / 1069.0))
    assert default.stiffness == (3000.0, 3000.0)
    assert default.friction == 0.1
    assert default.ratio == -19.0


def test_gear_state_publisher_takes_the_same_file(default):
    assert NodeParameters.load(default_config()) == default.parameters


@pytest.fixture
def config(tmp_path):
    """Write a parameter file with other values."""

    def write(**values) -> TwinGear:
        given = {'branch_stiffness': '[3000.0]', 'loads.rotor_inertia': 1e-5, 'play': 0.001}
        lines = (f'    {name}: {value}\n' for name, value in (given | values).items())
        path = tmp_path / 'gear.yaml'
        path.write_text(f'gear_simulator:\n  ros__parameters:\n{"".join(lines)}', 'utf-8')
        return TwinGear.load(path)

    return write


def test_without_a_preload_the_play_is_left(config):
    gear = config()
    assert gear.interference == -0.001
    assert gear.dead_bands == ((-0.0005, 0.0005),) * 2
    assert math.isinf(gear.shaft_stiffness)


def test_a_gear_of_which_only_the_ratio_is_known_has_one_branch(config):
    gear = config(gear_ratio='"7.2"')
    assert gear.ratio == 7.2
    assert gear.dead_bands == ((-0.0005, 0.0005),)


@pytest.mark.parametrize(
    ('values', 'fault'),
    [
        ({'branch_stiffness': '[0.0]'}, 'branch_stiffness must be greater than 0'),
        ({'loads.rotor_inertia': 0.0}, r'loads\.rotor_inertia must be greater than 0'),
        ({'branches': '[a]', 'branch_stiffness': '[1.0, 2.0]'}, '2 values for 1 branches'),
        ({'branches': '[a]', 'preload': 1.0}, 'exactly two branches'),
        ({'preload': 2000.0}, 'a gear takes at most 1 rad'),
        (
            {'friktion': 1.0, 'play': -1.0},
            'play must be between 0.0 and 1.0, .*; unknown parameter `friktion`; did you mean `f',
        ),
        ({'play': 'much'}, 'play must be of type float'),
    ],
)
def test_what_cannot_be_simulated_is_named(config, values, fault):
    with pytest.raises(ValueError, match=fault):
        config(**values)


def test_a_file_without_the_node_is_refused(tmp_path):
    path = tmp_path / 'other.yaml'
    path.write_text('other: {ros__parameters: {play: 0.1}}', 'utf-8')
    with pytest.raises(ConfigError, match='no parameters of /gear_simulator'):
        TwinGear.load(path)
