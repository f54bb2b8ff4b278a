# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Comparisons of several recordings."""

import math
from types import SimpleNamespace

import numpy as np
import pytest
import scipy
from gear_recordings import Gear, creep, ramps

from gear_kinematics.measurement.changes import (
    Change,
    Group,
    Quantity,
    at_common_torque,
    changes_of,
    judged,
    quantities,
    single,
)
from gear_kinematics.measurement.compare import _play, compared
from gear_kinematics.measurement.figures import gear_figures
from gear_kinematics.measurement.loops import find_ramps
from gear_kinematics.measurement.lost_motion import LostMotion
from gear_kinematics.measurement.sentences import Observation
from gear_kinematics.statistics.uncertainty import Estimate

MINUTE = math.radians(1.0 / 60.0)


# Changes


def exact(name, *values):
    return Quantity(name, 'rad', tuple(Estimate(v, 1e-3 * v, 4.0, 5) for v in values))


def test_two_groups_are_compared_by_students_test_of_logarithms():
    values = [1.0, 1.3, 1.1, 1.9, 2.2, 1.8, 2.5]
    groups = [Group('a', (0, 1, 2)), Group('b', (3, 4, 5, 6))]
    (change,) = changes_of(exact('a', *values), groups)
    expected = scipy.stats.ttest_ind(np.log(values[3:]), np.log(values[:3]))
    assert change.probability == pytest.approx(expected.pvalue)
    assert np.log(change.interval) == pytest.approx(list(expected.confidence_interval()))
    assert change.before == pytest.approx(scipy.stats.gmean(values[:3]))
    assert change.after == pytest.approx(scipy.stats.gmean(values[3:]))


def test_the_scatter_is_pooled_over_all_groups():
    # Logarithms to base 2 of three groups: (0, 1), (2, 3), (1, 3). Rows differ from their means
    # by 1/2, 1/2 and 1: 3 in squares, with 3 degrees of freedom.
    quantity = exact('a', 1.0, 2.0, 4.0, 8.0, 2.0, 8.0)
    groups = [Group('a', (0, 1)), Group('b', (2, 3)), Group('c', (4, 5))]
    result = changes_of(quantity, groups)
    half = 3.182446  # Student's t, as each mean has a variance of 1/2
    for change, logarithm in zip(result, (2.0, 1.5), strict=True):
        assert math.log2(change.after / change.before) == pytest.approx(logarithm)
        ends = logarithm - half, logarithm + half
        assert np.log2(change.interval) == pytest.approx(ends, rel=1e-6)
    assert all(change.repeated for change in result)


def test_without_repeats_the_scatter_is_that_within_recordings():
    values = Estimate(2.0, 0.1, 4.0, 5), Estimate(3.0, 0.3, 2.0, 3), Estimate(3.0, None, 0.0, 1)
    result = changes_of(Quantity('a', '', values), single(['a', 'b', 'c']))
    known, unknown = result
    # Relative standard uncertainties of 5 % and 10 %, by Welch and Satterthwaite.
    standard = math.hypot(0.05, 0.1)
    degrees = math.floor(standard**4 / (0.05**4 / 4.0 + 0.1**4 / 2.0))
    half = scipy.stats.t.ppf(0.975, degrees) * standard
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
    return LostMotion(name, None, None, gear_figures(found))


@pytest.fixture(scope='module')
def reports():
    return [measured(f'gear_{k}', play) for k, play in enumerate((0.010, 0.014, 0.011))]


def test_figures_are_taken_at_the_same_torques(reports):
    common = at_common_torque([reports[0], measured('larger', 0.01, top=50.0)])
    assert [report.figures.rated_torque for report in common] == pytest.approx(
        [40.0] * 2, rel=0.01
    )
    found = {quantity.name: quantity.values for quantity in quantities(common)[0]}
    # Of play and a linear spring: hysteresis is play + 2 friction / stiffness, at any amplitude.
    width = 0.01 + 2.0 * 0.8 / 300.0
    assert [own.value for own in found['hysteresis']] == pytest.approx([width] * 2, abs=2e-5)
    assert [own.value for own in found['stiffness 20 to 40 N·m']] == pytest.approx(
        [300.0] * 2, 0.01
    )


def test_ramps_of_other_amplitudes_are_left_out_and_named(reports):
    other = measured('other', 0.01, tests=[(10.0, 100)] * 3)
    section = compared(at_common_torque([*reports, other])).section
    assert 'the smallest ramps of gear_0, gear_1, gear_2 are smaller' in section.remarks[-1]
    assert {row[0].text.split(',')[0] for row in section.tables[0].rows}.isdisjoint({'hysteresis'})


@pytest.mark.parametrize(
    ('low', 'high', 'told'),
    [
        (3, 40, Observation.PLAY_LEFT(low=3 * MINUTE)),
        (0, 39, Observation.PLAY_AT_MOST(high=39 * MINUTE)),
        (0, None, Observation.PLAY_UNDETERMINED()),
    ],
)
def test_backlash_is_compared_by_its_interval(low, high, told):
    bounds = SimpleNamespace(low=low * MINUTE, high=high and high * MINUTE)
    reports = [None, SimpleNamespace(figures=SimpleNamespace(backlash=bounds))]
    assert [*_play(reports, Group('b', (1,)))] == [told]
