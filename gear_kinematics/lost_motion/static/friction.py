"""The friction on middle lines: what of it has not built up yet, and what a gap adds to it.

P. R. Dahl, A solid friction model, Aerospace Corporation TOR-0158(3107-18)-1 (1968): after a
reversal, friction approaches its value over some way. Until then one half of a loop lies nearer
to the spring than the other, so that the friction and the load that are read are off by the same.
"""

import math
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from gear_kinematics.lost_motion.static.midline import Midlines
from gear_kinematics.lost_motion.static.ramps import Array
from gear_kinematics.state.uncertainty import Component, Estimate, by_steps, resolution

_SHARES = np.linspace(0.1, 0.95, 18)
"""Loads, as shares of the greatest load of a loop, at which the friction is compared."""
_FAR, _NEAR = slice(0, 9), slice(-3, None)
"""Up to half of the load, where friction has built up, and above 80 %, where it may not have."""
_HARDLY = 20
"""Power of a weight that falls along a straight line; its mean is at a twentieth of the load."""
_DECLINES = np.geomspace(1.5, 12.0, 25)
"""Greatest load over that within which friction builds up to all but 1/e."""
_CLEAR = 0.02
"""Share of the friction that is missing there, if it builds up visibly."""
_HALF_DIFFERENCE = math.sqrt(0.5)
"""Standard uncertainty of half of the difference of two readings, over that of a reading."""


def friction_of(lines: Midlines, angle_step: float) -> tuple[Estimate, Estimate | None]:
    """Return the friction without load, and its growth with the load if that is significant.

    Args:
        lines: middle lines.
        angle_step: rad, between readings of the encoder; 0 if unknown.

    Returns:
        The friction, N·m, and the share of the load that adds to it, or None.
    """
    load = np.abs(lines.load)
    # What is at no load counts most.
    weight = 1.0 - load / (1.01 * np.max(load, axis=1, keepdims=True))
    fits = [
        np.polynomial.polynomial.polyfit(x, f, 1, w=w)
        for x, f, w in zip(load, lines.friction, weight, strict=True)
    ]
    growth = _significant(Estimate.of_mean([float(fit[1]) for fit in fits]))
    stiffness = float(np.mean(np.ptp(lines.load, axis=1) / np.ptp(lines.angle, axis=1)))
    # The gear is read at so many steps of its encoder, but between the same samples of the torque.
    angles = max(1.0, 2.0 * lines.reach / angle_step) if angle_step else 1.0
    angle = _HALF_DIFFERENCE * stiffness * resolution(angle_step) / math.sqrt(angles)
    reading = by_steps(math.hypot(angle, _between_samples(lines)), len(fits))
    if growth:
        # Friction may be the same at small loads, and grow from somewhere on.
        hardly = np.average(lines.friction, axis=1, weights=weight**_HARDLY)
        more = 0.5 * (hardly - [fit[0] for fit in fits])
        bend = Component(abs(float(np.mean(more))))
        return Estimate.of_mean((hardly - more).tolist(), reading, bend), growth
    means = np.average(lines.friction, axis=1, weights=weight**4)
    # Friction that builds up after a reversal, or depends on the angle, differs from load to load.
    uneven = float(np.mean(means)) - float(np.mean([fit[0] for fit in fits]))
    return Estimate.of_mean(means.tolist(), reading, Component(uneven / math.sqrt(3.0))), None


def _between_samples(lines: Midlines) -> float:
    """Standard uncertainty of the friction by the spacing of the samples of the torque, N·m."""
    return _HALF_DIFFERENCE * resolution(lines.spacing)


def more_within(
    lines: Midlines, within: NDArray[np.bool_], beyond: NDArray[np.bool_]
) -> Estimate | None:
    """Return by how much the friction in a gap exceeds that beyond it, if that is significant.

    A gear moves faster through its gap. The torque that this needs is read as friction, and, as it
    is greatest where the gear leaves the gap, as a load at both ends of it.

    Args:
        lines: middle lines.
        within: (levels,), which of them are in the gap.
        beyond: (levels,), which are beyond it.
    """
    if not (within.any() and beyond.any()):
        return None
    friction = lines.friction
    more = np.mean(friction[:, within], axis=1) - np.mean(friction[:, beyond], axis=1)
    return _significant(Estimate.of_mean(more.tolist(), Component(_between_samples(lines))))


def _significant(found: Estimate) -> Estimate | None:
    """Return an estimate whose interval lies above zero, else None."""
    return found if found.uncertainty is not None and found.value > found.uncertainty else None


class BuildUp(NamedTuple):
    """Friction that builds up slowly after a reversal."""

    near: Estimate
    """N·m, of it that are missing near the peaks."""
    rest: float
    """N·m, of it that may still be missing without load."""


def without_build_up(lines: Midlines) -> tuple[Midlines, BuildUp | None]:
    """Move the missing friction from the loads to the friction, if it is significant.

    Returns:
        Middle lines with the friction that is missing near the peaks, and what that is; or the
        same ones and None.
    """
    sides = [
        (sign * load[::sign], friction[::sign], sign * load[::sign] > 0.0)
        for load, friction in zip(lines.load, lines.friction, strict=True)
        for sign in (1, -1)
    ]
    if not all(np.any(away) for _, _, away in sides):
        return lines, None
    friction = np.array([_at_shares(load[away], friction[away]) for load, friction, away in sides])
    full = np.mean(friction[:, _FAR], axis=1)
    missing = full[:, None] - friction
    near = Estimate.of_mean(np.mean(missing[:, _NEAR], axis=1).tolist())
    if near.value <= max(near.uncertainty or 0.0, _CLEAR * float(np.mean(full))):
        return lines, None
    # The longer the way since the reversal, the less is missing.
    mean = np.maximum.accumulate(np.maximum(np.mean(missing, axis=0), 0.0))
    off = [
        np.sign(load) * np.interp(np.abs(load) / np.max(np.abs(load)), _SHARES, mean)
        for load in lines.load
    ]
    built = replace(lines, load=lines.load - off, friction=lines.friction + np.abs(off))
    return built, BuildUp(near, _rest(np.mean(friction, axis=0)))


def _rest(friction: Array) -> float:
    """What may be missing without load, N·m, of the friction at shares of the greatest load.

    Each branch lacks what falls exponentially with the load since its reversal, at either peak, so
    that both together lack a hyperbolic cosine of the load.
    """
    fits = []
    for decline in _DECLINES:
        columns = np.stack([np.ones_like(_SHARES), -np.cosh(decline * _SHARES)], axis=1)
        solution = np.linalg.lstsq(columns, friction)[0]
        fits.append((float(np.sum((friction - columns @ solution) ** 2)), float(solution[1])))
    return max(0.0, min(fits)[1])


def _at_shares(load: Array, friction: Array) -> Array:
    """The friction at shares of the greatest load, of one side of a loop."""
    rising = np.maximum.accumulate(load)
    found: Array = np.interp(_SHARES * rising[-1], rising, friction)
    return found
