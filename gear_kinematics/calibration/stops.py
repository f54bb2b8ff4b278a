"""States of stop operators at the measured angles of a recording."""

from collections.abc import Iterator
from itertools import pairwise

import numpy as np

from gear_kinematics.calibration.normal import Array
from gear_kinematics.calibration.recording import Recording
from gear_kinematics.state.correction import play_bounds

_CHUNK = 4096
_SAME = 1e-9  # of the radius: rounding


class TurningPoints:
    """Where the rotor turns back; the play in between depends on that at the last such point."""

    def __init__(self, recording: Recording, ideal: Array, starts: Array) -> None:
        """Find them.

        Args:
            recording: whose measured angles the states are for.
            ideal: output angle of the rotor's samples, rad.
            starts: indices of the rotor's samples before which the motion is unknown.
        """
        steps = np.diff(ideal)
        moving = np.flatnonzero(steps)
        back = np.diff(np.sign(steps[moving])) != 0.0
        points = np.union1d(starts, moving[1:][back])
        self._angles = ideal[points]
        self._begins = np.searchsorted(points, starts)
        self._last = np.searchsorted(points, recording.before, side='right') - 1
        self._output = recording.at_measured(ideal)

    def stop_states(self, radius: float) -> tuple[Array, Array]:
        """Return the states of a stop operator at the measured angles.

        Args:
            radius: rad.

        Returns:
            The middle between the least and the greatest possible state, (n,), rad, and whether
            both are the same.
        """
        parts = [np.hstack(ends) for ends in self._plays(radius)]
        plays = np.concatenate(parts)[self._last]
        low, high = self._output[:, np.newaxis] - radius, self._output[:, np.newaxis] + radius
        least, most = np.clip(plays, low, high).T
        return self._output - 0.5 * (least + most), most - least <= _SAME * radius

    def _plays(self, radius: float) -> Iterator[tuple[Array, Array]]:
        """Least and greatest possible plays at the turning points, in parts."""
        radii = np.array([radius])
        for begin, end in pairwise([*self._begins.tolist(), len(self._angles)]):
            least, most = np.array([-np.inf]), np.array([np.inf])
            for first in range(begin, end, _CHUNK):
                angles = self._angles[first : min(first + _CHUNK, end)]
                bounds = play_bounds(angles, radii, least, most)
                least, most = (ends[-1] for ends in bounds)
                yield bounds
