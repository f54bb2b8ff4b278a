# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Judges by limits of speed and acceleration whether the rotor can have turned so far.

A reading may be up to an interval, at most `STALEST`, older than its stamp says: stamps are late
or early, and drivers repeat a reading until the next. Each reading is judged at once, by the last
ones that were believed. One that the rotor cannot have reached is doubted. Three doubted ones in
a row that agree with each other are believed, as a jump or as a motion beyond the limits.
"""

import math
from enum import Enum
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from gear_kinematics.kinematics.rotor_turns import TURN

STALEST = 0.01
"""s; a reading is at most so much, or an interval if that is less, older than its stamp says."""
FLOOR = 0.05
"""rad: noise of any encoder, and what two successive steps may always differ by."""
_COARSEST = TURN / 6.0  # rad; what a Hall sensor of one pole pair resolves
_EQUAL = 1e-9  # rad, below which steps differ by rounding alone
_AGREEING = 3  # doubted readings in a row that are believed
_MOST_OF = 0.8  # a period: where so much is in reach, nothing is doubted
_MARGIN = 1.5  # of raised limits above what was seen


class Verdict(Enum):
    """What a reading is."""

    BELIEVED = 'believed'
    IMPLAUSIBLE = 'implausible'
    JUMP = 'jump'


BELIEVED = Verdict.BELIEVED  # an attribute of an enum is slow for what each message takes


class Jump(NamedTuple):
    """A step that the rotor did not make."""

    stamp: int
    """ns, of the first reading behind it."""
    size: float
    """rad, as far as it was not expected; of a single-turn encoder, within its range."""


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
        self.jump: Jump | None = None
        """The latest."""
        self.restrict(max_speed, max_acceleration, period)
        self.reset()

    def restrict(self, max_speed: float, max_acceleration: float, period: float = 0.0) -> None:
        """Change the limits from now on."""
        self.max_speed, self.max_acceleration = max_speed, max_acceleration
        self.period = period
        self.seen_speed = self.seen_acceleration = 0.0
        """rad/s and rad/s², of motions beyond the limits, which are raised above them."""

    def reset(self) -> None:
        """Forget the readings; the next one is believed."""
        self._doubted: list[tuple[int, float]] = []
        self._position = math.nan  # of the last believed reading, rad
        self._stamp = 0  # of it, ns
        self._changed = 0  # ns, when a believed reading was the first with that position
        self._step, self._span = 0.0, 0  # rad and ns, between the last two of those
        self._former = 0  # ns, the span before
        self.finest = _COARSEST
        """rad, the smallest step of all."""

    @property
    def jumped(self) -> str:
        """The last jump of the encoder, with its size and time; '' if there was none."""
        if not (jump := self.jump):
            return ''
        stamp = f'{jump.stamp / 1e9:.3f} s'
        return f"the rotor's encoder jumped by {jump.size:.4g} rad at {stamp}"

    @property
    def beyond_limits(self) -> str:
        """How the rotor has moved beyond its limits, and which these are; '' if it has not."""
        found = []
        if self.seen_speed:
            found.append(f'{self.seen_speed:.4g} rad/s exceed max_rotor_speed')
        if self.seen_acceleration:
            found.append(f'{self.seen_acceleration:.4g} rad/s² exceed max_rotor_acceleration')
        return ', '.join(found)

    def judge(self, position: float, stamp: int) -> Verdict:
        """Take the next reading, rad, with a stamp, ns, not before the last believed one."""
        step = position - self._position
        verdict = BELIEVED
        if step:
            change = step - self._step
            if self.period:
                change = math.remainder(change, self.period)
                step = self._step + change
            if not -FLOOR <= change <= FLOOR:
                verdict, step = self._look_closer(position, step, stamp)
                if verdict is not BELIEVED or not step:
                    return verdict
            self._note(step, stamp)
        self._position, self._stamp = position, stamp
        if self._doubted:
            self._doubted.clear()
        return verdict

    def believes(self, stamps: NDArray[np.int64], positions: NDArray[np.float64]) -> bool:
        """Take readings in order of time if `judge` would believe each; else change nothing."""
        if self.period or not len(stamps):
            return not len(stamps)
        fresh = math.isnan(self._position)
        if fresh:
            self._restart(float(positions[0]), int(stamps[0]))
        if self._doubted or not self._believes(stamps, positions):
            if fresh:
                self.reset()
            return False
        return True

    def _believes(self, stamps: NDArray[np.int64], positions: NDArray[np.float64]) -> bool:
        steps = np.diff(positions, prepend=self._position)
        changed = np.flatnonzero(steps)
        steps, when = steps[changed], stamps[changed]
        before = np.concatenate([[self._changed], when[:-1]])
        # Steps of the same stamp are added up, which is left to `judge`.
        if np.any(when == before):
            return False
        former = np.concatenate([[self._step], steps[:-1]])
        spans = np.concatenate([[self._former, self._span], when - before])
        sizes = np.where(np.abs(steps) > _EQUAL, np.abs(steps), _COARSEST)
        finest = np.minimum.accumulate(np.concatenate([[self.finest], sizes]))
        last = np.concatenate([[self._stamp], stamps[:-1]])[changed]
        far = np.abs(steps - former) > FLOOR
        columns = (steps, when, before, last, former, spans[1:-1], spans[:-2], finest[:-1])
        for step, *row in zip(*(column[far].tolist() for column in columns), strict=True):
            low, high = self._reach(*row)
            if not low <= step <= high:
                return False
        if len(when):
            self._changed, self._step = int(when[-1]), float(steps[-1])
            self._former, self._span = spans[-2:].tolist()
            self.finest = float(finest[-1])
        self._position, self._stamp = float(positions[-1]), int(stamps[-1])
        return True

    def _note(self, step: float, stamp: int) -> None:
        size = abs(step)
        if _EQUAL < size < self.finest:
            self.finest = size
        if stamp == self._changed:
            self._step += step
        else:
            self._former, self._span = self._span, stamp - self._changed
            self._step, self._changed = step, stamp

    def _look_closer(self, position: float, step: float, stamp: int) -> tuple[Verdict, float]:
        """Judge a step that differs from the last; 0 as the step to believe is none."""
        if math.isnan(self._position):
            self._restart(position, stamp)
            return Verdict.BELIEVED, 0.0
        state = self._changed, self._stamp, self._step, self._span, self._former
        low, high = self._reach(stamp, *state, self.finest)
        if self.period:
            middle = 0.5 * (low + high)
            step = middle + math.remainder(step - middle, self.period)
        reached = low <= step <= high or high - low > _MOST_OF * self.period > 0.0
        if reached and not (self._doubted and self._stays(position, step, stamp)):
            return Verdict.BELIEVED, step
        return self._doubt(position, stamp), 0.0

    def _stays(self, position: float, step: float, stamp: int) -> bool:
        """Whether a reading is nearer to the last doubted one than to what was expected."""
        _, doubted = self._doubted[-1]
        expected = self._speed() * (stamp - self._stamp) * 1e-9
        return abs(self._wrapped(position - doubted)) < abs(step - expected)

    def _speed(self) -> float:
        """The speed at the last believed reading, rad/s."""
        standing = not self._span or (self._stamp - self._changed) * 1e-9 > STALEST
        return 0.0 if standing else self._step / (self._span * 1e-9)

    def _reach(
        self,
        stamp: int,
        changed: int,
        last: int,
        step: float,
        span: int,
        former: int,
        finest: float,
    ) -> tuple[float, float]:
        """The least and the greatest step, rad, that the rotor can make until a stamp.

        Args:
            stamp: ns.
            changed: stamp of the reading from which the step is.
            last: stamp of the last reading with that position.
            step: rad, the step before.
            span: ns, in which that was made; 0: it is not known.
            former: ns, the span before.
            finest: rad, the smallest step until now.
        """
        noise = max(FLOOR, 2.0 * finest)
        speed, doubt, stale = 0.0, self.max_speed, STALEST
        elapsed, held = (stamp - changed) * 1e-9, (last - changed) * 1e-9
        if held > STALEST:  # it stands, as far as its last readings tell
            elapsed = (stamp - last) * 1e-9
            doubt = self.max_acceleration * min(held, 2.0 * elapsed)
        elif span:
            stale, within = min(STALEST, 1.25e-9 * max(span, former)), span * 1e-9
            speed = step / within
            doubt = self.max_acceleration * (within + stale) + noise / within
            doubt += 0.25 * abs(speed)  # stamps are late by less than they could be
        time = elapsed + stale
        way, gained = self.max_speed * time, 0.5 * self.max_acceleration * time * time
        high = min(way, max(0.0, min(self.max_speed, speed + doubt) * time + gained))
        low = max(-way, min(0.0, max(-self.max_speed, speed - doubt) * time - gained))
        return low - noise, high + noise

    def _restart(self, position: float, stamp: int) -> None:
        self.reset()
        self._position, self._stamp, self._changed = position, stamp, stamp

    def _doubt(self, position: float, stamp: int) -> Verdict:
        """Note a reading that is out of reach, and see whether it agrees with those before."""
        self._doubted = [*self._doubted[1 - _AGREEING :], (stamp, position)]
        if len(self._doubted) < _AGREEING:
            return Verdict.IMPLAUSIBLE
        times, positions = zip(*self._doubted, strict=True)
        spans = [(b - a) * 1e-9 for a, b in pairwise(times)]
        steps = [self._wrapped(b - a) for a, b in pairwise(positions)]
        stale = min(STALEST, max(spans))
        noise = max(FLOOR, 2.0 * self.finest)
        total = sum(spans)
        if total < 0.0:
            return Verdict.IMPLAUSIBLE
        speed = sum(steps) / total if total else 0.0
        slack = noise + self.max_acceleration * total * total
        uneven = max(abs(s - speed * t) for s, t in zip(steps, spans, strict=True))
        within = all(
            abs(s) <= self.max_speed * (t + stale) + noise
            for s, t in zip(steps, spans, strict=True)
        )
        if uneven > slack + abs(speed) * stale or not (within or total):
            return Verdict.IMPLAUSIBLE
        first = self._wrapped(positions[0] - self._position)
        elapsed = (times[0] - self._stamp) * 1e-9
        before = self._speed()
        way = abs(speed) * (elapsed + stale) + noise
        continuous = first * speed >= 0.0 and abs(first) <= way and not self.period
        if abs(speed) > self.max_speed:
            self.seen_speed = abs(speed)
            self.max_speed = _MARGIN * abs(speed)
        if continuous:
            seen = abs(speed - before) / max(elapsed + stale, 1e-9)
            if within and seen > self.max_acceleration:
                self.seen_acceleration = seen
                self.max_acceleration = _MARGIN * seen
        else:
            self.jumps += 1
            self.jump = Jump(times[0], self._wrapped(first - before * elapsed))
        finest = self.finest
        self._restart(position, stamp)
        self.finest = finest
        if spans[-1]:
            self._step, self._span = steps[-1], times[-1] - times[-2]
        return Verdict.BELIEVED if continuous else Verdict.JUMP

    def _wrapped(self, step: float) -> float:
        return math.remainder(step, self.period) if self.period else step
