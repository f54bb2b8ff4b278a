# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Figures of the mechanism, for a report or as the bytes of image files."""

from gear_kinematics.plotting.animation import animate
from gear_kinematics.plotting.mechanism import outlines, scheme
from gear_kinematics.plotting.motion import output, roses, slides
from gear_kinematics.plotting.preload import torque_split

__all__ = ['animate', 'outlines', 'output', 'roses', 'scheme', 'slides', 'torque_split']
