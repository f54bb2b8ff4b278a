# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Errors of the fields of an output topic, and their record over time for plots."""

import math
import sys
from collections.abc import Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from gear_kinematics.validation.occurrences import Occurrences
from gear_kinematics.validation.report import Curve, FieldReport, Series
from gear_kinematics.wire.cdr import SECOND

Array = NDArray[Any]

_MAX_SAMPLES = 2000
"""Samples of the record, which is halved when there are more."""


class FieldSamples(NamedTuple):
    """A field of compared messages; it can have several parts, such as the bodies of poses."""

    recorded: Array
    """(n, parts); NaN where it is absent."""
    expected: Array
    """(n, parts); NaN where it is absent."""
    error: Array
    """(n,): recorded minus expected, or its magnitude; infinite where the recorded value is not
    finite, NaN where the field is absent."""
    one_sided: Array = np.zeros(0, np.intp)
    """(m,): indices of the messages with the field in input or output only."""


class FieldErrors:
    """Statistics of the errors of one field, collected batch by batch."""

    def __init__(
        self, name: str, unit: str, tolerance: float, parts: Sequence[str] = ('',)
    ) -> None:
        """Start without samples; the parts are plotted, and have names if there are several."""
        self.name, self.tolerance, self.parts = name, tolerance, parts
        self.non_finite = Occurrences()
        self.absent = Occurrences()
        self._worst = FieldReport(name, unit, tolerance)
        self._compared = 0
        self._squares = 0.0

    def update(self, samples: FieldSamples, stamp: Array, rotor_angle: Array) -> None:
        """Add samples of messages, with their stamps, ns, and rotor angles, rad, (n,)."""
        error = np.abs(samples.error)
        self.absent.add(stamp[samples.one_sided])
        self.non_finite.add(stamp[error == np.inf])
        finite = np.isfinite(error)
        if not finite.all():
            error, stamp, rotor_angle = error[finite], stamp[finite], rotor_angle[finite]
        if not len(error):
            return
        self._compared += len(error)
        self._squares += float(error @ error)
        worst = int(np.argmax(error))
        if error[worst] > self._worst.max_error:
            self._worst = replace(
                self._worst,
                max_error=float(error[worst]),
                worst_stamp=int(stamp[worst]),
                worst_rotor_angle=float(rotor_angle[worst]),
            )

    def report(self) -> FieldReport:
        """Report on everything so far."""
        return replace(
            self._worst,
            compared=self._compared + self.non_finite.count,
            non_finite=self.non_finite.count,
            absent=self.absent.count,
            rms_error=math.sqrt(self._squares / self._compared) if self._compared else 0.0,
            first_non_finite=self.non_finite.first,
            first_absent=self.absent.first,
        )


class _Rows(NamedTuple):
    """Samples of all fields of compared messages."""

    stamp: Array
    rotor_angle: Array
    fields: Sequence[FieldSamples]


class SeriesRecorder:
    """Keeps one sample of each interval: the worst one, if it is beyond a tolerance."""

    def __init__(self, fields: Sequence[FieldErrors]) -> None:
        """Start without samples of these fields."""
        self._fields = fields
        self._kept: list[_Rows] = []
        self._interval = 1

    def update(self, stamp: NDArray[np.int64], rotor_angle: Array, *fields: FieldSamples) -> None:
        """Add compared messages (n,): stamps, ns, rotor angles, rad, and their fields."""
        if not len(stamp):
            return
        self._kept.append(self._thinned(_Rows(stamp, rotor_angle, fields), self._interval))
        while sum(len(rows.stamp) for rows in self._kept) > _MAX_SAMPLES:
            self._kept = [self._thinned(_joined(self._kept), 2)]
            self._interval *= 2

    def series(self, topic: str, start: int) -> Series | None:
        """Return the record, with the time 0 at a stamp, ns; None if nothing was compared."""
        if not self._kept:
            return None
        rows = _joined(self._kept)
        curves = [
            _curve(field, samples)
            for field, samples in zip(self._fields, rows.fields, strict=True)
            if not (np.isnan(samples.recorded).all() and np.isnan(samples.expected).all())
        ]
        time = (rows.stamp - start) / SECOND
        return Series(topic, time.tolist(), rows.rotor_angle.tolist(), tuple(curves))

    def _thinned(self, rows: _Rows, interval: int) -> _Rows:
        """Keep one sample of each interval, of a field beyond its tolerance the worst one."""
        excess = np.zeros(len(rows.stamp))
        for field, samples in zip(self._fields, rows.fields, strict=True):
            size = _size(samples.error)
            share = size / max(field.tolerance, sys.float_info.min)
            excess = np.maximum(excess, np.where(size > field.tolerance, share, 0.0))
        worst = _greatest(excess, interval)
        middle = np.minimum(np.arange(0, len(excess), interval) + interval // 2, len(excess) - 1)
        chosen = np.where(excess[worst] > 0.0, worst, middle)
        fields = []
        for field, samples in zip(self._fields, rows.fields, strict=True):
            # The worst error always, the values of another sample if they agree anyway.
            size = _size(samples.error)
            worst = _greatest(size, interval)
            shown = np.where(size[worst] > field.tolerance, worst, chosen)
            values = samples.recorded[shown], samples.expected[shown]
            fields.append(FieldSamples(*values, samples.error[worst]))
        return _Rows(rows.stamp[chosen], rows.rotor_angle[chosen], fields)


def _joined(kept: Sequence[_Rows]) -> _Rows:
    stamps, angles, fields = zip(*kept, strict=True)
    samples = (
        FieldSamples(*map(np.concatenate, zip(*of, strict=True)))
        for of in zip(*fields, strict=True)
    )
    return _Rows(np.concatenate(stamps), np.concatenate(angles), list(samples))


def _greatest(size: Array, interval: int) -> Array:
    """Index of the greatest of each interval of sizes, (n,), none of which is below -1."""
    padded = np.pad(size, (0, -len(size) % interval), constant_values=-1.0)
    found: Array = np.arange(0, len(size), interval) + padded.reshape(-1, interval).argmax(axis=1)
    return found


def _curve(field: FieldErrors, samples: FieldSamples) -> Curve:
    """Return the curve of the part that is farthest off where the field is worst."""
    recorded, expected, error, _ = samples
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
