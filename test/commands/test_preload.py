# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""gearkin index and preload as someone who sets a preload runs them."""

import json
import math
import os
import re
from fractions import Fraction

import pytest
from blocked_bags import BAGS, gearkin, refusal
from oracle import turn_of

from gear_kinematics.commands.cli import main

PAPER = ('--branch-stiffness', 'inf', '--shaft-stiffness', '1069')
SOFT = ('--branch-stiffness', '3000', '2000', '--shaft-stiffness', '1000')
COMPLIANCE = 1 / 3e3 + 1 / 2e3 + 1 / 1e3  # rad/(N·m)
SECOND = 4.848136811095360e-6  # rad
ODD = ('--ring-teeth', '61', '--satellite-teeth', '58')


def answer(capsys, *arguments: object) -> dict:
    assert main([*map(str, arguments), '--json', '-']) == 0
    return json.loads(capsys.readouterr().out)


def printed(capsys, *arguments: object) -> str:
    assert main([*map(str, arguments)]) == 0
    return capsys.readouterr().out


def holes(setting: dict) -> tuple[int, int, int]:
    return setting['tooth'], setting['ring_hole'], setting['chassis_hole']


def degrees(angle: float) -> str:
    return repr(math.degrees(angle))


# The vernier.


def test_index_says_which_holes_to_pin_in_words(capsys):
    out = printed(capsys, 'index', '--degrees', '0.0572957795')
    pins = 'Pin ring hole 78 in chassis hole 1, tooth 2'
    turn = 'the ring gear turns by 3′ 24.878″, 1.387″ less than wanted.'
    assert out.startswith(f'result: {pins}: {turn}\n')
    assert '265680 positions, one every 4.878″' in out
    assert 'ring hole 78 in chassis hole 1, tooth 2' in out
    assert 'ring hole 78 in chassis hole 42, tooth 42: the same position' in out
    assert '3′ 24.878″ for a wanted 3′ 26.265″ (-1.387″)' in out
    row = 'steps 0: tooth: 2 or 42; ring hole: 78; chassis hole: 1 or 42; turn: 3′ 24.878″; error'
    assert row in out


def test_an_error_that_rounds_to_nothing_has_no_minus(capsys):
    out = printed(capsys, 'index', '--degrees', '-0.5')
    assert '30′ 00.000″ (+0.000″)' in out
    assert ' -0.000' not in out


def test_index_lists_the_positions_around(capsys):
    found = answer(capsys, 'index', '--degrees', '-0.01')
    assert (found['ring_holes'], found['chassis_holes'], found['positions']) == (81, 82, 265_680)
    rows = found['positions_around']
    assert [row['steps'] for row in rows] == [-3, -2, -1, 0, 1, 2, 3]
    for row in rows:
        turned = turn_of(80, *holes(row['settings'][0]))
        turned -= round(turned)
        wanted = -0.01 + row['steps'] * 360.0 / 265_680
        assert float(turned) * 360.0 == pytest.approx(wanted, abs=4.879 / 2 / 3600)
        assert row['ring_turn'] == pytest.approx(float(turned) * 1296e3 * SECOND, abs=1e-15)
        ways = [Fraction(setting['body_turn']) for setting in row['settings']]
        near, far = (abs(way - round(way)) for way in ways)
        assert near < far


def test_the_phase_of_branch_b_is_added(capsys):
    phase = answer(capsys, 'index', '--phase-b', *ODD)['wanted']['phase']
    assert phase == pytest.approx(1296e3 / 122 * SECOND, rel=1e-12)
    braced = answer(capsys, 'preload', '--phase-b', '--wanted-preload', '0.5', *ODD, *SOFT)
    assert braced['preload'] == pytest.approx(0.5, rel=1e-9)
    assert braced['ring_turn'] == pytest.approx(phase + 58 / 61 * 0.5 * COMPLIANCE)
    assert '2° 57′ 02.951″ of it' in printed(capsys, 'index', '--phase-b', *ODD)
    assert answer(capsys, 'index', '--phase-b')['wanted']['phase'] == pytest.approx(0.0, abs=1e-16)


# The preload.


