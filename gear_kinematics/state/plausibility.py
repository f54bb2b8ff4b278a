# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Judges by limits of speed and acceleration whether the rotor can have turned so far.

Each reading is judged at once, by the last ones that were believed. One that the rotor cannot
have reached is doubted. Three doubted ones in a row that agree with each other are believed: as a
motion that the last believed reading only hid, or one beyond the limits, or as a jump.
"""

import math
from enum import Enum
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.state.doubted import AGREEING, agreement, goes_on
from gear_kinematics.state.reach import (
    FLOOR,
    LONGEST_NS,
    REGULAR,
    STALEST,
    Reading,
    RotorLimits,
    regular_bounds,
)
from gear_kinematics.state.statuses import Condition, Fact

_COARSEST = TURN / 6.0  # rad; what a Hall sensor of one pole pair resolves
_EQUAL = 1e-9  # rad, below which steps differ by rounding alone
_MOST_OF = 0.8  # a period: where so much is in reach, nothing is doubted
_MARGIN = 1.5  # of raised limits above what was seen
_STALEST_NS = round(STALEST * 1e9)


class Belief(Enum):
    """The verdict on a reading."""

    BELIEVED = 'believed'
    IMPLAUSIBLE = 'implausible'
    JUMP = 'jump'


BELIEVED = Belief.BELIEVED  # an attribute of an enum is slow for what each message takes


class Jump(NamedTuple):
    """A step of the readings that the rotor did not make."""

    stamp: int  # ns, of the first reading behind it
    size: float  # rad, as far as it was not expected; of a single-turn encoder, within its range


_UNKNOWN = math.nan, 0, 0.0, 0


class Plausibility:
    """Follows the readings of an encoder."""

    def __init__(self, max_speed: float, max_acceleration: float, period: float = 0.0) -> None:
        """Start without readings.

        Args:
            max_speed: rad/s.
            max_acceleration: rad/s².
            period: rad after which the readings repeat; 0: never.
        """
        self.jumps = 0
        self.jump: Jump | None = None  # the latest
        self.restrict(max_speed, max_acceleration, period)
        self.reset()

    def restrict(self, max_speed: float, max_acceleration: float, period: float = 0.0) -> None:
        """Change the limits from now on."""
        self.limits = RotorLimits(max_speed, max_acceleration)
        self.period = period
        self.seen_speed = self.seen_acceleration = 0.0
        """rad/s and rad/s², of motions beyond the limits, which are raised above them."""

    def reset(self) -> None:
        """Forget the readings; the next one is believed."""
        self._doubted: list[tuple[int, float]] = []
        self._last: Reading = _UNKNOWN
        self._former: Reading = _UNKNOWN
        self._moving: Reading = _UNKNOWN  # the last one before a standstill
        self._stamp = 0  # ns, of the last believed reading with the last position
        self.finest = _COARSEST
        """rad, the resolution of the encoder: the smallest step of all, or difference between two
        in a row; not less than matters, which is half of `FLOOR`."""
        self._look_always()

    @property
    def jumped(self) -> Fact | None:
        """The last jump of the encoder, if there was one."""
        jump = self.jump
        return Condition.JUMPED(angle=jump.size, time=jump.stamp / 1e9) if jump else None

    @property
    def beyond_limits(self) -> Fact | None:
        """How the rotor has moved beyond its limits, and which these are, if it has."""
        which = []
        if self.seen_speed:
            which.append(Condition.BEYOND_SPEED(speed=self.seen_speed))
        if self.seen_acceleration:
            which.append(Condition.BEYOND_ACCELERATION(acceleration=self.seen_acceleration))
        return Condition.BEYOND_LIMITS(which=which) if which else None

    def set_back(self, time: int) -> None:
        """Note that the clock was set back by so much, ns, since the last reading."""
        position, changed, step, span = self._last
        self._last = position, changed - time, step, span
        self._stamp -= time

    def judge(self, position: float, stamp: int) -> Belief:
        """Take the next reading, rad, with a stamp, ns, not before the last believed one."""
        last = self._last
        before, changed, former, _ = last
        step = position - before
        even, square, shortest, longest = self._even
        if 0.0 < step * step <= square and -even <= step - former <= even:
            span = stamp - changed
            if shortest <= span <= longest:
                self._former = last
                self._last = position, stamp, step, span
                self._stamp = stamp
                return BELIEVED
        elif not (step or former or self._doubted):  # it stands
            self._stamp = stamp
            return BELIEVED
        return self._look_closer(position, step, stamp)

    def believes(self, stamps: NDArray[np.int64], positions: NDArray[np.float64]) -> bool:
        """Take readings in order of time if `judge` would believe each; else change nothing."""
        if self.period or not len(stamps):
            return not len(stamps)
        fresh = math.isnan(self._last[0])
        if fresh:
            self._restart(float(positions[0]), int(stamps[0]))
        if not self._doubted and self._moves_evenly(stamps, positions):
            return True
        if self._doubted or not self._believes(stamps, positions):
            if fresh:
                self.reset()
            return False
        return True

    def _moves_evenly(self, stamps: NDArray[np.int64], positions: NDArray[np.float64]) -> bool:
        """Take readings as `_believes`, if each has moved in a regular time by a regular step."""
        position, since, last, last_span = self._last
        if self._stamp - since > _STALEST_NS or self.finest > 0.5 * FLOOR:
            return False
        bounds = regular_bounds(stamps, since, last_span, self._former[3], self.limits)
        steps = np.diff(positions, prepend=position)
        if bounds is None or len(steps) == 1 or not steps.all():
            return False
        evenness, most = bounds
        changes = np.diff(steps, prepend=last)
        if not ((np.abs(changes) <= evenness) & (np.abs(steps) <= most)).all():
            return False
        earlier, before, now = [since, *stamps[-3:].tolist()][-3:]
        self._former = (float(positions[-2]), before, float(steps[-2]), before - earlier)
        self._last = (float(positions[-1]), now, float(steps[-1]), now - before)
        self._stamp = now
        self._look_always()
        return True

    def _believes(self, stamps: NDArray[np.int64], positions: NDArray[np.float64]) -> bool:
        position, since, *last = self._last
        *_, former_step, former_span = self._former
        steps = np.diff(positions, prepend=position)
        rows = np.flatnonzero(steps)
        when, steps = stamps[rows], steps[rows]
        changed = np.concatenate([[since], when])
        until = np.append(np.concatenate([[self._stamp], stamps[:-1]])[rows], stamps[-1])
        stood = np.append(False, until - changed > _STALEST_NS)
        # The step and the span up to each position; none after a standstill.
        moved = np.concatenate([[former_step, last[0]], steps])
        spans = np.diff(changed)
        started = stood[1:-1] & (when > until[:-1])
        spans[started] = (when - until[:-1])[started]
        took = np.concatenate([[former_span, last[1]], spans])
        ended = stood & (moved != 0.0)
        step, span = np.where(ended, 0.0, moved), np.where(ended, 0, took)
        # Steps of the same stamp, which are added up, and abrupt stops are left to `judge`.
        if np.any(when == changed[:-1]):
            return False
        sizes = np.abs([steps, steps - step[1:-1]])
        sizes = np.where(sizes > _EQUAL, sizes, _COARSEST).min(axis=0)
        finest = np.minimum.accumulate(np.append(self.finest, np.maximum(sizes, 0.5 * FLOOR)))
        moving = self._moving
        for k in np.flatnonzero(ended).tolist():
            ends = (0.0, 0, moved[k], took[k]), (0.0, 0, step[k - 1], span[k - 1])
            if self.limits.least_speed(*ends, finest[k - 1]):
                return False
            where = float(positions[rows[k - 2]]) if k > 1 else position
            moving = where, int(changed[k - 1]), float(moved[k]), int(took[k])
        usual = 0.5 * (span[1:-1] + span[:-2])
        regular = usual <= LONGEST_NS
        for each in (span[1:-1], np.diff(changed)):
            regular &= np.abs(each - usual) <= REGULAR * usual
        regular &= np.abs(steps - step[1:-1]) <= self.limits.even_step(usual)
        regular &= np.abs(steps) <= self.limits.speed * 1e-9 * np.diff(changed)
        for k in np.flatnonzero(~regular).tolist():
            ends = (
                (0.0, int(changed[k]), float(step[k + 1]), int(span[k + 1])),
                (0.0, 0, float(step[k]), int(span[k])),
            )
            low, high = self.limits.reach(int(when[k]), int(until[k]), *ends, float(finest[k]))
            if not low <= steps[k] <= high:
                return False
        position, self._moving = float(positions[-1]), moving
        if len(rows):
            before = float(positions[rows[-2]]) if len(rows) > 1 else self._last[0]
            self._former = (before, int(changed[-2]), float(step[-2]), int(span[-2]))
        self._last = (position, int(changed[-1]), float(step[-1]), int(span[-1]))
        self._stamp, self.finest = int(stamps[-1]), float(finest[-1])
        self._look_always()
        return True

    def _look_always(self) -> None:
        self._even = -1.0, 0.0, 0, 0
        """rad, rad², ns, ns: a step that differs from the last by at most so much, and whose
        square is no greater, in a time within these limits, is in reach, and tells no more of the
        resolution."""

    def _look_closer(self, position: float, step: float, stamp: int) -> Belief:
        """Judge a reading by all that is known."""
        last, former = self._last, self._former
        before, changed, last_step, last_span = last
        if math.isnan(before):
            self._restart(position, stamp)
            return BELIEVED
        if not step:
            return self._hold(position, stamp)
        if self.period:
            step = last_step + math.remainder(step - last_step, self.period)
        low, high = self.limits.reach(stamp, self._stamp, last, former, self.finest)
        if self.period:
            middle = 0.5 * (low + high)
            step = middle + math.remainder(step - middle, self.period)
        reached = low <= step <= high or high - low > _MOST_OF * self.period > 0.0
        if not reached or (self._doubted and self._stays(position, step, stamp)):
            return self._doubt(position, stamp)
        self._doubted.clear()
        for size in (abs(step), abs(step - last_step)):
            if _EQUAL < size < self.finest:
                self.finest = max(size, 0.5 * FLOOR)
        span = stamp - changed
        if self._stamp - changed > _STALEST_NS:  # it stood until then
            span = stamp - self._stamp or span
        if not span:
            self._last = position, changed, last_step + step, last_span
        else:
            self._former, self._last = last, (position, stamp, step, span)
        self._stamp = stamp
        self._look_always()
        usual = (span + last_span) // 2
        if usual <= LONGEST_NS:
            shortest, longest = (1.0 - REGULAR) * usual, (1.0 + REGULAR) * usual
            if shortest <= span <= longest:
                # A step that differs tells of the resolution, as long as that is coarse.
                known = self.finest == 0.5 * FLOOR
                even = self.limits.even_step(usual) if known else _EQUAL
                if self.period:
                    even = min(even, 0.25 * self.period)
                most = self.limits.speed * shortest * 1e-9
                self._even = even, most * most, math.ceil(shortest), int(longest)
        return BELIEVED

    def _hold(self, position: float, stamp: int) -> Belief:
        """Judge a reading that repeats the last position.

        A rotor that has turned fast cannot stand at once.
        """
        held = stamp - self._last[1]
        if held > _STALEST_NS:
            time = held * 1e-9 - STALEST
            if speed := self.limits.least_speed(self._last, self._former, self.finest):
                way = speed * time - 0.5 * self.limits.acceleration * time * time
                if way > max(FLOOR, 2.0 * self.finest):
                    return self._doubt(position, stamp)
            if not speed or time > 2.0 * speed / self.limits.acceleration:
                if self._last[2]:
                    self._moving = self._last
                self._last = *self._last[:2], 0.0, 0
                self._look_always()
        self._stamp = stamp
        self._doubted.clear()
        return BELIEVED

    def _stays(self, position: float, step: float, stamp: int) -> bool:
        """Whether a reading is nearer to the last doubted one than to what was expected."""
        _, doubted = self._doubted[-1]
        expected = self._speed() * (stamp - self._stamp) * 1e-9
        return abs(self._wrapped(position - doubted)) < abs(step - expected)

    def _speed(self) -> float:
        """The speed at the last believed reading, rad/s."""
        *_, step, span = self._last
        return step / (span * 1e-9) if span else 0.0

    def _restart(self, position: float, stamp: int) -> None:
        self.reset()
        self._last, self._stamp = (position, stamp, 0.0, 0), stamp

    def _doubt(self, position: float, stamp: int) -> Belief:
        """Note a reading that is out of reach, and see whether it agrees with those before."""
        self._doubted = [*self._doubted[1 - AGREEING :], (stamp, position)]
        if len(self._doubted) < AGREEING:
            return Belief.IMPLAUSIBLE
        found = agreement(self._doubted, self.limits, self.finest, self.period)
        if not found:
            return Belief.IMPLAUSIBLE
        speed, step, span, stale, within = found
        began, where = self._doubted[0]
        first = self._wrapped(where - self._last[0])
        elapsed = (began - (self._stamp if first else self._last[1])) * 1e-9
        before = self._speed()
        way = abs(speed) * (elapsed + stale) + max(FLOOR, 2.0 * self.finest)
        continuous = first * speed >= 0.0 and abs(first) <= way and not self.period
        if abs(speed) > self.limits.speed:
            self.seen_speed = abs(speed)
            self.limits = self.limits._replace(speed=_MARGIN * abs(speed))
        moved = self._last[2] != 0.0
        motion = self._former if moved else self._moving
        if not self.period and goes_on(
            motion, began, where, speed, self.limits, self.finest, stood=not moved
        ):
            continuous = True
        elif continuous:
            seen = abs(speed - before) / max(elapsed + stale, 1e-9)
            if within and seen > self.limits.acceleration:
                self.seen_acceleration = seen
                if speed:
                    self.limits = self.limits._replace(acceleration=_MARGIN * seen)
        else:
            self.jumps += 1
            self.jump = Jump(began, self._wrapped(first - before * elapsed))
        last, finest = self._last, self.finest
        self._restart(position, stamp)
        self.finest = finest
        if continuous and not speed:
            self._moving = last
        if span:
            self._last = position, stamp, step, span
        return Belief.BELIEVED if continuous else Belief.JUMP

    def _wrapped(self, step: float) -> float:
        return math.remainder(step, self.period) if self.period else step
