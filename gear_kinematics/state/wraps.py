# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Recognises positions that repeat, or repeat otherwise than set, by equal steps back in a motion.

A wrap shows as a jump only where readings are frequent. Otherwise the rotor could have turned back
as far between two of them, and only the repetition tells a wrap from a motion. Then no period but
one turn is recognised, because the quick return of a machine looks like a wrap after any other.
"""

import math
from dataclasses import dataclass, field

from gear_kinematics.kinematics.rotor_turns import TURN, RotorTurns
from gear_kinematics.state.reach import Reading
from gear_kinematics.state.statuses import Condition, Fact

LEAST_STEP = 0.5 * TURN  # rad, of a step that may be a wrap
_LEAST_MOTION = 0.01  # rad between two readings of a rotor that moves
_FEWEST = 3  # equal steps back in a row between the same ends, and no other steps as far
_EQUAL = 0.02  # of their size: what they may differ by, as stamps are uneven
_ENDS = 0.3  # of their size: most motion during a step, and what their ends may differ by
_FEWEST_FAST, _SPREAD = 8, 0.15 * TURN
"""Steps back in a row of a rotor that turns on by more than `_ENDS` of them between readings; and
by how much their lower ends must differ, rad. A vibration of a third of the rate of the messages,
or a half, can step back like that, but always to the same end."""
_STEADY = 0.5  # of the greater speed: what the speeds before and after may differ by
_RESERVE = 1.25  # times what is needed: limits that are proposed
_MANY = 16  # wraps, whose mean shows that a range is another
_EVEN = 1.1  # greatest ratio of times between readings of which the steps are compared
_SURE = 6.0  # standard errors of the mean, by which it is then off beyond the noise of a reading
_RANGE = 'rotor_encoder_range, which gearkin init can find'


@dataclass
class Wraps:
    """Collects steps back of positions that are not known to repeat."""

    known: float = 0.0  # rad, after which the positions repeat by the parameters; 0: never
    period: float = 0.0  # rad, after which they repeat instead; 0 if they do not seem to
    counted: int = 0  # periods that were taken for wraps in the last step
    earlier: tuple[float, int] = 0.0, 0  # rad, ns: the step before the one before it, and its time
    _times: int = 0  # wraps that were checked, and of what they were off by, rad, its sums
    _off: float = 0.0
    _squares: float = 0.0
    _steps: list[tuple[float, float, float]] = field(default_factory=list)
    _fast: list[tuple[float, float]] = field(default_factory=list)

    @property
    def fact(self) -> Fact | None:
        """The period, and the parameter to set for it, if the positions repeat."""
        if not self.period:
            return None
        turn = not self.known and abs(self.period - TURN) < _EQUAL * TURN
        setting = 'rotor_encoder to single_turn' if turn else _RANGE
        return Condition.WRAPS(angle=TURN if turn else self.period, setting=setting)

    def check(
        self, steps: tuple[float, float, float], spans: tuple[int, int, int], noise: float
    ) -> bool:
        """Check the known period by the step of a wrap; return whether it is another.

        The steps, rad, are those before the wrap, of it, without the periods `counted`, and behind
        it, in spans of time, ns. What the motion and the noise of a reading, rad, do not explain
        shows how far the range is off. A motion can be fastest at each wrap: the parabola
        through the steps around it allows for that, as long as they differ by the noise at most.
        """
        (before, wrap, after), (earlier, time) = steps, self.earlier
        varies = max(earlier, before, after) - min(earlier, before, after)
        if max(time, *spans) > _EVEN * min(time, *spans) or varies > noise:
            return bool(self.period)
        off = math.copysign(1.0, self.counted) * (wrap - before - (after - earlier) / 3.0)
        self._times += 1
        self._off, self._squares = self._off + off, self._squares + off * off
        mean = self._off / self._times
        error = math.sqrt(max(0.0, self._squares / self._times - mean * mean) / self._times)
        if self._times >= _MANY and abs(mean) > noise + _SURE * error:
            self.period = abs(self.counted) * self.known + mean
        return bool(self.period)

    def follow(
        self, step: float, stamp: int, last: Reading, former: Reading, repeated: int, noise: float
    ) -> bool:
        """Return whether the last step, which was believed, was a wrap, as the next step shows.

        The next one, rad, ends at a stamp, ns; `repeated` is the last stamp of several readings.
        """
        position, changed, last_step, last_span = last
        *_, former_step, former_span = former
        span = stamp - changed
        moves = min(abs(former_step), abs(step)) >= _LEAST_MOTION
        if not (former_span and last_span and span and moves):
            return False
        if self.known:
            if former[1] <= repeated:  # a part of the last step may be yet to come
                return bool(self.period)
            return self.check(
                (former_step, last_step, step), (former_span, last_span, span), noise
            )
        speeds = former_step / (former_span * 1e-9), step / (span * 1e-9)
        return self.note(last_step, position, last_span * 1e-9, speeds, jump=False)

    def note(
        self, step: float, end: float, time: float, speeds: tuple[float, float], *, jump: bool
    ) -> bool:
        """Take a step to the position `end`; return whether it is a known wrap.

        The step and its end are in rad, its time in s, and the speeds around it in rad/s.
        """
        before, after = speeds
        motion = 0.5 * (before + after) * time
        size, low, high = abs(step - motion), min(end - step, end), max(end - step, end)
        equal = size >= (1.0 - _EQUAL) * TURN and (jump or size < (1.0 + _EQUAL) * TURN)
        if not (step * before < 0.0 > step * after and equal):
            if not self.period:
                self._steps.clear()
                self._fast.clear()
            return False
        change = abs(after - before)
        if abs(motion) > _ENDS * size:
            return not jump and change * time <= _EQUAL * TURN and self._note_fast(low, high)
        if change > _STEADY * max(abs(before), abs(after)):
            return False
        found = size, low, high
        alike = [_EQUAL * size, _ENDS * size, _ENDS * size]
        if any(
            abs(a - b) > most
            for each in self._steps
            for a, b, most in zip(each, found, alike, strict=True)
        ):
            self._steps.clear()
        self._steps = [*self._steps[1 - _FEWEST :], found]
        if len(self._steps) == _FEWEST and not self.period:
            self.period = sorted(self._steps)[_FEWEST // 2][0]
        return len(self._steps) == _FEWEST

    def _note_fast(self, low: float, high: float) -> bool:
        """Take the ends of a step back in fast motion, rad; return whether it is a known wrap."""
        self._fast = [*self._fast[1 - _MANY :], (low, high)]
        lows, highs = zip(*self._fast, strict=True)
        if max(highs) - min(lows) > (1.0 + _EQUAL) * TURN:
            self._fast.clear()
        known = len(self._fast) >= _FEWEST_FAST and max(lows) - min(lows) >= _SPREAD
        if known and not self.period:
            self.period = TURN
        return known


def why_unknown(turns: RotorTurns) -> Fact | None:
    """Return how a gap, or a step within one that hides no turn, made the turns unknown."""
    rarely, gap = too_seldom(*turns.usual_gap), turns.longest_gap
    if rarely or gap is None:
        return rarely
    hides = 2.0 * turns.max_speed * gap >= turns.period
    which = Condition.GAP if hides else Condition.TURNED_TOO_FAR
    return which(gap=gap)


def too_seldom(
    period: float, max_speed: float, max_acceleration: float, gap: float, *, known: bool = False
) -> Fact | None:
    """Return what to change if the rotor can turn by half a period between two messages.

    Args:
        period: of its positions, rad; 0 if they do not repeat.
        max_speed: rad/s.
        max_acceleration: rad/s².
        gap: time between messages, s.
        known: whether the messages have velocities, which narrow down where the rotor can be.
    """
    enough = 0.5 * max_acceleration * gap * gap < period
    if 2.0 * max_speed * gap <= period or (known and enough):
        return None
    return Condition.TOO_SELDOM(
        rate=float(f'{1.0 / gap:.3g}'),
        limit=max_speed,
        speed=0.5 * period / (_RESERVE * gap),
        least=_RESERVE * 2.0 * max_speed / period,
        other=', or send velocities' if enough else '',
    )
