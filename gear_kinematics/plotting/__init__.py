# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Figures of the mechanism, as the bytes of image files or for a report.

Plots take the image file that they are for, whose suffix is its format. They raise ValueError for
an unknown suffix and ModuleNotFoundError without matplotlib.
"""

from gear_kinematics.plotting.animation import animate, check_animation
from gear_kinematics.plotting.mechanism import outlines, scheme
from gear_kinematics.plotting.motion import output, roses, slides
from gear_kinematics.plotting.preload import leaving_mesh, load_range, loads_to_list, torque_split

__all__ = [
    'animate',
    'check_animation',
    'leaving_mesh',
    'load_range',
    'loads_to_list',
    'outlines',
    'output',
    'roses',
    'scheme',
    'slides',
    'torque_split',
]
