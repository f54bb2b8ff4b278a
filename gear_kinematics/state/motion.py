# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Follows the motion of a rotor over many readings at once, while each is within its reach."""

from collections.abc import Iterable
from typing import NamedTuple

import numpy as np

from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.state.reach import (
    FLOOR,
    REGULAR,
    STALEST,
    HeldUp,
    Reading,
    RotorLimits,
    single_precision_step,
)
from gear_kinematics.state.wraps import LEAST_STEP
from gear_kinematics.wire.batches import Array, once_for_joints

COARSEST = TURN / 6.0  # rad; what a Hall sensor of one pole pair resolves
EQUAL = 1e-9  # rad, below which steps differ by rounding alone
_SINGLE = 2.0**-21  # the same of numbers of 24 bits, of their size
STALEST_NS = round(STALEST * 1e9)
LONGEST_NS = 12_000_000  # between readings for which a look at the step alone may be enough


class Motion(NamedTuple):
    """The latest believed readings; see `Plausibility`."""

    last: Reading
    former: Reading
    moving: Reading
    stamp: int  # ns, of the last one with the last position
    noise: float  # rad
    held_up: HeldUp


def all_in_reach(
    known: Motion, limits: RotorLimits, stamps: Array, positions: Array
) -> Motion | None:
    """Take further readings in order of time, as `Plausibility.judge` takes them one by one.

    Stamps, ns, and positions, rad, are (n,), n > 0. The motion with them is returned; None if not
    each of them would be believed at once.
    """
    if found := _even(known, limits, stamps, positions):
        return found
    position, since, last_step, last_span = known.last
    *_, former_step, former_span = known.former
    former, moving = known.former, known.moving
    steps = np.diff(positions, prepend=position)
    gaps, pauses = np.diff(stamps, prepend=known.stamp), [known.held_up]
    held = (steps == 0.0) & (gaps > STALEST_NS)
    for stamp, gap in zip(stamps[held].tolist(), gaps[held].tolist(), strict=True):
        pauses.append(pauses[-1].at_rest(stamp - gap, stamp))
    seen = held.cumsum()
    rows = np.flatnonzero(steps)
    when, steps = stamps[rows], steps[rows]
    changed = np.concatenate([[since], when])
    until = np.append(np.concatenate([[known.stamp], stamps[:-1]])[rows], stamps[-1])
    stood = np.append(False, until - changed > STALEST_NS)
    # The step and the span up to each position; none after a standstill.
    moved = np.concatenate([[former_step, last_step], steps])
    spans = np.diff(changed)
    started = stood[1:-1] & (when > until[:-1])
    spans[started] = (when - until[:-1])[started]
    took = np.concatenate([[former_span, last_span], spans])
    ended = stood & (moved != 0.0)
    step, span = np.where(ended, 0.0, moved), np.where(ended, 0, took)
    # Left to `judge`: steps of the same stamp, which are added up, abrupt stops, and what may be
    # a wrap or a wrong reading.
    if np.any(when == changed[:-1]) or np.any(np.abs(moved[1:]) > LEAST_STEP):
        return None
    noise = np.full(len(rows) + 1, known.noise)
    if known.noise > FLOOR:
        sizes, ends = np.abs([steps, steps - step[1:-1]]), [position, *positions[rows].tolist()]
        fine = (sizes > EQUAL) & (sizes < 0.5 * known.noise)
        for k in np.flatnonzero(fine.any(axis=0)).tolist():
            noise[k + 1 :] = finer(float(noise[k]), sizes[:, k].tolist(), ends[k + 1], ends[k])
            if noise[k + 1] == FLOOR:
                break
    usual = 0.5 * (span[1:-1] + span[:-2])
    regular = usual <= LONGEST_NS
    for each in (span[1:-1], np.diff(changed)):
        regular &= np.abs(each - usual) <= REGULAR * usual
    regular &= np.abs(steps - step[1:-1]) <= limits.even_step(usual)
    regular &= np.abs(steps) <= limits.speed * 1e-9 * np.diff(changed)
    places = [known.former[0], position, *positions[rows].tolist()]
    held_up = known.held_up
    for k in np.flatnonzero(ended[1:] | np.append(~regular, False)).tolist():
        place, began = places[k + 1], int(changed[k])
        prior_stamp = int(until[k - 1]) if k else known.former[1]
        prior = places[k], prior_stamp, float(step[k]), int(span[k])
        if ended[k + 1]:
            moving = place, began, float(moved[k + 1]), int(took[k + 1])
            if limits.least_speed(moving, prior, noise[k], held_up):
                return None
        if k < len(rows) and not regular[k]:
            last = place, began, float(step[k + 1]), int(span[k + 1])
            held_up = max(held_up, pauses[seen[rows[k]]])  # the later one
            held_up = held_up.before(int(when[k]) - began, last, prior)
            times = int(until[k]), int(when[k])
            if moving[1] == began and limits.continues(moving, *times, steps[k], noise[k]):
                return None
            reach = limits.reach(times[1], times[0], last, prior, noise[k], held_up)
            if not reach[0] <= steps[k] <= reach[1]:
                return None
            if limits.takes_back(times[1], steps[k], last, prior, noise[k], held_up):
                return None
    if len(rows):
        before = float(positions[rows[-2]]) if len(rows) > 1 else position
        former = before, int(until[-2]), float(step[-2]), int(span[-2])
    latest = float(positions[-1]), int(changed[-1]), float(step[-1]), int(span[-1])
    held_up = max(held_up, pauses[-1])
    return Motion(latest, former, moving, int(stamps[-1]), float(noise[-1]), held_up)


