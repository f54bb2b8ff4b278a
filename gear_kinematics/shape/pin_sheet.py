# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""A drawing on A4 of the pin holes of ring gear and chassis, with the setting marked."""

import math
from collections.abc import Iterable, Iterator, Sequence
from fractions import Fraction
from typing import NamedTuple
from xml.sax.saxutils import escape

from gear_kinematics.kinematics.vernier import PinSetting
from gear_kinematics.shape.angles import arc

MOST_TEETH = 1000
"""With more teeth, the holes are too small to print on A4."""

_WIDTH, _HEIGHT = 210, 297  # mm, as every length here
_CENTRE = (105.0, 124.0)
_BORDER = 79.0  # radii
_ROOT, _TIP, _TOOTH_NUMBER = 60.5, 58.0, 50.0
_WIDEST_TOOTH = 1 / 40  # of the circumference, including the gap
_HOLE = 1.7
_NUMBER, _NUMBER_PITCH = 2.5, 5.0  # size, and least distance along the circumference
_DETAIL, _DETAIL_HOLES, _DETAIL_PITCH = 255.0, 4, 16.0
_INK, _FAINT, _PIN = '#24292f', '#8c959f', '#cf222e'

Point = tuple[float, float]


class _Row(NamedTuple):
    """The pin holes of one of the two bodies."""

    body: str
    holes: int
    pinned: int
    zero: Fraction
    """Position of its zero mark, turns counterclockwise from the chassis's."""
    direction: int
    """1 if the holes count counterclockwise, else -1."""
    radius: float
    outwards: int
    """1 if the numbers are outside the holes, else -1."""

    def turn(self, hole: int) -> Fraction:
        """Position of a hole, turns counterclockwise from the chassis's zero mark."""
        return self.zero + Fraction(self.direction * hole, self.holes)


def draw(
    ring_teeth: int, setting: PinSetting, notes: Sequence[str] = (), *, mirrored: bool = False
) -> str:
    """Draw ring gear and chassis with all teeth and holes, and the pin.

    Args:
        ring_teeth: zk, at most `MOST_TEETH`.
        setting: tooth and holes to mark.
        notes: up to three further lines of text.
        mirrored: whether to draw the view along the z axis instead of against it.

    Returns:
        An SVG document of the size of A4.

    Raises:
        ValueError: if there are too many holes for the page.
    """
    if ring_teeth > MOST_TEETH:
        raise ValueError(f'a drawing has room for {MOST_TEETH} teeth, not for {ring_teeth}')
    chassis = _Row('chassis', ring_teeth + 2, setting.chassis_hole, Fraction(0), 1, 83.0, 1)
    ring = _Row('ring gear', ring_teeth + 1, setting.ring_hole, setting.body_turn, -1, 75.0, -1)
    sense = -1 if mirrored else 1
    parts = [
        *_words(ring_teeth, setting, mirrored=mirrored),
        _circle(_CENTRE, _BORDER, f'stroke="{_FAINT}" stroke-width="0.25"'),
        *_teeth(ring_teeth, setting, sense),
        *_holes(chassis, sense),
        *_holes(ring, sense),
        *_lines(222.0, notes),
        *_detail(chassis, ring, sense),
    ]
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{_WIDTH}mm" height="{_HEIGHT}mm" '
        f'viewBox="0 0 {_WIDTH} {_HEIGHT}" fill="none" '
        'font-family="DejaVu Sans, Arial, sans-serif" text-anchor="middle">\n'
        '<rect width="100%" height="100%" fill="#ffffff"/>\n' + '\n'.join(parts) + '\n</svg>\n'
    )


def _words(ring_teeth: int, setting: PinSetting, *, mirrored: bool) -> Iterator[str]:
    title = f'Ring hole {setting.ring_hole} in chassis hole {setting.chassis_hole}'
    yield _text((_CENTRE[0], 17.0), 8.0, title, bold=True)
    bodies = f'{ring_teeth} teeth, {ring_teeth + 1} ring holes, {ring_teeth + 2} chassis holes'
    yield _text((_CENTRE[0], 25.0), 3.8, f'{bodies}; tooth profile turned by {arc(setting.angle)}')
    x, y = _CENTRE
    for dy, size, line in (
        (-17.0, 4.5, 'ring hole'),
        (-6.0, 11.0, str(setting.ring_hole)),
        (3.0, 4.5, 'in chassis hole'),
        (14.0, 11.0, str(setting.chassis_hole)),
        (24.0, 4.5, f'tooth {setting.tooth}'),
    ):
        yield _text((x, y + dy), size, line, _INK, bold=size > 5.0)  # noqa: PLR2004
    onward, back, side = 'counterclockwise', 'clockwise', 'against'
    if mirrored:
        onward, back, side = back, onward, 'along'
    lines = (
        f'Seen {side} the z axis. Black triangles are the zero marks, at hole 0.',
        f'Chassis holes and teeth count {onward}, ring holes {back}.',
        'Holes that lie over each other on the machine are drawn side by side.',
    )
    yield from _lines(280.0, lines)


def _lines(y: float, lines: Iterable[str]) -> Iterator[str]:
    for k, line in enumerate(lines):
        yield _text((_CENTRE[0], y + 5.0 * k), 3.6, line)


