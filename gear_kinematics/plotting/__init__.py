"""Figures of the mechanism, as image files or for a report; matplotlib is imported here only.

What makes an image file takes the path of the file that is to be, whose suffix says which format.
It raises ValueError if there is no such format, and ModuleNotFoundError without matplotlib.
"""

from gear_kinematics.plotting.animation import animate
from gear_kinematics.plotting.mechanism import outlines, scheme
from gear_kinematics.plotting.motion import output, roses, slides
from gear_kinematics.plotting.preload import torque_split

__all__ = ['animate', 'outlines', 'output', 'roses', 'scheme', 'slides', 'torque_split']
