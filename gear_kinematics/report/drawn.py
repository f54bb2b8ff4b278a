"""A mechanism as a report shows it: polygons, and how they move."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False, slots=True)
class DrawnBranch:
    """One branch of a mechanism, from back to front."""

    name: str
    cam_phase: float
    """rad."""
    shapes: Mapping[str, tuple[Array, ...]]
    """Closed polygons (n, 2), m, in the frame of their body, by classes of page.css."""


@dataclass(frozen=True, eq=False, slots=True)
class DrawnMechanism:
    """A mechanism as it is drawn."""

    branches: tuple[DrawnBranch, ...]
    body_names: Mapping[str, str]
    """Names in the legend by classes of page.css."""
    eccentricity: float
    """m."""


@dataclass(frozen=True, eq=False, slots=True)
class MovingMechanism:
    """A mechanism that moves with the x axis of the figure, time in s."""

    drawn: DrawnMechanism
    time: Array
    """(n,), s."""
    rotor: Array
    """Angle of the rotor, (n,), degrees."""
    output: Array
    """Angle of the output shaft, (n,), degrees."""
    start: int = 0
    """Index of the sample that is shown first."""
