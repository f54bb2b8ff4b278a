# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Tables as recordings: the rows that are used, their units and times."""

from collections.abc import Iterator
from contextlib import contextmanager
from fractions import Fraction
from functools import partial
from pathlib import Path
from typing import NamedTuple

import numpy as np

from gear_kinematics.kinematics.rotor_turns import LARGEST_ANGLE, TURN
from gear_kinematics.measurement.advice import advise
from gear_kinematics.measurement.clocks import FASTEST, MOST, stamps, with_unit
from gear_kinematics.measurement.columns import (
    ColumnsError,
    Sources,
    described,
    find_columns,
    nanoseconds_of,
)
from gear_kinematics.measurement.commissioning.encoder_range import count_wraps, signed, unwrapped
from gear_kinematics.measurement.commissioning.joint import other_unit
from gear_kinematics.measurement.dialects import TableFile
from gear_kinematics.measurement.encoder_step import Step, find_step
from gear_kinematics.measurement.formats import open_table
from gear_kinematics.measurement.gate import output_by_rotor
from gear_kinematics.measurement.recording import (
    Array,
    Encoders,
    Loading,
    Recording,
    RecordingError,
    RotorMotion,
    locked_shaft,
    match,
)
from gear_kinematics.measurement.sentences import Observation, Observed
from gear_kinematics.wire.cdr import SECOND

_LEAST = 1e-30
"""Smaller numbers are taken as 0, so that no squares or inverses underflow later."""
_GAP = 5  # greatest gap, in usual intervals of the rotor's samples, that is interpolated
_HALF_TURN = 180.0  # degrees: least jump of a single-turn encoder
_MOST_TWIST = 0.35  # rad of the output under torque; a shaft that turns further is not locked
_BLOCKS, _LIKE = 10, (0.08, 1.0)
"""Number of parts of a recording; error of the output within a part that shows degrees, rad."""
_WHOLE = 50  # number of different whole numbers that are no coincidence
_FEWEST, _ROWS = 10, 10_000  # least number of samples of a part; greatest number in all
_THOUSAND = 1000.0
_SHOWN = 800  # characters of an error, which may quote a long file


def read_table(path: Path, sources: Sources, ratio: Fraction, period: float = 0.0) -> Recording:
    """Read a table of a gear with a ratio.

    Positions of the rotor repeat after a period, rad; 0 if that is to be found.

    Raises:
        RecordingError: if it cannot be read, or has no such columns.
    """
    with _naming(path):
        return _recording(path, open_table(path), sources, ratio, period)


def read_rotor(path: Path, sources: Sources, ratio: Fraction) -> tuple[Array, Array, Array, str]:
    """Read the motion of a gear's rotor under torque.

    Returns:
        Stamps, ns, angles of the rotor, rad, and its torque, N·m, (n,) each; the columns read.

    Raises:
        RecordingError: if it cannot be read, or has no such columns.
    """
    with _naming(path):
        read = _Samples(path, open_table(path), sources, ratio)
        if 'torque' not in read.found or not read.timed:
            raise ValueError('no times or no torque: give --time-column and --torque-column')
        read.steps()
        role = 'rotor' if 'rotor' in read.found else 'angle'
        on_rotor = role == 'rotor' or read.found[role].on_rotor
        angle = read.unwrapped(role) * (1.0 if on_rotor else float(ratio))
        torque = read.torque_at(read.series[role]) / float(ratio)
        return read.series[role].stamp, angle, torque, ', '.join(read.said)


@contextmanager
def _naming(path: Path) -> Iterator[None]:
    """Turn errors into a RecordingError that names the path."""
    try:
        yield
    except (OSError, ValueError) as error:  # pandas raises the latter as well
        text = getattr(error, 'strerror', None) or ' '.join(str(error).split())
        if len(text) > _SHOWN:
            text = f'{text[: _SHOWN // 2]} ... {text[-_SHOWN // 2 :]}'
        raise RecordingError(f'{path}: {text}') from error


