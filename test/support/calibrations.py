# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""A calibration for tests, and its correction in 50 digits by the formulas as they are defined."""

from fractions import Fraction

import mpmath

from gear_kinematics.correction.calibration_file import (
    Calibration,
    Compliance,
    Order,
    Prediction,
    Spans,
    Stop,
    UsedRecording,
)

MP = mpmath.mp.clone()
MP.dps = 50


AMPLITUDE = 1e-3
"""Amplitude of the order of `single_order`, rad."""


def calibration(**changes) -> Calibration:
    """Make one for the shipped mechanism, 80/76 teeth, with terms of each kind."""
    fields = {
        'made_by': 'gearkin calibrate 0.2.0',
        'created': '2026-11-22T10:00:00Z',
        'recordings': (UsedRecording('bench.mcap', 64 * 'a', 120_000, 120.0, 0.0123),),
        'gear_ratio': Fraction(-19),
        'ring_teeth': 80,
        'satellite_teeth': 76,
        'constant': 1e-5,
        'orders': (
            Order('rotor × 1', Fraction(1), 1e-3, -4e-4),
            Order('rotor × 2', Fraction(2), 0.0, 2e-4),
            Order('output × 1', Fraction(1, 19), 5e-4, 7e-4),
            Order('rotor × 80/19', Fraction(80, 19), -1e-4, 3e-5),
        ),
        'hysteresis': (Stop(4e-4, 0.6), Stop(2e-3, 0.2)),
        'compliance': Compliance(-2e-5, 1.0),
        'half_width': 1e-4,
        'outside_half_width': 2e-3,
        'spans': Spans((-3.0, 3.0), (-20.0, 30.0), (-4.0, 4.0), 120.0),
        'validation': Prediction(1.1e-3, 5e-5, 0.951),
        **changes,
    }
    terms = 2 * len(fields['orders']) + len(fields['hysteresis'])
    terms += fields['compliance'] is not None
    identity = tuple(tuple(1e-12 * (k == n) for k in range(terms)) for n in range(terms))
    return Calibration(**{'covariance': identity} | fields)


def single_order(half_width: float = 1e-4) -> Calibration:
    """Make one that corrects nothing but AMPLITUDE · cos(φ2)."""
    orders = (Order('rotor × 1', Fraction(1), AMPLITUDE, 0.0),)
    return calibration(
        constant=0.0, orders=orders, hysteresis=(), compliance=None, half_width=half_width
    )


def expected_deviations(made: Calibration, motion) -> list[tuple[mpmath.mpf, mpmath.mpf]]:
    """Compute deviation and unknown part of it, rad, sample by sample.

    Args:
        made: the calibration.
        motion: of each sample the rotor's turns, angle in rad, and torque in N·m or None.
    """
    ends = [[-1, 1] for _ in made.hysteresis]  # of the states of stop operators, in radii
    before, results = None, []
    for turns, angle, effort in motion:
        x = (2 * MP.pi * turns + MP.mpf(angle)) * made.gear_ratio.denominator
        x /= made.gear_ratio.numerator
        deviation, unknown = MP.mpf(made.constant), MP.mpf(0)
        for order in made.orders:
            n = MP.mpf(order.cycles.numerator) / order.cycles.denominator
            phase = n * (2 * MP.pi * turns + MP.mpf(angle))
            deviation += order.cos * MP.cos(phase) + order.sin * MP.sin(phase)
        for stop, states in zip(made.hysteresis, ends, strict=True):
            step = 0 if before is None else (x - before) / MP.mpf(stop.radius)
            states[:] = [min(max(state + step, MP.mpf(-1)), MP.mpf(1)) for state in states]
            radius, coefficient = MP.mpf(stop.radius), MP.mpf(stop.coefficient)
            deviation += coefficient * radius * (states[0] + states[1]) / 2
            unknown += abs(coefficient) * radius * (states[1] - states[0]) / 2
        if made.compliance is not None:
            coefficient = MP.mpf(made.compliance.coefficient)
            if effort is None:
                least, most = made.spans.torque
                unknown += abs(coefficient) * (MP.mpf(most) - least) / 2
            else:
                torque = MP.mpf(effort) * made.gear_ratio.numerator / made.gear_ratio.denominator
                deviation += coefficient * (torque - MP.mpf(made.compliance.torque))
        before = x
        results.append((deviation, unknown))
    return results
