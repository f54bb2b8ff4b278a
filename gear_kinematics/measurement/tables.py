# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Tables as recordings: which rows are used, in what units, and at what times."""

import re
import shlex
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import replace
from fractions import Fraction
from itertools import filterfalse, permutations
from pathlib import Path
from typing import NamedTuple

import numpy as np

from gear_kinematics.kinematics.rotor_turns import LARGEST_ANGLE, TURN, split_turns
from gear_kinematics.measurement.clocks import FASTEST, MOST, stamps, with_unit
from gear_kinematics.measurement.columns import (
    Column,
    ColumnsError,
    Sources,
    find_columns,
    nanoseconds_beside,
)
from gear_kinematics.measurement.commissioning.encoder_range import count_wraps, signed, unwrapped
from gear_kinematics.measurement.commissioning.joint import other_unit
from gear_kinematics.measurement.dialects import TableFile
from gear_kinematics.measurement.encoder_step import Step, find_step, step_of
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
from gear_kinematics.wire.cdr import SECOND

_LEAST = 1e-30
"""Numbers that are smaller are 0: of none of those that follow, squares and inverses underflow."""
_GAP = 5
"""Usual intervals of the rotor's samples over which its motion is interpolated, at most."""
_HALF_TURN = 180.0
"""Degrees, by which the readings of a single-turn encoder jump at least."""
_MOST_TWIST = 0.35
"""rad of the output under torque: a shaft that turns further is not locked."""
_BLOCKS, _LIKE = 10, (0.08, 1.0)
"""Parts of a recording; rad by which the output leaves the rotor in most of them, in degrees."""
_WHOLE = 50
"""Levels that show whole numbers to be no coincidence."""
_TRIED, _FEWEST, _ROWS = 12, 10, 10_000
"""Columns among which two are sought for an example, least and most rows that tell them."""
_NO_ANGLE = re.compile(r'(?i)torque|effort|current|vel|speed|temp|time|stamp|erpm')
"""In names of columns that are not proposed as angles."""
_SHOWN = 800
"""Characters of an error, as those of a file can be many."""


def read_table(path: Path, sources: Sources, ratio: Fraction, period: float = 0.0) -> Recording:
    """Read a table of a gear with a ratio.

    Positions of the rotor repeat after a period, rad; 0: as they show.

    Raises:
        RecordingError: if it cannot be read, or has no such columns.
    """
    with _naming(path):
        return _recording(path, open_table(path), sources, ratio, period)


def read_rotor(path: Path, sources: Sources, ratio: Fraction) -> tuple[Array, Array, Array, str]:
    """Read how the rotor of a gear with a ratio moves under torque.

    Returns:
        Stamps, ns, the rotor's angle, rad, and its torque, N·m, (n,) each; what was taken.

    Raises:
        RecordingError: if it cannot be read, or has no such columns.
    """
    with _naming(path):
        found, series, said, _ = _read(path, open_table(path), sources, ratio)
        if 'torque' not in found or not said[0].startswith('time'):
            raise ValueError('no times or no torque: give --time-column and --torque-column')
        _steps(found, series, sources, timed=True)
        role = 'rotor' if 'rotor' in found else 'angle'
        one, torque = series[role], _torque(found, series, series[role], ratio) / float(ratio)
        on_rotor = role == 'rotor' or found[role].on_rotor
        angle = _unwrapped(one, role) * (1.0 if on_rotor else float(ratio))
        return one.stamp, angle, torque, ', '.join(said)


@contextmanager
def _naming(path: Path) -> Iterator[None]:
    """Raise errors as RecordingError that name the path."""
    try:
        yield
    except (OSError, ValueError) as error:  # pandas raises the latter, too
        text = getattr(error, 'strerror', None) or ' '.join(str(error).split())
        if len(text) > _SHOWN:
            text = f'{text[: _SHOWN // 2]} ... {text[-_SHOWN // 2 :]}'
        raise RecordingError(f'{path}: {text}') from error


class _Series(NamedTuple):
    """Quantities that were sampled together, (n,) each."""

    stamp: Array
    """ns; one second a row if times were not recorded."""
    values: dict[str, Array]
    """In SI units, by role."""
    segment: Array
    """Number that changes where rows were left out, as the motion in them is unknown."""


def _unwrapped(series: _Series, role: str, period: float = 0.0) -> Array:
    """Positions without the wraps of an encoder with a period, rad, or with one that shows."""
    values, seconds = series.values[role], (series.stamp - series.stamp[0]) / SECOND
    return unwrapped(values, seconds, find_step(values), period)


def _recording(
    path: Path, table: TableFile, sources: Sources, ratio: Fraction, period: float = 0.0
) -> Recording:
    found, series, said, remarks = _read(path, table, sources, ratio)
    timed = said[0].startswith('time')
    encoders, locked = _measured(found, series, sources, ratio, period, timed=timed)
    used = len(series['output' if 'output' in found else 'angle'].stamp)
    return Recording(path, path.name, tuple(said), used, encoders, locked, tuple(remarks))