class _Series(NamedTuple):
    """Quantities that were sampled together, (n,) each."""

    stamp: Array  # ns; one second a row if times were not recorded
    values: dict[str, Array]  # in SI units, by role
    segment: Array
    """Number that changes where rows were left out, whose motion is unknown."""


class _Samples:
    """Columns and samples of a table by role, with remarks and faults."""

    def __init__(self, path: Path, table: TableFile, sources: Sources, ratio: Fraction) -> None:
        """Read the columns; ValueError if they are missing or contain no numbers."""
        self._sources, self._ratio = sources, ratio
        try:
            found = find_columns(table.names, sources, table.units, table.clocks)
        except ColumnsError as error:
            advice = advise(path, table, sources, partial(_recording, path, table, ratio=ratio))
            raise ValueError(f'{error} {advice}') from error
        clock = found.pop('time', None)
        rest = nanoseconds_of(clock.name, table.names) if clock else None
        usual = clock.name if clock else ''
        clocks = {role: table.clocks.get(column.name, usual) for role, column in found.items()}
        wanted = {column.name for column in found.values()} | {*clocks.values(), rest or ''}
        raw, every = table.load(sorted(wanted - {''}))
        self.remarks = [Observation.ROWS_THINNED(every=every)] if every > 1 else []
        self.faults = list[Observed]()
        if clock and not (sources.time or table.first.get(usual, usual)):
            filled = raw[usual] == raw[usual]  # NaN is not equal to itself
            clock = clock if filled.any() else None
        if clock and rest:
            raw[usual] = raw[usual].astype(np.int64) * SECOND + raw[rest].astype(np.int64)
            clock = clock._replace(unit='ns', scale=1.0 / SECOND)
        if dates := [c.name for c in found.values() if raw[c.name].dtype.kind == 'M']:
            raise ValueError(f'{dates[0]} has dates in place of numbers')
        data = {role: raw[column.name] * column.scale for role, column in found.items()}
        usable = {role: np.abs(values) <= LARGEST_ANGLE for role, values in data.items()}  # no NaN
        if 'rotor' in found and 'torque' in found and not usable['torque'].any():
            del found['torque'], data['torque'], usable['torque']
        counts = [*map(np.count_nonzero, usable.values())]
        fewest, apart = min(counts), len({*clocks.values()}) > 1
        if not apart and len(lengths := {*map(len, raw.values())}) > 1:
            raise ValueError(
                f'columns of {" and ".join(map(str, sorted(lengths)))} rows, without times of each'
            )
        both = np.zeros(1, bool) if apart else np.all([*usable.values()], axis=0)
        # PlotJuggler writes each series at its own times, and leaves the other columns empty.
        apart = apart or bool(clock and 2 * np.count_nonzero(both) < max(counts))
        if not fewest or not (apart or both.any()):
            names = ', '.join(column.name for column in found.values())
            raise ValueError(f'no usable rows: none has numbers in all of {names}')
        if clock and not clock.unit:
            role = 'rotor' if 'rotor' in found else 'angle'
            clock = with_unit(clock, raw[clocks[role]], data[role], role)
        self.found, self.timed = found, clock is not None
        self.series: dict[str, _Series] = {}
        for roles in [[role] for role in found] if apart else [[*found]]:
            kept = usable[roles[0]] if apart else both
            if (left_out := np.count_nonzero(~kept)) and not apart:
                self.remarks.append(Observation.ROWS_LEFT_OUT(rows=left_out))
            times = raw.get(clocks[roles[0]])
            stamp, chosen = stamps(clock, times, kept, self.remarks, self.faults, alone=not apart)
            values = {role: data[role][chosen] for role in roles}
            values = {role: np.where(np.abs(v) < _LEAST, 0.0, v) for role, v in values.items()}
            for role in roles:
                if 'counts' in found[role].unit:
                    if _divided(raw[found[role].name]):
                        raise ValueError(
                            f'{found[role].name} has fractions of counts, as if points divided '
                            'thousands: write the numbers without them'
                        )
                    values[role] = signed(values[role], found[role].scale)
            gaps = 0 if apart else np.cumsum(np.abs(np.diff(chosen, prepend=chosen[0])) > _GAP)
            self.series |= dict.fromkeys(roles, _Series(stamp, values, gaps + 0 * stamp))
        angles = (role for role in found if role != 'torque')
        self._shown = {role: find_step(self.series[role].values[role]) for role in angles}
        base = self.series['output' if 'output' in found else 'angle']
        self.used = len(base.stamp)
        self.said = [f'time [{clock.unit}] from {clock.name}'] if clock else []
        self.said += map(described, found, found.values())
        rows = fewest if apart else len(data[next(iter(base.values))])
        self.said.append(f'{self.used} of {rows} rows')

    def unwrapped(self, role: str, period: float = 0.0) -> Array:
        """Return positions unwrapped by a period, rad, or by the one that they show."""
        series = self.series[role]
        values, seconds = series.values[role], (series.stamp - series.stamp[0]) / SECOND
        return unwrapped(values, seconds, self._shown[role], period)

    def torque_at(self, at: _Series) -> Array:
        """Return the torque at the output, N·m, at the stamps of other samples."""
        own = self.series['torque']
        torque = own.values['torque']
        torque = torque if own is at else np.interp(at.stamp, own.stamp, torque)
        return torque * float(self._ratio) if self.found['torque'].on_rotor else torque

    def steps(self) -> dict[str, Step]:
        """Return the steps of encoders by role; ValueError if an assumed unit is impossible."""
        steps = {}
        for role, column in self.found.items():
            if role != 'torque':
                of_output = role == 'output'
                known = self._sources.output_counts if of_output else self._sources.rotor_counts
                steps[role] = Step(TURN / known, seen=False) if known else self._shown[role]
            if cause := self._against(role, steps.get(role)):
                unit = 'Nmm' if role == 'torque' else 'counts'
                option = f"as in --{role}-column '{column.name} [{unit}]'"
                how = option if role == 'torque' or column.borrowed else 'with --angle-unit'
                raise ValueError(f'{column.name} has {cause}: give its unit {how}')
        return steps

    def _against(self, role: str, step: Step | None) -> str:
        """Return what shows that numbers without a unit are not in rad or N·m, if anything."""
        column, stamp = self.found[role], self.series[role].stamp
        if column.unit and not column.borrowed:
            return ''
        values = self.series[role].values[role]
        numbers = np.round(values / column.scale, 6)  # as they are in the table
        moved, whole = np.abs(np.diff(values)), bool(np.all(numbers == np.round(numbers)))
        if not step:
            return 'whole numbers' if whole and len(np.unique(values)) > _WHOLE else ''
        if whole and np.ptp(values) > TURN:
            return 'whole numbers, such as counts'
        if column.borrowed:
            return ''
        if _HALF_TURN < np.max(moved, initial=0.0) <= np.ptp(values) <= 2.0 * _HALF_TURN:
            return 'turns of 360, such as degrees'
        if unit := other_unit(values, step).partition(':')[0]:
            return f'positions in {unit}'
        if self.timed and (moving := moved > 0.0).any():
            seconds = np.maximum(np.diff(stamp)[moving], 1) / SECOND
            if (speed := np.quantile(moved[moving] / seconds, MOST)) > FASTEST:
                return f'speeds of {speed:.3g} a second, as in degrees'
        return ''

    def locked(self, period: float) -> Loading:
        """Return the angles under torque; ValueError if the shaft turns."""
        angle = self.found['angle']
        locked = locked_shaft(
            self.torque_at(self.series['angle']),
            self.unwrapped('angle', period * angle.on_rotor),
            self.steps()['angle'],
            self._ratio if angle.on_rotor else Fraction(1),
            self.series['angle'].stamp if self.timed else None,
            measured=angle.on_output,
        )
        # A few readings may be stray.
        if np.ptp(np.quantile(locked.angle, (0.01, 0.99))) > _MOST_TWIST:
            twist = np.ptp(locked.angle)
            raise ValueError(
                f'the output turns by {np.degrees(twist):.3g}° under torque: it is not '
                'locked, or the unit is another, which --angle-unit gives'
            )
        return locked

    def encoders(self, period: float) -> Encoders:
        """Return both encoders; ValueError if they cannot be those of a gear in rad."""
        steps, main, other = self.steps(), self.series['rotor'], self.series['output']
        rotor, output = main.values['rotor'], other.values['output']
        if not self._sources.as_recorded:
            rotor, output = self.unwrapped('rotor', period), self.unwrapped('output')
        before, share, inside = np.arange(self.used), np.zeros(self.used), np.ones(self.used, bool)
        if other is not main:
            gap = _GAP * float(np.median(np.diff(main.stamp)))
            before, share, inside = match(main.stamp, other.stamp, gap)
        torque = self.torque_at(main) / float(self._ratio) if 'torque' in self.found else None
        effort = None if torque is None or not torque.any() else torque
        motion = RotorMotion.of(main.stamp, rotor, effort, main.segment)
        steps_of_both = steps['rotor'], steps['output']
        both = Encoders(motion, self.timed, before, share, output[inside], *steps_of_both)
        if not (self.found['rotor'].unit or self.found['output'].unit):
            turned = self.unwrapped('rotor', period) if self._sources.as_recorded else rotor
            error = _error(both.at_measured(turned), both.measured)
            if min(_LIKE) < error < max(_LIKE):
                names = (self.found[role].name for role in ('output', 'rotor'))
                raise ValueError(
                    f'{" differs from ".join(names)} by more than gears do in rad, as in degrees: '
                    'give the unit with --angle-unit'
                )
        return both


