"""What the linear model needs of a recording, and the terms of the model.

A column of a term is in the unit of the calibration file, so that a coefficient is what the file
contains.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise

import numpy as np

from gear_kinematics.correction.corrector import MAX_GAP
from gear_kinematics.correction.stops import play_bounds
from gear_kinematics.kinematics import Mechanism
from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.measurement.recording import Array, Encoders, Recording
from gear_kinematics.measurement.transmission import bodies
from gear_kinematics.measurement.wording import ARC_MINUTES
from gear_kinematics.report.document import number

Recorded = tuple[Recording, Encoders]

_MOST = 400_000  # measured angles that are used, of all recordings; more would only take time
_SEED = 13
MOST_DRIFT = 16  # half waves of the drift of a recording's zero over its time
_MOVING = 0.05  # share of the greatest speed above which the output moves
_STROKES = 3  # strokes that tell a delay from hysteresis
_CHUNK = 4096  # turning points that are followed at a time
_SAME = 1e-9  # share of the radius by which states differ in rounding alone
_BODIES: Mapping[str, tuple[int, tuple[str, str]]] = {
    'teeth': (2, ('tooth spacing and tooth form', 'tooth form')),
    'rotor': (4, (
        'eccentricity or runout of the cams, of the rotor or of its encoder',
        'out-of-roundness or tilt of the rotor or its encoder, or errors within its pole pairs',
    )),
    'output': (4, (
        'eccentricity or runout of the output shaft or of its encoder',
        'tilt or out-of-roundness of the output shaft, or of its encoder',
    )),
    'satellite': (2, (
        'eccentricity or runout of a satellite, or an Oldham coupling out of square',
        'out-of-roundness of a satellite, or an Oldham coupling out of square',
    )),
}  # fmt: skip
"""Multiples that are tried, and likely causes of the first and of the higher ones."""
_TREND = 'not told by so short a travel; known over the calibrated output angles only'
CYCLES = 2.0  # cycles of an order that a recording must contain
_RADII = 2.0 ** (np.arange(-28, 9) / 4.0)
"""Radii of stop operators as shares of the width of the error: 1/128 to 4, 19 % apart."""
_KNOWN = 0.8  # share of the samples at which the state of a stop operator must be known
_LARGEST_DENOMINATOR = 2**16  # of an order; a ratio that was fitted may have a longer one


def thinned(recordings: Sequence[Recorded]) -> list[Recorded]:
    """Leave out measured angles if there are very many; the rotor's motion stays as it is.

    One of each group of successive ones is chosen, at random: even steps could hide an order.
    """
    group = max(1, -(-sum(len(encoders.measured) for _, encoders in recordings) // _MOST))
    random = np.random.default_rng(_SEED)
    kept = []
    for recording, encoders in recordings:
        starts = np.arange(0, len(encoders.measured) - group + 1, group)
        rows = starts + random.integers(0, group, len(starts))
        kept.append((recording, encoders.chosen(rows)))
    return kept


class Samples:
    """The measured angles of one recording, (n,) each unless said otherwise."""

    def __init__(self, recording: Recording, encoders: Encoders, ratio: Fraction) -> None:
        self.recording, self.encoders = recording, encoders
        self.turns, self.angle = encoders.position()
        self.seconds = encoders.seconds
        self.error = encoders.error(ratio)
        self.offset = float(np.median(self.error))
        self.error -= self.offset
        self.speed = encoders.speed(ratio)
        self.torque = encoders.torque(ratio)
        ideal = encoders.ideal(ratio)
        first_output = TURN * float(encoders.rotor.turns[0]) / float(ratio)
        # Outputs of recordings count from different whole turns otherwise.
        self.output = encoders.at_measured(ideal) + first_output
        self.rotor_turns: Array = self.turns - self.turns[0] + self.angle / TURN
        self.used = np.arange(len(self.error))
        """Indices of the samples at which all stop operators are known."""
        self._points = TurningPoints(encoders, ideal, encoders.starts(MAX_GAP))
        self._stops: dict[float, tuple[Array, Array]] = {}
        moving = self.speed[np.abs(self.speed) > _MOVING * np.max(np.abs(self.speed))]
        reversals = int(np.count_nonzero(np.diff(np.sign(moving))))
        # Hysteresis depends on the direction of strokes, and not on the speed, which varies where
        # they begin and end.
        self.tells_delay = encoders.timed and 1 + reversals >= _STROKES
        """Whether an error in proportion to the speed can be told from one by hysteresis."""

    def stop_states(self, radius: float) -> tuple[Array, Array]:
        """States of the stop operator of a radius, rad, and whether they are known."""
        if radius not in self._stops:
            states, known = self._points.stop_states(radius)
            self._stops[radius] = states.astype(np.float32), known
        return self._stops[radius]

    def own_values(self, at: Array) -> Array:
        """Columns of the recording's own unknowns at some samples: zero, delay, drift."""
        speed = self.speed[at] if self.tells_delay else np.zeros(len(at))
        time = math.pi * self.seconds[at] / self.seconds[-1]
        waves = np.cos(np.multiply.outer(time, np.arange(1, MOST_DRIFT + 1)))
        return np.column_stack([np.ones(len(at)), -speed, waves])


