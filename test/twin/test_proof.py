# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The proof of docs/twin.md: what is put into simulated gears comes back from measurements."""

import re
from collections import defaultdict
from pathlib import Path

import pytest

pytest.importorskip('mujoco', reason='MuJoCo is not installed')
from measured_twins import STEP
from proved_twins import GEARS, all_proved, filled, proved
from twins import drawn

PAGE = Path(__file__).parents[2] / 'docs' / 'twin.md'
pytestmark = pytest.mark.slow


@pytest.mark.parametrize('number', range(GEARS))
def test_strokes_loads_and_forces_give_back_what_was_put_in(number):
    """Errors and zeros are known to a step of the encoder at best, however small their ± is."""
    proof = proved(number)
    encoded, parameters = proof.encoded, proof.put_in.parameters
    assert encoded.ratio == parameters.mechanism.gear_ratio
    assert encoded.senses == parameters.rotor_direction * parameters.output_encoder_direction
    assert len(encoded.errors) == len(proof.put_in.errors) == 3
    assert all(abs(off) <= max(half, STEP) for off, half in encoded.errors.values())
    assert encoded.others <= STEP
    assert abs(encoded.zero) <= STEP
    assert [each.branch for each in proof.found] == [each.branch for each in proof.apart]
    assert len(proof.found) == 5
    assert proof.late <= 5
    assert proof.forces < 5e-3


def test_figures_of_ramps_lie_in_their_intervals():
    """If 95 % hold, fewer than 17 of 20 do once in 60 times."""
    by_name = defaultdict(list)
    for proof in all_proved():
        for figure in proof.figures:
            by_name[figure.name].append(figure)
    # Without the stiffness of the range with the play, where there is some.
    assert sorted(map(len, by_name.values())) == [GEARS // 2, *5 * [GEARS]]
    for name, figures in by_name.items():
        assert sum(each.holds for each in figures) >= 0.85 * len(figures), name
        assert all(abs(each.deviation) <= 2.0 * each.half for each in figures), name
    assert all(proof.figures[2].holds for proof in all_proved())  # the play


def test_page_has_these_numbers():
    """To a few units of the last digit, as processors round differently."""
    number = re.compile(r'(?<![\d.])\d+(?:\.\d+)?')
    page = PAGE.read_text('utf-8')
    now = filled(page, all_proved())
    assert number.sub('0', now) == number.sub('0', page)
    for new, old in zip(number.findall(now), number.findall(page), strict=True):
        unit = 10.0 ** -len(old.partition('.')[2])
        assert float(new) == pytest.approx(float(old), rel=0.01, abs=3.0 * unit)


def test_play_and_preload_are_both_drawn():
    gears = [drawn(number) for number in range(GEARS)]
    assert sum(bool(gear.preload) for gear in gears) == GEARS // 2
    assert sum(bool(gear.remaining) for gear in gears) == GEARS // 2
    assert {gear.parameters.rotor_direction for gear in gears} == {-1, 1}
