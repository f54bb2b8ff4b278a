"""The terms of a calibration, each with one or two columns of the linear model."""

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gear_kinematics.kinematics import Mechanism
from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.lost_motion.wording import ARC_MINUTES
from gear_kinematics.report.document import number

Array = NDArray[Any]

_MULTIPLES: Mapping[str, int] = {'output': 4, 'rotor': 4, 'satellite': 2, 'teeth': 2}
"""Multiples that are tried of each order."""
_CAUSES: Mapping[str, tuple[str, str]] = {
    'output': (
        'eccentricity or runout of the output shaft or of its encoder',
        'tilt or out-of-roundness of the output shaft, or of its encoder',
    ),
    'rotor': (
        'eccentricity or runout of the cams, of the rotor or of its encoder',
        'out-of-roundness or tilt of the rotor or its encoder, or errors within its pole pairs',
    ),
    'satellite': (
        'eccentricity or runout of a satellite, or an Oldham coupling out of square',
        'out-of-roundness of a satellite, or an Oldham coupling out of square',
    ),
    'teeth': ('tooth spacing and tooth form', 'tooth form'),
}
"""Likely causes of the first and of the higher multiples."""
_TREND = 'not told by so short a travel; known over the calibrated output angles only'

_LARGEST_DENOMINATOR = 2**16
"""Of an order; a ratio that was fitted may have a longer one."""


@dataclass(frozen=True, slots=True)
class OrderTerm:
    """A cosine and a sine of the rotor's angle."""

    name: str
    cycles: Fraction
    """Per turn of the rotor."""
    cause: str
    """The likely one, in words."""
    columns = 2

    def values(self, turns: Array, angle: Array) -> Array:
        """Cosine and sine at rotor angles 2π turns + angle, (n, 2); exact after many turns."""
        p, q = self.cycles.numerator, self.cycles.denominator
        phase = TURN * (np.fmod(p % q * np.fmod(turns, q), q) / q) + float(self.cycles) * angle
        return np.stack([np.cos(phase), np.sin(phase)], axis=1)


@dataclass(frozen=True, slots=True)
class StopTerm:
    """The state of a stop operator, in units of its radius."""

    radius: float
    """rad."""
    columns = 1
    cause = 'play, or friction that winds up the gear'

    @property
    def name(self) -> str:
        """The name in reports."""
        return f'hysteresis ±{number(self.radius * ARC_MINUTES)} arcmin'


@dataclass(frozen=True, slots=True)
class TorqueTerm:
    """The torque at the output less its mean, in units of its standard deviation."""

    mean: float
    """N·m."""
    deviation: float
    """N·m."""
    name = 'wind-up'
    columns = 1
    cause = 'torsional compliance under the torque'


@dataclass(frozen=True, slots=True)
class RatioTerm:
    """The ideal output angle, in units of the longest travel: how far the ratio is off."""

    travel: float
    """rad."""
    name = 'ratio'
    columns = 1
    cause = 'another gear ratio'


Term = OrderTerm | StopTerm | TorqueTerm | RatioTerm


def output_cycles(ratio: Fraction) -> Fraction:
    """Turns of the output in a turn of the rotor, without its sign."""
    return (1 / abs(ratio)).limit_denominator(_LARGEST_DENOMINATOR)


def _bodies(ratio: Fraction, mechanism: Mechanism | None) -> dict[str, Fraction]:
    """The bodies of a gear, and the cycles per turn of the rotor with which they repeat.

    In a turn of the rotor, the output turns 1/|i| times; the cam turns 1 + 1/|i| times against
    the satellite. Teeth mesh zk times.
    """
    output = output_cycles(ratio)
    bodies = {'rotor': Fraction(1), 'output': output}
    if mechanism:
        bodies = {'teeth': Fraction(mechanism.ring_teeth), **bodies, 'satellite': 1 + output}
    return bodies


def known_orders(ratio: Fraction, mechanism: Mechanism | None) -> list[OrderTerm]:
    """The orders that a gear is known to have, those of satellite and teeth with a mechanism."""
    found: dict[Fraction, OrderTerm] = {}
    for body, cycles in _bodies(ratio, mechanism).items():
        for multiple in range(1, _MULTIPLES[body] + 1):
            term = OrderTerm(
                f'{body} × {multiple}', multiple * cycles, _CAUSES[body][multiple > 1]
            )
            found.setdefault(term.cycles, term)
    return list(found.values())


def trend(multiple: int, ratio: Fraction) -> OrderTerm:
    """An order of the output of which only a part was recorded: what it does, not what it is."""
    return OrderTerm(f'trend × {multiple}', multiple * output_cycles(ratio), _TREND)


def order_of(cycles: Fraction, ratio: Fraction, mechanism: Mechanism | None) -> OrderTerm:
    """Name an order that was found in a spectrum."""
    for body, unit in _bodies(ratio, mechanism).items():
        if (multiple := cycles / unit).denominator == 1:
            return OrderTerm(f'{body} × {multiple}', cycles, _CAUSES[body][multiple > 1])
    return OrderTerm(f'rotor × {cycles}', cycles, 'another shaft, or a bearing')