def _read(
    path: Path, table: TableFile, sources: Sources, ratio: Fraction
) -> tuple[dict[str, Column], dict[str, _Series], list[str], list[str]]:
    """Return columns and samples by role, what was taken, and remarks."""
    try:
        found = find_columns(table.names, sources, table.units, table.clocks)
    except ColumnsError as error:
        raise ValueError(f'{error} {_advice(path, table, sources, ratio)}') from error
    clock = found.pop('time', None)
    rest = nanoseconds_beside(clock.name, table.names) if clock else None
    usual = clock.name if clock else ''
    clocks = {role: table.clocks.get(column.name, usual) for role, column in found.items()}
    wanted = {column.name for column in found.values()} | {*clocks.values(), rest or ''}
    raw, every = table.load(sorted(wanted - {''}))
    remarks = [f'one row of {every} is used: no more are kept in memory'] if every > 1 else []
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
    if not apart and len(lengths := {*map(len, data.values())}) > 1:
        raise ValueError(
            f'columns of {" and ".join(map(str, sorted(lengths)))} rows, without times'
        )
    both = np.zeros(1, bool) if apart else np.all([*usable.values()], axis=0)
    # PlotJuggler writes each at its own times, with nothing in the columns of the others.
    apart = apart or bool(clock and 2 * np.count_nonzero(both) < max(counts))
    if not fewest or not (apart or both.any()):
        names = ', '.join(column.name for column in found.values())
        raise ValueError(f'no usable rows: none has numbers in all of {names}')
    if clock and not clock.unit:
        role = 'rotor' if 'rotor' in found else 'angle'
        clock = with_unit(clock, raw[clocks[role]], data[role], role)
    series: dict[str, _Series] = {}
    for roles in [[role] for role in found] if apart else [[*found]]:
        kept = usable[roles[0]] if apart else both
        if (left_out := np.count_nonzero(~kept)) and not apart:
            remarks.append(f'{left_out} rows were left out: no numbers, or too large')
        stamp, chosen = stamps(clock, raw.get(clocks[roles[0]]), kept, remarks)
        values = {role: data[role][chosen] for role in roles}
        values = {role: np.where(np.abs(v) < _LEAST, 0.0, v) for role, v in values.items()}
        for role in roles:
            if 'counts' in found[role].unit:
                values[role] = signed(values[role], found[role].scale)
        gaps = 0 if apart else np.cumsum(np.diff(chosen, prepend=chosen[0]) > _GAP)
        one = _Series(stamp, values, gaps + 0 * stamp)
        series |= dict.fromkeys(roles, one)
    base = series['output' if 'output' in found else 'angle']
    said = [f'time [{clock.unit}] from {clock.name}'] if clock else []
    said += map(_described, found, found.values())
    rows = len(data[next(iter(base.values))]) if not apart else fewest
    return found, series, [*said, f'{len(base.stamp)} of {rows} rows'], remarks


def _measured(
    found: Mapping[str, Column],
    series: Mapping[str, _Series],
    sources: Sources,
    ratio: Fraction,
    period: float,
    *,
    timed: bool,
) -> tuple[Encoders | None, Loading | None]:
    """Both encoders, or angles under torque; ValueError if what is assumed cannot be."""
    steps = _steps(found, series, sources, timed=timed)
    main = series.get('rotor') or series['angle']
    torque = _torque(found, series, main, ratio) if 'torque' in found else None
    if torque is not None and 'angle' in found:
        angle = found['angle']
        locked = locked_shaft(
            torque, _unwrapped(main, 'angle', period * angle.on_rotor), steps['angle'],
            ratio if angle.on_rotor else Fraction(1), measured=angle.on_output,
        )  # fmt: skip
        if (twist := np.ptp(locked.angle)) > _MOST_TWIST:
            raise ValueError(
                f'the output turns by {np.degrees(twist):.3g}° under torque: it is not '
                'locked, or the unit is another, which --angle-unit gives'
            )
        return None, locked
    rotor, output = (series[role].values[role] for role in ('rotor', 'output'))
    if not sources.as_recorded:
        rotor, output = _unwrapped(main, 'rotor', period), _unwrapped(series['output'], 'output')
    rows = len(output)
    before, share, inside = np.arange(rows), np.zeros(rows), np.ones(rows, bool)
    if series['output'] is not main:
        gap = _GAP * float(np.median(np.diff(main.stamp)))
        before, share, inside = match(main.stamp, series['output'].stamp, gap)
    effort = None if torque is None or not torque.any() else torque / float(ratio)
    motion = RotorMotion(main.stamp, *split_turns(rotor), effort, main.segment)
    both = Encoders(
        motion, timed, before, share, output[inside], steps['rotor'], steps['output'],
    )  # fmt: skip
    assumed = not (found['rotor'].unit or found['output'].unit)
    turned = rotor if not sources.as_recorded else _unwrapped(main, 'rotor', period)
    if assumed and min(_LIKE) < _error(both.at_measured(turned), both.measured) < max(_LIKE):
        raise ValueError(
            f'{found["output"].name} differs from {found["rotor"].name} by more than gears do '
            'in rad, as in degrees: give the unit with --angle-unit'
        )
    return both, None