class TurningPoints:
    """Where the rotor turns back; the play in between depends on that at the last such point."""

    def __init__(self, encoders: Encoders, ideal: Array, starts: Array) -> None:
        """Find them.

        Args:
            encoders: whose measured angles the states are for.
            ideal: output angle of the rotor's samples, rad.
            starts: indices of the rotor's samples before which the motion is unknown.
        """
        steps = np.diff(ideal)
        moving = np.flatnonzero(steps)
        back = np.diff(np.sign(steps[moving])) != 0.0
        points = np.union1d(starts, moving[1:][back])
        self._angles = ideal[points]
        self._begins = np.searchsorted(points, starts)
        self._last = np.searchsorted(points, encoders.before, side='right') - 1
        self._output = encoders.at_measured(ideal)

    def stop_states(self, radius: float) -> tuple[Array, Array]:
        """Follow a stop operator of a radius, rad.

        Returns:
            The middle between its least and greatest possible state at the measured angles, (n,),
            rad, and whether both are the same.
        """
        parts = []
        for begin, end in pairwise([*self._begins.tolist(), len(self._angles)]):
            ends = np.array([-np.inf]), np.array([np.inf])
            for first in range(begin, end, _CHUNK):
                angles = self._angles[first : min(first + _CHUNK, end)]
                parts.append(np.hstack(play_bounds(angles, np.array([radius]), *ends)))
                ends = parts[-1][-1, :1], parts[-1][-1, 1:]
        output = self._output[:, np.newaxis]
        plays = np.concatenate(parts)[self._last]
        least, most = np.clip(plays, output - radius, output + radius).T
        return self._output - 0.5 * (least + most), most - least <= _SAME * radius


@dataclass(frozen=True, slots=True)
class OrderTerm:
    """A cosine and a sine of the rotor's angle."""

    name: str
    cycles: Fraction
    """Per turn of the rotor."""
    cause: str
    """The likely one, in words; empty where none is."""
    is_trend: bool = False
    """Whether it is known over the recorded output angles only."""
    columns, unit, radius = 2, 1.0, None

    def values(self, samples: Samples, at: Array) -> Array:
        """Cosine and sine at some samples, (at, 2); exact after many turns."""
        p, q = self.cycles.numerator, self.cycles.denominator
        turns = np.fmod(p % q * np.fmod(samples.turns[at], q), q) / q
        phase = TURN * turns + float(self.cycles) * samples.angle[at]
        return np.stack([np.cos(phase), np.sin(phase)], axis=1)


@dataclass(frozen=True, slots=True)
class StopTerm:
    """The state of a stop operator of a radius, rad."""

    radius: float
    columns, cycles, is_trend = 1, None, False
    cause = 'play, or friction that winds up the gear'

    @property
    def name(self) -> str:
        """The name in reports."""
        return f'hysteresis ±{number(self.radius * ARC_MINUTES)} arcmin'

    @property
    def unit(self) -> float:
        """The greatest value of the column."""
        return self.radius

    def values(self, samples: Samples, at: Array) -> Array:
        """The states at some samples, (at, 1)."""
        return samples.stop_states(self.radius)[0][at, None]


