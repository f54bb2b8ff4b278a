"""The formatting of figures on lost motion."""

import math

from gear_kinematics.lost_motion.static.play import PlayModel
from gear_kinematics.lost_motion.static.rate import Rate
from gear_kinematics.report.document import number
from gear_kinematics.state.uncertainty import COVERAGE, Estimate

ARC_MINUTES = 60.0 * 180.0 / math.pi
"""Arc minutes per radian; catalogues give lost motion in arc minutes."""
PERCENT = f'{100.0 * COVERAGE:g} %'
"""Probability with which an interval contains the value."""
_EXACT = 1e-5
"""Relative uncertainty below which values are rounded to six digits."""


def plus_minus(estimate: Estimate | None, scale: float = 1.0) -> str:
    """Format a quantity with its uncertainty, both to the second digit of the uncertainty."""
    if estimate is None:
        return ''
    value, spread = rounded(estimate, scale)
    return f'{value} ± {spread}' if spread else value


def arc_minutes(estimate: Estimate | None) -> str:
    """Format an angle in arc minutes with its uncertainty."""
    return plus_minus(estimate, ARC_MINUTES)


def play(model: PlayModel | None, unit: str = '') -> str:
    """Format the play by a model, in arc minutes: a value, a limit, or that there is neither.

    Args:
        model: None if there is none.
        unit: follows a number.
    """
    if model is None:
        return ''
    if model.play:
        return f'{arc_minutes(model.play)}{unit}'
    if model.limit is None:
        return 'not separable'
    return f'below {number(model.limit * ARC_MINUTES)}{unit}'


def rounded(estimate: Estimate, scale: float) -> tuple[str, str]:
    """Format a value and its uncertainty, which is empty if unknown."""
    value, spread = estimate.value * scale, estimate.uncertainty
    if not spread:
        return number(value, 4), '' if spread is None else '0'
    spread *= scale
    if spread < abs(value) * _EXACT:
        return number(value, 6), number(spread, 2)
    decimals = max(0, 1 - math.floor(math.log10(spread)))
    # Zero must have no sign.
    return f'{round(value, decimals) + 0.0:.{decimals}f}', f'{spread:.{decimals}f}'


def rate_and_duration(rate: Rate) -> str:
    """Describe how fast the torque of ramps changed."""
    return (
        f'{number(rate.rate)} N·m/s, {number(rate.duration)} s a loop to '
        f'{torque(rate.amplitude)} N·m'
    )


def torque(value: float) -> str:
    """Format a torque."""
    return number(value)