def test_preload_of_a_ring_turn(capsys):
    """One step of the paper's vernier, and the split by the equations of the specification."""
    found = answer(capsys, 'preload', '--setting', '1', '79', '1', *PAPER)
    assert found['ring_turn'] == pytest.approx(4.878 * SECOND, rel=1e-4)
    assert found['preload'] == pytest.approx(0.0266, abs=5e-5)
    assert holes(found['setting']) == (1, 79, 1)
    assert found['stiffness']['branch_a'] is None  # rigid
    assert found['threshold_a'] is None  # never
    assert found['threshold_b'] == pytest.approx(-found['preload'])
    assert found['play'] == 0.0

    soft = answer(capsys, 'preload', '--degrees', degrees(-0.002), *SOFT)
    kAe, kB = 3e3 * 1e3 / 4e3, 2e3
    T0 = 80 / 76 * 0.002 / COMPLIANCE
    assert soft['preload'] == pytest.approx(T0)
    assert soft['threshold_a'] == pytest.approx(T0 * (1 + kB / kAe))
    assert soft['threshold_b'] == pytest.approx(-T0 * (1 + kAe / kB))
    assert soft['limit'] == pytest.approx(T0 * (kAe + kB) / kB)
    assert soft['stiffness'] == {
        'branch_a': 3000.0,
        'branch_b': 2000.0,
        'shaft': 1000.0,
        'inside': pytest.approx(kAe + kB),
        'without_a': 2000.0,
        'without_b': pytest.approx(kAe),
    }


@pytest.mark.parametrize(
    ('wish', 'figure', 'way'),
    [('preload', 'preload', 1), ('preload', 'preload', -1), ('threshold', 'limit', 1)],
)
def test_preload_finds_the_ring_turn_for_a_wish(wish, figure, way, capsys):
    """In either direction; it closes the backlash first."""
    known = ('--backlash', '0.001', *SOFT)
    found = answer(capsys, 'preload', f'--wanted-{wish}', 2 * way, *known)
    assert found[figure] == pytest.approx(2.0, rel=1e-12)
    turn = way * 76 / 80 * (0.001 + found['preload'] * COMPLIANCE)
    assert found['ring_turn'] == pytest.approx(turn)
    turned = answer(capsys, 'preload', '--degrees', degrees(found['ring_turn']), *known)
    assert turned['setting'] == found['setting']
    assert turned[figure] == pytest.approx(2.0, rel=1e-12)
    nearest = found['setting']
    assert nearest['ring_turn'] == pytest.approx(found['ring_turn'], abs=4.879 / 2 * SECOND)
    pinned = answer(capsys, 'preload', '--setting', *holes(nearest), *known)
    assert pinned[figure] == pytest.approx(nearest[figure], rel=1e-9)


def test_preload_reads_well(capsys, monkeypatch):
    for name, value in {'FORCE_COLOR': '1', 'TERM': 'dumb', 'COLUMNS': '100'}.items():
        monkeypatch.setenv(name, value)
    out = printed(capsys, 'preload', '--wanted-threshold', '2', *SOFT)
    assert 'branch a 3000 N·m/rad, branch b 2000 N·m/rad, shaft 1000 N·m/rad' in out
    assert re.search(r'With ring hole \d+ .* the preload is 1\.4\d+ N·m: both', out)
    assert '1.455 N·m in both branches without a load' in out
    assert 'for -2 to 5.333 N·m: 2750 N·m/rad' in out
    assert 'leaves mesh at +5.333 N·m; branch b alone: 2000 N·m/rad' in out
    assert 'leaves mesh at -2 N·m; branch a alone: 750 N·m/rad' in out
    out = printed(capsys, 'preload', '--degrees', '0.00572957795', '--backlash', '0.001', *SOFT)
    assert 'none; a play of 3′ 04.553″ remains' in out
    assert 'leaves mesh' not in out
    assert 'never leaves mesh' in printed(capsys, 'preload', '--degrees', '0.00572957795', *PAPER)


