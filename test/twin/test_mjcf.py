# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The model as MuJoCo reads it: names, inertias, shapes, and loops that stay closed."""

import math
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest

from gear_kinematics.correction.calibration_file import Order
from gear_kinematics.kinematics import Branch, MechanismError, solve
from gear_kinematics.shape.solids import solids
from gear_kinematics.twin.gear import TwinGear
from gear_kinematics.twin.mjcf import mjcf
from gear_kinematics.twin.parameters import default_config

mujoco = pytest.importorskip('mujoco')


@pytest.fixture(scope='module')
def gear() -> TwinGear:
    return TwinGear.load(default_config())


def loaded(gear: TwinGear, *, shown: bool = False):
    model = mujoco.MjModel.from_xml_string(mjcf(gear, shown=shown))
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    return model, data


def slack(model, tendon: str) -> np.ndarray:
    """The lengths between which a tendon has no force."""
    return model.tendon_lengthspring[model.tendon(tendon).id]


def changed(gear: TwinGear, **values) -> TwinGear:
    return replace(gear, parameters=replace(gear.parameters, **values))


def test_names_are_those_of_links_and_topics(gear):
    model, _ = loaded(gear)
    links = {'stator', 'rotor', 'satellite_a', 'satellite_b', 'oldham_a', 'oldham_b'}
    assert links | {'output_shaft'} < {model.body(k).name for k in range(model.nbody)}
    joints = {model.joint(k).name for k in range(model.njnt)}
    assert joints == links - {'stator'} | {'output_shaft', 'arm_a', 'slot_arm_a', 'slot_arm_b'}
    sites = {model.site(k).name for k in range(model.nsite)}
    assert sites == {
        f'{kind}_{branch}'
        for kind in ('mesh', 'cam', 'slot_satellite', 'slot_arm')
        for branch in 'ab'
    }
    assert [model.sensor(k).name for k in range(model.nsensor)] == [
        *('rotor_state_position', 'rotor_state_velocity', 'output_encoder'),
        *('branch_loads_a', 'branch_loads_b'),
    ]
    assert [model.actuator(k).name for k in range(model.nu)] == ['rotor_command', 'load_torque']


def test_tendons_have_the_springs_and_the_play(gear):
    model, _ = loaded(gear)
    for number, name in enumerate(('branch_a', 'branch_b')):
        assert model.tendon_stiffness[model.tendon(name).id] == 3000.0
        assert slack(model, name).tolist() == [*gear.dead_bands[number]]
    assert model.tendon_stiffness[model.tendon('shaft').id] == 1069.0
    assert model.joint('output_shaft').frictionloss[0] == 0.1


def test_it_begins_at_rest_and_stays_there(gear):
    """Also with a kinematic error at the beginning."""
    for error in ((), (Order('cam', Fraction(1), 1e-3, 0.0),)):
        model, data = loaded(replace(gear, errors=error, friction=0.0))
        for name in ('branch_a', 'branch_b'):  # whose springs know nothing of the error
            slack(model, name)[:] -= sum(order.cos for order in error)
        before = data.qpos.copy()
        mujoco.mj_step(model, data, 1000)
        assert data.qpos == pytest.approx(before, abs=2e-7)
        assert data.sensordata[[5, 8]] == pytest.approx([2.0, -2.0], rel=1e-4)


def test_the_rotor_moves_the_bodies_as_the_kinematics_say(gear):
    """The loops stay closed to twice the way that the coupling is accelerated in a step."""
    parameters = replace(gear.parameters, preload=0.0)
    gear = replace(
        gear,
        parameters=parameters,
        shaft_stiffness=math.inf,
        interference=0.0,
        play=0.0,
        friction=0.0,
        rotor_damping=2e-4,
    )
    model, data = loaded(gear)
    data.ctrl[0] = 0.01
    for _ in range(200):
        mujoco.mj_step(model, data, 200)
        mujoco.mj_forward(model, data)
        state = solve(gear.parameters.mechanism, data.joint('rotor').qpos[0])
        speed = data.joint('rotor').qvel[0] * 20.0 / 19.0
        gap = 3.0 * 0.0011 * (speed * model.opt.timestep) ** 2
        for number, branch in enumerate('ab'):
            satellite, coupling = (
                data.body(f'{name}_{branch}').xpos for name in ('satellite', 'oldham')
            )
            assert math.dist(coupling, data.body(f'slot_arm_{branch}').xpos) < gap + 1e-12
            # The branches wind up by less than 50 µrad.
            assert math.dist(satellite[:2], state.satellite_centre[number]) < 1e-12
            assert math.dist(coupling[:2], state.oldham_centre[number]) < 0.0011 * 5e-5 + gap
    assert data.joint('rotor').qpos[0] > 20.0 * math.pi


