"""Plots for people, as the bytes of image files; matplotlib is imported here only.

A module for each subject; `figures` has what they share. Every plot takes the path of the file
that is to be: its suffix says which format. All raise ValueError if there is no such format, and
ModuleNotFoundError without matplotlib.
"""

from gear_kinematics.plotting.animation import animate
from gear_kinematics.plotting.lost_motion import lost_motion
from gear_kinematics.plotting.mechanism import scheme
from gear_kinematics.plotting.motion import output, roses, slides
from gear_kinematics.plotting.preload import torque_split

__all__ = ['animate', 'lost_motion', 'output', 'roses', 'scheme', 'slides', 'torque_split']
