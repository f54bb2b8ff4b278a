# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Evidence against the unit that is assumed for a column without one."""

import re
from collections.abc import Sequence

import numpy as np

from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.measurement.clocks import FASTEST, MOST
from gear_kinematics.measurement.columns import Column, ColumnsError
from gear_kinematics.measurement.encoder_range import count_wraps, other_unit
from gear_kinematics.measurement.encoder_step import Step
from gear_kinematics.measurement.names import ANGLE_UNITS, meaning, usual_unit
from gear_kinematics.measurement.recording import Array
from gear_kinematics.measurement.two_encoders import output_by_rotor
from gear_kinematics.wire.cdr import SECOND

_HALF_TURN = 180.0  # degrees: least jump of a single-turn encoder
_BLOCKS, _LIKE = 10, (0.08, 1.0)
"""Number of parts of a recording; error of the output within a part that shows degrees, rad."""
_WHOLE = 50  # number of different whole numbers that are no coincidence
_ANGLES = re.compile(
    r'(?i)(?:(?<!\d )|(?<=0\.1 )|(?<=0\.01 ))'
    r'\b(deg(ree)?s?|revolutions?|turns)\b(?!/|\.? *([CFK]|celsius)\b|[ -]of\b| per\b)'
)
"""Units of angles in titles and comments, but not in `deg C`, or of a value as in `3 turns`."""
_TORQUES = re.compile(
    r'(?i)(?<!\d )\b'
    r'(mN\W?m|N\W?[cm]m|kgf?\W?c?m|(oz|lb)f?s?\W?(in|ft)|(in|ft)\W?(oz|lb)f?s?)\b(?!/)'
)
"""Units of torque there other than N·m."""
_COMPOUND = re.compile(r'(?i)torque|moment(?!um)')
"""What names of torques such as Bremsmoment and TorqueSensor contain."""
_FEWEST, _ROWS = 10, 10_000  # least number of samples of a part; greatest number in all
_LEAST_TURNS, _EVIDENT, _NARROW, _CLEAR = 8.0, 0.05, 2.0, 4.0
"""Turns of the rotor from which on its error is not mistaken for one of the gear; least share of
the error that repeats once or twice in each; by which factors that exceeds the shares that repeat
half a cycle more or less often in all (2.5 in an even motion), and those further away or in rad.
In 36 simulations with an error of the rotor of 0.3°, it is at most 0.004 in another unit."""
_HALF = 0.5  # turns between samples, with which their waves look like others


def against(
    column: Column,
    values: Array,
    stamp: Array | None,
    step: Step | None,
    other: str,
    least: float,
    remark: str,
) -> tuple[str, str] | None:
    """Return what shows that numbers without a unit have another, and a likely one.

    Args:
        column: the column, whose numbers times its scale are the values.
        values: (n,), rad or N·m.
        stamp: (n,), ns; None if times were not recorded.
        step: of the encoder; None for a torque.
        other: unit of the other angle; empty if that is unknown, too.
        least: the range of the angle that turns least, rad or as it is written.
        remark: titles and comments above the names.

    Raises:
        ValueError: if the numbers are whole turns, without the angle within a turn.
    """
    known = column.unit and not column.assumed
    if known and column.unit != 'rev':
        return None
    numbers = np.round(values / column.scale, 6)  # as they are in the table
    moved, whole = np.abs(np.diff(values)), bool(np.all(numbers == np.round(numbers)))
    if known:
        if whole and moved.any():
            cause = 'has whole turns alone: add the angle within the turn in a column for both'
            raise ValueError(f'{column.name} {cause}')
        return None
    says = meaning(column.name)
    said = (_ANGLES if step else _TORQUES).search(remark)
    if said and says.role and not column.assumed:
        unit = usual_unit(said[0])
        return f'has no unit, and a line above the names says {unit}', unit
    if not step:
        if whole and len(np.unique(values)) > _WHOLE:
            return 'has whole numbers', 'Nmm'
        known = any(meaning(word).role == 'torque' for word in says.words)
        if not (known or _COMPOUND.search(column.name)):
            return 'does not say that it is a torque', 'N·m'
        return ('is raw', 'N·m') if 'raw' in says.words else None
    likely = other if other in ANGLE_UNITS else 'rad'
    if not (says.role or column.assumed):
        if not other and least >= 2.0 * TURN:  # as outputs hardly turn further
            likely = 'deg'
        return 'does not say that it is an angle', 'counts' if whole else likely
    if whole and np.ptp(values) > TURN:
        return 'has whole numbers, such as counts', 'counts'
    if 'raw' in says.words:
        return 'is raw', 'rev'
    if column.assumed:
        return None
    if _HALF_TURN < np.max(moved, initial=0.0) <= np.ptp(values) <= 2.0 * _HALF_TURN:
        return 'has turns of 360, such as degrees', 'deg'
    if unit := other_unit(values, step).partition(':')[0]:
        return f'has positions in {unit}', 'rev' if 'turns' in unit else 'deg'
    if stamp is not None and (moving := moved > 0.0).any():
        seconds = np.maximum(np.diff(stamp)[moving], 1) / SECOND
        if (speed := np.quantile(moved[moving] / seconds, MOST)) > FASTEST:
            cause = f'has speeds of {speed:.3g} a second, as in degrees'
            return f'{cause} or beside times in another unit', 'deg'
    if other not in {'', 'rad'}:
        return f'has no unit, and that of the other angle is {other}', likely
    return None


