# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Samples of a recording as the linear model needs them, and the terms of the model.

The columns of a term are in the units of the calibration file, which contains the coefficients.
"""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from fractions import Fraction
from itertools import count, islice, pairwise
from typing import NamedTuple

import numpy as np

from gear_kinematics.correction.calibration_file import Compliance, Order, Stop
from gear_kinematics.correction.corrector import MAX_GAP, Correction
from gear_kinematics.kinematics import Mechanism
from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.measurement.recording import Array, Recording
from gear_kinematics.measurement.sentences import Observation, Observed
from gear_kinematics.measurement.two_encoders import play_bounds
from gear_kinematics.measurement.wording import ARC_MINUTES
from gear_kinematics.report.document import number

_MOST = 400_000  # measured angles of all recordings that are used; more would only take time
_MOVING = 0.05  # share of the greatest speed above which the output moves
_STROKES = 3  # number of strokes that separate a delay from hysteresis
_SAME = 1e-9  # share of the radius below which states differ by rounding alone
_BODIES: Mapping[str, tuple[int, str]] = {
    'teeth': (2, 'tooth spacing and tooth form'),
    'rotor': (4, 'runout or out-of-roundness of the cams, of the rotor or of its encoder'),
    'output': (4, 'runout or out-of-roundness of the output shaft or of its encoder'),
    'satellite': (2, 'runout of a satellite, or an Oldham coupling out of square'),
}
"""Number of multiples that are tried for each body, and their likely cause."""
_HYSTERESIS = 'play, or friction that winds up the gear'
_TREND = 'undetermined by so short a travel; known over the calibrated output angles only'
_CYCLES = 2.0  # cycles of an order that a recording must contain
_RADII = 2.0 ** (np.arange(-28, 9) / 4.0)
"""Radii of stop operators as shares of the width of the error: 1/128 to 4, 19 % apart."""
_KNOWN = 0.8  # share of the samples at which the state of a stop operator must be known
_LARGEST_DENOMINATOR = 2**16  # of an order; a fitted ratio may have a larger one


def thinned(recordings: Sequence[Recording]) -> list[Recording]:
    """Thin out the measured angles if there are very many, but not the rotor's motion."""
    every = max(1, -(-sum(len(one.both.measured) for one in recordings) // _MOST))
    return [replace(one, encoders=one.both.chosen(slice(None, None, every))) for one in recordings]


class Samples:
    """The measured angles of one recording; arrays are (n,) unless stated otherwise."""

    def __init__(
        self,
        recording: Recording,
        ratio: Fraction,
        shift: float = 0.0,
        correction: Correction | None = None,
    ) -> None:
        """Take the samples as measured earlier than their stamps by a shift, s.

        A known correction at the rotor's samples is subtracted from the error.
        """
        encoders = recording.both.earlier(shift) if shift else recording.both
        self.recording, self.encoders, self.shift = recording, encoders, shift
        self.turns, self.angle = encoders.position()
        ideal, bend = encoders.ideal(ratio), encoders.bend / float(ratio)
        self._travel = encoders.at_measured(ideal) + bend
        self.known: Array | float = 0.0
        if correction:
            self.known = encoders.at_measured(correction.deviation)
            # The tangents at both rotor samples are off as far as the line, to the other side.
            tangents = encoders.at_measured(correction.slope) * self._travel
            self.known += 0.5 * (tangents - encoders.at_measured(correction.slope * ideal))
        self.error = encoders.error(ratio) - bend - self.known
        self.offset = float(np.median(self.error))
        self.error -= self.offset
        self.speed = encoders.speed(ratio)
        self.torque = encoders.torque(ratio)
        first_output = TURN * float(encoders.rotor.turns[0]) / float(ratio)
        # Otherwise, the outputs of recordings would count from different whole turns.
        self.output = self._travel + first_output
        self.rotor_turns: Array = self.turns - self.turns[0] + self.angle / TURN
        self.used = np.arange(len(self.error))
        """Indices of the samples at which the states of all stop operators are known."""
        # Play depends on the motion only at the points where that begins or reverses.
        steps, starts = np.diff(ideal), encoders.starts(MAX_GAP)
        changing = np.flatnonzero(steps)
        back = changing[1:][np.diff(np.sign(steps[changing])) != 0.0]
        points = np.union1d(starts, back)
        self._points = ideal[points]
        edges = np.append(np.searchsorted(points, starts), len(points)).tolist()
        self._motions = [slice(*ends) for ends in pairwise(edges) if ends[1] - ends[0] > 1]
        self._last_point = np.searchsorted(points, encoders.before, side='right') - 1
        self._stops: dict[float, tuple[Array, Array]] = {}
        moving = self.speed[np.abs(self.speed) > _MOVING * np.max(np.abs(self.speed))]
        reversals = int(np.count_nonzero(np.diff(np.sign(moving))))
        # Hysteresis depends on the direction of strokes, not on the speed, which varies where they
        # begin and end.
        self.tells_delay = encoders.timed and 1 + reversals >= _STROKES
        """Whether an error proportional to the speed is separable from one by hysteresis."""

    def stop_states(self, radius: float) -> tuple[Array, Array]:
        """Follow a stop operator of a radius, rad.

        Returns the middle between its least and greatest possible state, rad, and whether these
        are the same.
        """
        if radius not in self._stops:
            plays = np.array([self._points - radius, self._points + radius])  # of one point alone
            for motion in self._motions:
                plays[:, motion] = play_bounds(self._points[motion], radius)
            low, high = self._travel - radius, self._travel + radius
            least = np.clip(plays[0][self._last_point], low, high)
            middle, same = least.copy(), np.ones(len(least), bool)
            # From some point of a motion on, both are the same.
            (rest,) = np.nonzero((plays[0] != plays[1])[self._last_point])
            most = np.clip(plays[1][self._last_point[rest]], low[rest], high[rest])
            middle[rest] = 0.5 * (least[rest] + most)
            same[rest] = most - least[rest] <= _SAME * radius
            self._stops[radius] = self._travel - middle, same
        return self._stops[radius]

    def own_values(self, at: Array) -> Array:
        """Rows of the recording's own unknowns, zero and delay, at some samples, (2, at)."""
        speed = self.speed[at] if self.tells_delay else np.zeros(len(at))
        return np.stack([np.ones(len(at)), -speed])


class Term(NamedTuple):
    """A term of the model."""

    name: str
    cause: str  # likely cause, in words; may be empty
    entry: Order | Stop | Compliance  # entry of the file, with coefficients of 0
    unit: float = 1.0  # greatest value of its columns, or their standard deviation
    is_trend: bool = False  # whether it is known only over the recorded output angles

    @property
    def cycles(self) -> Fraction | None:
        """Cycles of an order per turn of the rotor; None for other terms."""
        return self.entry.cycles if isinstance(self.entry, Order) else None

    @property
    def coefficients(self) -> tuple[str, ...]:
        """Names of its coefficients, one for each column."""
        return ('cos', 'sin') if isinstance(self.entry, Order) else ('coefficient',)

    def values(self, samples: Samples, at: Array) -> Array:
        """Its columns at some samples, (columns, at); exact for orders even after many turns."""
        match self.entry:
            case Order(cycles=cycles):
                p, q = cycles.as_integer_ratio()
                turns = np.fmod(p % q * np.fmod(samples.turns[at], q), q) / q
                phase = TURN * turns + float(cycles) * samples.angle[at]
                return np.stack([np.cos(phase), np.sin(phase)])
            case Stop(radius=radius):
                return samples.stop_states(radius)[0][None, at]
            case Compliance(torque=mean):
                return np.asarray(samples.torque)[None, at] - mean


def columns_of(terms: Sequence[Term]) -> list[list[int]]:
    """Return the column numbers of each term, in the order of the terms."""
    columns = count()
    return [list(islice(columns, len(term.coefficients))) for term in terms]


def bodies(ratio: Fraction, mechanism: Mechanism | None) -> dict[str, Fraction]:
    """Return the cycles of each body of a gear per turn of the rotor.

    In a turn of the rotor, the output turns 1/abs(i) times. In a mechanism, the cam turns
    1 + 1/abs(i) times against the satellite, as do its mesh and the Oldham coupling, and zk teeth
    come into mesh.
    """
    output = (1 / abs(ratio)).limit_denominator(_LARGEST_DENOMINATOR)
    cycles = {'rotor': Fraction(1), 'output': output}
    if mechanism:
        cycles = {'teeth': Fraction(mechanism.ring_teeth), **cycles, 'satellite': 1 + output}
    return cycles


def known_orders(
    samples: Sequence[Samples],
    ratio: Fraction,
    mechanism: Mechanism | None,
    refused: dict[str, Observed],
) -> list[Term]:
    """Return trends of the output, and the orders of which a recording contains two cycles.

    Trends stand for orders of the output with fewer cycles. There are none of other bodies: they
    repeat within the calibrated span of the output, and would be used where they are not known.
    """
    travel = max(float(np.ptp(s.rotor_turns)) for s in samples)
    found: dict[Fraction, Term] = {}
    for body, unit in bodies(ratio, mechanism).items():
        most, cause = _BODIES[body]
        for multiple in range(1, most + 1):
            name, cycles = f'{body} × {multiple}', multiple * unit
            contained = travel * float(cycles)
            if contained >= _CYCLES:
                order = Order(name, cycles, 0.0, 0.0)
                found.setdefault(cycles, Term(name, cause, order))
                continue
            refused[name] = Observation.FEW_CYCLES(cycles=contained)
            # Over a part of its cycle, the first multiple is like higher ones; and an order with
            # whole cycles in a turn of the rotor is not tied to the output's angle.
            few = body == 'output' and multiple <= 1.0 + travel * float(unit)
            if few and cycles.denominator > 1:
                name = f'trend × {multiple}'
                trend = Order(name, cycles, 0.0, 0.0)
                found[cycles] = Term(name, _TREND, trend, is_trend=True)
    return sorted(found.values(), key=lambda term: not term.is_trend)


def wind_up(samples: Sequence[Samples], refused: dict[str, Observed]) -> list[Term]:
    """Return the wind-up, if the torque was recorded and varies."""
    torques = [s.torque for s in samples if s.torque is not None]
    if len(torques) < len(samples):
        if torques:
            refused['wind-up'] = Observation.SOME_EFFORTS()
        return []
    mean = float(np.mean(np.concatenate(torques)))
    deviation = float(np.sqrt(np.mean([np.var(torque) for torque in torques])))
    if deviation <= 1e-9 * abs(mean) or deviation == 0.0:
        refused['wind-up'] = Observation.TORQUE_CONSTANT()
        return []
    cause = 'torsional compliance under the torque'
    return [Term('wind-up', cause, Compliance(0.0, mean), deviation)]


def stops(samples: Sequence[Samples], refused: dict[str, Observed]) -> list[Term]:
    """Return stop operators up to the width of the error, which is at least its hysteresis.

    Those that moved too seldom through their range for a known state are left out.
    """
    width = max(float(np.ptp(np.quantile(s.error, (0.005, 0.995)))) for s in samples)
    kept = []
    for radius in (width * _RADII).tolist() if width > 0.0 else []:
        name = f'hysteresis ±{number(radius * ARC_MINUTES)} arcmin'
        known = [s.stop_states(radius)[1] for s in samples]
        if (share := np.concatenate(known).mean()) >= _KNOWN:
            kept.append(Term(name, _HYSTERESIS, Stop(radius, 0.0), radius))
            for s, states in zip(samples, known, strict=True):
                s.used = np.flatnonzero(states)  # where all smaller ones are known, too
        else:
            refused[name] = Observation.STATE_UNKNOWN(percent=100.0 * share)
    return kept
