"""Draw docs/scheme.svg, the picture of the README, from the kinematics core.

    python docs/scheme.py > docs/scheme.svg

On the left the bodies of one branch, with few teeth and a large eccentricity so that it can be
seen; on the right the whole path of an Oldham coupling's centre in the default actuator.
"""

import math
from collections.abc import Sequence

import numpy as np

from gear_kinematics.kinematics import Branch, Mechanism, solve

_INK, _RING, _SATELLITE, _COUPLING, _SHAFT = '#24292f', '#6e7781', '#0969da', '#bf8700', '#1a7f37'
_SIZE = 340  # px, of each half
Point = Sequence[float]

_ANGLE = math.radians(40.0)  # of the rotor, in the scheme


def main() -> None:
    """Print the drawing."""
    few_teeth = Mechanism(12, 9, 1.0, (Branch('a'),))
    actuator = Mechanism(80, 76, 0.0011, (Branch('a'),))
    print(
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {2 * _SIZE + 60} {_SIZE + 60}" '
        'font-family="DejaVu Sans, Arial, sans-serif" font-size="15" fill="none">'
        f'<rect width="100%" height="100%" rx="12" fill="#ffffff"/>'
        f'{_group(_SIZE / 2 + 20, _scheme(few_teeth))}{_caption(0, "one branch, 12/9 teeth")}'
        f'{_group(1.5 * _SIZE + 40, _rose(actuator))}'
        f'{_caption(_SIZE + 20, "path of O4, 80/76 teeth: 40 petals")}</svg>'
    )


def _scheme(mechanism: Mechanism) -> str:
    scale = _SIZE / 2 / (mechanism.ring_rolling_radius * 1.12)
    state = solve(mechanism, _ANGLE)
    satellite, coupling = scale * state.satellite_centre[0], scale * state.oldham_centre[0]
    turn = math.degrees(float(state.output_angle))
    ring = scale * mechanism.ring_rolling_radius
    pitch = scale * mechanism.satellite_rolling_radius
    contact = satellite * mechanism.ring_rolling_radius / mechanism.eccentricity
    slot = 0.62 * pitch
    return ''.join(
        [
            _circle((0, 0), 1.1 * ring, _RING, width=1),
            _circle((0, 0), ring, _RING, width=3),
            _circle(satellite, pitch, _SATELLITE, width=3, fill='#0969da18'),
            _line(_along(satellite, turn, -slot), _along(satellite, turn, slot), _SATELLITE),
            _line(_along((0, 0), turn + 90, -slot), _along((0, 0), turn + 90, slot), _SHAFT),
            _circle(coupling, 0.3 * pitch, _COUPLING, width=3, fill='#bf870022'),
            _line((0, 0), satellite, _INK, width=4),
            *(_circle(point, 4.5, _INK, fill=_INK) for point in ((0, 0), satellite, coupling)),
            _circle(contact, 4.5, _RING, fill=_RING),
            _label((0, 0), 'O₁', _INK, 8, 20),
            _label(satellite, 'O₃', _SATELLITE, -26, -8),
            _label(coupling, 'O₄', _COUPLING, 10, -8),
            _label(_along(satellite, turn, slot), 'x', _SATELLITE, 6, 4),
            _label(_along((0, 0), turn + 90, slot), 'y', _SHAFT, 8, 0),
            _label(satellite / 2, 'e', _INK, -16, 10),
        ]
    )


def _rose(mechanism: Mechanism) -> str:
    angles = np.linspace(0.0, 2.0 * np.pi * mechanism.satellite_teeth, 8000)
    path = solve(mechanism, angles).oldham_centre[:, 0] / mechanism.eccentricity * _SIZE / 2 * 0.95
    points = ' '.join(f'{x:.1f},{-y:.1f}' for x, y in path)
    return (
        f'<polyline points="{points}" stroke="{_COUPLING}" stroke-width="0.8"/>'
        + _circle((0, 0), _SIZE / 2 * 0.95, _RING, width=1)
        + _label((0, 0.95 * _SIZE / 2), 'radius e', _RING, 12, -4)
    )


def _along(start: Point, degrees: float, length: float) -> Point:
    angle = math.radians(degrees)
    return start[0] + length * math.cos(angle), start[1] + length * math.sin(angle)


def _group(x: float, content: str) -> str:
    return f'<g transform="translate({x} {_SIZE / 2 + 14})">{content}</g>'


def _caption(x: float, text: str) -> str:
    middle = x + 20 + _SIZE / 2
    return f'<text x="{middle}" y="{_SIZE + 44}" text-anchor="middle" fill="{_INK}">{text}</text>'


def _circle(
    centre: Point, radius: float, colour: str, width: float = 2, fill: str = 'none'
) -> str:
    return (
        f'<circle cx="{centre[0]:.2f}" cy="{-centre[1]:.2f}" r="{radius:.2f}" stroke="{colour}" '
        f'stroke-width="{width}" fill="{fill}"/>'
    )


def _line(start: Point, end: Point, colour: str, width: float = 2) -> str:
    return (
        f'<line x1="{start[0]:.2f}" y1="{-start[1]:.2f}" x2="{end[0]:.2f}" y2="{-end[1]:.2f}" '
        f'stroke="{colour}" stroke-width="{width}"/>'
    )


def _label(point: Point, text: str, colour: str, dx: float, dy: float) -> str:
    return f'<text x="{point[0] + dx:.1f}" y="{-point[1] + dy:.1f}" fill="{colour}">{text}</text>'


if __name__ == '__main__':
    main()