def _divided(counts: Array) -> bool:
    """Return whether counts have three decimal places, as those of 1.024 in place of 1024.

    Eighths, which have as many, are means of up to eight readings, and fewer places are others.
    """
    sizes = np.abs(counts[np.isfinite(counts)])
    third = (np.round(100.0 * sizes, 6) % 1.0 > 0.0) & (8.0 * sizes % 1.0 > 0.0)
    fractions = third.any() and not (np.round(_THOUSAND * sizes, 6) % 1.0).any()
    return bool(fractions and sizes.max() < _THOUSAND and not ((sizes > 0) & (sizes < 1)).any())


def _recording(
    path: Path, table: TableFile, sources: Sources, ratio: Fraction, period: float = 0.0
) -> Recording:
    read = _Samples(path, table, sources, ratio)
    encoders = None if 'angle' in read.found else read.encoders(period)
    locked = None if encoders else read.locked(period)
    said, remarks, faults = tuple(read.said), tuple(read.remarks), tuple(read.faults)
    return Recording(path, path.name, said, read.used, encoders, locked, remarks, faults=faults)


def _error(rotor: Array, output: Array) -> float:
    """Return the usual error of the output against the rotor within a part, rad."""
    output = np.unwrap(output) if count_wraps(output, TURN) else output
    every = max(1, len(rotor) // _ROWS)
    rotor, output = rotor[::every], output[::every]
    ratio = output_by_rotor(rotor, output)
    if ratio is None or len(rotor) < _FEWEST * _BLOCKS:
        return 0.0
    parts = np.array_split(np.stack([output - ratio * rotor, np.gradient(rotor)]), _BLOCKS, axis=1)
    parts = [part - [[np.median(part[0])], [0.0]] for part in parts]
    error, speed = np.concatenate(parts, axis=1)
    delay = error @ speed / max(speed @ speed, _LEAST)
    spreads = [np.ptp(np.quantile(e - delay * v, (1.0 - MOST, MOST))) for e, v in parts]
    return float(np.median(spreads))
