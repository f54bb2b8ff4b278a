"""Errors of the fields of an output topic, and their record over time for plots."""

import math
import sys
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from gear_kinematics.validation.occurrences import Occurrences
from gear_kinematics.validation.report import Curve, FieldReport, Series
from gear_kinematics.wire.cdr import SECOND

Array = NDArray[Any]

_NONE = np.zeros(0, np.int64)
_MAX_SAMPLES = 2000
"""Samples of the record, which is halved when there are more."""


class FieldErrors:
    """Statistics of the errors of one field, collected batch by batch."""

    def __init__(
        self, name: str, unit: str, tolerance: float, parts: Sequence[str] = ('',)
    ) -> None:
        """Start without samples.

        Args:
            name: of the field.
            unit: of its errors.
            tolerance: the greatest accepted error.
            parts: names of the parts that are plotted.
        """
        self.name, self.unit, self.tolerance, self.parts = name, unit, tolerance, parts
        self.non_finite = Occurrences()
        self.absent = Occurrences()
        self.max_error = 0.0
        self._compared = 0
        self._squares = 0.0
        self._worst_stamp: int | None = None
        self._worst_rotor_angle: float | None = None

    def update(
        self, error: Array, stamp: Array, rotor_angle: Array, absent: Array = _NONE
    ) -> None:
        """Add absolute errors (n,), and the stamps of samples that lack the field, (m,)."""
        self._compared += len(error)
        self.absent.add(absent)
        finite = np.isfinite(error)
        if not finite.all():
            self.non_finite.add(stamp[~finite])
            error, stamp, rotor_angle = error[finite], stamp[finite], rotor_angle[finite]
        if not len(error):
            return
        self._squares += float(error @ error)
        worst = int(np.argmax(error))
        if error[worst] > self.max_error:
            self.max_error = float(error[worst])
            self._worst_stamp = int(stamp[worst])
            self._worst_rotor_angle = float(rotor_angle[worst])

    def report(self) -> FieldReport:
        """Report on everything so far."""
        finite = self._compared - self.non_finite.count
        return FieldReport(
            name=self.name,
            unit=self.unit,
            tolerance=self.tolerance,
            compared=self._compared,
            non_finite=self.non_finite.count,
            absent=self.absent.count,
            max_error=self.max_error,
            rms_error=math.sqrt(self._squares / finite) if finite else 0.0,
            worst_stamp=self._worst_stamp,
            worst_rotor_angle=self._worst_rotor_angle,
            first_non_finite=self.non_finite.first,
            first_absent=self.absent.first,
        )


class FieldSamples(NamedTuple):
    """A field of compared messages; it can have several parts, such as the bodies of poses."""

    recorded: Array
    """(n, parts); NaN where it is absent."""
    expected: Array
    """(n, parts); NaN where it is absent."""
    error: Array
    """(n,): recorded minus expected, or its magnitude; infinite where the recorded value is not
    finite, NaN where the field is absent."""


_SAMPLES = FieldSamples._fields


class SeriesRecorder:
    """Keeps one sample of each interval: the worst one, if it is beyond a tolerance."""

    def __init__(self, fields: Sequence[FieldErrors]) -> None:
        """Start without samples of these fields."""
        self._fields = fields
        columns = [('stamp', np.int64), ('rotor_angle', np.float64)]
        self._row = np.dtype(columns + [(field.name, _samples_type(field)) for field in fields])
        self._kept: list[Array] = []
        self._interval = 1

    def update(self, stamp: NDArray[np.int64], rotor_angle: Array, *fields: FieldSamples) -> None:
        """Add compared messages (n,): stamps, ns, rotor angles, rad, and their fields."""
        if not len(stamp):
            return
        self._kept.append(self._thinned(stamp, rotor_angle, fields, self._interval))
        while sum(map(len, self._kept)) > _MAX_SAMPLES:
            rows = np.concatenate(self._kept)
            samples = [
                FieldSamples(*(rows[field.name][name] for name in _SAMPLES))
                for field in self._fields
            ]
            self._kept = [self._thinned(rows['stamp'], rows['rotor_angle'], samples, 2)]
            self._interval *= 2

    def series(self, topic: str, start: int) -> Series | None:
        """Return the record, or None if nothing was compared.

        Args:
            topic: name of the topic.
            start: stamp at the time 0, ns.
        """
        if not self._kept:
            return None
        rows = np.concatenate(self._kept)
        time = (rows['stamp'] - start) / SECOND
        curves = [
            _curve(field, rows[field.name])
            for field in self._fields
            if not all(np.isnan(rows[field.name][name]).all() for name in ('recorded', 'expected'))
        ]
        return Series(topic, time.tolist(), rows['rotor_angle'].tolist(), tuple(curves))

    def _thinned(
        self, stamp: Array, rotor_angle: Array, fields: Sequence[FieldSamples], interval: int
    ) -> Array:
        """Keep one sample of each interval, of a field beyond its tolerance the worst one."""
        count = -(-len(stamp) // interval)
        missing = count * interval - len(stamp)  # of the last interval
        sizes = [
            np.pad(_size(samples.error), (0, missing), constant_values=-1.0).reshape(count, -1)
            for samples in fields
        ]
        excess = np.zeros((count, interval))
        for size, field in zip(sizes, self._fields, strict=True):
            share = size / max(field.tolerance, sys.float_info.min)
            excess = np.maximum(excess, np.where(size > field.tolerance, share, 0.0))
        first = np.arange(0, len(stamp), interval)
        middle = np.minimum(first + interval // 2, len(stamp) - 1)
        chosen = np.where(excess.any(axis=1), first + np.argmax(excess, axis=1), middle)
        kept = np.empty(count, self._row)
        kept['stamp'], kept['rotor_angle'] = stamp[chosen], rotor_angle[chosen]
        for size, field, samples in zip(sizes, self._fields, fields, strict=True):
            # The worst error always, the values of another sample if they agree anyway.
            worst = first + np.argmax(size, axis=1)
            shown = np.where(size.max(axis=1) > field.tolerance, worst, chosen)
            rows = kept[field.name]
            rows['recorded'], rows['expected'] = samples.recorded[shown], samples.expected[shown]
            rows['error'] = samples.error[worst]
        return kept


def _samples_type(field: FieldErrors) -> np.dtype[Any]:
    """Type of the `FieldSamples` of one message."""
    parts = (np.float64, (len(field.parts),))
    return np.dtype([('recorded', *parts), ('expected', *parts), ('error', np.float64)])


def _curve(field: FieldErrors, samples: Array) -> Curve:
    """Return the curve of the part that is farthest off where the field is worst."""
    recorded, expected, error = (samples[name] for name in _SAMPLES)
    worst = int(np.argmax(_size(error)))
    off = np.abs(recorded[worst] - expected[worst])
    part = int(np.argmax(np.nan_to_num(off, nan=np.inf)))
    return Curve(
        field.name,
        field.parts[part],
        recorded[:, part].tolist(),
        expected[:, part].tolist(),
        error.tolist(),
    )


def _size(error: Array) -> Array:
    """Magnitudes of errors; those of absent values are less than any other."""
    size: Array = np.where(np.isnan(error), -1.0, np.abs(error))
    return size
