# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""One URDF of all actuators of an arm."""

from collections.abc import Mapping

from gear_kinematics.parameters.node_parameters import NodeParameters

_SPACING = 1.5  # diameters of the largest ring gear


def arm_urdf(actuators: Mapping[str, NodeParameters]) -> tuple[str, list[str]]:
    """Write the URDF of the actuators whose bodies are known, side by side where they are several.

    Args:
        actuators: parameters by name, as of `load_actuators`.

    Returns:
        The URDF, and the names of the actuators that are not in it.

    Raises:
        ValueError: if only the ratios are known, or there is no such mechanism.
    """
    shown = {name: each for name, each in actuators.items() if not each.gear_ratio} or actuators
    urdfs = [each.urdf() for each in shown.values()]
    if len(urdfs) == 1:
        return urdfs[0], [name for name in actuators if name not in shown]
    from gear_kinematics.shape.urdf import side_by_side  # noqa: PLC0415, of few programs

    largest = max(each.module * each.ring_teeth for each in shown.values())
    text = side_by_side(urdfs, _SPACING * largest)
    return text, [name for name in actuators if name not in shown]
