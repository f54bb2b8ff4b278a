# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The vernier of pin holes that fixes a ring gear in the chassis and sets the preload.

A ring gear has zk teeth and zk + 1 pin holes, the chassis zk + 2 holes; one pin goes through a
ring hole and a chassis hole. Seen against the z axis, teeth and chassis holes are numbered
counterclockwise from the zero marks of ring gear and chassis, ring holes clockwise. A setting puts
its tooth, in turns counterclockwise from the chassis's zero mark, at

    tooth/zk + ring_hole/(zk + 1) + chassis_hole/(zk + 2)      (mod 1)

which is the turn of the tooth profile, as all teeth are alike. Turns are exact fractions of a
whole turn here; angles in rad are rounded once.
"""

import math
from dataclasses import dataclass
from fractions import Fraction
from typing import NamedTuple

from gear_kinematics.kinematics.rotor_turns import EXACT_TURN, TURN


@dataclass(frozen=True, slots=True)
class PinSetting:
    """A tooth, the two holes that share the pin, and the resulting turn of the tooth profile."""

    tooth: int
    """Tooth number, 0 ... zk - 1."""
    ring_hole: int
    """Number of the hole in the ring gear, 0 ... zk."""
    chassis_hole: int
    """Number of the hole in the chassis, 0 ... zk + 1."""
    body_turn: Fraction
    """Turn of the ring gear's body as given by the two holes, in whole turns, [0, 1)."""
    turn: Fraction
    """Turn of the tooth profile, `body_turn` + tooth/zk, in whole turns, [0, 1)."""

    def __str__(self) -> str:
        holes = f'ring hole {self.ring_hole} in chassis hole {self.chassis_hole}'
        return f'{holes}, tooth {self.tooth}'

    @property
    def angle(self) -> float:
        """Angle of `turn`, rad."""
        return TURN * self.turn.numerator / self.turn.denominator


class Choice(NamedTuple):
    """A position of the vernier, compared with a wanted one."""

    steps: int
    """Signed number of positions from the nearest one."""
    settings: tuple[PinSetting, ...]
    """Settings of this position: two with bodies half a turn apart if zk is even, else one.

    The one that turns the ring's body less comes first.
    """
    ring_turn: float
    """Turn of the tooth profile, rad."""
    error: float
    """Error of `ring_turn`, rad: `ring_turn` minus the wanted turn."""


def combinations(ring_teeth: int) -> int:
    """Count the combinations of tooth, ring hole and chassis hole: zk (zk + 1)(zk + 2) (eq. 1)."""
    return ring_teeth * (ring_teeth + 1) * (ring_teeth + 2)


def distinct_positions(ring_teeth: int) -> int:
    """Count the distinct tooth positions, lcm(zk, zk + 1, zk + 2): half of n if zk is even."""
    return math.lcm(ring_teeth, ring_teeth + 1, ring_teeth + 2)


def step(ring_teeth: int) -> float:
    """Angle from one position to the next, rad: 2π / lcm(zk, zk + 1, zk + 2)."""
    return TURN / distinct_positions(ring_teeth)


def turns(angle: float) -> Fraction:
    """Convert an angle, rad, to turns of 2π itself, not of its float64.

    Raises:
        ValueError: if `angle` is not finite.
    """
    if not math.isfinite(angle):
        raise ValueError(f'an angle must be finite, not {angle} rad')
    return Fraction(angle) / EXACT_TURN


def angle_between(start: Fraction, end: Fraction) -> float:
    """The shorter angle from one turn to another, rad in [-π, π)."""
    apart = (end - start + Fraction(1, 2)) % 1 - Fraction(1, 2)
    return TURN * float(apart)


def pin_setting(ring_teeth: int, tooth: int, ring_hole: int, chassis_hole: int) -> PinSetting:
    """Create the setting of a tooth and two holes.

    Raises:
        ValueError: if there is no such tooth or hole.
    """
    if ring_teeth < 1:
        raise ValueError(f'a ring gear has at least 1 tooth, not {ring_teeth}')
    parts = (
        ('tooth', tooth, ring_teeth),
        ('ring hole', ring_hole, ring_teeth + 1),
        ('chassis hole', chassis_hole, ring_teeth + 2),
    )
    for name, number, count in parts:
        if not 0 <= number < count:
            raise ValueError(f'{name} {number} is not one of 0 to {count - 1}')
    body_turn = Fraction(ring_hole, ring_teeth + 1) + Fraction(chassis_hole, ring_teeth + 2)
    turn = body_turn + Fraction(tooth, ring_teeth)
    return PinSetting(tooth, ring_hole, chassis_hole, body_turn % 1, turn % 1)


def choices(
    ring_teeth: int, ring_turn: float, start: PinSetting | None = None, neighbours: int = 0
) -> list[Choice]:
    """Find the position nearest to a wanted turn of the ring gear, and its neighbours.

    Solved as a congruence, without enumeration.

    Args:
        ring_teeth: zk, at least 1.
        ring_turn: wanted turn of the tooth profile, rad.
        start: setting before the turn; by default that of tooth 0 and the holes 0.
        neighbours: number of positions to return on either side.

    Raises:
        ValueError: if `ring_turn` is not finite or `ring_teeth` less than 1.
    """
    start = start or pin_setting(ring_teeth, 0, 0, 0)
    wanted = start.turn + turns(ring_turn)
    lcm = distinct_positions(ring_teeth)
    nearest = round(wanted * lcm)
    found = []
    for steps in range(-neighbours, neighbours + 1):
        settings = sorted(
            _settings_at(ring_teeth, nearest + steps),
            key=lambda setting: abs(angle_between(start.body_turn, setting.body_turn)),
        )
        error = TURN * float(Fraction(nearest + steps, lcm) - wanted)
        found.append(Choice(steps, tuple(settings), ring_turn + error, error))
    return found


def _settings_at(ring_teeth: int, position: int) -> tuple[PinSetting, ...]:
    """Solve tooth/zk + ring_hole/(zk+1) + chassis_hole/(zk+2) ≡ position/lcm (mod 1).

    Modulo zk + 1 only the ring hole remains. The rest is a multiple of zk + 1 and splits between
    tooth and chassis hole: zk/2 and zk/2 + 1 differ by 1, zk and zk + 2 by 2. For even zk, tooth
    and chassis hole can both move on by half a turn, together a whole turn.
    """
    holes_ring, holes_chassis = ring_teeth + 1, ring_teeth + 2
    lcm = distinct_positions(ring_teeth)
    ring_hole = position * pow(lcm // holes_ring, -1, holes_ring) % holes_ring
    rest = (position - ring_hole * (lcm // holes_ring)) // holes_ring
    if ring_teeth % 2:
        half_turns = 1
        tooth = rest * pow(2, -1, ring_teeth)
        chassis_hole = -rest * pow(2, -1, holes_chassis)
    else:
        half_turns, tooth, chassis_hole = 2, rest, -rest
    return tuple(
        pin_setting(
            ring_teeth,
            (tooth + half_turn * ring_teeth // 2) % ring_teeth,
            ring_hole,
            (chassis_hole + half_turn * holes_chassis // 2) % holes_chassis,
        )
        for half_turn in range(half_turns)
    )
