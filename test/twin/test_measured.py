# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Figures from reports in a simulated gear."""

import json
import math
from dataclasses import replace
from functools import reduce
from operator import getitem

import pytest
from blocked_bags import gearkin_here
from refusals import refused

from gear_kinematics.kinematics.preload import Preload, Stiffness
from gear_kinematics.twin.gear import TwinGear
from gear_kinematics.twin.measured import measured
from gear_kinematics.twin.parameters import default_config


@pytest.fixture(scope='module')
def gear() -> TwinGear:
    return TwinGear.load(default_config())


@pytest.fixture(scope='module')
def loose(gear) -> TwinGear:
    """Without a preload."""
    parameters = replace(gear.parameters, preload=0.0)
    return replace(gear, parameters=parameters, interference=-gear.play)


LINE = {
    'angle': [-2e-3, -1e-3, 0.0, 1e-3, 3e-3],
    'load': [-3.0, -0.5, 0.0, 1.0, 7.0],
    'friction': [0.6, 0.4, 0.2, 0.3, 0.5],
}

LEVEL = {
    'friction': {'value': 0.1},
    'measured': False,
    'middle_line': {'angle': [0.0, 0.0], 'load': [0.0, 1.0], 'friction': [0.1, 0.1]},
}
"""Angles of a report which do not grow."""


@pytest.fixture
def ramps(tmp_path):
    """Write the report on torque ramps."""

    def write(stiffness=(), *, friction=None, line=LINE, measured=False):
        ranges = [{'low': low, 'high': high, 'value': value} for low, high, value in stiffness]
        figures = {
            'friction': {'value': friction},
            'middle_line': line,
            'stiffness': ranges,
            'measured': measured,
        }
        path = tmp_path / 'ramps.json'
        data = {'made_by': 'gearkin lost-motion', 'recordings': [figures]}
        path.write_text(json.dumps(data), 'utf-8')
        return path

    return write


@pytest.fixture
def pins(tmp_path):
    """Write the report on a preload."""

    def write(*arguments):
        path = tmp_path / 'preload.json'
        done = gearkin_here('preload', *arguments, '--json', path)
        assert done.returncode == 0, done.stderr
        return path

    return write


@pytest.mark.parametrize('count', [1, 2])
def test_branches_share_the_middle_line(loose, ramps, count):
    """By hand, at its points, between them and beyond; the shaft is in it."""
    alone = replace(loose.parameters, branches=loose.parameters.branches[:count])
    gear = replace(loose, parameters=alone, stiffness=loose.stiffness[:count])
    found, notes = measured(gear, [ramps()])
    assert notes == []
    assert found.stiffness == (pytest.approx(3000.0 / count),) * count
    assert found.friction == 0.4
    for wind_up, load, friction in (
        (0.0, 0.0, 0.2),
        (1e-3, 1.0, 0.3),
        (2e-3, 4.0, 0.4),
        (5e-3, 13.0, 0.5),
        (-1.5e-3, -1.75, 0.5),
        (-4e-3, -8.0, 0.6),
    ):
        torques, held = found.torques((wind_up,) * count)
        assert torques == pytest.approx((load / count,) * count, rel=1e-12)
        assert held == pytest.approx(friction, rel=1e-12)


def test_a_load_on_the_output_winds_it_up_backwards(loose, ramps):
    """Where an encoder measured the output; else it was locked, and the rotor turned."""
    found, _ = measured(loose, [ramps(measured=True)])
    torques, friction = found.torques((-2e-3, -2e-3))
    assert sum(torques) == pytest.approx(-4.0)
    assert friction == pytest.approx(0.4)


def test_a_loop_tells_a_preloaded_gear_friction_and_stiffness_at_no_load(gear, ramps):
    """With ks of 1000, k of 3000 is 3000 + 750 at the output, while both are in mesh."""
    report = ramps([(0.0, 1.0, 3750.0), (1.0, 4.0, 800.0)], friction=0.2)
    found, notes = measured(replace(gear, shaft_stiffness=1000.0).preloaded(2.0), [report])
    assert found.preload == pytest.approx(2.0)
    assert found.stiffness == pytest.approx((3000.0, 3000.0))
    assert found.play == gear.play
    assert found.friction == 0.2
    assert notes == [
        'play of the flanks: 0.00029 rad, as configured',
        'stiffness beyond 1 N·m: as below',
    ]
    rigid, _ = measured(replace(gear, shaft_stiffness=math.inf).preloaded(2.0), [report])
    assert rigid.stiffness == (1875.0, 1875.0)
    unknown, _ = measured(gear, [ramps([(0.0, 1.0, 3750.0)])])
    assert unknown.friction == 0.4


@pytest.mark.parametrize('sign', [1.0, -1.0])
def test_the_preload_is_that_of_the_pins(gear, pins, sign):
    stiffness = ('--branch-stiffness', 2500, 3500, '--shaft-stiffness', 'inf')
    report = pins('--wanted-preload', 2.0 * sign, *stiffness, '--phase-b')
    data = json.loads(report.read_text('utf-8'))
    found, notes = measured(gear, [report])
    assert found.preload == pytest.approx(sign * data['setting']['preload'], rel=1e-12)
    assert found.stiffness == (2500.0, 3500.0)
    assert not found.has_shaft
    twist = Preload.from_torque(Stiffness(2500.0, 3500.0, math.inf), abs(found.preload))
    assert found.interference == pytest.approx(twist.interference, rel=1e-12)
    assert notes == []


