# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The gear ratio from recorded angles of rotor and output."""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from itertools import count, islice

import numpy as np

from gear_kinematics.kinematics.gear_ratio import GearRatio, simplest_fraction
from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.measurement.encoder_range import MOST_SPAN
from gear_kinematics.measurement.recording import Array, Encoders, RecordingError
from gear_kinematics.measurement.sentences import Observation, Observed
from gear_kinematics.measurement.two_encoders import STEP, EncoderFit, directions
from gear_kinematics.statistics.uncertainty import Estimate

_SETTLED, _MOST_PLAY = 0.05, math.radians(2.0)
"""Travel left out after a reversal, as play is crossed: share of the whole, and at most, rad."""
_LEAST = 230  # samples in motion
_FEWEST_WRAPS = 3
_ONE_TURN = 390  # deg of the output: more than a turn, within which hardly anything repeats
_MOST_TURNED = 3600  # deg of the output, at most, that the user is asked to turn
_BY_CHANCE = 0.05  # probability below which a simple fraction in the interval is no coincidence
_WHOLE = _BY_CHANCE / 4.0  # greatest uncertainty at which the same holds for a whole number
_MAX_DISTANCE = 2
"""Expanded uncertainties within which a fraction may be the true ratio, since one recording in 20
has it beyond a single one."""
_BEYOND = 0.05  # share of such recordings: a coincidence must be as much less likely there
_CANDIDATES = 10
_ROUNDS = 4  # from a ratio of the wrong sign at fast rotors, three
_UNITS = {'degrees': math.degrees(1.0), 'turns': 1.0 / TURN}  # per rad, of a rotor by mistake
_MOST_ERROR = 0.5
"""Greatest error of a gear without a delay, play and noise over its motion, rms. It is about 1 or
more where the output is the angle of another joint, a time, a current or a temperature."""
_EXCHANGED = 1.2  # times the rotor's travel, by which encoders at one shaft never differ
_MULTIPLE = 1e-3  # from a multiple of the assumed ratio, as by wrong counts per turn or units


@dataclass(frozen=True, slots=True)
class RatioEstimate:
    """A gear ratio as it was measured."""

    measured: Estimate
    candidates: tuple[Fraction, ...]  #: possible ratios by denominator, or the one that is taken
    taken: GearRatio | None = None  #: simplest possible ratio, unless it may be a coincidence
    advice: Observed | None = None  #: what to record to determine the ratio; None if it is taken

    def fits(self, ratio: Fraction) -> bool:
        """Return whether a ratio may be the true one."""
        return abs(self.measured.value - ratio) <= _MAX_DISTANCE * self.measured.expanded


def check_ratio(encoders: Encoders, assumed: GearRatio) -> Observed | None:
    """Compare a recording with a ratio; return what is wrong, if anything.

    Raises:
        RecordingError: if the error reaches all angles of a turn, so that it has no meaning.
    """
    error, wrong = encoders.error(assumed), wrong_ratio(encoders, assumed)
    if float(np.ptp(np.remainder(error - error[0] + 0.5 * TURN, TURN))) >= 0.5 * TURN:
        causes = 'the ratio is wrong, an encoder slips, or both are read too far apart in time'
        raise RecordingError(f'the output does not follow the rotor: {wrong or causes}')
    return Observation.NOT_THE_RATIO(assumed=assumed, why=wrong) if wrong else None


def wrong_ratio(encoders: Encoders, assumed: Fraction) -> Observed | None:
    """Find the ratio of a recording, if it is clearly not the assumed one.

    This needs an output that, between samples, turns at most half a turn more or less than the
    assumed ratio implies.
    """
    found = _estimated(encoders, assumed) or _estimated(encoders, -assumed)
    if found and found.fits(assumed):
        return None
    if found and found.fits(-assumed):
        measured = found.measured
        return Observation.COUNTS_BACKWARDS(measured=measured, assumed=assumed, ratio=-assumed)
    inverse = _estimated(encoders, 1 / assumed)
    for ratio in (1 / assumed, -1 / assumed):
        if inverse and inverse.fits(ratio):
            measured = inverse.measured
            return Observation.UPSIDE_DOWN(measured=measured, assumed=assumed, ratio=ratio)
    if not found:
        if _wraps(encoders.rotor.turned):
            return Observation.WRAPS_UNCOUNTED()
        output = float(np.ptp(np.unwrap(encoders.measured)))
        more = output > _EXCHANGED * float(np.ptp(encoders.rotor.turned))
        return Observation.EXCHANGED() if more else None
    what = Observation.ANOTHER_RATIO if found.taken else Observation.OTHER_RATIOS
    ratio = found.candidates[0]
    times = found.measured.value / float(assumed)
    whole = round(times)
    if whole > 1 and abs(times - whole) < _MULTIPLE * whole:
        what, ratio = Observation.MULTIPLE_RATIO, whole * assumed
    elif any(abs(times - size) < _MULTIPLE * size for size in (math.degrees(1.0), TURN)):
        what = Observation.MULTIPLE_RATIO
    return what(measured=found.measured, assumed=assumed, ratio=ratio)


