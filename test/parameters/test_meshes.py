# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The parameter `meshes`, and the installed meshes."""

import pytest

from gear_kinematics.kinematics import Branch, Mechanism
from gear_kinematics.parameters.meshes import check, folder_uri

MODULE = 0.0005
INSTALLED = 'package://gear_kinematics/meshes/80_76_0_0011_0_0005'


def test_installed_meshes_are_taken_for_their_mechanism_alone(actuator):
    assert folder_uri('auto', actuator, MODULE) == INSTALLED
    # They are the same for other branches.
    alone = Mechanism(80, 76, 0.0011, (Branch('c', 0.3, 0.1),))
    assert folder_uri('auto', alone, MODULE) == INSTALLED
    for other in (Mechanism(80, 76, 0.00111, actuator.branches),
                  Mechanism(80, 77, 0.0011, actuator.branches),
                  Mechanism(81, 76, 0.0011, actuator.branches)):  # fmt: skip
        assert folder_uri('auto', other, MODULE) == ''
    assert folder_uri('auto', actuator, 0.00051) == ''


def test_other_values_do_not_depend_on_the_mechanism(actuator):
    assert folder_uri('none', actuator, MODULE) == ''
    for uri in ('package://my_robot/meshes', 'file:///home/me/my%20meshes'):
        assert folder_uri(uri, actuator, MODULE) == folder_uri(f'{uri}/', actuator, 1.0) == uri


@pytest.mark.parametrize(
    'value', ['', 'meshes', '/m', '://m', 'package://', 'file:///a b', 'a://ä']
)
def test_other_values_are_refused(value):
    for usable in ('auto', 'none', 'package://my_robot/meshes', 'http://host:8000/m', 'file:///m'):
        check(usable)
    with pytest.raises(ValueError, match=r'must be auto, none or a URI such as package://'):
        check(value)
