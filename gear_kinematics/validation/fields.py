# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Errors of the fields of an output topic, and their record over time for plots."""

import math
import sys
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from gear_kinematics.validation.report import FieldReport, Series
from gear_kinematics.wire.cdr import SECOND

Array = NDArray[Any]

_PART = 10_000  # numbers, up to which OpenBLAS computes in one thread
_MAX_SAMPLES = 2000  # samples of the record, which is halved when there are more


class Window:
    """The latest n samples, or some of them, as columns by name, each (n,)."""

    def __init__(self, columns: Mapping[str, Array]) -> None:
        self.columns = dict(columns)

    def __len__(self) -> int:
        return len(next(iter(self.columns.values())))

    def __getitem__(self, name: str) -> Array:
        return self.columns[name]

    def __setitem__(self, name: str, values: Array) -> None:
        self.columns[name] = values

    def take(self, rows: Array | slice) -> 'Window':
        """Return samples; those of a slice share the memory of their columns."""
        return Window({name: values[rows] for name, values in self.columns.items()})

    def extended(self, new: 'Window') -> 'Window':
        """Return these samples with other ones behind them."""
        return Window({
            name: np.concatenate([values, new[name]]) for name, values in self.columns.items()
        })  # fmt: skip


def as_slice(rows: Array) -> Array | slice:
    """Return the rows as a slice, which is faster, if they follow each other."""
    if not len(rows):
        return slice(0)
    first = int(rows[0])
    return slice(first, first + len(rows)) if (np.diff(rows) == 1).all() else rows


class Occurrences:
    """Number of messages to which something happened, and the stamp of the first."""

    def __init__(self) -> None:
        self.count = 0
        self.first: int | None = None  # stamp of the one that was added first, ns

    def add(self, stamps: Array) -> None:
        """Add occurrences at stamps, (n,), ns."""
        if self.first is None and len(stamps):
            self.first = int(stamps[0])
        self.count += len(stamps)

    def add_all(self, others: 'Occurrences') -> None:
        """Add the occurrences of another object."""
        if self.first is None:
            self.first = others.first
        self.count += others.count


def product(one: Array, other: Array) -> float:
    """Return the scalar product of vectors, (n,), in parts.

    For longer ones, BLAS starts threads, which wait for each other on a busy machine.
    """
    parts = range(0, len(one), _PART)
    return float(sum(one[k : k + _PART] @ other[k : k + _PART] for k in parts))


class FieldSamples(NamedTuple):
    """A field of compared messages."""

    error: Array
    """(n,): recorded minus expected, or its magnitude; infinite where the recorded value is not
    finite, NaN where the field is absent."""
    one_sided: Array = np.zeros(0, np.intp)  # (m,), messages with it in input or output only
    recorded: Array = np.zeros(0)  # (n,), values of a field of one number; NaN if absent
    expected: Array = np.zeros(0)  # (n,), the expected value; NaN as in `recorded`


class FieldErrors:
    """Statistics of the errors of one field, collected batch by batch."""

    def __init__(self, name: str, unit: str, tolerance: float) -> None:
        self.name, self.tolerance = name, tolerance
        self.non_finite = Occurrences()
        self.absent = Occurrences()
        self._worst = FieldReport(name, unit, tolerance)
        self._compared = 0
        self._squares = 0.0

    def update(self, samples: FieldSamples, stamp: Array, rotor_angle: Array) -> Array:
        """Add samples of messages, with their stamps, ns, and rotor angles, rad, (n,).

        Returns which of them are wrong, (n,).
        """
        size = error = np.abs(samples.error)
        self.absent.add(stamp[samples.one_sided])
        wrong = size > self.tolerance
        wrong[samples.one_sided] = True
        if not math.isfinite(size.max(initial=0.0)):
            finite = np.isfinite(size)
            self.non_finite.add(stamp[size == np.inf])
            error, stamp, rotor_angle = size[finite], stamp[finite], rotor_angle[finite]
        self._compared += len(error)
        self._squares += product(error, error)
        if error.max(initial=0.0) > self._worst.max_error:
            worst = int(np.argmax(error))
            self._worst = replace(
                self._worst,
                max_error=float(error[worst]),
                worst_stamp=int(stamp[worst]),
                worst_rotor_angle=float(rotor_angle[worst]),
            )
        return wrong

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


class SeriesRecorder:
    """Keeps the worst error of each field in each interval of messages."""

    def __init__(self, fields: Sequence[FieldErrors]) -> None:
        self._fields = fields
        self._start: int | None = None  # stamp of the first message, ns
        self._kept = np.zeros((2 + len(fields), 0))
        """Rows with times since then, s, rotor angles, rad, and the errors of each field."""
        self._interval = 1

    def update(self, stamp: NDArray[np.int64], rotor_angle: Array, *fields: FieldSamples) -> None:
        """Add compared messages (n,): stamps, ns, rotor angles, rad, and their fields."""
        if not len(stamp):
            return
        if self._start is None:
            self._start = int(stamp[0])
            while len(stamp) > _MAX_SAMPLES * self._interval:  # else halved until then
                self._interval *= 2
        moment, errors = self._worst([field.error for field in fields], self._interval)
        time = (stamp[moment] - self._start) / SECOND
        new = np.stack([time, rotor_angle[moment], *errors])
        self._kept = np.hstack([self._kept, new])
        while self._kept.shape[1] > _MAX_SAMPLES:
            moment, errors = self._worst(self._kept[2:], 2)
            self._kept = np.stack([*self._kept[:2, moment], *errors])
            self._interval *= 2

    def series(self, topic: str, start: int) -> Series | None:
        """Return the record, with the time 0 at a stamp, ns; None if nothing was compared."""
        if self._start is None:
            return None
        time, rotor_angle, *errors = self._kept
        time = time + (self._start - start) / SECOND
        compared = {
            field.name: error.tolist()
            for field, error in zip(self._fields, errors, strict=True)
            if not np.isnan(error).all()
        }
        return Series(topic, time.tolist(), rotor_angle.tolist(), compared)

    def _worst(self, errors: Iterable[Array], interval: int) -> tuple[Array, list[Array]]:
        """Return when most of a tolerance was used, and the worst of each error, (n,)."""
        most, worst = np.zeros(0), list[Array]()
        for error, field in zip(errors, self._fields, strict=True):
            size = np.abs(error)
            if np.isnan(size.max()):  # errors of absent values are less than any other
                size[np.isnan(size)] = -1.0
            worst.append(error[_greatest(size, interval)])
            share = size / max(field.tolerance, sys.float_info.min)
            most = np.maximum(most, share) if len(worst) > 1 else share
        return _greatest(most, interval), worst


def _greatest(size: Array, interval: int) -> Array:
    """Find the indices of the greatest sizes, (n,), of each interval."""
    whole = len(size) - len(size) % interval
    within = size[:whole].reshape(-1, interval).argmax(axis=1)
    found = np.arange(0, whole, interval) + within
    return np.append(found, whole + np.argmax(size[whole:])) if whole < len(size) else found
