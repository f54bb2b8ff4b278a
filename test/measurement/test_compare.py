# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Comparisons of several recordings."""

import math
from types import SimpleNamespace

import numpy as np
import pytest
from gear_recordings import Gear, creep, ramps
from scipy import stats

from gear_kinematics.correction.uncertainty import Estimate
from gear_kinematics.measurement.compare.changes import Change, changes_of, judged
from gear_kinematics.measurement.compare.quantities import Quantity, at_common_torque, in_common
from gear_kinematics.measurement.compare.section import _play
from gear_kinematics.measurement.figures import gear_figures, settings_for
from gear_kinematics.measurement.loops import find_ramps
from gear_kinematics.measurement.lost_motion import LostMotion
from gear_kinematics.measurement.names import (
    POSITION,
    Group,
    positions_of,
    single,
)

MINUTE = math.radians(1.0 / 60.0)


def test_a_name_has_a_position_and_the_rest_is_the_gear():
    names = ['a_pos1.csv', 'b_position_1.csv', 'a_pos2.csv']
    gears = [Group('a.csv', (0, 2)), Group('b.csv', (1,))]
    assert positions_of(names, POSITION) == (gears, ['1', '1', '2'])
    assert positions_of(['g at90deg.csv'], r'at(\d+)deg') == ([Group('g.csv', (0,))], ['90'])


# Changes


def exact(name, *values):
    return Quantity(name, 'rad', tuple(Estimate(v, 1e-3 * v, 4.0, 5) for v in values), main=True)


def test_two_groups_are_compared_by_students_test_of_logarithms():
    values = [1.0, 1.3, 1.1, 1.9, 2.2, 1.8, 2.5]
    groups = [Group('a', (0, 1, 2)), Group('b', (3, 4, 5, 6))]
    (change,) = changes_of(exact('a', *values), groups)
    expected = stats.ttest_ind(np.log(values[3:]), np.log(values[:3]))
    assert change.probability == pytest.approx(expected.pvalue)
    assert np.log(change.interval) == pytest.approx(list(expected.confidence_interval()))
    assert change.before == pytest.approx(stats.gmean(values[:3]))
    assert change.after == pytest.approx(stats.gmean(values[3:]))


def test_positions_pair_recordings():
    first, second = np.array([1.0, 5.0, 20.0, 3.0]), np.array([1.5, 7.0, 33.0, 4.9])
    positions = ['1', '2', '3', '4', '2', '1', '4', '3']  # the second group in another order
    quantity = exact('a', *first, *second[[1, 0, 3, 2]])
    groups = [Group('a', (0, 1, 2, 3)), Group('b', (4, 5, 6, 7))]
    (change,) = changes_of(quantity, groups, positions)
    expected = stats.ttest_rel(np.log(second), np.log(first))
    assert change.probability == pytest.approx(expected.pvalue)
    assert np.log(change.interval) == pytest.approx(list(expected.confidence_interval()))


def test_the_scatter_is_pooled_over_all_groups():
    # Logarithms to base 2 of three groups at two positions: (0, 1), (2, 3), (1, 3). Rows differ
    # from the additive model by ±1/6, ±1/6 and ±1/3: 1/3 in squares, with 2 degrees of freedom.
    quantity = exact('a', 1.0, 2.0, 4.0, 8.0, 2.0, 8.0)
    groups = [Group('a', (0, 1)), Group('b', (2, 3)), Group('c', (4, 5))]
    result = changes_of(quantity, groups, ['1', '2'] * 3)
    half = 4.302653 * math.sqrt(1.0 / 6.0)
    for change, logarithm in zip(result, (2.0, 1.5), strict=True):
        assert math.log2(change.after / change.before) == pytest.approx(logarithm)
        ends = logarithm - half, logarithm + half
        assert np.log2(change.interval) == pytest.approx(ends, rel=1e-6)
    assert all(change.repeated for change in result)


