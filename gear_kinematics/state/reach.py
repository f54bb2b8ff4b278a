# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""How far a rotor can turn between two readings of its encoder, by its limits.

A reading may be up to an interval, at most `STALEST`, older than its stamp says: stamps are late
or early, and drivers repeat a reading until the next. Messages that were held up come in a burst,
and are as old as the interval before it.
"""

import math
from dataclasses import dataclass, field
from typing import Any, NamedTuple

from gear_kinematics.kinematics.rotor_turns import TURN

STALEST = 0.01  # s; a reading is so much, or an interval, older than its stamp says, at most
HELD_UP_AT_FIRST = 50_000_000  # ns: a pause that there may have been before a first reading
FLOOR = 0.05  # rad: noise of any encoder, and what two successive steps may always differ by
REGULAR = 0.3  # share of the usual time by which one may vary; with a lost message it is 1/3
_ROUNDING = 1e-6  # of a step of single precision, by a conversion of units in double precision
_REPEATS = 3.5  # times as long as between two readings: for which a driver repeats one, at most
_LONGEST_REPEAT = 1.0  # s, for which a driver repeats a reading while the rotor turns on
_REPEATED = 0.05  # of the way meanwhile: what it may differ by from that at a steady speed
_STEADY = 0.25  # of the speed: what it may change by meanwhile
_ALONE = 0.25  # of what a reading is off by: what the two steps beside it differ by
_STEPS = 3.25  # times the noise, of readings that are wrong beyond it
_UNEVEN = 0.25  # of a speed: what it may differ by, as readings are older than their stamps
_OFTEN = 5  # repeated readings in a row before a step: they are those of the driver
_FASTEST = 250_000  # ns between the readings of a driver; those of a burst can be closer
_CLOSE = 750_000  # ns, below which readings can be those of a burst, rather than of a fast driver

Reading = tuple[float, int, float, int]
"""A believed reading: rad; ns; the step from the one before, rad, and the time since that, ns,
which is 0 if it is not known, or after a standstill. Of several with one position, the stamp is
that of the first if they are the latest readings, and that of the last if they are former ones."""


class HeldUp(NamedTuple):
    """A pause, ns, after which the messages that were held up come in a burst."""

    end: int = 0
    length: int = 0
    usual: int = 0  # time between two readings before it; 0 if all came in bursts
    speed: float = math.inf  # rad/s, before it
    position: float = math.nan  # rad, before it; NaN if its time is uncertain

    def late(self, last: int, stamp: int) -> float:
        """Return by how much the time between two readings may exceed that of their stamps, ns.

        In a burst it is the usual time, if that is known, and that by which any reading may be
        older, as where one is lost. A burst lasts no longer than the pause before it.
        """
        left, since = float(self.length - (last - self.end)), stamp - last
        usual = self.usual or (left if since < _CLOSE else 0.0)
        return min(left, usual + min(1.25 * usual, 1e9 * STALEST)) - since

    def before(self, span: int, last: Reading, former: Reading) -> 'HeldUp':
        """Take the time until a reading, ns, after two others, and return the pause before it."""
        _, end, _, length = last
        length = min(length, end - former[1])  # messages in between show that there was no pause
        since = end - self.end
        # Times within `REGULAR` of the usual one differ by no more.
        if 13 * span >= 7 * length or length <= self.length - since:
            return self
        if since - length < 2 * self.length:  # the stamps of the burst before tell no speed
            usual = max(former[3], self.usual)
            return HeldUp(end, length, usual if self.usual or usual > _CLOSE else 0)
        speed = abs(former[2]) / former[3] * 1e9 if former[3] else math.inf
        # Bursts that came before while the rotor stood did not show.
        at_rest = self.usual if since == length else 0
        usual = former[3] if former[3] > min(_CLOSE, max(_FASTEST, 2 * span)) else at_rest
        return HeldUp(end, length, usual, speed, former[0])

    def at_rest(self, last: int, stamp: int) -> 'HeldUp':
        """Take the stamp of a reading that repeats the position of the one before, ns."""
        pause = stamp - last
        regular = self.end == last and pause <= 2 * max(self.length, self.usual)
        usual = self.usual if self.end == last else 0
        return HeldUp(stamp, 0, pause) if regular else HeldUp(stamp, pause, usual)


def _stale(last: Reading, former: Reading, late: float) -> float:
    """By how much a reading may be older than its stamp, s."""
    return max(min(STALEST, 1.25e-9 * max(last[3], former[3])), 1e-9 * late)


class RotorLimits(NamedTuple):
    """The limits of a rotor."""

    speed: float  # rad/s
    acceleration: float  # rad/s²
    period: float = math.inf  # rad, after which readings repeat

    def hides_turn(self, span: int) -> bool:
        """Whether the rotor can turn by half of what readings repeat after, in a time, ns."""
        return 2e-9 * self.speed * span >= self.period

    def even_step(self, span: Any) -> Any:
        """Return by how much successive steps may differ, rad, if each takes about a time, ns.

        It is less than what `reach` allows beyond the last step.
        """
        stale = (1.25 * (1.0 - REGULAR) * 1e-9) * span
        return FLOOR + 1.5 * self.acceleration * stale * stale

    def least_speed(self, last: Reading, former: Reading, noise: float, held_up: HeldUp) -> float:
        """The speed, rad/s, that the rotor had at least; 0 if it can stand at once."""
        if not (last[3] and former[3]):
            return 0.0
        position, changed, step, took = last
        late = held_up.late(changed - took, changed)
        ways = [(step + former[2], took + former[3] + max(0.0, late))]
        # Stamps of a burst tell little of the speed, the one before the pause more.
        if late > 0.0 and not math.isnan(held_up.position):
            way = math.remainder(position - held_up.position, self.period)
            ways.append((way, changed - held_up.end + held_up.length))
        stale, speed = _stale(last, former, late), 0.0
        for way, span in ways:
            time = span * 1e-9 + stale
            speed = max(speed, (abs(way) - noise) / time - self.acceleration * time)
        return speed if speed * abs(speed) > 2.0 * self.acceleration * noise else 0.0

    @staticmethod
    def continues(moving: Reading, until: int, stamp: int, step: float, noise: float) -> bool:
        """Whether a step, rad, continues a motion that seemed to end, at most twice as fast.

        The last reading of the motion was repeated until a stamp, ns, as by a driver that
        publishes more often than it reads. `noise` is that of a reading, rad.
        """
        _, since, former, span = moving
        repeated = until - since <= _REPEATS * (stamp - until)
        if not (span and repeated and min(abs(former), abs(step)) > noise):
            return False
        way = former / span * (stamp - since)
        return abs(step - way) <= abs(way)

    def goes_on(
        self, motion: Reading, now: tuple[int, float, float], noise: float, *, repeated: bool
    ) -> bool:
        """Whether a motion can have gone on to what is known `now`: stamp, position and speed.

        A driver repeated the last reading of the motion meanwhile, or else it sent a wrong one.
        """
        (before, since, step, span), (stamp, position, speed) = motion, now
        time = (stamp - since) * 1e-9
        if not (step and span) or (time > _LONGEST_REPEAT and repeated):
            return False
        former = step / (span * 1e-9)
        change = _STEADY * abs(former) + (0.0 if repeated else self.acceleration * time)
        way, stale = 0.5 * (former + speed) * time, min(STALEST, 1.25e-9 * span)
        uncertain = noise + max(abs(former), abs(speed)) * stale
        uncertain += _REPEATED * abs(way) + 0.25 * change * time
        turned, most = position - before, self.speed * (time + stale) + noise
        within = abs(turned) <= most and abs(turned - way) <= uncertain
        return within and abs(speed - former) <= change

    def takes_back(
        self,
        stamp: int,
        step: float,
        last: Reading,
        former: Reading,
        noise: float,
        held_up: HeldUp,
    ) -> bool:
        """Whether a step, rad, takes back the last one, which the rotor cannot have made at all.

        Beyond the motion before, it turns about between them, and within a time it goes no farther
        from there than by half its acceleration times the square of that time. The last pause
        tells how late the readings of a burst can be.
        """
        _, changed, out, took = last
        if abs(out - step) <= 2.0 * _STEPS * noise:  # by which both are beyond what is possible
            return False
        spans = took, stamp - changed, former[3]
        if not took or self.hides_turn(max(spans)):
            return False
        speed = former[2] / former[3] if former[3] else 0.0
        out, back = out - speed * took, step - speed * spans[1]
        way = min(abs(out), abs(back))
        if out * back > 0.0 or abs(out + back) > _ALONE * way:
            return False
        stale, span = _stale(last, former, held_up.late(changed, stamp)), 1e-9 * max(spans)
        time = span + stale
        # Where two readings have the same stamp, the next one seems to be an interval late.
        least = 0.5 * self.acceleration * time * time + 1e9 * abs(speed) * max(span, stale)
        return way > least + _STEPS * noise

    def reach(
        self, stamp: int, until: int, last: Reading, former: Reading, noise: float, held_up: HeldUp
    ) -> tuple[float, float]:
        """The least and the greatest step, rad, that the rotor can make until a stamp.

        Args:
            stamp: ns.
            until: stamp of the last reading with the last position.
            last: the first reading with it.
            former: the one before.
            noise: rad, of a reading, see `Plausibility`.
            held_up: the last pause.
        """
        slow, fast, stale = -self.speed, self.speed, STALEST
        _, changed, step, span = last
        elapsed, held = (stamp - changed) * 1e-9, (until - changed) * 1e-9
        if held > STALEST:  # it stands, as far as its last readings tell
            elapsed = (stamp - until + max(0.0, held_up.late(until, stamp))) * 1e-9
            fast = self.acceleration * min(held, 2.0 * elapsed)
            slow = -fast
        elif not span:
            stale = max(stale, 1e-9 * held_up.late(changed, stamp))
        else:
            late = held_up.late(changed, stamp)
            stale = _stale(last, former, late)
            before = held_up.late(changed - span, changed)
            if before >= span:  # spans within a burst do not show how old its last reading was
                stale = max(stale, min(STALEST, 1.25e-9 * held_up.usual or STALEST))
            # Stamps of a burst tell no speed, those before it do.
            if late >= stamp - changed or before >= span:
                since = (stamp - held_up.end + held_up.length) * 1e-9
                fast = (1.0 + _UNEVEN) * held_up.speed + self.acceleration * (since + stale)
                fast += noise / (max(held_up.usual, 1) * 1e-9)
                slow = -fast
            else:
                within = span * 1e-9
                slow = fast = step / within
                if former[3]:  # readings that are older than their stamps make one of them wrong
                    other = former[2] / (former[3] * 1e-9)
                    slow, fast = min(slow, other), max(fast, other)
                doubt = self.acceleration * (within + stale) + noise / within
                slow -= doubt + _UNEVEN * abs(slow)
                fast += doubt + _UNEVEN * abs(fast)
        time = elapsed + stale
        way, gained = self.speed * time, 0.5 * self.acceleration * time * time
        high = min(way, max(0.0, min(self.speed, fast) * time + gained))
        low = max(-way, min(0.0, max(-self.speed, slow) * time - gained))
        return low - noise, high + noise


@dataclass
class Repeats:
    """Finds for how long a driver repeats each reading, where that can hide a turn or a pause."""

    lasts: float = 0.0  # ns; 0 if no turn can be hidden, or readings are not repeated
    lasted: list[float] = field(default_factory=list)  # ns, for which the latest ones were valid
    _burst: tuple[int, int] = 0, 0
    """Last message before a pause, and until when those after it can be of a burst, ns."""

    def note(self, span: int, repeated: int, limits: RotorLimits) -> None:
        """Take a step that is greater than the noise, from a reading that a driver may repeat.

        That reading came `span` before the step, and was repeated for a time, both in ns.
        """
        if span < self.lasts or not repeated:
            self.lasted, self.lasts = [], self.lasts if span >= self.lasts else 0.0
        elif limits.hides_turn(span):
            self.lasted = [*self.lasted[1 - _OFTEN :], 0.5 * (span + repeated)]
            if len(self.lasted) == _OFTEN:
                self.lasts = min(self.lasted)

    def in_burst(self, last: int, stamp: int, usual: int) -> bool:
        """Return whether a message that repeats a reading can be one of a burst after a pause.

        It was sent before the pause, then, and does not show that the rotor stands. The last
        message before, this one, and the usual time between different readings are in ns.
        """
        if self._burst[0] != last and stamp - last > (1.0 + REGULAR) * usual:
            self._burst = last, 2 * stamp - last
        return last == self._burst[0] and stamp < self._burst[1]


def single_precision_step(*positions: float) -> float:
    """Return the step of numbers of 24 bits, rad, if positions are such in some unit; else 0.

    Many drivers convert them from such numbers of rad, turns or degrees. Of several, it is the
    smallest step.
    """
    for unit in (1.0, TURN, math.radians(1.0)):
        steps = [math.ldexp(unit, math.frexp(each / unit)[1] - 24) for each in positions]
        if all(
            step and abs(math.remainder(each, step)) < _ROUNDING * step
            for each, step in zip(positions, steps, strict=True)
        ):
            return min(steps)
    return 0.0
