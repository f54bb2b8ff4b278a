# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Transfer of a real gear's measured figures to a simulated gear, from reports of gearkin in JSON.

A loop at the output shows all branches together. Its middle line is the curve of a gear without
preload. Of a preloaded one, which has two branches of the same stiffness k, branch A acts through
the shaft: near no load, where both are in mesh, the output has the stiffness

    K = k + k ks/(k + ks)
"""

import json
import math
from collections.abc import Iterable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from gear_kinematics.kinematics import MechanismError
from gear_kinematics.kinematics.preload import braced
from gear_kinematics.twin.gear import LoadingCurve, TwinGear

Report = Mapping[str, Any]
_ROUNDING = 1e-6  # share of the greatest stiffness of a middle line by which it may fall


def measured(gear: TwinGear, reports: Iterable[Path]) -> tuple[TwinGear, list[str]]:
    """Replace properties of a gear by measured figures; later reports replace earlier ones.

    The reports are the JSON of `gearkin preload`, or of `gearkin lost-motion` on one recording.
    The gear keeps all other properties, and the shaft between the arms, which a measured loop does
    not show. The returned texts say what is assumed where the reports leave something
    undetermined. Raises ValueError if a report cannot be used; the text names it.
    """
    notes: list[str] = []
    for path in reports:
        try:
            data = json.loads(path.read_bytes(), parse_float=_finite, parse_constant=_finite)
            if 'recordings' in data:
                [recording] = data['recordings']
                gear = _loaded(gear, recording, notes)
            else:
                gear = _set(gear, data)
        except OSError as error:
            raise ValueError(f'{path}: {error.strerror}') from error
        except MechanismError as error:
            raise ValueError(f'{path}: {error}') from error
        except (ArithmeticError, LookupError, RecursionError, TypeError, ValueError) as error:
            wanted = 'torque ramps of one recording by gearkin lost-motion, or of gearkin preload'
            raise ValueError(f'{path}: must be the JSON of {wanted}') from error
    return gear, notes


def _finite(text: str) -> float:
    """Parse a number in JSON, in which Python also reads NaN, Infinity and 1e999."""
    if not math.isfinite(number := float(text)):
        raise ValueError(f'{text} is no number')
    return number


def _set(gear: TwinGear, data: Report) -> TwinGear:
    """Set the stiffnesses, and the preload or the play at the pins."""
    braced(gear.parameters.mechanism)
    # Infinity is null in JSON.
    branch_a, branch_b, shaft = (
        math.inf if data['stiffness'][part] is None else data['stiffness'][part]
        for part in ('branch_a', 'branch_b', 'shaft')
    )
    pins = data['setting']
    torque, turn = pins['preload'], pins['ring_turn'] - (data['phase'] or 0.0)
    if pins['play'] < 0.0:
        raise MechanismError(['the play is less than 0'])
    return replace(
        gear,
        parameters=replace(gear.parameters, preload=math.copysign(torque, turn)),
        stiffness=(branch_a, branch_b),
        shaft_stiffness=shaft,
        curve=None,
        play=max(gear.play, pins['play']),
        interference=-pins['play'],
    ).preloaded(torque)


def _loaded(gear: TwinGear, data: Report, notes: list[str]) -> TwinGear:
    """Set the curve, or friction and stiffness at no load; note what the ramps do not show."""
    line, count = data['middle_line'], len(gear.stiffness)
    figure, mean_friction = data['friction'], max(0.0, float(np.mean(line['friction'])))
    friction = max(0.0, figure['value'] or 0.0) or mean_friction  # noise may make it negative
    if (figure['value'] or 0.0) < -(figure.get('expanded_uncertainty') or math.inf):
        raise MechanismError(['the friction is less than 0'])
    if not gear.preload:
        # A load winds up the locked gear by its rotor, or turns the output back.
        sign = -1 if data['measured'] else 1
        rows = zip(line['angle'], line['load'], line['friction'], strict=True)
        points = sorted((sign * angle, sign * load, friction) for angle, load, friction in rows)
        curve = LoadingCurve(*zip(*points, strict=True))
        unloaded = (0.0, 0.0) in zip(curve.wind_up, curve.torque, strict=True)
        if not unloaded or min(curve.stiffness) < -_ROUNDING * max(curve.stiffness):
            raise MechanismError(['the load must grow with the angle, and be 0 at 0 rad'])
        return replace(
            gear,
            stiffness=(max(curve.stiffness) / count,) * count,
            shaft_stiffness=math.inf,
            play=0.0,
            interference=0.0,
            friction=mean_friction,
            curve=curve,
        )
    notes.append(f'play of the flanks: {gear.play:.4g} rad, as configured')
    first = data['stiffness'][0]
    # Beyond, one branch alone may be in mesh.
    notes.append(f'stiffness beyond {first["high"]:.4g} N·m: as below')
    branch, shaft = first['value'] / count, gear.shaft_stiffness
    if gear.has_shaft:
        branch += math.hypot(branch, shaft) - shaft
    changed = replace(gear, stiffness=(branch,) * count, friction=friction)
    return changed.preloaded(abs(gear.preload))
