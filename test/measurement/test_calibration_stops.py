# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Stop operators along a motion, against a loop over its samples."""

import weakref
from dataclasses import replace
from fractions import Fraction
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from gear_recordings import encoders
from hypothesis import given, settings
from hypothesis import strategies as st

from gear_kinematics.measurement.calibration.model import without_delays
from gear_kinematics.measurement.calibration.terms import Samples
from gear_kinematics.measurement.recording import Encoders, Recording

RADIUS = 0.25


def states(x, starts, radius=RADIUS):
    """The least and the greatest possible state after each sample, by definition."""
    low, high, found = -radius, radius, []
    for k, angle in enumerate(x):
        if k in starts:
            low, high = -radius, radius
        else:
            low, high = (min(max(d + angle - x[k - 1], -radius), radius) for d in (low, high))
        found.append((low, high))
    return np.array(found).T


def followed(both: Encoders):
    """What is said of them of a gear with a ratio of 1."""
    recording = Recording(Path(), '', (), len(both.measured), both)
    return Samples(recording, Fraction(1)).stop_states(RADIUS)


step = st.sampled_from([0.0, 0.01, -0.02, 0.1, -0.1, 0.3, -0.7])
steps = st.lists(step, min_size=1, max_size=60)


@settings(max_examples=60)
@given(steps, st.sets(st.integers(0, 59)))
def test_states_are_those_of_the_definition(moves, unknown):
    x = np.cumsum(moves)
    starts = sorted({0, *(k for k in unknown if k < len(x))})
    low, high = states(x, starts)
    both = encoders(x, x)
    segment = np.cumsum(np.isin(np.arange(len(x)), starts))
    middle, known = followed(replace(both, rotor=both.rotor._replace(segment=segment)))
    assert middle == pytest.approx(0.5 * (low + high), abs=1e-12)
    assert np.array_equal(known, high - low < 1e-9)


def test_states_are_those_of_the_definition_after_thousands_of_reversals():
    x = np.cumsum(np.random.default_rng(3).normal(0.0, 0.1, 20_000))
    low, high = states(x, [0])
    middle, known = followed(encoders(x, x))
    assert middle == pytest.approx(0.5 * (low + high), abs=1e-11)
    assert np.array_equal(known, high - low < 1e-9)


def test_state_between_two_samples_of_the_rotor():
    x = np.array([0.0, 1.0, 1.0, 0.9, 0.9, 0.5])
    between = replace(
        encoders(x, x), before=np.array([2, 4]), share=np.array([0.5, 0.25]), measured=x[:2]
    )
    middle, known = followed(between)
    # From the bound 0.25 at 1.0, back by 0.05, and by 0.1 + 0.1.
    assert middle == pytest.approx([0.2, 0.05])
    assert known.all()


def test_states_of_a_model_are_gone_before_those_of_the_next_are_followed():
    """They are most of the memory of a calibration."""

    class Model:
        samples, delays = (), ()

    made = []

    def model_of(shifts):
        assert not any(earlier() for earlier in made)
        model = Model()
        model.samples = [SimpleNamespace(shift=shift) for shift in shifts]
        model.delays = [SimpleNamespace(value=0.01, clear=True)]
        made.append(weakref.ref(model))
        return model

    without_delays(model_of, 1)
    assert len(made) == 2
