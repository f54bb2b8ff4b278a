"""Finds the terms that recordings can determine, and says why others cannot be."""

from collections.abc import Sequence
from fractions import Fraction

import numpy as np

from gear_kinematics.calibration.model import Samples
from gear_kinematics.calibration.terms import (
    OrderTerm,
    StopTerm,
    TorqueTerm,
    known_orders,
    output_cycles,
    trend,
)
from gear_kinematics.kinematics import Mechanism

_CYCLES = 2.0
"""Cycles of an order that a recording must contain."""
_MOVING = 0.05
"""Share of the greatest speed above which the output moves."""
_STROKES = 3
"""Strokes that tell a delay from hysteresis."""
_COARSE = 2.0 ** np.arange(-7, 3)
"""Radii that are tried first, as shares of the width of the error."""
_FINE = 2.0 ** (np.arange(-3, 4) / 4.0)
"""Radii that are tried next, as multiples of those that were chosen."""
_KNOWN = 0.8
"""Share of the samples at which the state of a stop operator must be known."""


def orders(
    samples: Sequence[Samples],
    ratio: Fraction,
    mechanism: Mechanism | None,
    refused: dict[str, str],
) -> tuple[list[OrderTerm], list[OrderTerm]]:
    """The known orders of which a recording contains two cycles, and trends instead of others.

    Those are of the output. Other ones repeat within the calibrated span of the output, so that
    they would be used where they are not known.
    """
    travel = max(float(np.ptp(s.rotor_turns)) for s in samples)
    output = output_cycles(ratio)
    kept, trends = [], []
    for term in known_orders(ratio, mechanism):
        cycles = travel * float(term.cycles)
        if cycles >= _CYCLES:
            kept.append(term)
        else:
            refused[term.name] = f'the longest travel holds {cycles:.2g} cycles, less than 2'
            multiple = term.cycles / output
            # Higher ones do not differ from the first over a part of its cycle, and a whole number
            # of cycles in a turn of the rotor is not tied to the output's angle.
            few = multiple.denominator == 1 and multiple <= 1.0 + travel * float(output)
            if few and term.cycles.denominator > 1:
                trends.append(trend(int(multiple), ratio))
    return kept, trends


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


def tells_delay(samples: Samples) -> bool:
    """Whether an error in proportion to the speed can be told from one by hysteresis.

    That takes several strokes, as hysteresis depends on their direction and not on the speed,
    which varies where they begin and end. How well they tell it is up to the uncertainty.
    """
    if not (samples.recording.separate and samples.recording.timed):
        return False
    speed = samples.speed[np.abs(samples.speed) > _MOVING * np.max(np.abs(samples.speed))]
    return 1 + int(np.count_nonzero(np.diff(np.sign(speed)))) >= _STROKES


def coarse_stops(samples: Sequence[Samples], refused: dict[str, str]) -> list[StopTerm]:
    """Stop operators over the width of the error, which is at least that of its hysteresis."""
    width = max(float(np.ptp(np.quantile(s.error, (0.005, 0.995)))) for s in samples)
    return _determined(samples, (width * _COARSE).tolist() if width > 0.0 else [], refused)


def fine_stops(
    samples: Sequence[Samples], chosen: Sequence[StopTerm], refused: dict[str, str]
) -> list[StopTerm]:
    """Stop operators with radii near those that were chosen."""
    radii = sorted({round(float(np.log2(s.radius * k)), 6) for s in chosen for k in _FINE})
    return _determined(samples, [2.0**power for power in radii], refused)


def _determined(
    samples: Sequence[Samples], radii: Sequence[float], refused: dict[str, str]
) -> list[StopTerm]:
    """Those radii whose travel was made often enough to know the state."""
    kept = []
    for radius in radii:
        term = StopTerm(radius)
        for s in samples:
            s.follow(radius)
        known = np.concatenate([s.known[radius] for s in samples])
        if known.mean() >= _KNOWN:
            kept.append(term)
        else:
            refused[term.name] = f'its state is known at {100 * known.mean():.0f} % of the samples'
    return kept


def use_known(samples: Sequence[Samples], stops: Sequence[StopTerm]) -> None:
    """Use the samples at which the states of all stop operators are known."""
    for s in samples:
        known = np.ones(len(s.error), bool)
        for term in stops:
            known &= s.known[term.radius]
        s.used = np.flatnonzero(known)