def _steps(
    found: Mapping[str, Column], series: Mapping[str, _Series], sources: Sources, *, timed: bool
) -> dict[str, Step]:
    """Steps of the encoders by role; ValueError if what is assumed of a unit cannot be."""
    steps = {}
    for role, column in found.items():
        if role != 'torque':
            counts = sources.output_counts if role == 'output' else sources.rotor_counts
            steps[role] = step_of(counts, series[role].values[role])
        if not column.unit and (
            cause := _against(series[role], role, steps.get(role), timed=timed)
        ):
            option = f"as in --torque-column '{column.name} [Nmm]'"
            how = option if role == 'torque' else 'with --angle-unit'
            raise ValueError(f'{column.name} has {cause}: give its unit {how}')
    return steps


def _torque(
    found: Mapping[str, Column], series: Mapping[str, _Series], at: _Series, ratio: Fraction
) -> Array:
    """Torque at the output, N·m, at the stamps of other samples."""
    own = series['torque']
    torque = own.values['torque']
    torque = torque if own is at else np.interp(at.stamp, own.stamp, torque)
    return torque * float(ratio) if found['torque'].on_rotor else torque


def _error(rotor: Array, output: Array) -> float:
    """By how much the output leaves the rotor within most parts of a recording, rad."""
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


def _against(series: _Series, role: str, step: Step | None, *, timed: bool) -> str:
    """What shows that numbers without a unit are not in rad or N·m, if anything."""
    values = series.values[role]
    moved = np.abs(np.diff(values))
    if not step:
        whole = np.all(values == np.round(values)) and len(np.unique(values)) > _WHOLE
        return 'whole numbers' if whole else ''
    if np.ptp(values) > TURN and np.all(values == np.round(values)):
        return 'whole numbers, such as counts'
    if _HALF_TURN < np.max(moved, initial=0.0) <= np.ptp(values) <= 2.0 * _HALF_TURN:
        return 'turns of 360, such as degrees'
    if unit := other_unit(values, step).partition(':')[0]:
        return f'positions in {unit}'
    if timed and (moving := moved > 0.0).any():
        seconds = np.maximum(np.diff(series.stamp)[moving], 1) / SECOND
        if (speed := np.quantile(moved[moving] / seconds, MOST)) > FASTEST:
            return f'speeds of {speed:.3g} a second, as in degrees'
    return ''


def _described(role: str, column: Column) -> str:
    unit = column.unit or {'torque': 'N·m'}.get(role, 'rad, assumed')
    side = ' of the rotor' if column.on_rotor else ' at the output'
    side = side if role in {'angle', 'torque'} else ''
    return f'{role}{side} [{unit.replace("nm", "N·m")}] from {column.name}'


def _advice(path: Path, table: TableFile, sources: Sources, ratio: Fraction) -> str:
    """List the columns with their first values, and end with a command line that works, if any."""
    names = [name for name in table.names if name]
    listed = ', '.join(f'{name} ({table.first.get(name, "")})' for name in names)
    raw, _ = table.load([name for name in names if names.count(name) == 1][:_TRIED])
    pairs = {}
    for rotor, output in permutations(filterfalse(_NO_ANGLE.search, raw), 2):
        kinds = raw[rotor].dtype.kind + raw[output].dtype.kind
        if kinds != 'ff' or len(raw[rotor]) != len(raw[output]):
            continue
        pair = np.array([raw[rotor], raw[output]])[:, :_ROWS]
        pair = np.diff(pair[:, np.isfinite(pair).all(axis=0)])
        if pair.shape[1] > _FEWEST and (spread := np.std(pair, axis=1))[0] > spread[1] > 0.0:
            pairs[abs(np.corrcoef(pair)[0, 1])] = rotor, output
    text = f'among the columns {listed}; name them'
    for likeness in sorted(pairs, reverse=True)[:_FEWEST]:
        rotor, output = pairs[likeness]
        named = replace(sources, rotor=rotor, output=output)
        words = ['--rotor-column', rotor, '--output-column', output]
        try:
            _recording(path, table, named, ratio)
        except ValueError as error:
            if '--angle-unit' not in str(error):
                continue
            words += ['--angle-unit', 'deg']
        command = shlex.join([*sources.command.split(), str(path), *words])
        return f'{text}, for example: {command}'
    return f'{text} with --angle-column, --torque-column, --rotor-column, --output-column'
