"""How much wider an interval is because its width is an estimate."""

import numpy as np
import pytest

from gear_kinematics.calibration.blockwise import widening

T_975 = {1: 12.7062, 2: 4.3027}
"""Student's t from tables; for infinitely many degrees of freedom it is 1.9600."""


def test_one_wave_of_drift_has_one_degree_of_freedom():
    wave = np.cos(np.pi * (np.arange(24) + 0.5) / 24)
    same = np.full(24, np.mean(wave**2))
    # The blocks' mean squares are made equal, so that only the drift counts.
    assert widening(same, [wave]) == pytest.approx(T_975[1] / 1.96, rel=1e-4)
    second = np.cos(2 * np.pi * (np.arange(24) + 0.5) / 24)
    assert widening(2 * same, [wave + second]) == pytest.approx(T_975[2] / 1.96, rel=1e-4)
    # The same drift in two recordings, each by chance.
    both = np.concatenate([same, same])
    assert widening(both, [wave, second]) == pytest.approx(T_975[2] / 1.96, rel=1e-4)


def test_zeros_and_steady_noise_widen_nothing():
    same = np.ones(24)
    assert widening(same, [np.zeros(24)]) == 1.0
    assert widening(same, [np.full(24, 0.3)]) == pytest.approx(1.0)


def test_intervals_of_noise_and_drift_hold_on_other_recordings():
    random = np.random.default_rng(2)

    def walks():
        walk = np.cumsum(random.standard_normal((2000, 24)), axis=1) / 24**0.5
        return walk - walk.mean(axis=1, keepdims=True)

    noise, inside, plain = 0.3, [], []
    for first, second in zip(walks(), walks(), strict=True):
        errors = first**2 + noise**2
        half_width = 1.96 * np.sqrt(errors.mean())
        other = second + noise * random.standard_normal(24)
        inside.append(np.abs(other) <= half_width * widening(errors, [first]))
        plain.append(np.abs(other) <= half_width)
    assert np.mean(plain) < 0.93
    assert 0.94 <= np.mean(inside) <= 0.98
