# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Tables as recordings: the rows that are used, their units and times."""

from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from functools import partial
from pathlib import Path
from typing import NamedTuple, TypeVar

import numpy as np

from gear_kinematics.kinematics.rotor_turns import LARGEST_ANGLE, TURN
from gear_kinematics.measurement.advice import advice, no_times, rising
from gear_kinematics.measurement.assumed_units import against, check_both
from gear_kinematics.measurement.clocks import (
    are_apart,
    are_no_times,
    check_steps,
    check_units,
    stamps,
    with_unit,
)
from gear_kinematics.measurement.columns import (
    Column,
    ColumnsError,
    Sources,
    assumed_unit,
    described,
    find_columns,
    own_clocks,
)
from gear_kinematics.measurement.dialects import TableFile
from gear_kinematics.measurement.encoder_range import signed, unwrapped
from gear_kinematics.measurement.encoder_step import Step, find_step
from gear_kinematics.measurement.formats import open_table
from gear_kinematics.measurement.names import TIME_UNITS, meaning
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
from gear_kinematics.measurement.second_fractions import fraction_of, join_fractions
from gear_kinematics.measurement.sentences import Observation, Observed
from gear_kinematics.measurement.series import rows_of
from gear_kinematics.wire.cdr import SECOND

T = TypeVar('T')
_SHOWN = 1500  # characters of an error, which may quote a long file
_LEAST = 1e-30
"""Smaller numbers are taken as 0, so that no squares or inverses underflow later."""
_GAP = 5  # greatest gap, in usual intervals of the rotor's samples, that is interpolated


def read_table(
    path: Path, sources: Sources, ratio: Fraction, period: float = 0.0, *, both: bool = False
) -> Recording:
    """Read a table of a gear with a ratio.

    Positions of the rotor repeat after a period, rad; 0 if that is to be found.

    Raises:
        RecordingError: if it cannot be read, or has no such columns, or lacks one of `both`
            encoders.
    """

    def recording(table: TableFile, sources: Sources) -> Recording:
        read = _Samples(table, sources, ratio, both=both)
        encoders = None if 'angle' in read.found else read.encoders(period)
        if sources.needs_times and not read.timed:
            cause = 'no column of times, such as time_s; name it with --time-column'
            raise ColumnsError(cause, **rising(table))
        locked = None if encoders else read.locked(period)
        said, remarks, faults = tuple(read.said), tuple(read.remarks), tuple(read.faults)
        return Recording(
            path, path.name, said, read.used, encoders, locked, remarks, faults=faults
        )

    return _advised(path, sources, recording)


def read_rotor(path: Path, sources: Sources, ratio: Fraction) -> tuple[Array, Array, Array, str]:
    """Read the motion of a gear's rotor under torque, by default from columns of the rotor.

    Returns:
        Stamps, ns, angles of the rotor, rad, and its torque, N·m, (n,) each; the columns read.

    Raises:
        RecordingError: if it cannot be read, or has no such columns.
    """

    def motion(table: TableFile, sources: Sources) -> tuple[Array, Array, Array, str]:
        read = _Samples(table, replace(sources, of_rotor=True), ratio, both=False)
        if 'torque' not in read.found or not read.timed:
            raise ColumnsError('no times or no torque: give --time-column and --torque-column')
        read.steps()
        role = 'rotor' if 'rotor' in read.found else 'angle'
        angle = read.unwrapped(role) * (1.0 if read.found[role].on_rotor else float(ratio))
        torque = read.torque_at(read.series[role]) / float(ratio)
        return read.series[role].stamp, angle, torque, ', '.join(read.said)

    return _advised(path, sources, motion)


