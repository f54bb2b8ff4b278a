# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""What the steps of an encoder add to an uncertainty, against rounded readings."""

import math

import numpy as np
import pytest

from gear_kinematics.measurement.resolution import hidden_resolution, slope_resolution


@pytest.mark.parametrize('scatter', [0.0, 0.1, 0.2, 0.3, 0.4])
def test_scatter_of_repeats_shows_the_steps_of_an_encoder(scatter):
    # Means of rounded readings of a normal distribution, for all its places within a step of 1.
    places = np.arange(500) / 500
    off = np.linspace(-6.0, 6.0, 4001) if scatter else np.zeros(1)
    density = np.exp(-0.5 * off**2)
    readings = np.round(places[:, None] + scatter * off)
    error = readings @ density / density.sum() - places
    repeats = [7.0 - scatter, 7.0, 7.0 + scatter]
    found = hidden_resolution(1.0, repeats, readings=1)
    assert 0.75 * found <= np.sqrt(np.mean(error**2)) <= 1.001 * found


def test_a_single_reading_hides_its_whole_step():
    assert hidden_resolution(0.3, [5.0], readings=2) == pytest.approx(0.3 / math.sqrt(6.0))
    assert hidden_resolution(0.0, [5.0, 6.0], readings=2) == 0.0


@pytest.mark.parametrize('steps', [3.0, 10.0, 80.0])
def test_slope_of_a_line_is_as_uncertain_as_its_steps(steps):
    run = np.linspace(0.0, 2.0, 600)
    random = np.random.default_rng(3)
    lines = 0.5 * steps * run + random.uniform(size=(2000, 1)) + random.normal(size=(2000, 600))
    errors = np.polynomial.polynomial.polyfit(run, (np.round(lines) - lines).T, 1)[1]
    aligned = 0.5 * steps * run + random.uniform(size=(2000, 1))
    worst = np.polynomial.polynomial.polyfit(run, (np.round(aligned) - aligned).T, 1)[1]
    stated = slope_resolution(1.0, run=2.0, slope=-0.5 * steps)
    assert max(np.std(errors), np.std(worst)) <= stated
