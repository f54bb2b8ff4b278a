"""The advice on a preload, read from the JSON of `gearkin lost-motion --preloads`."""

import json
import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

from gear_kinematics.kinematics.preload import Preload
from gear_kinematics.lost_motion.preload.advice import Advice, Branches
from gear_kinematics.lost_motion.preload.model import Line, Play, PlayLine, Span
from gear_kinematics.state.uncertainty import Estimate


class MeasuredPreload(NamedTuple):
    """What measured ramps tell about turns of the ring gear, rad."""

    least: Span
    """The least turn without play under the load."""
    price: Estimate | None
    """N·m of friction."""
    preload: Preload
    """The model of both branches at a turn of 0, with the measured play."""
    scale: float
    """zk/zs of the gear."""


def read_advice(path: Path, load: float) -> MeasuredPreload:
    """Read a file and find the least turn for a load, N·m.

    Raises:
        ValueError: if the file contains no advice, not for turns, or none with a ±.
    """
    try:
        document = json.loads(path.read_text('utf-8'))
        found = document['preload']
        turns, model = found['ring_turns'], found['model']
        cause = found['cause']
        advice = Advice(
            (),
            model['scale'],
            tuple(model['loads']),
            _play(model['play']),
            _branches(model['branches']),
            _line(model['friction']),
            None,
            '',
        )
    except OSError as error:
        raise ValueError(f'{path}: {error.strerror}') from error
    except (ValueError, KeyError, TypeError) as error:
        raise ValueError(f'{path}: not the JSON of gearkin lost-motion with --preloads') from error
    if not turns:
        raise ValueError(
            f'{path}: its settings are plain numbers, not turns of the ring gear; name pins, or '
            'give --preload-unit with --preloads'
        )
    least = advice.least(load)
    if least is None or least.vague or advice.branches is None or advice.play.line is None:
        raise ValueError(f'{path}: no least turn with a ±: {cause or "the interval is too wide"}')
    return MeasuredPreload(
        least,
        advice.price(load),
        advice.branches.preload(-advice.play.line.offset),
        advice.play.line.slope,
    )


def _play(data: Mapping[str, Any]) -> Play:
    line = data['line']
    return Play(
        line
        and PlayLine(
            line['offset'],
            line['slope'],
            tuple(line['covariance']),
            line['scatter'],
            _freedom(line['degrees_of_freedom']),
        ),
        data['greatest_with'],
        data['least_without'],
        data['cause'],
    )


def _branches(data: Mapping[str, Any] | None) -> Branches | None:
    if data is None:
        return None
    return Branches(*(_estimate(data[side]) for side in ('positive', 'negative', 'softer')))


def _line(data: Mapping[str, Any] | None) -> Line | None:
    if data is None:
        return None
    return Line(
        data['base'],
        data['slope'],
        tuple(data['covariance']),
        data['scatter'],
        _freedom(data['degrees_of_freedom']),
        tuple(data['by_end']),
    )


def _estimate(data: Mapping[str, Any]) -> Estimate:
    return Estimate(
        data['value'],
        data['standard_uncertainty'],
        _freedom(data['degrees_of_freedom']),
        data['repeats'],
    )


def _freedom(value: float | None) -> float:
    """Degrees of freedom; in JSON, null stands for infinity."""
    return math.inf if value is None else value
