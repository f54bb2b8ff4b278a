# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The twin of a real gear: COMPAct's printed one, whose loop is recorded."""

from pathlib import Path

import pytest

pytest.importorskip('scipy', reason='scipy is not installed')
import printed_gear

PAGE = Path(__file__).parents[2] / 'docs' / 'twin.md'


@pytest.fixture(scope='module')
def loops(shared_path):
    return printed_gear.loops(shared_path(f'data/{printed_gear.RECORDING}'))


@pytest.mark.slow
def test_its_loop_is_reproduced_within_its_own_scatter(loops):
    assert 0.0 < loops.off < loops.scatter
    page = PAGE.read_text('utf-8')
    assert f'off by {1e3 * loops.off:.1f} mrad' in page
    assert f'rms difference is {1e3 * loops.scatter:.1f} mrad' in page
    assert f'alone, the difference is {1e3 * loops.scatter_once_loaded:.1f} mrad' in page
    assert loops.scatter_once_loaded < loops.off  # as the page says
    assert f'along it, {loops.friction:.1f} N·m' in page
