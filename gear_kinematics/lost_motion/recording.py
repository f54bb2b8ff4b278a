"""What a recording holds to measure lost motion by, whatever kind of file it is."""

import math
from dataclasses import dataclass
from typing import Self

import numpy as np
from numpy.typing import NDArray

from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.lost_motion.transmission import Motion

Array = NDArray[np.float64]

_FAR = 1000
"""Distances of readings that are as many times the least tell nothing more about the step."""
_CLEAR = 1000
"""A step is at least as many times what rounding makes of it."""


@dataclass(frozen=True, eq=False, slots=True)
class Loading:
    """Angles under torque, (n,) each, in the order of their sampling."""

    torque: Array
    """N·m, at the output."""
    angle: Array
    """rad, at the output: how far the gear is wound up, from anywhere."""
    angle_step: float
    """rad at the output, between readings of the angle; 0 where it is not known."""
    measured: bool
    """Whether an encoder saw the output; else it is taken to be locked."""

    @classmethod
    def of_gear(cls, torque: Array, motion: Motion) -> Self:
        """Of the gear alone, where both its encoders were recorded.

        Args:
            torque: (n,), N·m, at the output, at the samples of `motion`.
            motion: whose error is the wind-up.
        """
        step = math.hypot(motion.rotor_step, motion.output_step)
        return cls(torque, -motion.error, step, measured=True)


@dataclass(frozen=True, eq=False, slots=True)
class Recording:
    """A recording: at least one of `loading` and `motion`."""

    name: str
    columns: tuple[str, ...]
    """What was read from where, a phrase each."""
    rows: int
    """Samples that were read."""
    loading: Loading | None = None
    motion: Motion | None = None
    remarks: tuple[str, ...] = ()
    """Sentences about what was left out or assumed."""
    error: str | None = None
    """What cut the recording short."""


def smallest_step(readings: Array) -> float:
    """The step of a sensor whose readings are whole numbers of it; 0 if they are not.

    It is the greatest common divisor of the distances between readings, by Euclid's algorithm.

    Args:
        readings: in their unit, and the step is, too.
    """
    levels = np.unique(readings)
    rounding = 4.0 * float(np.spacing(np.max(np.abs(levels), initial=0.0)))
    distances = np.diff(levels)
    distances = distances[distances > rounding]
    distances = distances[distances <= _FAR * np.min(distances, initial=np.inf)]
    step = 0.0
    while len(distances):
        step = float(np.min(distances))
        if step < _CLEAR * rounding:
            return 0.0
        wholes = np.round(distances / step)
        rest = np.abs(distances - wholes * step)
        distances = rest[rest > rounding * (1.0 + wholes)]
    return step


def step_of(counts: int | None, readings: Array) -> float:
    """The step of an encoder, rad: of so many in a turn, or what its readings show."""
    return TURN / counts if counts else smallest_step(readings)
