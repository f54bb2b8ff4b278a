"""The contents of a recording for measuring lost motion, whatever its file format."""

from dataclasses import dataclass
from typing import Self

import numpy as np
from numpy.typing import NDArray

from gear_kinematics.lost_motion.recorded.encoder_step import Step
from gear_kinematics.lost_motion.recorded.motion import Motion

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False, slots=True)
class Loading:
    """Angles under torque, (n,) each, in the order of their sampling."""

    torque: Array
    """N·m, at the output."""
    angle: Array
    """rad, at the output: the twist of the gear, from an arbitrary zero."""
    angle_step: Step
    """rad at the output, between readings of the angle."""
    measured: bool
    """Whether an encoder measured the output; if not, it is taken to be locked."""
    time: Array | None = None
    """s since the first sample, increasing; None if it is not known."""

    @classmethod
    def of_gear(cls, torque: Array, motion: Motion, time: Array | None = None) -> Self:
        """Create the loading of the gear alone, from recordings of both its encoders.

        Args:
            torque: (n,), N·m, at the output, at the samples of `motion`.
            motion: whose error is the negative twist.
            time: (n,), s since the first sample.
        """
        step = motion.rotor_step.joined(motion.output_step)
        return cls(torque, -motion.error, step, measured=True, time=time)


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
