# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""What `index` and `preload` have in common: the turn of a ring gear, and the pins for it."""

import argparse
import math
from collections.abc import Iterable, Iterator
from typing import Any, NamedTuple

from gear_kinematics.commands import arguments
from gear_kinematics.commands.files import write_text
from gear_kinematics.kinematics import Mechanism, vernier
from gear_kinematics.kinematics.preload import ring_phase
from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.kinematics.vernier import Choice, PinSetting
from gear_kinematics.report.mark import MARK
from gear_kinematics.shape.angles import arc, arc_seconds
from gear_kinematics.shape.pin_sheet import MOST_TEETH, draw

HEADING = 'turn of a ring gear'
SENSES = (
    'Seen against the z axis, angles, teeth and chassis holes count counterclockwise, ring holes '
    'clockwise, from 0 at the zero marks.'
)


class Pins(NamedTuple):
    """The wanted turn of a ring gear, and the positions of the vernier around it."""

    ring_teeth: int
    start: PinSetting
    phase: float | None
    """Part of the turn that the cam phase of branch B requires, rad; None if not requested."""
    ring_turn: float
    """The wanted turn, rad."""
    choices: list[Choice]
    """The nearest one is in the middle."""

    @property
    def nearest(self) -> Choice:
        """The position to pin."""
        return self.choices[len(self.choices) // 2]

    def holes(self) -> Iterator[tuple[str, str]]:
        """Yield how to pin the nearest position."""
        first, *others = self.nearest.settings
        yield 'from', str(self.start)
        yield 'pin', str(first)
        for other in others:
            yield 'or', f'{other}: the same position'
        yield 'ring body', arc(vernier.angle_between(self.start.body_turn, first.body_turn))

    def turned(self) -> Iterator[tuple[str, str]]:
        """Yield by how much that turns the ring gear."""
        error = f'{arc_seconds(self.nearest.error):+.3f}″'
        yield 'turn', f'{arc(self.nearest.ring_turn)} for a wanted {arc(self.ring_turn)} ({error})'
        if self.phase is not None:
            yield 'phase', f'{arc(self.phase)} of it'


def add_turn(parser: argparse.ArgumentParser, *, required: bool) -> argparse._ActionsContainer:
    """Add the options for a turn and its pins; returns the group of ways to give the turn."""
    group = arguments.group(parser, HEADING)
    ways = group.add_mutually_exclusive_group(required=required)
    ways.add_argument('--angle', type=float, metavar='RAD', help='turn of the ring gear')
    ways.add_argument('--degrees', type=float, metavar='DEG', help='the same in degrees')
    group.add_argument(
        '--phase-b', action='store_true', help='add the turn for the cam phase of branch B'
    )
    add_setting(group, '--from', 'start', 'initial pin setting (default: 0 0 0)')
    output = arguments.group(parser, 'output')
    output.add_argument(
        '--drawing', metavar='FILE', help='draw the holes as SVG on a page of A4 (-: stdout)'
    )
    output.add_argument(
        '--mirrored', action='store_true', help='draw as seen along the z axis, not against it'
    )
    return ways


def add_setting(group: argparse._ActionsContainer, option: str, name: str, text: str) -> None:
    """Add an option for a pin setting, stored as `name`."""
    holes = ('TOOTH', 'RING_HOLE', 'CHASSIS_HOLE')
    group.add_argument(option, dest=name, type=int, nargs=3, metavar=holes, help=text)


def ring_turn(options: argparse.Namespace) -> float | None:
    """The turn of the ring gear given by the options, rad, if any."""
    given: float | None = options.angle
    return given if options.degrees is None else math.radians(options.degrees)


def find(
    options: argparse.Namespace,
    ring_teeth: int,
    mechanism: Mechanism | None,
    turn: float,
    neighbours: int = 0,
) -> Pins:
    """Find the pins nearest to a turn, rad, and to that of the phase, if the options ask for it.

    Raises:
        ValueError: if it is more than a whole turn in either direction.
    """
    phase = ring_phase(mechanism) if mechanism and options.phase_b else None
    wanted = turn + (phase or 0.0)
    if not abs(wanted) <= TURN:
        raise ValueError(f'a ring gear is turned by at most a whole turn, not by {wanted:g} rad')
    start = vernier.pin_setting(ring_teeth, *(options.start or (0, 0, 0)))
    choices = vernier.choices(ring_teeth, wanted, start, neighbours)
    return Pins(ring_teeth, start, phase, wanted, choices)


def at_setting(options: argparse.Namespace, mechanism: Mechanism) -> Pins:
    """The pins of the given setting, and the turn to it."""
    pins = find(options, mechanism.ring_teeth, mechanism, 0.0)
    setting = vernier.pin_setting(mechanism.ring_teeth, *options.setting)
    turn = vernier.angle_between(pins.start.turn, setting.turn)
    return pins._replace(ring_turn=turn, choices=[Choice(0, (setting,), turn, 0.0)])


def drawing(options: argparse.Namespace, pins: Pins, notes: Iterable[tuple[str, str]]) -> str:
    """Draw the pins for a page and, if the options say so, write the drawing."""
    if not options.drawing and not (options.html and pins.ring_teeth <= MOST_TEETH):
        return ''
    lines = [' '.join(note) for note in notes]
    drawn = draw(pins.ring_teeth, pins.nearest.settings[0], lines, mirrored=options.mirrored)
    if options.drawing:
        write_text(options.drawing, f'{drawn}<!-- {MARK} -->\n')
    return drawn


def to_json(setting: PinSetting) -> dict[str, Any]:
    """Return tooth, holes and turns of a setting."""
    return {
        'tooth': setting.tooth,
        'ring_hole': setting.ring_hole,
        'chassis_hole': setting.chassis_hole,
        'turn': str(setting.turn),
        'body_turn': str(setting.body_turn),
    }