def _advised(path: Path, sources: Sources, read: Callable[[TableFile, Sources], T]) -> T:
    """Read a table; a RecordingError names the path, and ends with advice on unknown columns."""
    try:
        table = open_table(path)
        try:
            return read(table, sources)
        except ColumnsError as error:
            text = advice(error, path, table, sources, partial(read, table))
            raise ValueError(text) from error
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

    def __init__(self, table: TableFile, sources: Sources, ratio: Fraction, *, both: bool) -> None:
        """Read the columns; ValueError if they are missing or contain no numbers."""
        self._sources, self._ratio, self._remark = sources, ratio, table.remark
        self.remarks, self.faults = list[Observed](), list[Observed]()
        self.found = find_columns(table.names, sources, table.units, table.clocks, table.first)
        if both and 'angle' in self.found:
            cause = f'not both a rotor and an output, but {self.found["angle"].name} alone: give '
            raise ColumnsError(f'{cause}--rotor-column and --output-column, or join two tables')
        clock = self.found.pop('time', None)
        usual = clock.name if clock else ''
        clocks = {role: table.clocks.get(one.name, usual) for role, one in self.found.items()}
        given, own = self.found.pop('output_time', None), dict[str, str]()
        if given or (clock and not (table.clocks or sources.time)):
            own = {'output': given.name} if given else own_clocks(table.names, self.found)
        units = {**table.units, **{one.name: one.unit for one in (clock, given) if one}}
        raw, clock = self._loaded(table, clock, {*clocks.values(), *own.values()}, units)
        if sources.output_time and not (given and clock):
            raise ValueError('--output-time-column needs both encoders, and --time-column')
        clocks |= self._own(own, raw, usual, units)
        if len({*clocks.values()}) == 1 and len(lengths := {*map(len, raw.values())}) > 1:
            number = ' and '.join(map(str, sorted(lengths)))
            raise ValueError(f'columns of {number} rows, without times of each')
        data = {role: raw[column.name] * column.scale for role, column in self.found.items()}
        usable = {role: np.abs(values) <= LARGEST_ANGLE for role, values in data.items()}  # no NaN
        if 'rotor' in self.found and 'torque' in self.found and not usable['torque'].any():
            del self.found['torque'], data['torque'], usable['torque']
        groups = [([role], rows) for role, rows in usable.items()]
        if len({*clocks.values()}) == 1:
            groups = rows_of(data, usable, self.remarks, self._every, clock and raw[clock.name])
        if not all(rows.any() for _, rows in groups):
            names = ', '.join(column.name for column in self.found.values())
            raise ValueError(f'no usable rows: none has numbers such as -12.5 in all of {names}')
        if clock:
            role = 'rotor' if 'rotor' in self.found else 'angle'
            turned = data[role] * (self.found[role].unit != 'counts')  # whose speed is unknown
            if not clock.unit:
                clock = with_unit(clock, raw[clocks[role]], turned, role)
            elif not sources.time:
                check_steps(clock, raw[clocks[role]], turned, self.found[role].unit, role)
        self._clock, self.timed = clock, clock is not None
        self.series: dict[str, _Series] = {}
        for roles, kept in groups:
            name, values = clocks[roles[0]], {role: data[role] for role in roles}
            one = self._sampled(values, kept, name, raw.get(name), alone=len(groups) == 1)
            self.series |= dict.fromkeys(roles, one)
        self._shown = {r: find_step(self.series[r].values[r]) for r in self.found if r != 'torque'}
        role = 'output' if 'output' in self.found else 'angle'
        self.used = len(self.series[role].stamp)
        named = ' and '.join(dict.fromkeys(clocks.values()))
        self.said = [f'time [{clock.unit}] from {named}' if clock else no_times(table, self.found)]
        self.said += map(described, self.found, self.found.values())
        of = ((assumed_unit(role, one), one.name) for role, one in self.found.items())
        if assumed := [f'{unit} for {name}' for unit, name in of if unit]:
            self.remarks.append(Observation.UNITS_ASSUMED(units=assumed))
        kept = next(rows for roles, rows in groups if role in roles)
        rows = len(kept) if len(groups) == 1 else np.count_nonzero(kept)
        thinned = f', one in {self._every} of the file' if self._every > 1 else ''
        self.said.append(f'{self.used} of {rows} rows{thinned}')

    def _loaded(
        self, table: TableFile, clock: Column | None, clocks: set[str], units: dict[str, str]
    ) -> tuple[dict[str, Array], Column | None]:
        """Load columns, and join times, as `units` then say; also return the clock, if any."""
        rests = {name: fraction_of(name, table.names) or '' for name in clocks - {''} if clock}
        wanted = {column.name for column in self.found.values()} | clocks | {*rests.values()}
        raw, self._every = table.load(sorted(wanted - {''}))
        if self._every > 1:
            self.remarks.append(Observation.ROWS_THINNED(every=self._every))
        if dates := [c.name for c in self.found.values() if raw[c.name].dtype.kind == 'M']:
            raise ValueError(f'{dates[0]} has dates in place of numbers')
        if clock and not self._sources.time:
            times = raw[clock.name]
            filled = times == times  # noqa: PLR0124, as NaN is not equal to itself
            empty = not (filled.any() or table.first.get(clock.name, clock.name))
            clock = None if empty or are_no_times(clock.name, clock.unit, times[filled]) else clock
        units |= join_fractions(raw, rests)
        if clock and units[clock.name] == 'ns':
            clock = clock._replace(unit='ns', scale=1.0 / SECOND)
        return raw, clock

    def _own(
        self, own: dict[str, str], raw: dict[str, Array], usual: str, units: dict[str, str]
    ) -> dict[str, str]:
        """Return the columns of times by role that belong to one column alone.

        Either both encoders have their own times by name, or they are given, or a column has
        numbers exactly where its times have some, and elsewhere than the usual times.
        """
        found = {}
        filled = {name: values == values for name, values in raw.items()}  # noqa: PLR0124, no NaN
        named = meaning(usual).on_rotor != meaning(usual).on_output
        if self._sources.output_time:
            named = True
        else:
            own = {k: v for k, v in own.items() if not are_no_times(v, '', raw[v][filled[v]])}
        for role, times in own.items():
            own_rows, rows, usual_rows = (filled[k] for k in (times, self.found[role].name, usual))
            alone = np.array_equal(own_rows, rows) and not np.array_equal(usual_rows, rows)
            if times != usual and (named or alone):
                found[role] = times
            elif len({*own.values()}) > 1 and are_apart(raw[usual], raw[times]):
                one, other = (own.get(side, usual) for side in ('rotor', 'output'))
                if one == other:  # the torque has other times
                    raise ValueError(
                        f'{usual} and {times} may be the times of one column each: interpolate '
                        'all to the same times, or give those of all with --time-column'
                    )
                raise ColumnsError(
                    f'{one} and {other} may be the times of one encoder each: give both, or the '
                    'times of all with --time-column alone',
                    time=one,
                    output_time=other,
                )
        for times in {*found.values()}:
            own_unit, unit = (units.get(k) or meaning(k).unit for k in (times, usual))
            if own_unit != unit:
                if not {own_unit, unit} <= TIME_UNITS.keys():
                    cause = 'are not in the same unit: give both units in the names'
                    raise ValueError(f'{times} and {usual} {cause}')
                raw[times] = raw[times] * (TIME_UNITS[own_unit] / TIME_UNITS[unit])
        return found

    def _sampled(
        self, data: dict[str, Array], kept: Array, name: str, times: Array | None, *, alone: bool
    ) -> _Series:
        """Return kept rows in the order of named times; `alone` if there are no other series."""
        if (left_out := np.count_nonzero(~kept)) and alone:
            self.remarks.append(Observation.ROWS_LEFT_OUT(rows=left_out))
        clock = self._clock and self._clock._replace(name=name)
        columns, said = data.values(), (self.remarks, self.faults)
        stamp, chosen = stamps(clock, times, kept, columns, *said, alone=alone)
        values = {role: np.where(np.abs(v) < _LEAST, 0.0, v)[chosen] for role, v in data.items()}
        for role, angles in values.items():
            if 'counts' in self.found[role].unit:
                values[role] = signed(angles, self.found[role].scale)
        steps = np.diff(chosen, prepend=chosen[0])
        in_turn = alone and (np.all(steps >= 0) or np.all(steps <= 0))  # otherwise sorted by time
        gaps = in_turn * np.cumsum(np.abs(steps) > _GAP)
        return _Series(stamp, values, gaps)

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
        least = min(float(np.ptp(self.series[role].values[role])) for role in self._shown)
        unit = next(filter(None, (self.found[role].unit for role in self._shown)), '')
        steps = {}
        for role, column in self.found.items():
            if role != 'torque':
                encoder = 'output' if role == 'output' else 'rotor'
                known = getattr(self._sources, f'{encoder}_counts')
                steps[role] = Step(TURN / known, seen=False) if known else self._shown[role]
            values, stamp = self.series[role].values[role], self.series[role].stamp
            timed = stamp if self.timed else None
            if found := against(column, values, timed, steps.get(role), unit, least, self._remark):
                cause, likely = found
                alone = role == 'torque' or unit
                example = {role: f'{column.name} [{likely}]'} if alone else {'unit': likely}
                raise ColumnsError(f'{column.name} {cause}', 'its unit', **example)
        return steps

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
        if locked.not_locked:
            of = ", or the angle is the motor's (--on-rotor)" * (angle.on_rotor == angle.on_output)
            raise ColumnsError(f'{locked.not_locked}, or the unit is another (--angle-unit){of}')
        if locked.opposed:  # as the sensor measures the torque of the clamp
            locked = replace(locked, angle=-locked.angle)
            self.remarks.append(Observation.OPPOSED())
        return locked

    def encoders(self, period: float) -> Encoders:
        """Return both encoders; ValueError if they cannot be those of a gear in rad."""
        steps, main, other = self.steps(), self.series['rotor'], self.series['output']
        rotor, output = main.values['rotor'], other.values['output']
        if not self._sources.as_recorded:
            rotor, output = self.unwrapped('rotor', period), self.unwrapped('output')
        before, share, inside = np.arange(self.used), np.zeros(self.used), np.ones(self.used, bool)
        if other is not main:
            check_units(main.stamp, other.stamp)
            gap = _GAP * float(np.median(np.diff(main.stamp)))
            before, share, inside = match(main.stamp, other.stamp, gap)
            if not inside.any():
                raise ValueError('the times of the rotor and of the output are never the same')
        torque = self.torque_at(main) / float(self._ratio) if 'torque' in self.found else None
        effort = None if torque is None or not torque.any() else torque
        motion = RotorMotion.of(main.stamp, rotor, effort, main.segment)
        steps_of_both = steps['rotor'], steps['output']
        both = Encoders(motion, self.timed, before, share, output[inside], *steps_of_both)
        turned = self.unwrapped('rotor', period) if self._sources.as_recorded else rotor
        columns = self.found['rotor'], self.found['output']
        check_both(both.at_measured(turned), both.measured, *columns)
        return both
