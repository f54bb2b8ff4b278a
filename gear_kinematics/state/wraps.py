# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Recognises positions that repeat, by equal steps back while the rotor turns on.

A wrap shows as a jump only where readings are frequent. Otherwise the rotor could have turned back
as far between two of them, and only the repetition tells a wrap from a motion. Then no period but
one turn is recognised, because the quick return of a machine looks like a wrap after any other.
"""

from dataclasses import dataclass, field

from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.state.statuses import Condition, Fact

LEAST_STEP = 0.7 * TURN  # rad, of a step back
_FEWEST = 3  # equal steps back in a row between the same ends
_EQUAL = 0.02  # of their size: what they may differ by, as stamps are uneven
_ENDS = 0.3  # of their size: most motion during a step, and what their ends may differ by
_STEADY = 0.5  # of the greater speed: what the speeds before and after may differ by
_RESERVE = 1.25  # times what is needed: limits that are proposed
_RANGE = 'rotor_encoder_range, which gearkin init can find'


@dataclass
class Wraps:
    """Collects steps back of positions that are not known to repeat."""

    period: float = 0.0  # rad, after which the positions repeat; 0 if they do not seem to
    _steps: list[tuple[float, float, float]] = field(default_factory=list)

    @property
    def fact(self) -> Fact | None:
        """The period, and the parameter to set for it, if the positions repeat."""
        if not self.period:
            return None
        turn = abs(self.period - TURN) < _EQUAL * TURN
        setting = 'rotor_encoder to single_turn' if turn else _RANGE
        return Condition.WRAPS(angle=TURN if turn else self.period, setting=setting)

    def note(
        self, step: float, end: float, time: float, speeds: tuple[float, float], *, jump: bool
    ) -> bool:
        """Take a step to the position `end`; return whether it is a known wrap.

        The step and its end are in rad, its time in s, and the speeds around it in rad/s.
        """
        before, after = speeds
        motion = 0.5 * (before + after) * time
        size, low, high = abs(step - motion), min(end - step, end), max(end - step, end)
        if (
            not step * before < 0.0 > step * after
            or size < (1.0 - _EQUAL) * TURN
            or not (jump or size < (1.0 + _EQUAL) * TURN)
            or abs(motion) > _ENDS * size
            or abs(after - before) > _STEADY * max(abs(before), abs(after))
        ):
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
