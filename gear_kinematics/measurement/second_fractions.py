# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Times in two columns: whole seconds, and the fractions that belong to them."""

from collections.abc import Mapping, Sequence

import numpy as np

from gear_kinematics.measurement.names import TIME_UNITS, meaning
from gear_kinematics.measurement.recording import Array
from gear_kinematics.wire.cdr import SECOND


def fraction_of(name: str, names: Sequence[str]) -> str | None:
    """Return the column of ns, µs or ms that may belong to one of whole seconds, or dates."""
    words, unit, *_ = meaning(name)
    likely = [(words, other) for other in ('ns', 'us', 'ms') if unit == 's']
    # Millisecond beside Time, or Fractional Seconds
    likely += [((), 'ms'), (('fractional',), 's')] * (not unit)
    return next((other for other in names if meaning(other)[:2] in likely), None)


def in_nanoseconds(seconds: Array, fraction: Array, name: str) -> Array | None:
    """Add the fractions in a column of a name to whole seconds; None if they are times alone."""
    size = round(1.0 / TIME_UNITS[meaning(name).unit])
    if seconds.dtype.kind == 'M':
        seconds = np.where(np.isnat(seconds), np.nan, seconds.astype(np.int64) / SECOND)
    known = (seconds == seconds) & (fraction == fraction)  # noqa: PLR0124, no NaN
    if np.any(seconds[known] % 1.0) or np.any(fraction[known] >= size):
        return None
    whole, rest = (np.where(known, one, 0.0) for one in (seconds, fraction * (SECOND / size)))
    both = whole.astype(np.int64) * SECOND + np.round(rest).astype(np.int64)
    return both if known.all() else np.where(known, both, np.nan)


def join_fractions(raw: dict[str, Array], rests: Mapping[str, str]) -> dict[str, str]:
    """Make whole seconds and their fractions, by the names of both, times in ns, if they are such.

    Both columns become the same, so that neither is the time of one encoder. Returns the unit
    of those of seconds.
    """
    units = {}
    for name, rest in rests.items():
        if rest and (both := in_nanoseconds(raw[name], raw[rest], rest)) is not None:
            raw[name] = raw[rest] = both
            units[name] = 'ns'
    return units
