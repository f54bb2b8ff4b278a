# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The twins of real gears, whose loops are recorded, and what the page says of them."""

import json
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from blocked_bags import gearkin_here
from real_twins import PRINTED, READ_PRINTED, loops, real_gear

from gear_kinematics.twin.parameters import default_config

ROOT = Path(__file__).resolve().parents[2]
PAGE, SHARED = ROOT / 'docs/twin.md', ROOT.parent / 'shared/data'


def test_the_loop_of_the_printed_gear_is_reproduced_within_its_own_scatter(shared_path, tmp_path):
    gear, [ramps] = real_gear(shared_path(f'data/{PRINTED}'), tmp_path / 'r.json', **READ_PRINTED)
    found = loops(gear, ramps)
    assert 0.0 < found.off < found.scatter
    figures = f'{1e3 * found.off:.1f} mrad (rms), the image by {1e3 * found.scatter:.1f} mrad'
    assert figures in PAGE.read_text('utf-8')


def test_springs_of_its_xml_are_the_middle_line(shared_path, tmp_path):
    """From one command to the other, as their user goes."""
    mujoco = pytest.importorskip('mujoco')
    recording, report = shared_path(f'data/{PRINTED}'), tmp_path / 'report.json'
    config, model = tmp_path / 'loose.yaml', tmp_path / 'loose.xml'
    text = default_config().read_text('utf-8')
    config.write_text(text.replace('preload: 2.0', 'preload: 0.0'), 'utf-8')
    read_as = '--ratio', '36/5', '--on-rotor'
    for command in (
        ('lost-motion', recording, *read_as, '--json', report),
        ('mjcf', '--config', config, '--measured', report, '--output', model),
    ):
        done = gearkin_here(*command)
        assert done.returncode == 0, done.stderr
    assert done.stderr == ''  # nothing is missing in the report
    line = json.loads(report.read_bytes())['recordings'][0]['middle_line']
    loaded = mujoco.MjModel.from_xml_path(str(model))
    low, high = loaded.tendon_lengthspring.T
    for wind_up in (-0.09, -0.033, 0.0, 0.012, 0.05):
        beyond = np.maximum(wind_up - high, 0.0) + np.minimum(wind_up - low, 0.0)
        expected = np.interp(wind_up, line['angle'], line['load'])
        assert loaded.tendon_stiffness @ beyond == pytest.approx(expected, abs=1e-9)
    friction = loaded.joint('output_shaft').frictionloss
    assert friction == pytest.approx(np.mean(line['friction']))


RECORDED = sorted(SHARED.glob('torque_ramps/*.csv')) + sorted(
    SHARED.glob('torque_ramps_more/*.csv')
)


@cache
def apart(recording: Path, folder: Path) -> tuple[float, float, float]:
    """Distances of large loops from the twin and from each other, rad; of small ones, a share."""
    gear, [small, *_, large] = real_gear(recording, folder / f'{recording.stem}.json')
    found, lesser = loops(gear, large), loops(gear, small)
    assert len(found.recorded) > 1
    return found.off, found.scatter, lesser.off / np.nanmean(np.ptp(lesser.recorded, axis=1))


@pytest.fixture(scope='module')
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp('reports')


@pytest.mark.slow
@pytest.mark.parametrize('recording', RECORDED, ids=lambda path: path.stem)
def test_no_loop_is_further_from_its_twin_than_from_its_repeats(recording, folder):
    off, scatter, _ = apart(recording, folder)
    assert off < scatter


@pytest.mark.slow
def test_page_says_how_far_loops_are_from_their_twins(folder):
    """Ramps to a tenth of the torque show what a twin cannot do."""
    if not RECORDED:
        pytest.skip(f'no recorded data at {SHARED}')
    offs, scatters, beside = np.transpose([apart(recording, folder) for recording in RECORDED])
    shares, page = offs / scatters, PAGE.read_text('utf-8')
    assert f'all {len(RECORDED)} recordings' in page
    assert f'by {min(shares):.2f} to {max(shares):.2f} times' in page
    assert f'{100.0 * np.median(beside):.0f} % of the angle' in page
