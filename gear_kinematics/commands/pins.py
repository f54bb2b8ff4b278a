# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Common parts of `index` and `preload`: the turn of a ring gear, and the pins for it."""

import argparse
import math
from collections.abc import Iterator
from fractions import Fraction
from typing import NamedTuple

from gear_kinematics.commands import arguments
from gear_kinematics.kinematics import Mechanism, vernier
from gear_kinematics.kinematics.preload import ring_phase
from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.kinematics.vernier import Choice
from gear_kinematics.shape.angles import arc, arc_seconds

SENSES = (
    'Seen against the z axis, angles, teeth and chassis holes count counterclockwise, ring holes '
    'clockwise, from 0 at the zero marks.'
)
_ZERO = Fraction(0)  # setting of a ring gear whose tooth 0 and hole 0 are at the chassis's hole 0


class Pins(NamedTuple):
    """The wanted turn of a ring gear, and the positions of the vernier around it."""

    phase: float | None  # rad: part of the turn that the cam phase of branch B requires, or None
    ring_turn: float  # the wanted turn, rad
    choices: list[Choice]  # positions of the vernier, with the nearest one in the middle

    @property
    def nearest(self) -> Choice:
        """The position to pin."""
        return self.choices[len(self.choices) // 2]

    def facts(self) -> Iterator[tuple[str, str]]:
        """Yield how to pin the nearest position, and by how much that turns the ring gear."""
        first, *others = self.nearest.settings
        yield 'pin', str(first)
        for other in others:
            yield 'or', f'{other}: the same position'
        yield 'ring body', arc(vernier.angle_between(_ZERO, first.body_turn))
        error = f'{arc_seconds(self.nearest.error):+z.3f}″'
        yield 'turn', f'{arc(self.nearest.ring_turn)} for a wanted {arc(self.ring_turn)} ({error})'
        if self.phase is not None:
            yield 'phase', f'{arc(self.phase)} of it, for the cam phase of branch B'


def add_turn(parser: argparse.ArgumentParser, *, required: bool) -> argparse._ActionsContainer:
    """Add the options for a turn and its pins; returns the group of options for the turn."""
    group = arguments.group(parser, 'turn of a ring gear')
    turns = group.add_mutually_exclusive_group(required=required)
    turns.add_argument('--degrees', type=float, metavar='DEG', help='turn of the ring gear')
    group.add_argument(
        '--phase-b', action='store_true', help='add the turn for the cam phase of branch B'
    )
    return turns


def find(
    options: argparse.Namespace, mechanism: Mechanism, turn: float, neighbours: int = 0
) -> Pins:
    """Find the pins nearest to a turn, rad, plus the turn for the cam phase if requested.

    Raises ValueError for more than a whole turn in either direction.
    """
    phase = ring_phase(mechanism) if options.phase_b else None
    wanted = turn + (phase or 0.0)
    if not abs(wanted) <= TURN:
        degrees = math.degrees(wanted)
        raise ValueError(f'a ring gear is turned by at most a whole turn, not by {degrees:g}°')
    choices = vernier.choices(mechanism.ring_teeth, wanted, neighbours=neighbours)
    return Pins(phase, wanted, choices)


def at_setting(options: argparse.Namespace, mechanism: Mechanism) -> Pins:
    """Return the pins of the given setting, and the turn to it."""
    pins = find(options, mechanism, 0.0)
    setting = vernier.pin_setting(mechanism.ring_teeth, *options.setting)
    turn = vernier.angle_between(_ZERO, setting.turn)
    return pins._replace(ring_turn=turn, choices=[Choice(0, (setting,), turn, 0.0)])
