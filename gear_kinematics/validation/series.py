"""What was recorded and recomputed, thinned out over time for plots."""

from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from gear_kinematics.validation.report import Curve, Series
from gear_kinematics.wire.cdr import SECOND

Array = NDArray[np.float64]

_MOST = 2000  # samples of the record, which is halved when there are more


class FieldSamples(NamedTuple):
    """A field of compared messages; it can have several parts, such as the bodies of poses."""

    recorded: Array
    """(n, parts); NaN where it is absent."""
    expected: Array
    """(n, parts); NaN where it is absent."""
    error: Array
    """(n,): recorded minus expected, or its magnitude; infinite where the recorded value is not
    finite, NaN where the field is absent."""


class RecordedField(NamedTuple):
    """A field to record."""

    tolerance: float
    parts: Sequence[str] = ('',)
    """Their names."""


class _Rows(NamedTuple):
    """Samples; what is kept of an interval has the same form."""

    stamp: NDArray[np.int64]
    """(n,), ns."""
    rotor_angle: Array
    """(n,), rad."""
    fields: tuple[FieldSamples, ...]


class SeriesRecorder:
    """Keeps one sample of each interval: the worst one, if it is beyond a tolerance."""

    def __init__(self, fields: Mapping[str, RecordedField]) -> None:
        """Start without samples.

        Args:
            fields: the fields by their names.
        """
        self._fields = fields
        self._kept: list[_Rows] = []
        self._rest: list[_Rows] = []
        self._interval = 1

    def update(self, stamp: NDArray[np.int64], rotor_angle: Array, *fields: FieldSamples) -> None:
        """Add compared messages (n,): stamps, ns, rotor angles, rad, and their fields."""
        if not len(stamp):
            return
        rest = _joined([*self._rest, _Rows(stamp, rotor_angle, fields)])
        whole = len(rest.stamp) // self._interval * self._interval
        self._kept.append(self._thinned(_part(rest, slice(whole)), self._interval))
        self._rest = [_part(rest, slice(whole, None))]
        while sum(len(rows.stamp) for rows in self._kept) > _MOST:
            kept = _joined(self._kept)
            even = len(kept.stamp) // 2 * 2
            odd_one = _part(kept, slice(even, None))
            self._kept = [self._thinned(_part(kept, slice(even)), 2), odd_one]
            self._interval *= 2

    def series(self, topic: str, start: int) -> Series | None:
        """Return the record, or None if nothing was compared.

        Args:
            topic: name of the topic.
            start: stamp at the time 0, ns.
        """
        if not self._rest:
            return None
        rest = _joined(self._rest)
        rows = _joined([*self._kept, self._thinned(rest, max(len(rest.stamp), 1))])
        time = (rows.stamp - start) / SECOND
        curves = [
            _curve(name, recorded, samples)
            for (name, recorded), samples in zip(self._fields.items(), rows.fields, strict=True)
            if not (np.isnan(samples.recorded).all() and np.isnan(samples.expected).all())
        ]
        return Series(topic, time.tolist(), rows.rotor_angle.tolist(), tuple(curves))

    def _thinned(self, rows: _Rows, interval: int) -> _Rows:
        """Keep one sample of each interval, of a field beyond its tolerance the worst one."""
        if interval == 1:
            return rows
        size = [_size(samples).reshape(-1, interval) for samples in rows.fields]
        count = len(rows.stamp) // interval
        first = interval * np.arange(count)
        excess = np.zeros((count, interval))
        for values, field in zip(size, self._fields.values(), strict=True):
            beyond = values > field.tolerance
            share = np.where(beyond, values / max(field.tolerance, np.finfo(float).tiny), 0.0)
            excess = np.maximum(excess, share)
        fails = excess.any(axis=1)
        chosen = first + np.where(fails, np.argmax(excess, axis=1), interval // 2)
        fields = []
        for samples, values, field in zip(rows.fields, size, self._fields.values(), strict=True):
            worst = first + np.argmax(values, axis=1)
            shown = np.where(values.max(axis=1) > field.tolerance, worst, chosen)
            # The worst error always, the values of another sample if they agree anyway.
            kept = samples.recorded[shown], samples.expected[shown], samples.error[worst]
            fields.append(FieldSamples(*kept))
        return _Rows(rows.stamp[chosen], rows.rotor_angle[chosen], tuple(fields))


def _curve(name: str, field: RecordedField, samples: FieldSamples) -> Curve:
    """Return the curve of the part that is farthest off where the field is worst."""
    worst = int(np.argmax(_size(samples)))
    off = np.abs(samples.recorded[worst] - samples.expected[worst])
    part = int(np.argmax(np.nan_to_num(off, nan=np.inf)))
    return Curve(
        name,
        field.parts[part],
        samples.recorded[:, part].tolist(),
        samples.expected[:, part].tolist(),
        samples.error.tolist(),
    )


def _size(samples: FieldSamples) -> Array:
    """Magnitudes of the errors; those of absent values are less than any other."""
    size: Array = np.where(np.isnan(samples.error), -1.0, np.abs(samples.error))
    return size


def _part(rows: _Rows, part: slice) -> _Rows:
    fields = (FieldSamples(*(column[part] for column in samples)) for samples in rows.fields)
    return _Rows(rows.stamp[part], rows.rotor_angle[part], tuple(fields))


def _joined(parts: Sequence[_Rows]) -> _Rows:
    stamps, angles, fields = zip(*parts, strict=True)
    return _Rows(
        np.concatenate(stamps),
        np.concatenate(angles),
        tuple(
            FieldSamples(*map(np.concatenate, zip(*samples, strict=True)))
            for samples in zip(*fields, strict=True)
        ),
    )
