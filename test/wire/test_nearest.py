"""The nearest known name is asked for, and nothing where none is near."""

import pytest

from gear_kinematics.wire.nearest import nearest

KNOWN = ('rotor_joint', 'rotor_zero', 'output_joint')


@pytest.mark.parametrize(
    ('name', 'expected'),
    [
        ('rotor_jiont', '; did you mean `rotor_joint`?'),
        ('rotor_joints', '; did you mean `rotor_joint`?'),
        ('Rotor_zero', '; did you mean `rotor_zero`?'),
        ('nothing_like_it', ''),
        ('', ''),
    ],
)
def test_nearest_known_name_ends_the_message(name, expected):
    assert nearest(name, KNOWN) == expected
    assert nearest(name, iter(KNOWN)) == expected
    assert nearest(name, ()) == ''