def _place(radius: float, turn: Fraction | float, sense: int) -> Point:
    angle = sense * 2.0 * math.pi * float(turn)
    return _CENTRE[0] - radius * math.sin(angle), _CENTRE[1] - radius * math.cos(angle)


def _teeth(ring_teeth: int, setting: PinSetting, sense: int) -> Iterator[str]:
    pitch = min(1.0 / ring_teeth, _WIDEST_TOOTH)
    for tooth in range(ring_teeth):
        middle = float(setting.body_turn) + tooth / ring_teeth
        corners = ((_ROOT, -0.3), (_TIP, -0.14), (_TIP, 0.14), (_ROOT, 0.3))
        points = (_place(radius, middle + part * pitch, sense) for radius, part in corners)
        yield _polygon(points, 'tooth', _PIN if tooth == setting.tooth else _FAINT)
    at = _place(_TOOTH_NUMBER, setting.turn, sense)
    yield _number(at, f'tooth {setting.tooth}', pinned=True)


def _holes(row: _Row, sense: int) -> Iterator[str]:
    pitch = 2.0 * math.pi * row.radius / row.holes
    every = next(
        n * 10**k for k in range(6) for n in (1, 2, 5) if n * 10**k * pitch >= _NUMBER_PITCH
    )
    numbers = row.radius + row.outwards * 5.5
    for hole in range(row.holes):
        turn, pinned = row.turn(hole), hole == row.pinned
        yield _hole(_place(row.radius, turn, sense), min(_HOLE, 0.3 * pitch), row, pinned=pinned)
        from_pin = min((hole - row.pinned) % row.holes, (row.pinned - hole) % row.holes)
        wrapping = hole and row.holes - hole < every  # too near to hole 0
        if pinned or (hole % every == 0 and from_pin >= every and not wrapping):
            yield _number(_place(numbers, turn, sense), str(hole), pinned=pinned)
    tip, base = row.radius + row.outwards * 8.0, row.radius + row.outwards * 11.5
    corners = ((tip, 0.0), (base, -0.2 / base), (base, 0.2 / base))
    points = (_place(radius, float(row.zero) + part, sense) for radius, part in corners)
    yield _polygon(points, 'zero', _INK)


def _detail(chassis: _Row, ring: _Row, sense: int) -> Iterator[str]:
    """The holes next to the pin, unrolled, with their numbers."""
    x, pin, to_number = _CENTRE[0], _DETAIL_PITCH * 0.375, 7.0
    yield _line((30.0, _DETAIL), (_WIDTH - 30.0, _DETAIL), _FAINT, 0.25)
    most = min(_DETAIL_HOLES, (ring.holes - 1) // 2)
    for row in (chassis, ring):
        y = _DETAIL - row.outwards * pin
        yield _text((8.0, y + 1.3), 3.6, row.body, anchor='start')
        pitch = _DETAIL_PITCH * chassis.holes / row.holes
        for k in range(-most, most + 1):
            point = (x - sense * row.direction * k * pitch, y)
            yield _circle(point, 3.4, f'stroke="{_INK}" stroke-width="0.4"')
            number = str((row.pinned + k) % row.holes)
            below = (point[0], y - row.outwards * to_number + 1.6)
            yield _text(below, 4.6, number, _INK if k else _PIN, bold=not k)
    yield _line((x, _DETAIL - pin), (x, _DETAIL + pin), _PIN, 4.0)


def _hole(centre: Point, radius: float, row: _Row, *, pinned: bool) -> str:
    name = row.body.replace(' ', '-')
    if pinned:
        return _circle(centre, max(radius, 0.8), f'class="{name} pinned" fill="{_PIN}"')
    width = max(radius / 6.0, 0.15)
    return _circle(centre, radius, f'class="{name}" stroke="{_INK}" stroke-width="{width:.3f}"')


def _number(at: Point, number: str, *, pinned: bool) -> str:
    size = 1.5 * _NUMBER if pinned else _NUMBER
    colour = _PIN if pinned else _INK
    return _text((at[0], at[1] + 0.36 * size), size, number, colour, bold=pinned)


def _polygon(points: Iterable[Point], name: str, colour: str) -> str:
    path = ' '.join(f'{x:.3f},{y:.3f}' for x, y in points)
    return f'<polygon class="{name}" points="{path}" fill="{colour}"/>'


def _circle(centre: Point, radius: float, style: str) -> str:
    return f'<circle cx="{centre[0]:.3f}" cy="{centre[1]:.3f}" r="{radius:.3f}" {style}/>'


def _line(start: Point, end: Point, colour: str, width: float) -> str:
    return (
        f'<line x1="{start[0]:.3f}" y1="{start[1]:.3f}" x2="{end[0]:.3f}" y2="{end[1]:.3f}" '
        f'stroke="{colour}" stroke-width="{width}" stroke-linecap="round"/>'
    )


def _text(
    at: Point,
    size: float,
    text: str,
    colour: str = _INK,
    *,
    bold: bool = False,
    anchor: str = 'middle',
) -> str:
    weight = ' font-weight="bold"' if bold else ''
    return (
        f'<text x="{at[0]:.3f}" y="{at[1]:.3f}" font-size="{size:g}" fill="{colour}"{weight} '
        f'text-anchor="{anchor}">{escape(text)}</text>'
    )
