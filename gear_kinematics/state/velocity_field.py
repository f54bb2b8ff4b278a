# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Compares the velocities in a driver's messages with the slope of its positions.

What is compared is the mean of the velocities of all messages between two positions: a single one
may be that of a step of a coarse encoder, or of a vibration.
"""

import math
from itertools import accumulate, pairwise
from operator import mul

import numpy as np

from gear_kinematics.state.belief import VelocityMeaning, velocity_factors
from gear_kinematics.state.disorder import spaced, sums_between
from gear_kinematics.state.reach import FLOOR
from gear_kinematics.state.statuses import Condition, Fact
from gear_kinematics.wire.batches import Array
from gear_kinematics.wire.cdr import SECOND

SPAN = 100_000_000  # ns, between the readings that are compared; four times that decides
_PAUSE = 10 * SPAN  # after velocities that were found right, for all but a stuck encoder
_READINGS = 4
_STRIDES = 1, 4, 16  # noted readings between compared ones: more while the rotor is slow
_MOST = 1 + (_READINGS - 1) * _STRIDES[-1]  # noted readings
_FAR = 3.0  # times or less than a third of the slope: no rounding, where the rotor is slow
_STEADY, _STANDS = 0.1, 0.4  # of the speed: what it may vary by; where the positions stand
_AGREES = 0.25  # of the slope: delays of filters and the rest of the acceleration
_ALIKE = 0.1  # of a factor that has a name
_REPEATED = 1.4
"""Greatest factor that even steps show of right velocities: where a driver reads each 75 to 82 ms,
there is one new reading in most intervals of `SPAN`, and two in the others."""
_TRAVEL, _NOISES = 3.0, 10  # rad, and noises of a reading, at least, in a comparison
_FEWEST = 10  # turns between readings in a comparison of an unsteady motion
_ALIGNED = 0.95  # the square of a correlation from which a factor explains the velocities
_FEW = 4  # velocities between readings, of which the mean is that of an oscillation
_RELATED = 0.5  # the correlation that a motion has with its velocities, at least
_IMPOSSIBLE = 30.0  # times the travel: any more between two readings is no velocity
_LONGEST, _FRO = 10, 30  # readings in which velocities that go on, or to and fro, show it stuck
_STUCK = 1.5  # times a velocity that does not change: more than its rounding and a held-up driver
_ROUNDING = 1e-9  # of a velocity: by which a mean of equal ones may differ
_FILTERED = 0.5  # share by which what a filter leaves of a motion may differ from a projection
_LATE, _EXPLAINED = 0.03, 0.9  # s, square of a correlation, from which a delay is reported
_CHANGES, _MOST_CHANGES = 4.0, 10.0
"""Noises of a reading, and times the changes of the velocities, as squares: changes of the travels
that can show a delay. At a steady speed, an error of the positions, such as one of each turn, or
of the stamps looks like a delay of half of `SPAN`."""

_POSITIONS = {VelocityMeaning.OF_TURNS, VelocityMeaning.OF_DEGREES, VelocityMeaning.OF_OUTPUT}


class VelocityField:
    """Follows positions and velocities of the rotor, and finds what the velocities are."""

    def __init__(self, output_factor: float) -> None:
        """Start without readings; the rotor's velocity times a factor is that of the output."""
        self._factors = velocity_factors(output_factor)
        self.finding = VelocityMeaning.UNDECIDED
        self.factor = math.nan  # ratio of velocities in messages to the slope of positions
        self.contradicts = False  # whether the velocities contradict the positions
        self.delay = 0.0  # s, by which velocities are late, or, below 0, positions, if too long
        self._late = 0  # 1 if the velocities may be late, -1 if the positions may
        self._past: Fact | None = None  # the last contradiction that ended
        self.decided: int | None = None  # ns, the stamp of the reading that decided first
        self._candidate = VelocityMeaning.UNDECIDED  # what the last comparison found
        self._may_repeat = False  # whether repeated readings of the encoder could explain it
        self._moved = False  # whether there was a velocity other than 0
        self.restart()

    def restart(self) -> None:
        """Forget the readings, but not what was found."""
        self.due = 0  # ns, the stamp from which on the next reading is wanted
        self.quiet_until = 0  # ns: `due`, or 0 while the velocities are not to be used
        self.confirmed = -_PAUSE  # ns, the stamp of the last reading that showed them right
        self._total, self._count = 0.0, 0  # of the velocities since the last reading
        self._last: float | None = None  # rad/s, the velocity at the last reading
        self._ways: list[float] = []  # rad, by the velocities since the position changed
        self._readings: list[tuple[int, float, float]] = []
        """Each stamp, ns, its position, rad, and the mean velocity since the one before, rad/s."""
        self._begin_block()

    def _begin_block(self) -> None:
        self._turns = 0  # between readings, and what is known of them
        self._path = self._squares = self._velocity_squares = self._products = 0.0
        self._fewest, self._off_squares = SPAN, 0.0  # velocities between two readings; rad²
        # Products of what the velocities differ by and what the speed changed by, as travels, by
        # the positions and by the velocities.
        self._products_of_changes, self._change_squares = [0.0, 0.0], [0.0, 0.0]

    @property
    def positions_stand(self) -> bool:
        """Whether the positions stand although the velocities are those of a motion."""
        return self.contradicts and math.isinf(self.factor)

    @property
    def meaning(self) -> Fact | None:
        """What the velocities seem to be, if they contradict the positions."""
        if not self.contradicts:
            late = Condition.POSITIONS_LATE if self.delay < 0.0 else Condition.VELOCITIES_LATE
            return late(delay=abs(self.delay)) if self.delay else None
        if self.positions_stand:
            return Condition.POSITIONS_STAND()
        if self.finding is VelocityMeaning.UNKNOWN and not math.isnan(self.factor):
            return Condition.VELOCITIES_UNKNOWN(meaning=self.finding, factor=self.factor)
        which = Condition.POSITIONS_ARE if self.finding in _POSITIONS else Condition.VELOCITIES_ARE
        return which(meaning=self.finding)

    @property
    def in_recording(self) -> Fact | None:
        """What the velocities seem to be, or seemed to be until they agreed with the positions."""
        return self.meaning or self._past

    def believed(self, stamps: Array, values: Array, noise: float) -> Array:
        """Note readings in order of time, and return their velocities, (n,).

        Stamps, ns, are those of (n,) rows or more; values, (n, 3), are position, velocity and
        effort; `noise` is that of a reading, rad. Velocities that contradict the positions become
        NaN.
        """
        velocity, start = values[:, 1].copy(), 0
        given = ~np.isnan(velocity)
        rows = spaced(stamps, self.due, SPAN)
        rows = rows[rows < len(values)]
        terms = np.where(given, velocity, 0.0)
        totals, counts = sums_between(terms, given, rows, self._total)
        readings = zip(rows.tolist(), stamps[rows].tolist(), values[rows].tolist(), strict=True)
        for k, (row, stamp, (position, last, _)) in enumerate(readings):
            self._total, self._count = totals[k], self._count + counts[k]
            if self.contradicts:
                velocity[start:row] = np.nan
            start = row
            self.note(stamp, position, None if math.isnan(last) else last, noise)
        self._total, self._count = totals[-1], self._count + counts[-1]
        if self.contradicts:
            velocity[start:] = np.nan
        return velocity

    def add(self, velocity: float | None) -> None:
        """Take the velocity of a message, rad/s, without comparing it yet."""
        if velocity is not None:
            self._total, self._count = self._total + velocity, self._count + 1

    def note(self, stamp: int, position: float, velocity: float | None, noise: float) -> None:
        """Take a reading: ns, rad, rad/s if given, and the noise of a reading, rad."""
        self.due = stamp + SPAN
        readings = self._readings
        self.add(velocity)
        if not self._count or (readings and stamp > readings[-1][0] + 2 * SPAN):
            readings.clear()
            self._ways.clear()
        if readings:
            self._follow_way(stamp, position, velocity)
        if stamp < self.confirmed + _PAUSE and not self.contradicts:
            readings[:] = [(stamp, position, 0.0)]
            self._last, self._total, self._count = velocity, 0.0, 0
            self.quiet_until = self.due
            return
        travel = max(_TRAVEL, _NOISES * noise)
        if self._count:
            self._fewest = min(self._fewest, self._count)
            if velocity is not None and self._last is not None:  # by trapezoids
                self._total += 0.5 * (self._last - velocity)
            self._last = velocity
            mean, self._total, self._count = self._total / self._count, 0.0, 0
            self._moved |= mean != 0.0
            readings.append((stamp, position, mean))
            if len(readings) > 1:
                self._follow(travel, noise)
        del readings[:-_MOST]
        if not self.contradicts and self._stuck(travel):
            self._decide(math.nan, VelocityMeaning.STUCK)
        for stride in _STRIDES:
            if self._compare(travel, stride):
                break
        self.quiet_until = 0 if self.contradicts else self.due

    def _follow_way(self, stamp: int, position: float, velocity: float | None) -> None:
        """Decide on velocities that are too great, or go on while the position stands."""
        since, before, _ = self._readings[-1]
        mean, turn = self._total / max(1, self._count), position - before
        expected = mean * (stamp - since) * 1e-9
        self._ways = [] if turn else [*self._ways[1 - _FRO :], expected]
        impossible = abs(expected) > _IMPOSSIBLE * (abs(turn) + _TRAVEL)
        if impossible or (not turn and self._lead_away(mean, velocity)):
            factor = expected / turn if turn else math.inf
            self._decide(factor, self._meaning_of(factor))

    def _lead_away(self, mean: float, velocity: float | None) -> bool:
        """Return whether velocities go on while the position stands, or lead away and back."""
        places = [*accumulate(self._ways, initial=0.0)]
        last, now = (math.copysign(v or 0.0, (v or 0.0) * mean) for v in (self._last, velocity))
        # Behind a stop, the velocities of a filter fall, and lead to no place and back.
        goes_on = min(last, now) >= 0.5 * abs(mean) and now >= (1.0 - _STEADY) * last
        far = abs(sum(self._ways[-_LONGEST:])) >= _TRAVEL and self.finding is VelocityMeaning.RIGHT
        back = max(places) - min(places) - abs(places[-1])
        return (goes_on and far) or (back >= _TRAVEL and not self.contradicts)

    def _follow(self, travel: float, noise: float) -> None:
        """Decide on a motion of more than `travel`, rad, however unsteady, of the latest readings.

        Only a factor that has a name counts: delays of filters make any of the others.
        """
        (before, start, _), (stamp, end, velocity) = self._readings[-2:]
        turn, expected = end - start, velocity * (stamp - before) * 1e-9
        self._turns += 1
        self._path += abs(turn)
        self._squares += turn * turn
        self._velocity_squares += expected * expected
        self._products += turn * expected
        if len(self._readings) > 2:  # noqa: PLR2004, two travels
            (earlier, origin, _), (_, _, former), _ = self._readings[-3:]
            off = expected - turn
            self._off_squares += off * off
            turned = (start - origin) * (stamp - before) / (before - earlier)
            changes = turned - turn, expected - former * (stamp - before) * 1e-9
            for k, change in enumerate(changes):
                self._products_of_changes[k] += off * change
                self._change_squares[k] += change * change
        if self._turns >= _FEWEST and self._path >= travel:
            least, (squares, given) = self._turns * (_CHANGES * noise) ** 2, self._change_squares
            if self._moved and least <= squares <= _MOST_CHANGES * given:
                self._note_delay()
            least = _ALIGNED * self._squares * self._velocity_squares
            if self._products * self._products >= least > 0.0:
                factor = self._products / self._squares
                if self._meaning_of(factor) is not VelocityMeaning.UNKNOWN:
                    self._decide(factor)
            elif self._fewest >= _FEW and not self._late and self._unrelated():
                self._decide(math.nan)
            self._begin_block()
        elif self._turns > _READINGS * _STRIDES[-1]:
            self._begin_block()

    def _stuck(self, travel: float) -> bool:
        """Return whether the velocities keep a value far from the speed, which changes."""
        value, off = self._last or 0.0, list[float]()
        for (since, start, _), (stamp, end, velocity) in pairwise(self._readings):
            off.append((end - start) / (stamp - since) * SECOND - value)
            if abs(velocity - value) > _ROUNDING * abs(value):
                off.clear()
        least = max(_STUCK * abs(value), travel * SECOND / (_READINGS * SPAN))
        if not value or sum(abs(each) >= least for each in off) < _READINGS:
            return False  # late velocities, and those that are held, differ for less time
        return max(off) - min(off) >= least

    def _unrelated(self) -> bool:
        """Return whether the velocities of all readings, nearly 5 s, are those of no such motion.

        Travels over short times do not match where a driver repeats readings, but longer ones do.
        """
        turned = [position for _, position, _ in self._readings]
        travels = [1e-9 * v * (t - s) for (s, *_), (t, _, v) in pairwise(self._readings)]
        given = [*accumulate(travels, initial=0.0)]
        filtered = True
        for stride in _STRIDES:
            motions = [b - a for a, b in zip(turned, turned[stride:], strict=False)]
            expected = [b - a for a, b in zip(given, given[stride:], strict=False)]
            product, size = sum(map(mul, motions, expected)), math.hypot(*expected)
            if len(turned) < _MOST or product >= _RELATED * math.hypot(*motions) * size:
                return False
            # What a filter leaves of a motion is the projection of that motion on it.
            filtered &= abs(product - size * size) < _FILTERED * size * size
        return not filtered

    def _note_delay(self) -> None:
        """Say that velocities or positions are late if two blocks in a row show it.

        One block that shows no delay ends it. Late velocities lie between those of the last two
        travels, or are earlier ones; late positions make a travel that of an earlier velocity.
        A delay within the time between two messages is none.
        """
        least = max(_LATE, SPAN * 1e-9 / self._fewest)
        for k, late in enumerate((1, -1)):
            product, squares = self._products_of_changes[k], self._change_squares[k]
            delay = product / squares * SPAN * 1e-9 if squares else 0.0
            if delay >= least and product * product >= _EXPLAINED * self._off_squares * squares:
                if self._late == late:
                    self.delay = late * delay
                self._late = late
                return
        self._late = 0
        if self._off_squares < (0.5e9 * _LATE / SPAN) ** 2 * self._change_squares[0]:
            self.delay = 0.0

    def _compare(self, travel: float, stride: int) -> bool:
        """Decide on the latest readings; False if they moved by less than `travel`, rad."""
        count = 1 + (_READINGS - 1) * stride
        if len(self._readings) < count:
            return True
        readings = self._readings[-count:]
        if not self._moved:  # 0 throughout a motion, however unsteady, which is not one jump
            positions = [position for _, position, _ in readings]
            if max(positions) - min(positions) < travel:
                return False
            steps = [abs(q - p) for p, q in pairwise(positions)]
            if sum(steps) - max(steps) >= travel:
                self._decide(0.0)
                return True
        (first, start, _), (last, end, _) = readings[0], readings[-1]
        time, slow, far = (last - first) * 1e-9, stride > 1, abs(end - start) >= travel
        velocities = [velocity for _, _, velocity in readings[1:]]
        mean = sum(velocities) / len(velocities)
        if not far and abs(mean) * time < travel:
            return False
        stands = all(abs(position - end) <= FLOOR for _, position, _ in readings)
        if slow and not (far or stands):
            return False
        slope = 0.0 if stands else (end - start) / time
        if not stands and any(
            abs((q - p) / (t - s) * 1e9 - slope) > _STEADY * abs(slope)
            for (s, p, _), (t, q, _) in pairwise(readings[::stride])
        ):
            if self._may_repeat:
                self._candidate = VelocityMeaning.UNDECIDED
            return True
        most = (_STEADY if slope else _STANDS) * max(abs(mean), abs(slope))
        fall = not slope and abs(velocities[-1]) < (1.0 - _STEADY) * abs(velocities[0])
        if fall or any(abs(velocity - mean) > most for velocity in velocities):
            return True  # velocities fall behind a filter after a stop
        factor = mean / slope if slope else math.inf
        if not (slow and (1.0 / _FAR < factor < _FAR or (self._moved and not factor))):
            self._decide(factor)
        return True

    def _decide(self, factor: float, certain: VelocityMeaning | None = None) -> None:
        """Change the finding if it is certain, or two comparisons in a row find the same."""
        found, stamp = certain or self._meaning_of(factor), self._readings[-1][0]
        if certain or found is self._candidate:
            self.decided = stamp if self.decided is None else self.decided
            if self.contradicts and found is VelocityMeaning.RIGHT:
                self._past = Condition.VELOCITIES_WERE(time=stamp / SECOND, doubt=self.meaning)
            self.finding, self.factor = found, factor
            self.contradicts = found is not VelocityMeaning.RIGHT
            self.confirmed = self.confirmed if self.contradicts else stamp
        self._candidate = found
        self._may_repeat = found is VelocityMeaning.UNKNOWN and 1.0 < factor < _REPEATED

    def _meaning_of(self, factor: float) -> VelocityMeaning:
        """Return what velocities are that are a multiple of the right ones."""
        if abs(factor - 1.0) <= _AGREES:
            return VelocityMeaning.RIGHT
        factors = self._factors.items()
        alike = (name for name, known in factors if abs(factor - known) <= _ALIKE * abs(known))
        return next(alike, VelocityMeaning.UNKNOWN)
