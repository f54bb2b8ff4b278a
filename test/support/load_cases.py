# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Mechanisms under load to draw, and how large what adds up to their loads is."""

import math

import numpy as np
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp
from properties import assert_close, mechanisms, speed_up

from gear_kinematics.kinematics.loads import Bodies


def either_way(most: float):
    """Draw 0, or a number of either sign that is not lost beside others."""
    return st.just(0.0) | st.floats(1e-3, most) | st.floats(-most, -1e-3)


amounts = st.just(0.0) | st.builds(
    lambda mantissa, decade: mantissa * 10.0**decade, st.floats(1.0, 10.0), st.integers(-6, 2)
)
pressure_angles = st.just(0.0) | st.floats(0.0, 1.4)
all_bodies = st.builds(Bodies, *[amounts] * 5, pressure_angles)


@st.composite
def loaded(draw, max_branches: int = 4):
    """Draw a mechanism, the rotor's angle, velocity and acceleration, torques and bodies."""
    mechanism = draw(mechanisms(max_branches))
    rotor = draw(st.floats(-20.0, 20.0)), draw(either_way(1e3)), draw(either_way(1e5))
    torques = draw(hnp.arrays(np.float64, len(mechanism.branches), elements=either_way(1e3)))
    return mechanism, rotor, torques, draw(all_bodies)


def scales(mechanism, rotor, torques, bodies) -> dict[str, np.ndarray]:
    """Give for each field the sum of what may cancel in it, per branch; cf. `speed_up`."""
    radius, e = mechanism.satellite_rolling_radius, mechanism.eccentricity
    fastest = speed_up(mechanism) * max(abs(rotor[1]), math.sqrt(abs(rotor[2])), 1e-3)
    spin = max(abs(rotor[2]), 1e-6) / abs(float(mechanism.gear_ratio))
    orbit = (bodies.satellite_mass + bodies.coupling_mass) * e * fastest**2
    couple = np.abs(torques) + (bodies.satellite_inertia + bodies.coupling_inertia) * spin
    couple = couple + e * orbit
    tangential = couple / radius
    force = tangential / math.cos(bodies.pressure_angle) + orbit
    at_rotor = bodies.rotor_inertia * abs(rotor[2]) + np.sum(e * (tangential + orbit))
    return {
        'mesh_tangential': tangential,
        'mesh_force': force,
        'cam_force': force,
        'satellite_slot_force': np.full(couple.shape, orbit),
        'arm_slot_force': np.full(couple.shape, orbit),
        'satellite_couple': couple,
        'arm_couple': couple,
        'rotor_torque': at_rotor,
    }


def assert_expected(actual, expected, tolerances) -> None:
    """Compare loads of one state with those of an oracle, within 1e-12 of the scales."""
    rounding = 1e-40 * max(np.max(scale) for scale in tolerances.values())  # of 50 digits
    for name, scale in tolerances.items():
        values = np.array(getattr(expected, name), dtype=object).astype(float)
        tolerance = 1e-12 * (scale[:, np.newaxis] if values.ndim == 2 else scale) + rounding
        assert_close(getattr(actual, name), values, tolerance)
