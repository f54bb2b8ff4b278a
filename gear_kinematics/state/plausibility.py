# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Judges by limits of speed and acceleration whether the rotor can have turned so far.

Each reading is judged at once, by the last believed ones. A reading that the rotor cannot have
reached is doubted. Three doubted readings in a row that agree with each other are believed: as a
motion that a wrong last reading had hidden, as a motion beyond the limits, or as a jump.
"""

import math
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from gear_kinematics.state.belief import BELIEVED, Belief
from gear_kinematics.state.disorder import Alternation
from gear_kinematics.state.motion import (
    COARSEST,
    EQUAL,
    LONGEST_NS,
    STALEST_NS,
    Motion,
    all_in_reach,
    finer,
)
from gear_kinematics.state.reach import (
    FLOOR,
    HELD_UP_AT_FIRST,
    REGULAR,
    STALEST,
    HeldUp,
    Reading,
    Repeats,
    RotorLimits,
    single_precision_step,
)
from gear_kinematics.state.statuses import Condition, Fact
from gear_kinematics.state.wraps import LEAST_STEP, Wraps

_AGREEING = 3  # doubted readings in a row that are believed
_MOST_OF = 0.8  # a period: where so much is in reach, nothing is doubted
_MARGIN = 1.5  # of raised limits above what was seen
_MOST_BEYOND = 2.0  # times the limit: speeds at which a driver may repeat readings
_FEW_STEPS = 3.0  # between readings: what a drive whose clock begins anew may turn meanwhile
_LONGER = 1.5  # times what was seen: for which a driver repeats readings, as stamps are uneven
_SHORTER = 4  # times than a repeated reading lasts: two intervals that end the repeats
_UPTIME = 10**17  # ns, 3 years: stamps below are the time since a start, no date
_UNKNOWN = math.nan, 0, 0.0, 0


class Plausibility:
    """Follows the readings of an encoder."""

    def __init__(self, max_speed: float, max_acceleration: float, period: float = 0.0) -> None:
        """Start without readings, which repeat after a period, rad; 0: never.

        The limits are in rad/s and rad/s².
        """
        self.jumps, self.alternation = 0, Alternation()
        self.jump: Fact | None = None  # the latest; of an encoder that repeats, in its range
        self.jumped_by = 0.0  # rad, of all jumps since the last reference
        self.restrict(max_speed, max_acceleration, period)
        self.reset()

    def restrict(self, max_speed: float, max_acceleration: float, period: float = 0.0) -> None:
        """Change the limits from now on."""
        self.limits = RotorLimits(max_speed, max_acceleration, period or math.inf)
        self.period, self.wraps = period, Wraps(period)
        self._repeats: float = STALEST_NS  # ns, for which a driver repeats readings in motion
        self.seen_speed = self.seen_acceleration = 0.0
        """rad/s and rad/s², of motions beyond the limits, which are raised above them."""

    def reset(self) -> None:
        """Forget the readings; the next one is believed."""
        self._doubted: list[tuple[int, float]] = []
        self._last: Reading = _UNKNOWN
        self._former: Reading = _UNKNOWN
        self._moving: Reading = _UNKNOWN  # the last one before a standstill
        self._stamp = 0  # ns, of the last believed reading with the last position
        self._repeated = 0  # ns, the last stamp of several readings
        self.repeats = Repeats()
        self.likely = 0, 0.0  # ns, rad: the latest step of positions that repeat, as it is judged
        self._held_up = HeldUp()
        self.noise = 2.0 * COARSEST
        """rad, of a reading: twice the resolution of the encoder, which is the smallest step of
        all, or difference between two in a row; at least `FLOOR`."""
        self._look_always()

    @property
    def position(self) -> float:
        """The last believed position, rad; NaN before the first."""
        return self._last[0]

    @property
    def jumped(self) -> Fact | None:
        """The last jump of the encoder, or that its positions wrap; None if there was none."""
        return self.wraps.fact or self.jump

    @property
    def beyond_limits(self) -> Fact | None:
        """Which limits of the rotor, or of their own precision, the readings exceed."""
        which = []
        if self.seen_speed:
            which.append(Condition.BEYOND_SPEED(speed=self.seen_speed))
        if self.seen_acceleration:
            which.append(Condition.BEYOND_ACCELERATION(acceleration=self.seen_acceleration))
        if (step := single_precision_step(self._former[0], self._last[0])) > FLOOR:
            which.append(Condition.BEYOND_PRECISION(angle=step))
        return Condition.BEYOND_LIMITS(which=which, advice=which[-1].advice) if which else None

    def set_back(self, time: int) -> None:
        """Note that the clock was set back by a time, ns, since the last reading."""
        position, changed, step, span = self._last
        self._last = position, changed - time, step, span
        self._stamp -= time
        self._held_up = HeldUp()

    def judge_reset(self, position: float, last: int, stamp: int) -> Belief:
        """Forget the readings, as the clock went back from a stamp to another, ns.

        It is a jump if a drive restarted elsewhere than near the last position, rad, and stamps by
        the time since its start, no longer by the date.
        """
        before, _, step, _ = self._last
        moved, near = position - before, _FEW_STEPS * abs(step) + self.noise
        self.reset()
        # Turns of positions that repeat are unknown then, wherever the drive starts.
        if self.period or not (stamp < _UPTIME < last and abs(moved) > near):
            return BELIEVED
        self.jumps += 1
        self.jump = Condition.JUMPED(angle=moved, time=stamp / 1e9)
        return Belief.JUMP

    def judge(self, position: float, stamp: int) -> Belief:
        """Take the next reading, rad, with a stamp, ns, not before the last believed one."""
        last = self._last
        before, changed, former, took = last
        step = position - before
        even, square, shortest, longest = self._even
        if 0.0 < step * step <= square and -even <= step - former <= even:
            span = stamp - changed
            if shortest <= span <= longest:
                self._former = before, self._stamp, former, took
                self._last = position, stamp, step, span
                self._stamp = stamp
                return BELIEVED
        elif not (step or former or self._doubted or stamp - self._stamp > STALEST_NS):
            self._stamp = stamp  # it stands
            return BELIEVED
        return self._look_closer(position, step, stamp)

    def believes(self, stamps: NDArray[np.int64], positions: NDArray[np.float64]) -> bool:
        """Take readings in order of time if `judge` would believe each; else change nothing."""
        if self.period or self._repeats > STALEST_NS or not len(stamps):
            return not len(stamps)
        fresh = math.isnan(self._last[0])
        if fresh:
            self._restart(float(positions[0]), int(stamps[0]))
        now = self._last, self._former, self._moving, self._stamp, self.noise, self._held_up
        found = not self._doubted and all_in_reach(Motion(*now), self.limits, stamps, positions)
        if found:
            self._last, self._former, self._moving, self._stamp, self.noise, self._held_up = found
            self._look_always()
        elif fresh:
            self.reset()
        return bool(found)

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
        repeated = self._stamp
        if self._doubted and self._doubted[-1][1] == before:
            repeated = self._doubted[-1][0]
        moving = last if last_step else self._moving
        stood = repeated - changed > self._repeats and moving[1] == changed
        stood = stood and not self.limits.hides_turn(stamp - changed)
        if stood and self.limits.continues(moving, repeated, stamp, step, self.noise):
            self._repeats, last = _LONGER * (repeated - changed), moving
            last_step, last_span = last[2:]
        until = self._stamp if self._stamp - changed > self._repeats else changed
        held_up = self._held_up.before(stamp - changed, last, former)
        low, high = self.limits.reach(stamp, until, last, former, self.noise, held_up)
        if self.period:
            middle = 0.5 * (low + high)
            step = middle + math.remainder(step - middle, self.period)
            self.likely = stamp, step
        reached = low <= step <= high or high - low > _MOST_OF * self.period > 0.0
        if not reached or (self._doubted and self._stays(position, step, stamp)):
            return self._doubt(position, stamp)
        if self.limits.takes_back(stamp, step, last, former, self.noise, held_up):
            self.alternation.take_back(last_step, changed)
        self._doubted.clear()
        self._held_up = held_up
        possible = self.wraps.counted if self.period else abs(last_step) > LEAST_STEP
        readings = self._last, self._former
        wraps = possible and self.wraps.follow(step, stamp, *readings, self._repeated, self.noise)
        clear = 2.0 * (high - low) < self.period
        self.wraps.counted = round((position - before - step) / self.period) if clear else 0
        self.wraps.earlier = former[2:] if self.wraps.counted else (0.0, 0)
        if self.period and abs(step) > self.noise:
            self.repeats.note(stamp - changed, repeated - changed, self.limits)
        former_step = moving[2] if self.period else last_step
        steps = step, step - former_step
        self.noise = finer(self.noise, steps, position, before, self.period)
        span = stamp - changed
        if until > changed:  # it stood until then
            span = stamp - self._stamp or span
        if last_span and _SHORTER * max(span, last_span) < self._repeats:
            self._repeats = STALEST_NS  # the driver now reads more often
        if not span:
            self._last = position, changed, last_step + step, last_span
            self._repeated = stamp
        else:
            self._former = before, self._stamp, last_step, last_span
            self._last = position, stamp, step, span
        self._stamp = stamp
        self._look_always()
        usual = (span + last_span) // 2
        if usual <= LONGEST_NS and not (self.wraps.counted or self.repeats.lasted):
            shortest, longest = (1.0 - REGULAR) * usual, (1.0 + REGULAR) * usual
            if shortest <= span <= longest:
                # A step that differs tells of the resolution, as long as that is coarse.
                even = self.limits.even_step(usual) if self.noise == FLOOR else EQUAL
                if self.period:
                    even = min(even, 0.25 * self.period)
                most = self.limits.speed * shortest * 1e-9
                self._even = even, most * most, math.ceil(shortest), int(longest)
        self.jumps += bool(wraps)
        return Belief.JUMP if wraps else BELIEVED

    def _hold(self, position: float, stamp: int) -> Belief:
        """Judge a reading that repeats the last position.

        A rotor that has turned fast cannot stand at once.
        """
        held = stamp - self._last[1]
        if held > self._repeats:
            time = held * 1e-9 - STALEST
            known = self._last, self._former, self.noise, self._held_up
            if speed := self.limits.least_speed(*known):
                way = speed * time - 0.5 * self.limits.acceleration * time * time
                if way > self.noise:
                    times = self._stamp, stamp, self._last[3]
                    sent_before = not self._doubted and self.repeats.in_burst(*times)
                    return BELIEVED if sent_before else self._doubt(position, stamp)
            if self._last[2] and time > 2.0 * speed / self.limits.acceleration:
                self._moving = self._last
                self._last = *self._last[:2], 0.0, 0
                self._look_always()
        if stamp - self._stamp > STALEST_NS:
            self._held_up = self._held_up.at_rest(self._stamp, stamp)
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
        self._held_up = HeldUp(stamp, HELD_UP_AT_FIRST)

    def _doubt(self, position: float, stamp: int) -> Belief:
        """Note a reading that is out of reach, and see whether it agrees with those before."""
        previous = self._doubted[-1][1] if self._doubted else self._last[0]
        self.alternation.doubt(position, previous, self._wrapped)
        self._doubted = [*self._doubted[1 - _AGREEING :], (stamp, position)]
        self._look_always()  # so that a reading in reach ends the row
        if len(self._doubted) < _AGREEING:
            return Belief.IMPLAUSIBLE
        times, positions = zip(*self._doubted, strict=True)
        spans = [(b - a) * 1e-9 for a, b in pairwise(times)]
        steps = [self._wrapped(b - a) for a, b in pairwise(positions)]
        stale, noise, total = min(STALEST, max(spans)), self.noise, sum(spans)
        speed = sum(steps) / total if total else 0.0
        slack = noise + self.limits.acceleration * total * total
        ways = list(zip(steps, spans, strict=True))
        uneven = max(abs(way - speed * t) for way, t in ways)
        within = all(abs(way) <= self.limits.speed * (t + stale) + noise for way, t in ways)
        # A false speed, as of a wrong reading before a jump, must not allow its own unevenness.
        slack += min(abs(speed), _MOST_BEYOND * self.limits.speed) * stale
        if total < 0.0 or uneven > slack or not (within or total):
            return Belief.IMPLAUSIBLE
        first = self._wrapped(positions[0] - self._last[0])
        elapsed = (times[0] - (self._stamp if first else self._last[1])) * 1e-9
        before = self._speed()
        way = abs(speed) * (elapsed + stale) + noise
        continuous = first * speed >= 0.0 and abs(first) <= way and not self.period
        held_up = self._held_up.before(times[0] - self._last[1], self._last, self._former)
        late = 2e-9 * max(0.0, held_up.late(*times[1:]))  # the stamps of a burst tell no speed
        if abs(speed) * total > self.limits.speed * (total + late):
            self.seen_speed = abs(speed)
            self.limits = self.limits._replace(speed=_MARGIN * abs(speed))
        moved = bool(self._last[2])
        motion = self._former if moved else self._moving
        now = times[0], positions[0], speed
        if not self.period and self.limits.goes_on(motion, now, noise, repeated=not moved):
            continuous = True
        elif continuous:
            seen = abs(speed - before) / max(elapsed + stale, 1e-9)
            if within and seen > self.limits.acceleration:
                self.seen_acceleration = seen
                if speed:
                    self.limits = self.limits._replace(acceleration=_MARGIN * seen)
        else:
            self.jumps += 1
            size = self._wrapped(first - before * elapsed)
            self.jump = Condition.JUMPED(angle=size, time=times[0] / 1e9)
            self.jumped_by = self._wrapped(self.jumped_by + size)
            if not self.period:
                self.wraps.note(first, positions[0], elapsed, (before, speed), jump=True)
        last, noise = self._last, self.noise
        self._restart(position, stamp)
        self.noise = noise
        if continuous and not speed:
            self._moving = last
        if spans[-1]:
            self._last = position, stamp, steps[-1], times[-1] - times[-2]
        return Belief.BELIEVED if continuous else Belief.JUMP

    def _wrapped(self, step: float) -> float:
        return math.remainder(step, self.period) if self.period else step
