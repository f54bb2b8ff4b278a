# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The advice on a preload, read from the JSON of `gearkin lost-motion --preloads`."""

import json
import math
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

from gear_kinematics.correction.uncertainty import Estimate
from gear_kinematics.kinematics.preload import Preload, Stiffness


@dataclass(frozen=True, slots=True)
class Span:
    """A setting, and the interval that contains it with the probability `COVERAGE`."""

    value: float
    low: float
    high: float


class MeasuredPreload(NamedTuple):
    """What measured ramps tell about turns of the ring gear, rad."""

    least: Span
    """The least turn at which both branches stay in mesh under the load."""
    load: float | None
    """N·m; None: up to this turn the hysteresis falls."""
    added_friction: Estimate | None
    """N·m, by the preload at this turn."""
    preload: Preload
    """The model of both branches at a turn of 0, with the measured play."""
    scale: float
    """zk/zs of the gear."""


def read_advice(path: Path) -> MeasuredPreload:
    """Read a file.

    Raises:
        ValueError: if the file contains no advice, not for turns, or none with an interval.
    """
    try:
        found = json.loads(path.read_text('utf-8'))['preload']
        if not found['closing']:
            cause = 'its settings are plain numbers, not turns of the ring gear'
        elif cause := found['cause']:
            cause = f'no least turn: {cause}'
        else:
            names = 'value', 'standard_uncertainty', 'degrees_of_freedom', 'repeats'
            added = found['added_friction']
            friction = added and Estimate(*(added[name] for name in names))
            (push, pull), closing = found['compliances'], found['closing']
            stiffness = Stiffness(1.0 / pull, 1.0 / push, math.inf)
            preload = Preload(stiffness, -closing * found['closed'])
            least = Span(**found['least'])
            return MeasuredPreload(least, found['load'], friction, preload, closing)
    except OSError as error:
        raise ValueError(f'{path}: {error.strerror}') from error
    except (ValueError, KeyError, TypeError) as error:
        raise ValueError(f'{path}: not the JSON of gearkin lost-motion with --preloads') from error
    raise ValueError(f'{path}: {cause}')
