"""The motion of a gear whose rotor and output were both recorded."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from heapq import merge
from operator import itemgetter
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.lost_motion.recorded.encoder_step import Step
from gear_kinematics.state.transmission_error import ErrorSample, TransmissionError
from gear_kinematics.wire.cdr import SECOND

Array = NDArray[np.float64]


class MotionError(ValueError):
    """A recording of both encoders without usable samples."""


@dataclass(frozen=True, eq=False, slots=True)
class Motion:
    """The transmission error as it was recorded, (n,) each, in the order of time."""

    stamp: NDArray[np.int64]
    """ns."""
    angle: Array
    """Ideal output angle, rad, counted from the first turn."""
    error: Array
    """Measured minus ideal output angle, rad."""
    direction: NDArray[np.int8]
    """1, -1, or 0 where unknown."""
    unmatched: Mapping[str, int]
    """Measured angles without an error, by cause."""
    rotor_step: Step
    """rad at the output, between readings of the rotor's encoder."""
    output_step: Step
    """rad, the same of the output's encoder."""
    in_rows: bool = False
    """Whether the stamps are numbers of rows, for want of times."""

    @property
    def time(self) -> Array:
        """(n,), s since the first sample, or rows."""
        unit = 1.0 if self.in_rows else 1.0 / SECOND
        time: Array = (self.stamp - self.stamp[0]) * unit
        return time

    def without_delay(self, delay: float) -> 'Motion':
        """The motion if the output was measured earlier than stamped, by a delay, s or rows."""
        time = self.time
        angle = np.interp(time - delay, time, self.angle)
        nearest = np.clip(np.searchsorted(time, time - delay), 0, len(time) - 1)
        return replace(
            self,
            angle=angle,
            error=self.error + self.angle - angle,
            direction=self.direction[nearest],
        )

    @classmethod
    def from_angles(
        cls,
        comparison: TransmissionError,
        ideal: tuple[NDArray[Any], NDArray[Any], NDArray[Any]],
        measured: tuple[NDArray[Any], NDArray[Any]],
        rotor_step: Step,
        output_step: Step,
        *,
        in_rows: bool = False,
    ) -> 'Motion':
        """Compare ideal (stamp, turns, angle) with measured (stamp, angle), in order of stamps.

        Raises:
            MotionError: if there is nothing to compare.
        """
        stamps, turns, angles = ideal
        columns = (stamps, turns.astype(np.int64), angles), measured
        rows = (zip(*(column.tolist() for column in c), strict=True) for c in columns)
        samples: list[ErrorSample] = []
        for stamp, *angle in merge(*rows, key=itemgetter(0)):
            add: Any = comparison.add_ideal if len(angle) > 1 else comparison.add_measured
            samples += add(stamp, *angle)
        if not samples:
            causes = ', '.join(f'{cause} {count}' for cause, count in comparison.unmatched.items())
            raise MotionError(f'no output angle could be matched with the rotor: {causes}')
        first = samples[0].turns
        return cls(
            np.array([s.stamp for s in samples]),
            np.array([(s.turns - first) * TURN + s.ideal for s in samples]),
            np.array([s.error for s in samples]),
            np.array([s.direction for s in samples], np.int8),
            dict(comparison.unmatched),
            rotor_step,
            output_step,
            in_rows,
        )
