# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""MuJoCo's gear against the audited preload, forces of the bodies, energy and the fast model."""

import math
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest

from gear_kinematics.correction.calibration_file import Order
from gear_kinematics.kinematics.preload import Preload, Stiffness
from gear_kinematics.twin.fast_model import FastModel
from gear_kinematics.twin.gear import LoadingCurve, TwinGear
from gear_kinematics.twin.model import TwinModel
from gear_kinematics.twin.parameters import default_config

mujoco = pytest.importorskip('mujoco')
from gear_kinematics.twin.mujoco_model import MujocoModel, check  # noqa: E402

STIFFNESS = Stiffness(3000.0, 3000.0, 1069.0)
PRELOAD = Preload.from_torque(STIFFNESS, 2.0)
"""That of the default gear. A leaves mesh at 9.6 N·m, B at -2.5 N·m."""

BENT = LoadingCurve(
    (-2e-3, -1e-3, 0.0, 1e-3, 3e-3), (-7.0, -1.0, 0.0, 2.0, 5.0), (0.6, 0.5, 0.2, 0.3, 0.4)
)
"""Harder backwards, softer forwards; friction grows with the load."""


@pytest.fixture(scope='module')
def gear() -> TwinGear:
    """The default one, whose branches do not reach their other flanks, without friction."""
    return replace(TwinGear.load(default_config()), friction=0.0, play=0.05)


BOTH = pytest.mark.parametrize('kind', [MujocoModel, FastModel])


def settled(model: TwinModel, load: float) -> TwinModel:
    """Let the output come to rest under a load, with the rotor locked."""
    model.rotor_locked = True
    for _ in range(80):
        model.advance(1e-3, 0.0, load - 4.0 * model.output_velocity)
    assert abs(model.output_velocity) < 1e-7
    return model


def test_branches_share_a_load_as_the_audited_preload_says(gear):
    model = MujocoModel(gear)
    model.model.opt.disableflags &= ~int(mujoco.mjtDisableBit.mjDSBL_SENSOR)
    for load in (0.0, 1.0, -2.0, 9.0, 12.0, -6.0):
        expected = PRELOAD.split(load)
        settled(model, load)
        torques = float(expected.branch_a), -float(expected.branch_b)
        assert model.branch_torques == pytest.approx(torques, rel=1e-4, abs=1e-5), load
        # What the coupling gives the arm.
        measured = model.data.sensordata[[5, 8]]
        assert measured == pytest.approx(torques, rel=1e-4, abs=1e-5), load


@pytest.mark.parametrize(('loads', 'stiffness'), [
    ((-2.0, 9.0), STIFFNESS.both_in_mesh), ((10.0, 14.0), STIFFNESS.branch_b_alone),
    ((-9.0, -4.0), STIFFNESS.branch_a_alone),
])  # fmt: skip
def test_soft_constraints_do_not_show_in_the_stiffness(gear, loads, stiffness):
    low, high = loads
    model = MujocoModel(gear)
    begin = settled(model, low).output_angle
    turned = settled(model, high).output_angle - begin
    assert (high - low) / turned == pytest.approx(stiffness, rel=1e-4)


@pytest.mark.parametrize(('stiffness', 'satellite_inertia', 'output_inertia'), [
    (Stiffness(13e3, 16e3, math.inf), 1e-7, 1e-4), (Stiffness(80e3, 250.0, math.inf), 1e-6, 0.1),
    (Stiffness(11e3, 200.0, 80e3), 1e-5, 1e-3),
], ids=['light satellites', 'a soft output', 'a stiff shaft'])  # fmt: skip
def test_so_it_is_for_other_gears(gear, stiffness, satellite_inertia, output_inertia):
    loads = replace(
        gear.parameters.loads, satellite_inertia=satellite_inertia, coupling_inertia=1e-8
    )
    gear = replace(
        gear,
        parameters=replace(gear.parameters, loads=loads),
        stiffness=(stiffness.branch_a, stiffness.branch_b),
        shaft_stiffness=stiffness.shaft,
        output_inertia=output_inertia,
        play=1.0,
    ).preloaded(2.0)
    damping, model = math.sqrt(stiffness.both_in_mesh * output_inertia), MujocoModel(gear)
    model.rotor_locked = True
    for _ in range(400):
        model.advance(0.1 * output_inertia / damping, 0.0, 1.0 - damping * model.output_velocity)
    assert 1.0 / model.output_angle == pytest.approx(stiffness.both_in_mesh, rel=1e-4)


def test_energy_is_kept(gear):
    """The load works on the output on its springs, which oscillates and gives it back.

    The shaft would damp that a little.
    """
    gear = replace(gear, shaft_stiffness=math.inf).preloaded(2.0)
    model = MujocoModel(gear)
    model.model.opt.enableflags |= mujoco.mjtEnableBit.mjENBL_ENERGY
    model.rotor_locked = True
    mujoco.mj_forward(model.model, model.data)
    before, work = model.data.energy.sum(), 0.0
    for _ in range(300):
        angle = model.output_angle
        model.advance(1e-3, 0.0, 1.0)
        work += model.output_angle - angle
        mujoco.mj_forward(model.model, model.data)
        gained = model.data.energy.sum() - before
        assert gained == pytest.approx(work, abs=1e-5)
    assert model.data.energy[0] > 0.0