@dataclass(frozen=True, slots=True)
class TorqueTerm:
    """The torque at the output less its mean, N·m."""

    mean: float
    unit: float
    """N·m: the standard deviation of the torque."""
    name = 'wind-up'
    columns, cycles, radius, is_trend = 1, None, None, False
    cause = 'torsional compliance under the torque'

    def values(self, samples: Samples, at: Array) -> Array:
        """The torques at some samples, (at, 1)."""
        return np.asarray(samples.torque)[at, None] - self.mean


Term = OrderTerm | StopTerm | TorqueTerm


def output_cycles(ratio: Fraction) -> Fraction:
    """Turns of the output in a turn of the rotor, without its sign."""
    return (1 / abs(ratio)).limit_denominator(_LARGEST_DENOMINATOR)


def _order(body: str, multiple: int, unit: Fraction) -> OrderTerm:
    most, causes = _BODIES[body]
    cause = causes[multiple > 1] if multiple <= most else ''
    return OrderTerm(f'{body} × {multiple}', multiple * unit, cause)


def order_of(cycles: Fraction, ratio: Fraction, mechanism: Mechanism | None) -> OrderTerm:
    """Name an order."""
    for body, unit in bodies(output_cycles(ratio), mechanism).items():
        if (multiple := cycles / unit).denominator == 1:
            return _order(body, int(multiple), unit)
    return OrderTerm(f'rotor × {cycles}', cycles, 'another shaft, or a bearing')


def known_orders(
    samples: Sequence[Samples],
    ratio: Fraction,
    mechanism: Mechanism | None,
    refused: dict[str, str],
) -> list[OrderTerm]:
    """The orders of which a recording contains two cycles, after trends instead of others.

    Trends are of the output. Other orders repeat within the calibrated span of the output, so that
    they would be used where they are not known.
    """
    travel = max(float(np.ptp(s.rotor_turns)) for s in samples)
    found: dict[Fraction, OrderTerm] = {}
    for body, unit in bodies(output_cycles(ratio), mechanism).items():
        for multiple in range(1, _BODIES[body][0] + 1):
            order = _order(body, multiple, unit)
            held = travel * float(order.cycles)
            if held >= CYCLES:
                found.setdefault(order.cycles, order)
                continue
            refused[order.name] = f'the longest travel holds {held:.2g} cycles, less than 2'
            # Higher multiples do not differ from the first over a part of its cycle, and a whole
            # number of cycles in a turn of the rotor is not tied to the output's angle.
            few = body == 'output' and multiple <= 1.0 + travel * float(unit)
            if few and order.cycles.denominator > 1:
                trend = OrderTerm(f'trend × {multiple}', order.cycles, _TREND, is_trend=True)
                found[order.cycles] = trend
    return sorted(found.values(), key=lambda term: not term.is_trend)


def wind_up(samples: Sequence[Samples], refused: dict[str, str]) -> list[TorqueTerm]:
    """The wind-up, if torque was recorded and varies."""
    torques = [s.torque for s in samples if s.torque is not None]
    if len(torques) < len(samples):
        if torques:
            refused['wind-up'] = 'not every recording has an effort throughout'
        return []
    mean = float(np.mean(np.concatenate(torques)))
    deviation = float(np.sqrt(np.mean([np.var(torque) for torque in torques])))
    if deviation <= 1e-9 * abs(mean) or deviation == 0.0:
        refused['wind-up'] = 'the torque does not vary'
        return []
    return [TorqueTerm(mean, deviation)]


def stops(samples: Sequence[Samples], refused: dict[str, str]) -> list[StopTerm]:
    """Stop operators over the width of the error, which is at least that of its hysteresis.

    Those are left out whose travel was made too seldom to know the state.
    """
    width = max(float(np.ptp(np.quantile(s.error, (0.005, 0.995)))) for s in samples)
    kept = []
    for term in map(StopTerm, (width * _RADII).tolist() if width > 0.0 else []):
        known = np.concatenate([s.stop_states(term.radius)[1] for s in samples])
        if known.mean() >= _KNOWN:
            kept.append(term)
        else:
            refused[term.name] = f'its state is known at {100 * known.mean():.0f} % of the samples'
    for s in samples:
        all_known = [s.stop_states(term.radius)[1] for term in kept]
        s.used = np.flatnonzero(np.all([np.ones(len(s.error), bool), *all_known], axis=0))
    return kept
