"""The contents of a recording for measuring lost motion, whatever its file format."""

import math
from dataclasses import dataclass
from typing import Self

import numpy as np
from numpy.typing import NDArray

from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.lost_motion.transmission import Motion

Array = NDArray[np.float64]

_FAR = 1000
"""Gaps over this many times the smallest one are ignored."""
_CLEAR = 1000
"""A step is at least this many times the rounding error."""


@dataclass(frozen=True, eq=False, slots=True)
class Loading:
    """Angles under torque, (n,) each, in the order of their sampling."""

    torque: Array
    """N·m, at the output."""
    angle: Array
    """rad, at the output: the twist of the gear, from an arbitrary zero."""
    angle_step: float
    """rad at the output, between readings of the angle; 0 if unknown."""
    measured: bool
    """Whether an encoder measured the output; if not, it is taken to be locked."""

    @classmethod
    def of_gear(cls, torque: Array, motion: Motion) -> Self:
        """Create the loading of the gear alone, from recordings of both its encoders.

        Args:
            torque: (n,), N·m, at the output, at the samples of `motion`.
            motion: whose error is the negative twist.
        """
        step = math.hypot(motion.rotor_step, motion.output_step)
        return cls(torque, -motion.error, step, measured=True)


@dataclass(frozen=True, eq=False, slots=True)
class Recording:
    """A recording: at least one of `loading` and `motion`."""

    name: str
    columns: tuple[str, ...]
    """Descriptions of the data that were read."""
    rows: int
    """Number of samples read."""
    loading: Loading | None = None
    motion: Motion | None = None
    remarks: tuple[str, ...] = ()
    """Sentences about what was left out or assumed."""
    error: str | None = None
    """Damage at which reading ended."""


def smallest_step(readings: Array) -> float:
    """Compute the step of a sensor whose readings are its multiples; 0 if they are not.

    It is the greatest common divisor of the gaps between readings, by Euclid's algorithm.

    Args:
        readings: in any unit, which is also that of the step.
    """
    levels = np.unique(readings)
    rounding = 4.0 * float(np.spacing(np.max(np.abs(levels), initial=0.0)))
    gaps = np.diff(levels)
    gaps = gaps[gaps > rounding]
    gaps = gaps[gaps <= _FAR * np.min(gaps, initial=np.inf)]
    step = 0.0
    while len(gaps):
        step = float(np.min(gaps))
        if step < _CLEAR * rounding:
            return 0.0
        wholes = np.round(gaps / step)
        rest = np.abs(gaps - wholes * step)
        gaps = rest[rest > rounding * (1.0 + wholes)]
    return step


def step_of(counts: int | None, readings: Array) -> float:
    """The step of an encoder, rad: from its counts per turn, or from its readings."""
    return TURN / counts if counts else smallest_step(readings)
