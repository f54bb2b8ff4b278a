# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The twins of real gears, whose loops are recorded, and what the page says of them."""

import json
from pathlib import Path

import numpy as np
import pytest
from blocked_bags import gearkin_here

from gear_kinematics.twin.parameters import default_config

pytest.importorskip('scipy', reason='scipy is not installed')
from real_twins import PRINTED, READ_PRINTED, loops, real_gear

PAGE = Path(__file__).parents[2] / 'docs' / 'twin.md'


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


@pytest.mark.slow
def test_no_loop_is_further_from_its_twin_than_from_its_repeats(shared_path, tmp_path):
    """Of all that are recorded; ramps to a tenth of the torque show what a twin cannot do."""
    folders = shared_path('data/torque_ramps'), shared_path('data/torque_ramps_more')
    recordings = [path for folder in folders for path in sorted(folder.glob('*.csv'))]
    off, beside = [], []
    for recording in recordings:
        gear, [small, *_, large] = real_gear(recording, tmp_path / f'{recording.stem}.json')
        found = loops(gear, large)
        assert len(found.recorded) > 1
        assert found.off < found.scatter, recording.name
        off.append(found.off / found.scatter)
        lesser = loops(gear, small)
        beside.append(lesser.off / np.nanmean(np.ptp(lesser.recorded, axis=1)))
    page = PAGE.read_text('utf-8')
    assert f'all {len(recordings)} recordings' in page
    assert f'by {min(off):.2f} to {max(off):.2f} times' in page
    assert f'{100.0 * np.median(beside):.0f} % of the angle' in page
