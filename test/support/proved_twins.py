# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""What was put into twenty simulated gears and what came back, as the tables of docs/twin.md."""

import math
import tempfile
from collections.abc import Iterable, Iterator, Sequence
from functools import cache
from pathlib import Path
from typing import NamedTuple

from measured_twins import Encoded, Figure, Moment, moments, ramps, strokes
from twin_reactions import forces_off
from twins import PutIn, drawn

from gear_kinematics.twin.mujoco_model import MujocoModel

GEARS = 20
MINUTE, SECOND = math.radians(1.0 / 60.0), math.radians(1.0 / 3600.0)


class Proof(NamedTuple):
    """What was put into one gear, and what was measured of it."""

    number: int
    put_in: PutIn
    figures: list[Figure]
    encoded: Encoded
    found: list[Moment]
    """Moments without mesh that were found."""
    apart: list[Moment]
    """Those in which a branch had no torque."""
    forces: float
    """The greatest difference of a force, as a share of the greatest one."""

    @property
    def late(self) -> int:
        """ms: the greatest difference of the beginnings and ends of moments."""
        pairs = zip(self.found, self.apart, strict=True)
        return max(
            abs(a - b) for pair in pairs for a, b in zip(*(p[:2] for p in pair), strict=True)
        )


@cache
def proved(number: int) -> Proof:
    """Prove one gear on MuJoCo, once."""
    put_in, braced = drawn(number), drawn(number, braced=True)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        figures = ramps(put_in, MujocoModel, folder)
        encoded = strokes(put_in, MujocoModel, folder)
        found, apart = moments(braced, MujocoModel, folder)
    return Proof(number, put_in, figures, encoded, found, apart, forces_off(braced))


def all_proved() -> list[Proof]:
    """Prove all gears."""
    return [proved(number) for number in range(GEARS)]


def answer(proofs: Sequence[Proof]) -> str:
    """Say what came back, with the worst deviation of each figure."""
    widths, frictions, plays = zip(*(proof.figures[:3] for proof in proofs), strict=True)
    springs = [each for proof in proofs for each in proof.figures[3:]]
    stiffness = max(abs(each.deviation / each.put_in) for each in springs)
    friction = max(abs(each.deviation / each.put_in) for each in frictions)
    width = max(abs(each.deviation) for each in widths) / MINUTE
    held = sum(each.holds for each in plays)
    encoded = [proof.encoded for proof in proofs]
    error = max(abs(off) for each in encoded for off, _ in each.errors.values()) / SECOND
    zero = max(abs(each.zero) for each in encoded) / SECOND
    count = sum(len(proof.apart) for proof in proofs)
    late, forces = (max(each) for each in zip(*((p.late, p.forces) for p in proofs), strict=True))
    return (
        f'Yes, for {GEARS} random gears. Stiffnesses come back within {100 * stiffness:.2f} %, '
        f'friction within {100 * friction:.1f} %, hysteresis within {width:.3f}′, and the play '
        f'lies within the interval of the backlash in {held} of {GEARS}. Ratios and directions '
        f'come back exactly, errors of the gear within {error:.2f}″, zeros within {zero:.2f}″. '
        f'{count} moments without mesh begin and end within {late} ms of the true ones, and '
        f'forces agree within {100 * forces:.2f} %. Twins of real gears follow the recorded loops '
        '[as closely as the loops repeat](#real-gears).'
    )


def filled(page: str, proofs: Sequence[Proof]) -> str:
    """Write the answer and both tables into the page, between their marks."""
    parts = {'answer': [answer(proofs)], 'ramps': _ramps(proofs), 'encoders': _encoders(proofs)}
    for name, lines in parts.items():
        begin, end = f'<!-- {name} -->\n', f'<!-- end of {name} -->'
        head, _, rest = page.partition(begin)
        _, _, tail = rest.partition(end)
        page = head + begin + '\n'.join(lines) + '\n' + end + tail
    return page


def _ramps(proofs: Sequence[Proof]) -> Iterator[str]:
    return _table(
        ('gear', 'preload or play', 'hysteresis, ′', 'friction, N·m', 'backlash, ′'),
        ('stiffness to 15 %, N·m/rad', 'to 50 %', 'to 100 %'),
        (
            (
                str(proof.number),
                _braced(proof.put_in),
                _found(hysteresis, 3, 1.0 / MINUTE),
                _found(friction, 4),
                f'{backlash.low / MINUTE:.2f} to {backlash.high / MINUTE:.2f}',
                *[''] * (3 - len(stiffness)),
                *(_found(each, 0) for each in stiffness),
            )
            for proof in proofs
            for hysteresis, friction, backlash, *stiffness in [proof.figures]
        ),
    )


def _encoders(proofs: Sequence[Proof]) -> Iterator[str]:
    return _table(
        ('gear', 'ratio', 'encoders count', 'rotor × 1, ″', 'rotor × 2, ″', 'output × 2, ″'),
        ('zero, ″', 'moments', 'off, ms', 'forces, %'),
        (
            (
                str(proof.number),
                str(proof.encoded.ratio),
                'alike' if proof.encoded.senses > 0 else 'oppositely',
                *(_off(*each) for each in proof.encoded.errors.values()),
                f'{abs(proof.encoded.zero) / SECOND:.2f}',
                str(len(proof.found)),
                str(proof.late),
                f'{100 * proof.forces:.2f}',
            )
            for proof in proofs
        ),
    )


def _table(
    first: Sequence[str], second: Sequence[str], rows: Iterable[Sequence[str]]
) -> Iterator[str]:
    head = *first, *second
    # A value is not torn from its ±; what was put in may have a line of its own.
    kept = ([c.replace(' ', '\N{NO-BREAK SPACE}') for c in row] for row in rows)
    body = ([c.replace(':\N{NO-BREAK SPACE}', ': ') for c in row] for row in kept)
    for row in (head, ['---'] * len(head), *body):
        yield f'| {" | ".join(row)} |'


def _braced(put_in: PutIn) -> str:
    if put_in.preload:
        return f'{put_in.preload:+.2f} N·m'
    return f'{put_in.remaining / MINUTE:.2f}′'


def _found(figure: Figure, digits: int, scale: float = 1.0) -> str:
    put_in, value, half = (
        f'{scale * each:.{digits}f}' for each in (figure.put_in, figure.value, figure.half)
    )
    return f'{put_in}: {value} ± {half}'


def _off(off: complex, half: float) -> str:
    return f'{abs(off) / SECOND:.2f} ± {half / SECOND:.2f}'
