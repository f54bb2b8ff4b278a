"""Rate, gaps and speed of the rotor topic, and a thinned-out record over time for plots."""

import numpy as np
from numpy.typing import NDArray

from gear_kinematics.state.rotor_input import RotorInput
from gear_kinematics.validation.report import Gap, InputReport, Series

Array = NDArray[np.float64]

_GAP = 5.0  # median periods
_LONGEST = 10  # listed gaps
_PERIODS_FOR_MEDIAN = 65_536
_MOST = 4000  # points of the record, which is halved when there are more
_SECOND = 1e9  # ns


class InputHealth:
    """Collects statistics of the samples, batch by batch, in bounded memory."""

    def __init__(self, max_speed: float) -> None:
        """Start without samples.

        Args:
            max_speed: greatest possible speed of the rotor, rad/s.
        """
        self._max_speed = max_speed
        self._first_stamp: int | None = None
        self._last_stamp: int | None = None
        self._last_angle = 0.0
        self._duration = 0.0
        self._period_count = 0
        self._waiting: list[tuple[NDArray[np.int64], Array, Array]] = []
        self._median = 0.0
        self._gaps = 0
        self._longest: list[Gap] = []
        self._overspeed = 0
        self._fastest = 0.0

    def update(self, stamp: NDArray[np.int64], rotor_angle: Array) -> None:
        """Add the next samples: stamps in ns, angles in rad, (n,)."""
        if not len(stamp):
            return
        if self._last_stamp is None:
            self._first_stamp = int(stamp[0])
            self._last_stamp, self._last_angle = int(stamp[0]), float(rotor_angle[0])
        period = np.diff(stamp, prepend=self._last_stamp) / _SECOND
        turned = np.diff(rotor_angle, prepend=self._last_angle)
        self._last_stamp, self._last_angle = int(stamp[-1]), float(rotor_angle[-1])
        forward = period > 0.0  # neither a duplicate nor a restart
        period, turned, stamp = period[forward], turned[forward], stamp[forward]
        self._duration += float(period.sum())
        speed = np.abs(turned) / period
        self._fastest = max(self._fastest, float(speed.max(initial=0.0)))
        self._overspeed += int(np.count_nonzero(speed > self._max_speed))
        self._waiting.append((stamp, period, turned))
        if not self._median:
            self._period_count += len(period)
            if self._period_count < _PERIODS_FOR_MEDIAN:
                return
        self._find_gaps()

    def report(self, rotor_input: RotorInput, topic: str) -> InputReport:
        """Report on everything so far."""
        self._find_gaps()
        return InputReport(
            topic=topic,
            joint=rotor_input.settings.rotor_joint,
            messages=rotor_input.received,
            valid=rotor_input.received - rotor_input.rejected.total(),
            rejected=dict(rotor_input.rejected),
            duplicates=rotor_input.duplicates,
            zero_stamps=rotor_input.zero_stamps,
            unnormalised_stamps=rotor_input.unnormalised_stamps,
            resets=rotor_input.resets,
            first_stamp=self._first_stamp,
            rate=1.0 / self._median if self._median else 0.0,
            duration=self._duration,
            gaps=self._gaps,
            jumps=rotor_input.unknown_turns,
            overspeed=self._overspeed,
            max_speed=self._fastest,
            longest_gaps=tuple(self._longest),
            referenced=not rotor_input.unknown_turns,
        )

    def _find_gaps(self) -> None:
        """Find gaps in the waiting periods, compared with the median of the first ones."""
        if not self._waiting:
            return
        stamps, periods, angles = zip(*self._waiting, strict=True)
        stamp, period, turned = map(np.concatenate, (stamps, periods, angles))
        self._waiting.clear()
        if not self._median and len(period):
            self._median = float(np.median(period))
        long = np.flatnonzero(period > _GAP * self._median)
        self._gaps += len(long)
        longest = long[np.argsort(-period[long], kind='stable')[:_LONGEST]]
        self._longest += [Gap(int(stamp[k]), float(period[k]), float(turned[k])) for k in longest]
        self._longest.sort(key=lambda gap: -gap.seconds)
        del self._longest[_LONGEST:]


class SeriesRecorder:
    """Keeps the sample with the worst error of each interval."""

    def __init__(self) -> None:
        self._columns = np.zeros((5, 0))
        self._interval = 1
        self._rest = np.zeros((5, 0))
        self._first: int | None = None

    def update(self, output: dict[str, Array], poses: dict[str, Array]) -> None:
        """Add the compared samples of output_state, with the pose errors at the same stamps."""
        if not output or not len(output['stamp']):
            return
        if self._first is None:
            self._first = int(output['stamp'][0])
        position_error = np.zeros(len(output['stamp']))
        if poses and len(poses['stamp']):
            order = np.argsort(poses['stamp'], kind='stable')
            at = np.searchsorted(poses['stamp'], output['stamp'], sorter=order)
            at = order[np.minimum(at, len(order) - 1)]
            same = poses['stamp'][at] == output['stamp']
            position_error[same] = poses['error'][at[same]]
        fresh = np.array(
            [
                (output['stamp'] - self._first) / _SECOND,
                output['rotor_angle'],
                output['output_angle'],
                output['error'],
                position_error,
            ]
        )
        self._rest = np.concatenate([self._rest, fresh], axis=1)
        whole = self._rest.shape[1] // self._interval * self._interval
        self._columns = np.concatenate(
            [self._columns, _worst(self._rest[:, :whole], self._interval)], axis=1
        )
        self._rest = self._rest[:, whole:]
        while self._columns.shape[1] > _MOST:
            even = self._columns.shape[1] // 2 * 2
            left = self._columns[:, even:]
            self._columns = np.concatenate([_worst(self._columns[:, :even], 2), left], axis=1)
            self._interval *= 2

    def series(self) -> Series | None:
        """Return the record, or None if nothing was compared."""
        if self._first is None:
            return None
        rest = _worst(self._rest, max(self._rest.shape[1], 1))
        return Series(*np.concatenate([self._columns, rest], axis=1).tolist())


def _worst(columns: Array, interval: int) -> Array:
    """For each interval, the time and angles of its middle and its worst errors."""
    table = columns.reshape(5, -1, interval)
    thinned = table[:, :, interval // 2].copy()
    for row in (3, 4):
        worst = np.argmax(np.abs(table[row]), axis=1) if table.size else []
        thinned[row] = table[row, np.arange(table.shape[1]), worst]
    return thinned
