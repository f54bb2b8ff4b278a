# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Figures from reports in a simulated gear."""

import json
import math
from dataclasses import replace

import pytest
from blocked_bags import gearkin_here

from gear_kinematics.kinematics import Branch
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


@pytest.fixture
def ramps(tmp_path):
    """Write the report on torque ramps."""

    def write(stiffness, *, friction=None, backlash=None, low=0.0, high=None):
        play = {'value': backlash, 'low': low, 'high': high}
        ranges = [
            {'low': begin, 'high': end, 'value': value, 'unit': 'N·m/rad'}
            for begin, end, value in stiffness
        ]
        figures = {'friction': {'value': friction}, 'backlash': play, 'stiffness': ranges}
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


def test_one_branch_has_the_stiffness_of_the_output(loose, ramps):
    alone = replace(loose.parameters, branches=(Branch('a'),))
    gear = replace(loose, parameters=alone, stiffness=loose.stiffness[:1], play=0.0)
    report = ramps([(0.0, 2.0, 1000.0), (2.0, 5.0, 2000.0)], friction=0.5, high=None)
    found, notes = measured(gear, [report])
    assert found.stiffness == (1000.0,)
    assert found.friction == 0.5
    assert found.play == 0.0
    assert notes == [
        'play of the flanks: 0 rad, as configured',
        'stiffness beyond 2 N·m: as below',
    ]


def test_two_branches_share_the_stiffness_of_the_output(loose, ramps):
    """With ks of 1000, k of 3000 is 3000 + 750 at the output, below the load of one alone."""
    report = ramps([(0.0, 3.0, 3750.0), (3.0, 9.0, 1500.0)], friction=0.0, backlash=0.0, high=0.0)
    found, notes = measured(replace(loose, shaft_stiffness=1000.0), [report])
    assert found.stiffness == pytest.approx((3000.0, 3000.0))
    assert found.friction == 0.0
    assert found.play == 0.0
    assert notes == ['stiffness beyond 3 N·m: as below']
    rigid, _ = measured(replace(loose, shaft_stiffness=math.inf), [report])
    assert rigid.stiffness == (1875.0, 1875.0)


def test_play_is_not_in_the_stiffness_and_its_interval_is_noted(loose, ramps):
    ranges = [(0.0, 1.0, 300.0), (1.0, 4.0, 3000.0)]
    found, notes = measured(
        loose, [ramps(ranges, friction=0.1, backlash=2e-3, low=1e-3, high=3e-3)]
    )
    assert found.play == -found.interference == 2e-3
    [own] = {*found.stiffness}
    assert own + 1.0 / (1.0 / own + 1.0 / 1069.0) == pytest.approx(3000.0)
    assert notes == ['stiffness beyond 4 N·m: as below']
    found, notes = measured(loose, [ramps(ranges, low=1e-3, high=4e-3)])
    assert found.play == 2.5e-3
    assert found.friction == loose.friction
    assert notes == [
        'friction: 0.1 N·m, as configured',
        'play: 0.0025 rad, the middle of 0.001 to 0.004 rad',
        'stiffness beyond 4 N·m: as below',
    ]


def test_a_preload_is_kept_and_its_play_is_not_measured(gear, ramps):
    report = ramps([(0.0, 1.0, 3750.0), (1.0, 4.0, 800.0)], friction=0.2, backlash=0.0, high=0.0)
    found, notes = measured(replace(gear, shaft_stiffness=1000.0).preloaded(2.0), [report])
    assert found.preload == pytest.approx(2.0)
    assert found.stiffness == pytest.approx((3000.0, 3000.0))
    assert found.play == gear.play
    assert notes == [
        'play of the flanks: 0.00029 rad, as configured',
        'stiffness beyond 1 N·m: as below',
    ]


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


def test_a_later_report_replaces_figures_of_an_earlier_one(gear, ramps, pins):
    loop = ramps([(0.0, 1.0, 3000.0)], friction=0.3, backlash=0.0, high=0.0)
    preload = pins('--wanted-preload', 1.0, '--branch-stiffness', 10, '--shaft-stiffness', 1000)
    found, _ = measured(gear, [preload, loop])
    assert found.preload == pytest.approx(1.0, abs=0.02)
    assert found.friction == 0.3
    assert found.stiffness[0] > 1000.0
    found, _ = measured(gear, [loop, preload])
    assert found.preload == pytest.approx(1.0, abs=0.02)
    assert found.friction == 0.3
    assert found.stiffness == (10.0, 10.0)


@pytest.mark.parametrize(
    ('content', 'fault'),
    [
        ('no report', 'must be the JSON'),
        ('[' * 100_000, 'must be the JSON'),
        ('[]', 'must be the JSON'),
        ('{"made_by": "gearkin loads", "recordings": [{}]}', 'must be the JSON'),
        ('{"recordings": [{}, {}]}', 'one recording'),
        ('{"recordings": [{"friction": {"value": null}}]}', 'must be the JSON'),
    ],
)
def test_what_is_no_report_is_named(gear, tmp_path, content, fault):
    path = tmp_path / 'report.json'
    path.write_text(content, 'utf-8')
    with pytest.raises(ValueError, match=fault) as error:
        measured(gear, [path])
    assert str(error.value).startswith(f'{path}: ')
    with pytest.raises(ValueError, match='No such file'):
        measured(gear, [tmp_path / 'none.json'])


def test_a_rigid_branch_is_named(gear, pins):
    report = pins('--wanted-preload', 1.0, '--branch-stiffness', 'inf', '--shaft-stiffness', 1000)
    with pytest.raises(ValueError, match='branch_stiffness must be greater than 0'):
        measured(gear, [report])