def check_both(rotor: Array, output: Array, of_rotor: Column, of_output: Column) -> None:
    """Raise ColumnsError if both encoders show that angles without a unit are not in rad.

    The angles, (n,) each, are taken as rad, and the rotor's are unwrapped.
    """
    if of_output.unit or of_rotor.unit not in {'', 'rad'}:
        return
    output = np.unwrap(output) if count_wraps(output, TURN) else output
    every = max(1, len(rotor) // _ROWS)
    rotor, output = rotor[::every], output[::every]
    ratio = output_by_rotor(rotor, output) if len(rotor) >= _FEWEST * _BLOCKS else None
    if ratio is None:
        return
    error = output - ratio * rotor
    if _differ_as_degrees(rotor, error):
        cause, likely = 'more than gears do in rad, as in degrees', 'deg'
    elif not of_rotor.unit and _repeats_each_turn(rotor, output, error):
        cause = 'an error that repeats with each turn of the rotor if that is in turns'
        likely = 'rev'
    else:
        return
    cause = f'{of_output.name} differs from {of_rotor.name} by {cause}'
    lone = {'output': f'{of_output.name} [{likely}]'} if of_rotor.unit else {'unit': likely}
    raise ColumnsError(cause, 'the unit', **lone)


def _differ_as_degrees(rotor: Array, error: Array) -> bool:
    """Return whether the error is more than that of gears in rad, usually within a part of it."""
    parts = np.array_split(np.stack([error, np.gradient(rotor)]), _BLOCKS, axis=1)
    parts = [part - [[np.median(part[0])], [0.0]] for part in parts]
    error, speed = np.concatenate(parts, axis=1)
    delay = error @ speed / max(speed @ speed, np.finfo(float).tiny)
    spreads = [np.ptp(np.quantile(e - delay * v, (1.0 - MOST, MOST))) for e, v in parts]
    return bool(min(_LIKE) < np.median(spreads) < max(_LIKE))


def _repeats_each_turn(rotor: Array, output: Array, error: Array) -> bool:
    """Return whether the error repeats with the rotor as if it were in turns, and not in rad."""
    turns = float(np.ptp(rotor))
    slow, usual, fast = np.quantile(np.abs(np.diff(rotor)), [0.1, 0.5, 0.9])
    if turns < _LEAST_TURNS or usual > _HALF > fast - slow:  # aliased, as the speed is even
        return False
    speed = np.gradient(rotor)
    known = [rotor**0, rotor, speed, np.sign(speed)]
    in_rad = max(_share(error, [*known, *_waves(output)], k * rotor) for k in (1.0, 2.0))
    known += [*_waves(output), *_waves(TURN * output)]
    for cycles in (1.0, 2.0):
        apart = (cycles + step / turns for step in (0.0, -0.5, 0.5, -2.0, -1.0, 1.0, 2.0))
        own, *near = (_share(error, known, TURN * each * rotor) for each in apart)
        if own > max(_EVIDENT, _NARROW * max(near[:2]), _CLEAR * max(in_rad, *near[2:])):
            return True
    return False


def _waves(angle: Array) -> tuple[Array, Array]:
    return np.cos(angle), np.sin(angle)


def _share(error: Array, known: Sequence[Array], angle: Array) -> float:
    """Return the share of an error that repeats with an angle, of what is left by known terms."""
    basis, _ = np.linalg.qr(np.stack([*known, *_waves(angle)], axis=1))
    parts = basis.T @ error
    left = error @ error - np.sum(parts[:-2] ** 2)
    return float(np.sum(parts[-2:] ** 2) / max(left, np.finfo(float).tiny))
