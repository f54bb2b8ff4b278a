# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Angles as people read them."""

import math

import numpy as np
import pytest

from gear_kinematics.shape.angles import arc, arc_seconds


@pytest.mark.parametrize(('seconds', 'text'), [
    (0.0, '0.000″'), (-1e-9, '0.000″'), (4.8786, '4.879″'), (-4.878, '-4.878″'),
    (59.9996, '1′ 00.000″'), (206.265, '3′ 26.265″'), (3600.0, '1° 00′ 00.000″'),
    (-3723.45, '-1° 02′ 03.450″'), (1295999.9999, '360° 00′ 00.000″'),
])  # fmt: skip
def test_angles_are_written_in_degrees_minutes_and_seconds(seconds, text):
    assert arc(math.radians(seconds / 3600.0)) == text


def test_seconds_of_arc_are_those_of_the_definition():
    assert arc_seconds(math.pi) == pytest.approx(180.0 * 3600.0, rel=1e-15)
    angles = np.array([0.0, -math.pi / 2])
    np.testing.assert_allclose(arc_seconds(angles), [0.0, -90.0 * 3600.0], rtol=1e-15)