def test_without_repeats_the_scatter_is_that_within_recordings():
    values = Estimate(2.0, 0.1, 4.0, 5), Estimate(3.0, 0.3, 2.0, 3), Estimate(3.0, None, 0.0, 1)
    result = changes_of(Quantity('a', '', values, main=True), single(['a', 'b', 'c']))
    known, unknown = result
    # Relative standard uncertainties of 5 % and 10 %, by Welch and Satterthwaite.
    standard = math.hypot(0.05, 0.1)
    degrees = math.floor(standard**4 / (0.05**4 / 4.0 + 0.1**4 / 2.0))
    half = stats.t.ppf(0.975, degrees) * standard
    assert np.log(known.interval) == pytest.approx([math.log(1.5) - half, math.log(1.5) + half])
    assert (unknown.interval, unknown.probability) == ((), None)
    assert not known.repeated


def test_hysteresis_and_the_others_are_judged_apart():
    def change(name, probability):
        return Change(exact(name), 'a', 'b', 1.0, 2.0, (), probability, repeated=True)

    # By Bonferroni, 5 % are 0.025 for each of two, and 0.0125 for each of four.
    found = [change('hysteresis', p) for p in (0.024, 0.026)]
    found += [change('other', p) for p in (0.012, 0.013, 0.9, 0.9, None)]
    assert [own.significant for own in judged(found)] == [True, False, True] + [False] * 4


def test_an_unchanged_gear_shows_a_change_in_at_most_5_percent():
    groups = [Group(str(k), (3 * k, 3 * k + 1, 3 * k + 2)) for k in range(4)]
    alarms = 0
    for seed in range(400):
        values = np.exp(0.3 * np.random.default_rng(seed).standard_normal(12))
        found = judged(changes_of(exact('hysteresis', *values), groups))
        alarms += any(change.significant for change in found)
    assert 5 <= alarms <= 20


# Whole recordings, simulated


def measured(name, play, *, friction=0.8, stiffness=300.0, tests=((5.0, 100),) * 3, top=40.0):
    torque = ramps(*tests, (top, 100))
    found = find_ramps(torque, creep(Gear(play, stiffness, friction), torque))
    return LostMotion(name, None, None, gear_figures(found, settings_for(found, 0.0)))


@pytest.fixture(scope='module')
def reports():
    return [measured(f'gear_{k}', play) for k, play in enumerate((0.010, 0.014, 0.011))]


def test_figures_are_taken_at_the_same_torques(reports):
    common = at_common_torque([reports[0], measured('larger', 0.01, top=50.0)])
    settings = [report.figures.settings for report in common]
    assert settings[0] == settings[1]
    assert settings[0].rated_torque == pytest.approx(40.0, rel=0.01)
    assert settings[0].corners[:2] == pytest.approx([6.0, 20.0], rel=0.01)
    found = {quantity.name: quantity.values for quantity in in_common(common).quantities}
    # Of play and a linear spring: hysteresis is play + 2 friction / stiffness, at any amplitude.
    width = 0.01 + 2.0 * 0.8 / 300.0
    assert [own.value for own in found['hysteresis']] == pytest.approx([width] * 2, abs=2e-5)
    assert [own.value for own in found['stiffness 20 to 40 N·m']] == pytest.approx(
        [300.0] * 2, 0.01
    )
    given = at_common_torque(reports, 20.0, [2.0, 10.0])
    assert {report.figures.settings.corners for report in given} == {(2.0, 10.0, 20.0)}


def test_ramps_of_other_amplitudes_are_left_out_and_named(reports):
    other = measured('other', 0.01, tests=[(10.0, 100)] * 3)
    (remark,) = in_common(at_common_torque([*reports, other])).remarks
    assert remark.endswith('about 10 N·m, which gear_0, gear_1, gear_2 lack')


@pytest.mark.parametrize(
    ('old', 'new', 'told'),
    [
        ((70, 80), (0, 4), '; play fell from at least 70′ to at most 4′'),
        ((0, 2), (8, 9), '; play rose from at most 2′ to at least 8′'),
        ((0, 80), (3, 40), '; there is play of at least 3′'),
        ((0, 80), (0, 39), '; whether play is left cannot be told (at most 39′)'),
        ((0, None), (0, None), '; whether play is left cannot be told'),
    ],
)
def test_backlash_is_compared_by_its_intervals(old, new, told):
    bounds = [SimpleNamespace(low=a * MINUTE, high=b and b * MINUTE) for a, b in (old, new)]
    reports = [SimpleNamespace(figures=SimpleNamespace(backlash=each)) for each in bounds]
    assert _play(reports, single(['a', 'b'])) == told