def test_plot_shows_the_split_and_its_thresholds(tmp_path, figures):
    """Curves as matplotlib gets them, at loads where the torques are known."""
    path = tmp_path / 'split.png'
    assert main(['preload', '--wanted-preload', '1', *SOFT, '--plot', str(path)]) == 0
    [figure] = figures
    torques, turns = figure.axes
    curves = {line.get_label(): line for line in torques.get_lines()}
    load, branch_a = curves['branch a'].get_data()
    _, branch_b = curves['branch b'].get_data()
    assert branch_b - branch_a == pytest.approx(load, abs=1e-12)
    assert min(branch_a) == min(branch_b) == 0.0
    at = [line.get_xdata()[0] for line in torques.get_lines() if line.get_linestyle() == '--']
    assert sorted(at) == pytest.approx([-1.375, 1 + 2000 / 750])
    _, seconds = turns.get_lines()[0].get_data()
    assert seconds[-1] == pytest.approx((load[-1] - 1.0) / 2000 / SECOND)


TURN = ('preload', '--degrees', '1')


@pytest.mark.parametrize(
    ('arguments', 'cause'),
    [
        (['index'], 'give --degrees or --phase-b'),
        (['index', '--degrees', 'nan'], 'at most a whole turn, not by nan°'),
        (['index', '--degrees', '361'], 'at most a whole turn, not by 361°'),
        (['index', '--degrees', '1', '--ring-teeth', '0'], 'must be between 2 and 100000, not 0'),
        (['preload', '--setting', '80', '0', '0', *SOFT], 'tooth 80 is not one of 0 to 79'),
        (['preload', *SOFT], 'one of the arguments --degrees --setting'),
        ([*TURN, '--branch-stiffness', '1'], 'are required: --shaft-stiffness'),
        ([*TURN, *SOFT, '--branch-stiffness', '1', '1', '1'], 'one value or two, not 3'),
        ([*TURN, *SOFT, '--backlash', '-1'], 'backlash must be finite and not negative'),
        (
            [*TURN, *SOFT, '--backlash', '0.1'],
            '--backlash must be less than a tooth pitch, 0.0827 rad',
        ),
        (
            ['preload', '--degrees', '200', *SOFT],
            'the preload twists the output by 3.67 rad: a gear takes at most 1 rad',
        ),
        ([*TURN, *SOFT, '--plot', 'plot.xyz'], 'plot.xyz: the suffix'),
        (['preload', '--wanted-preload', '1e6', *SOFT], 'at most a whole turn'),
    ],
)
def test_unusable_input_gets_one_clear_line_and_no_file(arguments, cause, tmp_path, monkeypatch):
    if '--plot' in arguments:
        pytest.importorskip('matplotlib')
    monkeypatch.chdir(tmp_path)
    assert cause in refusal(*arguments)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.slow
@pytest.mark.parametrize('arguments', [('--help',), ('--degrees', '0.0572957795', *PAPER)])
def test_a_pipe_that_knows_no_seconds_gets_the_rest(arguments):
    done = gearkin('preload', *arguments, env=os.environ | {'PYTHONIOENCODING': 'ascii'})
    assert (done.returncode, done.stderr) == (0, '')
    assert '\\xb7m' in done.stdout


@pytest.mark.parametrize('count', [1, 3])
def test_branches_that_cannot_be_braced_are_refused(count, tmp_path):
    config = tmp_path / 'branches.yaml'
    names = ', '.join('abc'[:count])
    config.write_text(f'/**:\n  ros__parameters:\n    branches: [{names}]\n')
    for command in (['index', '--phase-b'], ['preload', '--degrees', '0.0572957795', *SOFT]):
        error = refusal(*command, '--config', config)
        assert f'exactly two branches are needed, not {count}' in error


# From a recording.


def test_preload_for_a_recording_holds_with_its_margin_and_has_its_price(capsys):
    """The greatest torque of the recording is 4.0 N·m, of which branch B is relieved of 0.8."""
    bag = BAGS / 'servo_point_to_point'
    words = '--branch-stiffness', '3000', '--shaft-stiffness', '1000'
    found = answer(capsys, 'preload', '--from', bag, '--margin', '1.5', *words)
    assert found['preload'] == pytest.approx(1.5 * 0.8 * 4.0, rel=1e-3)
    text = printed(capsys, 'preload', '--from', bag, *words)
    assert '183.7 N at each mesh and cam' in text  # 1.2 × 3.2 N·m at 20.9 mm
    lost = refusal('preload', '--from', BAGS / 'single_turn_encoder', *words)
    assert 'the loads on /rotor_state are unknown: effort missing' in lost