def test_play_at_the_pins_is_left(gear, pins):
    stiffness = ('--branch-stiffness', 3000, '--shaft-stiffness', 1000, '--backlash', 5e-3)
    found, _ = measured(gear, [pins('--degrees', 0.1, *stiffness)])
    assert found.preload == 0.0
    play = json.loads(pins('--degrees', 0.1, *stiffness, '--force').read_text('utf-8'))['setting']
    assert found.play == -found.interference == pytest.approx(play['play'])


def test_a_later_report_replaces_figures_of_an_earlier_one(loose, ramps, pins):
    loop = ramps([(0.0, 1.0, 3000.0)], friction=0.3)
    preload = pins('--wanted-preload', 1.0, '--branch-stiffness', 10, '--shaft-stiffness', 1000)
    found, _ = measured(loose, [preload, loop])
    assert found.preload == pytest.approx(1.0, abs=0.02)
    assert found.friction == 0.3
    assert found.stiffness[0] > 1000.0
    found, _ = measured(loose, [loop, preload])
    assert found.preload == pytest.approx(1.0, abs=0.02)
    assert found.friction == 0.4
    assert found.stiffness == (10.0, 10.0)
    assert found.curve is None


@pytest.mark.parametrize(('content', 'fault'), [
    ('no report', 'must be the JSON'), ('[' * 100_000, 'must be the JSON'),
    ('[]', 'must be the JSON'),
    ('{"made_by": "gearkin loads", "recordings": [{}]}', 'must be the JSON'),
    ('{"recordings": [{}, {}]}', 'one recording'),
    ('{"recordings": [{"friction": {"value": null}}]}', 'must be the JSON'),
    (json.dumps({'recordings': [LEVEL]}), 'must be the JSON'),
])  # fmt: skip
def test_what_is_no_report_is_named(gear, tmp_path, content, fault):
    path = tmp_path / 'report.json'
    path.write_text(content, 'utf-8')
    with refused(ValueError, path, fault):
        measured(gear, [path])
    with pytest.raises(ValueError, match='No such file'):
        measured(gear, [tmp_path / 'none.json'])


SOUND = {
    'friction': {'value': 0.2, 'expanded_uncertainty': 0.1},
    'measured': False,
    'middle_line': LINE,
    'stiffness': [{'low': 0.0, 'high': 1.0, 'value': 3750.0}],
}


@pytest.mark.parametrize(('preload', 'path', 'value', 'fault'), [
    (0.0, 'friction.value', math.nan, 'must be the JSON'),
    (2.0, 'friction.value', -1.0, 'the friction is less than 0'),
    (2.0, 'friction.value', '3', 'must be the JSON'),
    (2.0, 'stiffness.0.value', 0.0, 'stiffness'),
    (0.0, 'middle_line.friction.1', math.nan, 'must be the JSON'),
    (0.0, 'middle_line.load.3', math.inf, 'must be the JSON'),
    (0.0, 'middle_line.load', [0.0] * 5, 'branch_stiffness must be greater than 0'),
    (0.0, 'middle_line.load.1', 4.0, 'the load must grow with the angle'),
    (0.0, 'middle_line.load.2', 0.5, 'be 0 at 0 rad'),
    (0.0, 'middle_line.angle.2', 5e-4, 'be 0 at 0 rad'),
])  # fmt: skip
def test_edited_figures_that_no_gear_has_are_refused(loose, tmp_path, preload, path, value, fault):
    """Without a preload, the middle line is taken, here for a single branch."""
    report, edited = tmp_path / 'report.json', json.loads(json.dumps(SOUND))
    *steps, last = (int(step) if step.isdecimal() else step for step in path.split('.'))
    reduce(getitem, steps, edited)[last] = value
    report.write_text(json.dumps({'recordings': [edited]}), 'utf-8')
    alone = replace(loose.parameters, branches=loose.parameters.branches[:1])
    one = replace(loose, parameters=alone, stiffness=loose.stiffness[:1])
    with refused(ValueError, report, fault):
        measured(loose.preloaded(preload) if preload else one, [report])


def test_friction_that_is_less_than_0_by_noise_is_none(loose, ramps):
    line = LINE | {'friction': [-1e-4] * 5}
    for gear in (loose, loose.preloaded(2.0)):
        found, _ = measured(gear, [ramps([(0.0, 1.0, 3750.0)], friction=-1e-4, line=line)])
        assert found.friction == 0.0


@pytest.mark.parametrize('edited', [{'play': -1.0, 'preload': 0.0}, {'ring_turn': math.inf}])
def test_edited_pins_are_refused(gear, pins, edited):
    stiffness = ('--branch-stiffness', 3000, '--shaft-stiffness', 1000)
    report = pins('--degrees', 0.1, *stiffness)
    data = json.loads(report.read_text('utf-8'))
    report.write_text(json.dumps(data | {'setting': data['setting'] | edited}), 'utf-8')
    with refused(ValueError, report):
        measured(gear, [report])


def test_a_rigid_branch_is_named(gear, pins):
    report = pins('--wanted-preload', 1.0, '--branch-stiffness', 'inf', '--shaft-stiffness', 1000)
    with pytest.raises(ValueError, match='branch_stiffness must be greater than 0'):
        measured(gear, [report])