def finer(noise: float, steps: Iterable[float], position: float, *others: float) -> float:
    """Return the noise of readings, rad, as far as steps to a position show that it is less.

    The others are the position before and what positions repeat after.
    """
    if noise <= FLOOR:
        return noise
    sizes = [size for size in map(abs, steps) if EQUAL < size < 0.5 * noise]
    if sizes and single_precision_step(position):
        rounding = _SINGLE * max(map(abs, (position, *others)))
        sizes = [size for size in sizes if size > rounding]
    return max(2.0 * min(sizes), FLOOR) if sizes else noise


def _even(known: Motion, limits: RotorLimits, stamps: Array, positions: Array) -> Motion | None:
    """Take readings as `all_in_reach`, if the rotor moved on in even steps and regular times."""
    position, since, last, last_span = known.last
    if known.stamp - since > STALEST_NS or known.noise > FLOOR or len(stamps) == 1:
        return None
    bounds = _bounds(stamps, since, last_span, known.former[3], limits)
    steps = np.diff(positions, prepend=position)
    if not bounds or not steps.all():
        return None
    evenness, most = bounds
    changes = np.diff(steps, prepend=last)
    if not ((np.abs(changes) <= evenness) & (np.abs(steps) <= most)).all():
        return None
    earlier, before, now = [since, *stamps[-3:].tolist()][-3:]
    former = float(positions[-2]), before, float(steps[-2]), before - earlier
    latest = float(positions[-1]), now, float(steps[-1]), now - before
    return Motion(latest, former, known.moving, now, known.noise, known.held_up)


@once_for_joints
def _bounds(
    stamps: Array, since: int, last_span: int, former_span: int, limits: RotorLimits
) -> tuple[Array, Array] | None:
    """Return by how much each step may differ from the last one, and its most, rad, each (n,).

    The stamp `since` is that of the reading before; the times from one reading to the next until
    then were `former_span` and `last_span`; all in ns. Without regular times it is None.
    """
    spans = np.diff(stamps, prepend=since)
    former = np.concatenate([[former_span, last_span], spans])
    usual = 0.5 * (former[1:-1] + former[:-2])
    regular = (usual <= LONGEST_NS) & (spans > 0)
    for each in (former[1:-1], spans):
        regular &= np.abs(each - usual) <= REGULAR * usual
    if not regular.all():
        return None
    return limits.even_step(usual), limits.speed * 1e-9 * spans
