"""The vernier of pin holes that fixes a ring gear in the chassis and sets the preload.

A ring gear has zk teeth and zk + 1 pin holes, the chassis zk + 2 holes; one pin goes through a
ring hole and a chassis hole. A setting turns the ring gear's tooth profile by
2π [tooth/zk + ring_hole/(zk + 1) + chassis_hole/(zk + 2)].
"""

import math
from dataclasses import dataclass
from fractions import Fraction


@dataclass(frozen=True, slots=True)
class PinSetting:
    """Which tooth and holes are brought together, and the turn of the tooth profile it gives."""

    tooth: int
    """0 ... zk - 1."""
    ring_hole: int
    """0 ... zk."""
    chassis_hole: int
    """0 ... zk + 1."""
    turn: Fraction
    """The exact turn of the ring gear's profile, in whole turns, within [0, 1)."""

    @property
    def angle(self) -> float:
        """`turn` in rad."""
        return 2.0 * math.pi * self.turn.numerator / self.turn.denominator


def combinations(ring_teeth: int) -> int:
    """n = zk (zk + 1)(zk + 2): combinations of tooth, ring hole and chassis hole (eq. 1)."""
    return ring_teeth * (ring_teeth + 1) * (ring_teeth + 2)


def distinct_positions(ring_teeth: int) -> int:
    """lcm(zk, zk + 1, zk + 2): positions that differ; n/2 for even zk, n for odd."""
    return math.lcm(ring_teeth, ring_teeth + 1, ring_teeth + 2)


def ring_body_positions(ring_teeth: int) -> int:
    """(zk + 1)(zk + 2): positions of the ring's body, each tooth apart; they all differ."""
    return (ring_teeth + 1) * (ring_teeth + 2)


def step(ring_teeth: int) -> float:
    """2π / lcm(zk, zk + 1, zk + 2), rad: from one position to the next."""
    return 2.0 * math.pi / distinct_positions(ring_teeth)


def nearest_setting(ring_teeth: int, angle: float) -> PinSetting:
    """Find the setting that turns the ring gear's profile nearest to `angle`, rad.

    Solved as a congruence, without enumeration. Of settings at the same position, for even zk two,
    it gives one.

    Args:
        ring_teeth: zk, at least 1.
        angle: finite, rad; taken modulo a whole turn.

    Raises:
        ValueError: if `angle` is not finite or `ring_teeth` less than 1.
    """
    if ring_teeth < 1 or not math.isfinite(angle):
        raise ValueError(f'no pin setting for {ring_teeth} teeth at an angle of {angle} rad')
    positions = distinct_positions(ring_teeth)
    position = round(math.remainder(angle, 2.0 * math.pi) / step(ring_teeth)) % positions
    return _setting(ring_teeth, position)


def _setting(ring_teeth: int, position: int) -> PinSetting:
    """Solve tooth/zk + ring_hole/(zk+1) + chassis_hole/(zk+2) ≡ position/lcm (mod 1).

    Modulo zk + 1 only the ring hole remains. What is left over is a multiple of zk + 1 and splits
    between tooth and chassis hole: zk/2 and zk/2 + 1 differ by 1, zk and zk + 2 by 2.
    """
    holes_ring, holes_chassis = ring_teeth + 1, ring_teeth + 2
    lcm = distinct_positions(ring_teeth)
    ring_hole = position * pow(lcm // holes_ring, -1, holes_ring) % holes_ring
    rest = (position - ring_hole * (lcm // holes_ring)) // holes_ring
    if ring_teeth % 2:
        tooth = rest * pow(2, -1, ring_teeth) % ring_teeth
        chassis_hole = -rest * pow(2, -1, holes_chassis) % holes_chassis
    else:
        tooth, chassis_hole = rest % ring_teeth, -rest % holes_chassis
    return PinSetting(tooth, ring_hole, chassis_hole, Fraction(position, lcm))
