# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The nearest known name is asked for, and nothing where none is near."""

import pytest

from gear_kinematics.wire.nearest import among, listed

GEARS = ('/left/gear', '/right/gear', '/right_arm/gear')
KNOWN = ('rotor_joint', 'rotor_zero', 'output_joint')


@pytest.mark.parametrize(
    ('name', 'known', 'expected'),
    [
        ('rotor_jiont', KNOWN, '; did you mean `rotor_joint`? there are: output_joint, rotor_jo'),
        ('', KNOWN, '; there are: output_joint, rotor_joint, rotor_zero'),
        ('ROTOR_ZERO', KNOWN, '; did you mean `rotor_zero`? there are: output_joint, rotor_join'),
        ('nothing_like_it', KNOWN, '; there are: output_joint, rotor_joint, rotor_zero'),
        ('/left', GEARS, '; did you mean `/left/gear`? there are: /left/gear, /right/gear, '),
        ('right', GEARS, '; did you mean `/right/gear`? there are: '),
        ('gear', GEARS, '; there are: /left/gear, '),
        ('/', GEARS, '; there are: /left/gear, '),
        ('m', (), '; there are none'),
        ('m', [f'{k:02}' for k in range(12)], '; there are: 00, 01, 02, 03, 04, 05, 06, 07, 08, '),
    ],
)
def test_message_ends_with_the_names_that_there_are(name, known, expected):
    assert among(name, known).startswith(expected)


def test_many_and_long_names_are_cut():
    assert listed([f'{k:02}' for k in range(12)]).endswith(', 09 and 2 more')
    assert listed(['b', 'a', 'c'], first=['c'], most=2) == 'c, a and 1 more'
    assert len(listed(['x' * 1000])) == 100