def test_its_kinetic_energy_is_that_of_all_bodies(gear):
    loads, mechanism = gear.parameters.loads, gear.parameters.mechanism
    model, data = loaded(replace(gear, interference=0.0, play=0.0))
    model.opt.enableflags |= mujoco.mjtEnableBit.mjENBL_ENERGY
    speed = 200.0
    state = solve(mechanism, 0.0, speed)
    for name, value in (('rotor', speed), ('output_shaft', state.output_velocity)):
        data.joint(name).qvel[0] = value
    data.joint('arm_a').qvel[0] = state.output_velocity
    for number, branch in enumerate('ab'):
        data.joint(f'satellite_{branch}').qvel[0] = state.output_velocity - speed
        data.joint(f'oldham_{branch}').qvel[0] = state.satellite_slide_velocity[number]
        data.joint(f'slot_arm_{branch}').qvel[0] = state.arm_slide_velocity[number]
    mujoco.mj_forward(model, data)
    squares = (np.sum(each**2) for each in (state.satellite_velocity, state.oldham_velocity))
    satellites, couplings = squares
    turning = 2.0 * (loads.satellite_inertia + loads.coupling_inertia) + gear.output_inertia
    expected = 0.5 * (
        loads.rotor_inertia * speed**2
        + loads.satellite_mass * satellites
        + loads.coupling_mass * couplings
        + turning * state.output_velocity**2
    )
    assert data.energy[1] == pytest.approx(expected, rel=1e-6)


def test_teeth_are_shown_and_touch_nothing(gear):
    text = mjcf(gear)
    assert len(text) < 500_000
    model, data = loaded(gear, shown=True)
    assert not model.geom_contype.any()
    assert not model.geom_conaffinity.any()
    assert data.ncon == 0
    expected = solids(gear.parameters.mechanism, gear.parameters.module)
    assert {model.mesh(k).name for k in range(model.nmesh)} == set(expected)
    for name, solid in expected.items():
        assert model.mesh(name).vertnum[0] == 2 * sum(map(len, solid.outlines))
    links = {model.body(each).name for each in model.geom_bodyid}
    assert {'stator', 'rotor', 'satellite_a', 'oldham_b', 'output_shaft'} < links
    # As without them: shapes have no mass.
    assert model.body_mass.tolist() == loaded(gear)[0].body_mass.tolist()
    # MuJoCo before 3.3.5 refuses a body of shapes without mass.
    assert (model.body_mass[1:] > 0.0).all()


def test_simple_shapes_need_no_meshes(gear):
    model, _ = loaded(changed(gear, meshes='none'), shown=True)
    assert model.nmesh == 0
    assert model.ngeom > 5


def test_what_surrounds_the_springs_is_written(gear):
    """Orders, a rigid shaft and further branches."""
    orders = (Order('tooth <1>', Fraction(4), 1e-5, 2e-5),)
    model, _ = loaded(replace(gear, errors=orders))
    assert model.numeric('tooth <1>').data.tolist() == [4.0, 1e-5, 2e-5]
    rigid, _ = loaded(replace(gear, shaft_stiffness=math.inf))
    assert rigid.nv == model.nv - 1
    three = tuple(Branch(name, 2.1 * k, 0.02 * k) for k, name in enumerate('abc'))
    model, _ = loaded(
        replace(changed(gear, branches=three, preload=0.0), stiffness=gear.stiffness[:1] * 3)
    )
    assert slack(model, 'branch_c').tolist() == [-1.45e-4, 1.45e-4]


def test_remarks_are_in_the_comment(gear):
    text = mjcf(gear, ['Not measured: this -- nor that.'], shown=False)
    assert 'Not measured: this - - nor that.' in text.partition('-->')[0]


def test_bodies_without_mass_are_refused(gear):
    loads = replace(gear.parameters.loads, coupling_mass=0.0, satellite_inertia=0.0)
    with pytest.raises(MechanismError, match=r'loads\.satellite_inertia, loads\.coupling_mass'):
        mjcf(changed(gear, loads=loads))


def test_the_step_is_a_part_of_a_millisecond_and_short_for_the_springs(gear):
    """Arm A is the fastest: 3000 and 1069 N·m/rad hold 2.073e-5 kg·m²."""
    model, _ = loaded(gear)
    assert 1e-3 / model.opt.timestep == pytest.approx(round(1e-3 / model.opt.timestep), rel=1e-12)
    assert 0.5 < model.opt.timestep * math.sqrt(4069.0 / 2.073e-5) < 0.7


def test_softer_loops_hardly_add_to_the_compliance(gear):
    """MuJoCo Warp, in single precision, makes NaN of the stiffer ones."""
    turned = []
    for single_precision in (False, True):
        text = mjcf(gear, shown=False, single_precision=single_precision)
        model = mujoco.MjModel.from_xml_string(text)
        data = mujoco.MjData(model)
        data.eq_active[model.equality('rotor_lock').id] = 1
        data.ctrl[model.actuator('load_torque').id] = 2.0
        mujoco.mj_step(model, data, 8000)
        turned.append(data.sensor('output_encoder').data[0])
    assert turned[1] / turned[0] - 1.0 == pytest.approx(4e-4, rel=0.2)