def not_followed(angle: Array, error: Array, assumed: Fraction) -> Observed | None:
    """Return that the ratio is wrong if the error is too large for so little motion.

    Both are (n,), rad: the output angle that the ratio implies, and the error without a delay.
    Play and white noise do not count, however large they are.
    """
    sides = directions(angle, min(_SETTLED * float(np.ptp(angle)), _MOST_PLAY))
    columns = np.column_stack([np.ones(len(error)), sides])
    left = error - columns @ np.linalg.lstsq(columns, error, rcond=None)[0]
    changes = np.diff(error, 2, prepend=error[:1], append=error[-1:])  # six times as much noise
    if np.var(left) - np.mean(changes**2) / 6.0 <= _MOST_ERROR**2 * np.var(angle):
        return None
    return Observation.NOT_THE_RATIO(assumed=assumed, why=Observation.NOT_FOLLOWED())


def _estimated(encoders: Encoders, assumed: Fraction) -> RatioEstimate | None:
    """Estimate the ratio, starting from one that is about right; None if that is impossible.

    A wrong ratio can imply that the output wrapped between samples. So the ratio that it shows is
    the next one to start from, until one shows itself.
    """
    time = encoders.seconds if encoders.timed else None
    for _ in range(_ROUNDS):
        ideal = encoders.at_measured(encoders.ideal(assumed))
        output = ideal + encoders.error(assumed)
        try:
            found = estimate_ratio(ideal * float(assumed), output, time, encoders.interpolated)
        except RecordingError:
            return None
        if found.fits(assumed):
            return found
        assumed = Fraction(found.measured.value)
    return None


def estimate_ratio(
    rotor: Array, output: Array, time: Array | None = None, period: float = 0.0
) -> RatioEstimate:
    """Estimate the ratio by the fit of both encoders.

    The multi-turn angles, (n,) each, rad, are in the order of time, s. The rotor is interpolated
    between samples that are `period` apart, s; 0 if it is not.

    Raises:
        RecordingError: if there are too few samples, or the output hardly turns with the rotor, or
            more than it.
    """
    for angle, body in ((rotor, 'rotor'), (output, 'output')):
        if not np.ptp(angle):
            raise RecordingError(f'the {body} does not turn')
    if _wraps(rotor):
        raise RecordingError(str(Observation.WRAPS_UNCOUNTED()))
    centred = (rotor - np.mean(rotor)) / np.ptp(rotor)
    slope = float(centred @ (output - np.mean(output)) / (centred @ centred) / np.ptp(rotor))
    times = np.asarray(STEP * np.arange(len(rotor)) if time is None else time, float)
    travel = min(_SETTLED * abs(slope) * float(np.ptp(rotor)), _MOST_PLAY)
    direction = directions(slope * rotor, travel)
    if (count := np.count_nonzero(direction)) < _LEAST:
        few = f'{count} samples in motion are too few'
        raise RecordingError(f'{few}; turn the output until there are {_LEAST}')
    fit = EncoderFit(rotor, output, times, direction, slope).refined().refined()
    measured = fit.slope_estimate(period)
    if not _MAX_DISTANCE * measured.expanded < abs(measured.value):
        raise RecordingError(str(Observation.NOT_FOLLOWED()))
    turned = math.degrees(abs(measured.value) * fit.travel)
    measured = measured.inverse()
    if abs(measured.value) + _MAX_DISTANCE * measured.expanded < 1.0:
        raise RecordingError(str(Observation.EXCHANGED()))
    return _judged(measured, turned)


def _wraps(rotor: Array) -> bool:
    """Return whether angles, rad, stay within a turn and often step by more than half of it."""
    steps = np.count_nonzero(np.abs(np.diff(rotor)) > 0.5 * TURN)
    return bool(steps >= _FEWEST_WRAPS and np.ptp(rotor) <= MOST_SPAN * TURN)


def _judged(measured: Estimate, turned: float) -> RatioEstimate:
    """Take the simplest fraction that may be the ratio, or advise by how many degrees to turn."""
    value, spread = measured.value, measured.expanded
    around = _MAX_DISTANCE * spread
    low, high = Fraction(value - around), Fraction(value + around)
    simplest = simplest_fraction(low, high)
    # Fewer than q (q + 1)/2 fractions per unit have a denominator of at most q.
    q = simplest.denominator
    enough = _BY_CHANCE / (_MAX_DISTANCE * q * (q + 1))
    if abs(value - simplest) > spread:
        enough *= _BEYOND
    if spread < enough:
        return RatioEstimate(measured, (simplest,), GearRatio(simplest))
    # Over a turn, the uncertainty falls as it grows.
    more = 90 * math.ceil(spread / enough * turned / 90.0)
    more = more if turned >= _ONE_TURN else _ONE_TURN
    advice = Observation.TURN_FURTHER(degrees=more)
    if not turned < more <= _MOST_TURNED:
        advice = Observation.SAMPLE_TOGETHER()
    for unit, size in _UNITS.items():
        whole = round(value / size)
        if abs(whole) > 1 and abs(value - whole * size) < spread < _WHOLE * size:
            advice = Observation.PERHAPS_UNIT(sent=unit, ratio=whole, advice=advice)
            break
    candidates = islice(_fractions(low, high, q, value), _CANDIDATES)
    return RatioEstimate(measured, tuple(candidates), advice=advice)


def _fractions(low: Fraction, high: Fraction, least: int, value: float) -> Iterator[Fraction]:
    """Yield the fractions in an interval by denominator, those nearest to a value first."""
    for q in count(least):
        whole = range(math.ceil(low * q), math.floor(high * q) + 1)
        for p in sorted(whole, key=lambda p: abs(p - value * q)):
            if math.gcd(p, q) == 1:
                yield Fraction(p, q)