@pytest.mark.parametrize('values', [
    {}, {'friction': 0.4}, {'interference': -1e-3, 'play': 1e-3}, {'shaft_stiffness': math.inf},
    {'shaft_stiffness': math.inf, 'interference': -1e-3, 'play': 1e-3, 'curve': BENT},
], ids=['braced', 'friction', 'play', 'rigid shaft', 'a measured curve, worn'])  # fmt: skip
def test_a_ramp_is_that_of_the_fast_model(gear, values):
    """Within 1 % of its greatest turn, with the rotor locked."""
    gear = replace(gear, **values)
    loops = []
    for kind in (MujocoModel, FastModel):
        model = kind(gear)
        model.rotor_locked = True
        loop = []
        for step in range(1000):
            load = 8.0 * math.sin(2.0 * math.pi * step / 800.0)
            # Both are damped alike, as the play would let them rattle.
            model.advance(1e-3, 0.0, load - 4.0 * model.output_velocity)
            loop.append(model.output_angle)
        loops.append(np.array(loop))
    ours, fast = loops
    assert np.abs(ours - fast).max() < 0.01 * np.abs(fast).max()


def test_a_fast_rotor_is_as_fast_as_that_of_the_fast_model():
    """As the reference says; faster, MuJoCo's loops feed in energy, and the rotor is held."""
    gear = TwinGear.load(default_config())
    mujocos, fast = MujocoModel(gear), FastModel(gear)
    for _ in range(400):
        for model in (mujocos, fast):
            model.advance(1e-3, 0.0, 5.0)
    assert abs(fast.rotor_velocity) > 3600.0
    assert mujocos.rotor_velocity == pytest.approx(fast.rotor_velocity, rel=5e-3)
    assert mujocos.notice == ''
    mujocos.data.qvel *= 3.0
    mujocos.advance(1e-3, 0.0, 0.0)
    assert mujocos.notice == 'the rotor is limited to the 3780 rad/s that MuJoCo can follow'
    for _ in range(100):
        mujocos.advance(1e-3, 0.0, 0.0)
    assert abs(mujocos.rotor_velocity) < 3780.0  # without load, friction slows it down


def test_a_load_beyond_all_bounds_leaves_a_gear_that_works_and_no_file(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)  # MuJoCo writes its warnings into the current folder
    model = MujocoModel(TwinGear.load(default_config()))
    notices = set()
    for _ in range(10):
        model.advance(1e-3, 0.0, 1e6)
        notices.add(model.notice)
    assert 'the motion exceeded what MuJoCo can follow, and starts anew' in notices
    settled(model, 0.0)
    assert not [*tmp_path.iterdir()]


@BOTH
def test_errors_move_the_output(gear, kind):
    order = Order('cam', Fraction(1), 2e-3, 1e-3)
    gear = replace(gear, errors=(order,), rotor_damping=1e-3)
    model = kind(gear)
    assert model.output_angle == pytest.approx(2e-3)
    off = []
    for _ in range(600):
        model.advance(1e-3, 0.01, -0.5 * model.output_velocity)
        error = gear.error(model.rotor_angle)
        off.append(model.output_angle - model.rotor_angle / gear.ratio - error)
    assert abs(model.rotor_angle) > 2.0
    assert np.abs(off).max() < 1e-4


@BOTH
def test_locks_hold_and_let_go(gear, kind):
    model = kind(gear)
    for _ in range(100):
        model.advance(1e-3, 0.02, 0.0)
    model.rotor_locked = model.output_locked = True
    rotor, output = model.rotor_angle, model.output_angle
    model.advance(0.05, 0.3, 5.0)
    creep = kind is MujocoModel  # whose constraints are soft
    assert model.rotor_angle == pytest.approx(rotor, rel=0.0, abs=1e-5 * creep)
    assert model.output_angle == pytest.approx(output, rel=0.0, abs=1e-6 * creep)
    model.rotor_locked = model.output_locked = False
    model.advance(0.1, 0.02, 0.0)
    assert model.rotor_angle > rotor + 1.0


@BOTH
def test_a_gear_wears_while_it_moves(gear, kind):
    model = settled(kind(gear), 0.0)
    model.gear = gear.worn(1e-3)
    assert model.gear.preload < 1.5
    settled(model, 0.0)
    T0 = Preload(STIFFNESS, gear.interference - 1e-3).torque
    assert model.branch_torques == pytest.approx((T0, -T0), rel=1e-4)
    assert model.rotor_locked


def test_time_that_is_no_whole_step_is_not_lost(gear):
    model = MujocoModel(gear)
    for _ in range(1000):
        model.advance(1.3e-5, 0.0, 0.0)
    assert model.data.time == pytest.approx(1.3e-2, abs=model.model.opt.timestep)


def test_a_model_that_mujoco_refuses_is_no_model():
    with pytest.raises(ValueError, match='mass and inertia'):
        check('<mujoco><worldbody><body><joint/></body></worldbody></mujoco>')
