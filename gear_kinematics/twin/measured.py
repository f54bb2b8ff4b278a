# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The figures of a real gear for a simulated one, from reports of gearkin as JSON.

A loop at the output shows the sum of the branches, which have the same stiffness. Of two of them,
branch A acts through the shaft: a stiffness K at the output is that of k in both where

    K = k + k ks/(k + ks)
"""

import json
import math
from collections.abc import Iterable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from gear_kinematics.kinematics import MechanismError
from gear_kinematics.kinematics.preload import braced
from gear_kinematics.twin.gear import TwinGear

Report = Mapping[str, Any]


def measured(gear: TwinGear, reports: Iterable[Path]) -> tuple[TwinGear, list[str]]:
    """Take the figures of reports for those of a gear; later reports replace earlier ones.

    Args:
        gear: has all others, and the shaft between the arms, which a loop does not show.
        reports: the JSON of `gearkin preload`, or of `gearkin lost-motion` on one recording.

    Returns:
        The gear, and what the reports leave open, with what was taken for it.

    Raises:
        ValueError: if one cannot be used, naming it.
    """
    notes: list[str] = []
    for path in reports:
        try:
            data = json.loads(path.read_bytes())
            if 'recordings' in data:
                [recording] = data['recordings']
                gear = _loaded(gear, recording, notes)
            else:
                gear = _set(gear, data)
        except OSError as error:
            raise ValueError(f'{path}: {error.strerror}') from error
        except MechanismError as error:
            raise ValueError(f'{path}: {error}') from error
        except (LookupError, RecursionError, TypeError, ValueError) as error:
            wanted = 'torque ramps of one recording by gearkin lost-motion, or of gearkin preload'
            raise ValueError(f'{path}: must be the JSON of {wanted}') from error
    return gear, notes


def _set(gear: TwinGear, data: Report) -> TwinGear:
    """Take the stiffnesses, and the preload or the play at the pins."""
    braced(gear.parameters.mechanism)
    # Infinity is null in JSON.
    branch_a, branch_b, shaft = (
        math.inf if data['stiffness'][part] is None else float(data['stiffness'][part])
        for part in ('branch_a', 'branch_b', 'shaft')
    )
    pins = data['setting']
    torque, turn = pins['preload'], pins['ring_turn'] - (data['phase'] or 0.0)
    return replace(
        gear,
        parameters=replace(gear.parameters, preload=math.copysign(torque, turn)),
        stiffness=(branch_a, branch_b),
        shaft_stiffness=shaft,
        play=max(gear.play, pins['play']),
        interference=-pins['play'],
    ).preloaded(torque)


def _loaded(gear: TwinGear, data: Report, notes: list[str]) -> TwinGear:
    """Take friction, play and stiffness from torque ramps, and note what they leave open."""
    friction, backlash = data['friction']['value'], data['backlash']
    if friction is None:
        friction = gear.friction
        notes.append(f'friction: {friction:.4g} N·m, as configured')
    play, low, high = backlash['value'], backlash['low'], backlash['high']
    if gear.preload or high is None:
        play = gear.play
        notes.append(f'play of the flanks: {play:.4g} rad, as configured')
    elif play is None:
        play = 0.5 * (low + high)
        notes.append(f'play: {play:.4g} rad, the middle of {low:.4g} to {high:.4g} rad')
    first, *others = data['stiffness']
    if play and others and not (gear.preload or first['low']):
        first = others[0]  # the play is in the other
    notes.append(f'stiffness beyond {first["high"]:.4g} N·m: as below')  # a branch may be alone
    total, shaft = first['value'], gear.shaft_stiffness
    own = total / len(gear.stiffness)
    if gear.has_shaft:
        own = 0.5 * (total - 2.0 * shaft + math.hypot(total, 2.0 * shaft))
    return replace(
        gear,
        stiffness=(own,) * len(gear.stiffness),
        play=play,
        interference=-play,
        friction=friction,
    ).preloaded(abs(gear.preload))
