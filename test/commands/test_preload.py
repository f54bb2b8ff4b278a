# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""gearkin index and preload as someone who sets a preload runs them."""

import json
import os
import re
from fractions import Fraction
from xml.etree import ElementTree as ET

import numpy as np
import pytest
from advising import readings
from blocked_bags import gearkin, refusal
from braced_gears import BracedGear

from gear_kinematics.commands.cli import main
from gear_kinematics.measurement.preload.advice import advise
from gear_kinematics.measurement.wording import plain

PAPER = ('--branch-stiffness', 'inf', '--shaft-diameter', '0.012', '--shaft-length', '0.151')
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


def turn_of(ring_teeth: int, tooth: int, ring_hole: int, chassis_hole: int) -> Fraction:
    turn = Fraction(tooth, ring_teeth) + Fraction(ring_hole, ring_teeth + 1)
    return (turn + Fraction(chassis_hole, ring_teeth + 2)) % 1


# The vernier.


def test_index_says_which_holes_to_pin_in_words(capsys):
    out = printed(capsys, 'index', '--angle', '0.001')
    pins = 'Pin ring hole 78 in chassis hole 1, tooth 2'
    turn = 'the ring gear turns by 3′ 24.878″, 1.387″ less than wanted.'
    assert out.startswith(f'result: {pins}: {turn}\n')
    assert '265680 positions, one every 4.878″' in out
    assert 'ring hole 78 in chassis hole 1, tooth 2' in out
    assert 'ring hole 78 in chassis hole 42, tooth 42: the same position' in out
    assert '3′ 24.878″ for a wanted 3′ 26.265″ (-1.387″)' in out
    row = 'steps 0: tooth: 2 or 42; ring hole: 78; chassis hole: 1 or 42; turn: 3′ 24.878″; error'
    assert row in out


def test_index_turns_on_from_a_setting(capsys):
    start = ('23', '17', '5')
    found = answer(capsys, 'index', '--degrees', '-0.01', '--from', *start, '--neighbours', '0')
    assert (found['ring_holes'], found['chassis_holes'], found['positions']) == (81, 82, 265_680)
    [row] = found['positions_around']
    assert row['steps'] == 0
    turned = turn_of(80, *holes(row['settings'][0])) - turn_of(80, 23, 17, 5)
    turned -= round(turned)
    assert float(turned) * 360.0 == pytest.approx(-0.01, abs=4.879 / 2 / 3600)
    assert row['ring_turn'] == pytest.approx(float(turned) * 1296e3 * SECOND, abs=1e-15)
    bodies = [Fraction(setting['body_turn']) for setting in row['settings']]
    from_start = [body - Fraction(found['from']['body_turn']) for body in bodies]
    ways = [abs(way - round(way)) for way in from_start]
    assert ways[0] < ways[1]


def test_the_phase_of_branch_b_is_added(capsys):
    phase = answer(capsys, 'index', '--phase-b', *ODD)['wanted']['phase']
    assert phase == pytest.approx(1296e3 / 122 * SECOND, rel=1e-12)
    braced = answer(capsys, 'preload', '--phase-b', '--wanted-preload', '0.5', *ODD, *SOFT)
    assert braced['preload'] == pytest.approx(0.5, rel=1e-9)
    assert braced['ring_turn'] == pytest.approx(phase + 58 / 61 * 0.5 * COMPLIANCE)
    assert '2° 57′ 02.951″ of it' in printed(capsys, 'index', '--phase-b', *ODD)
    assert answer(capsys, 'index', '--phase-b')['wanted']['phase'] == pytest.approx(0.0, abs=1e-16)


@pytest.mark.parametrize('command', [('index',), ('preload', *PAPER)], ids=lambda words: words[0])
def test_the_pinned_holes_are_drawn(command, tmp_path, capsys):
    path, turn = tmp_path / 'pin.svg', ('--angle', '0.001')
    out = printed(capsys, *command, *turn, '--drawing', path, '--mirrored')
    assert 'ring hole 78 in chassis hole 1' in out
    words = [text.text for text in ET.parse(path).iterfind('.//{*}text')]  # noqa: S314, our own
    assert 'Ring hole 78 in chassis hole 1' in words
    assert 'turn 3′ 24.878″ for a wanted 3′ 26.265″ (-1.387″)' in words
    assert any((word or '').startswith('Seen along the z axis') for word in words)
    drawn = printed(capsys, *command, *turn, '--drawing', '-')
    assert ET.fromstring(drawn).get('width') == '210mm'  # noqa: S314, our own


# The preload.


def test_preload_of_a_ring_turn(capsys):
    """One step of the paper's vernier, and the split by the equations of the specification."""
    start = ('--setting', '4', '74', '3', '--from', '3', '76', '2')
    found = answer(capsys, 'preload', *start, *PAPER)
    assert found['ring_turn'] == pytest.approx(4.878 * SECOND, rel=1e-4)
    assert found['preload'] == pytest.approx(0.0266, abs=5e-5)
    assert holes(found['setting']) == (4, 74, 3)
    assert found['stiffness']['shaft'] == pytest.approx(1069.0, abs=0.5)
    assert found['stiffness']['branch_a'] is None  # rigid
    assert found['threshold_a'] is None  # never
    assert found['threshold_b'] == pytest.approx(-found['preload'])
    assert found['play'] == 0.0

    soft = answer(capsys, 'preload', '--angle', '-0.002', *SOFT)
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
    loads, *torques = (soft['split'][name] for name in ('load', 'branch_a', 'branch_b'))
    assert loads == pytest.approx([-6, -4.5, -3, soft['threshold_b'], -1.5, 0, 1.5, 3,
                                   soft['threshold_a'], 4.5, 6])  # fmt: skip
    for load, of_a, of_b in zip(loads, *torques, strict=True):
        if load < soft['threshold_b']:
            expected = -load, 0.0
        elif load > soft['threshold_a']:
            expected = 0.0, load
        else:
            expected = T0 - kAe * load / (kAe + kB), T0 + kB * load / (kAe + kB)
        assert (of_a, of_b) == pytest.approx(expected, abs=1e-12)


@pytest.mark.parametrize(('wish', 'figure'), [('preload', 'preload'), ('threshold', 'limit')])
def test_preload_finds_the_ring_turn_for_a_wish(wish, figure, capsys):
    known = ('--backlash', '0.001', *SOFT)
    found = answer(capsys, 'preload', f'--wanted-{wish}', '2', *known)
    assert found[figure] == pytest.approx(2.0, rel=1e-12)
    turned = answer(capsys, 'preload', '--angle', repr(found['ring_turn']), *known)
    assert turned['setting'] == found['setting']
    assert turned[figure] == pytest.approx(2.0, rel=1e-12)
    nearest = found['setting']
    assert nearest['ring_turn'] == pytest.approx(found['ring_turn'], abs=4.879 / 2 * SECOND)
    pinned = answer(capsys, 'preload', '--setting', *holes(nearest), *known)
    assert pinned[figure] == pytest.approx(nearest[figure], rel=1e-9)


def test_preload_closes_the_backlash_first_and_turns_either_way(capsys):
    one_way, back = (
        answer(capsys, 'preload', '--wanted-preload', wanted, '--backlash', '0.002', *SOFT)
        for wanted in ('0.5', '-0.5')
    )
    assert one_way['ring_turn'] == pytest.approx(76 / 80 * (0.002 + 0.5 * COMPLIANCE))
    assert back['ring_turn'] == -one_way['ring_turn']
    assert back['preload'] == pytest.approx(0.5, rel=1e-12)
    assert back['setting']['preload'] == pytest.approx(one_way['setting']['preload'])


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
    rows = [line.split() for line in out.splitlines() if line.endswith('leaves mesh ')]
    assert [row[:3] for row in rows] == [['-2.000', '2.000', '0.000'], ['5.333', '0.000', '5.333']]
    out = printed(capsys, 'preload', '--angle', '0.0001', '--backlash', '0.001', *SOFT)
    assert 'none; a play of 3′ 04.553″ remains' in out
    assert 'leaves mesh' not in out
    assert 'never leaves mesh' in printed(capsys, 'preload', '--angle', '0.0001', *PAPER)


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


# The advice of ramps at several turns of the ring gear.

GEAR = BracedGear(closing=80 / 76, backlash=0.004, friction=0.5)
TURNS = np.radians((0.0, 0.08, 0.15, 0.35, 0.45, 0.6))
LOAD = 2.0  # N·m


@pytest.fixture(scope='module')
def advice():
    """Recordings that scatter by 1 %, as in the JSON of gearkin lost-motion."""
    found = readings(GEAR, TURNS.tolist(), 0.01, np.random.default_rng(5))
    advised = plain(vars(advise(found, GEAR.closing, LOAD)))
    return {'closing': GEAR.closing, 'load': LOAD, 'cause': None, **advised}


@pytest.fixture
def ramps(advice, tmp_path):
    """Write that JSON, with some keys changed."""

    def write(**keys):
        path = tmp_path / 'ramps.json'
        path.write_text(json.dumps({'preload': advice | keys}), 'utf-8')
        return path

    return write


def test_measured_ramps_give_the_pins_for_the_upper_end(ramps, capsys):
    words = ('preload', '--measured', ramps(), '--load', LOAD)
    found = answer(capsys, *words)
    least = found['measured']['least']
    assert least['low'] <= GEAR.least(LOAD) <= least['high'] < 1.1 * GEAR.least(LOAD)
    assert found['ring_turn'] == pytest.approx(least['high'])
    assert found['preload'] == pytest.approx(GEAR.preload(least['high']), rel=0.1)
    output = printed(capsys, *words)
    assert output == printed(capsys, *words[:3])  # the load is that of the file
    assert 'measured: both branches stay in mesh under 2 N·m from ' in output
    assert 'added friction' in output
    output = printed(capsys, 'preload', '--measured', ramps(load=None, added_friction=None))
    assert 'measured: hysteresis falls no further from ' in output


ANGLE = ('preload', '--angle', '1')
MEASURED = ['preload', '--measured', 'FILE']


@pytest.mark.parametrize(
    ('keys', 'arguments', 'cause'),
    [
        ({'load': None}, [*MEASURED, '--load', '2'], 'made without --load, not for 2 N·m'),
        ({}, [*MEASURED, '--load', '3'], 'made for 2 N·m, not for 3 N·m'),
        ({}, [*MEASURED, *SOFT], 'contains the stiffness and backlash, give no others'),
        ({}, [*MEASURED, '--ring-teeth', '100'], 'measured on a gear with other teeth'),
        ({'closing': None}, MEASURED, 'its settings are plain numbers'),
        ({'cause': 'nothing falls'}, MEASURED, 'no least turn: nothing falls'),
        ({'least': 1}, MEASURED, 'not the JSON of gearkin lost-motion with --preloads'),
        ({}, [*MEASURED[:2], 'nowhere.json'], 'nowhere.json: No such file or directory'),
    ],
)
def test_measured_ramps_are_refused_in_one_line(ramps, keys, arguments, cause):
    path = ramps(**keys)
    assert cause in refusal(*(path if word == 'FILE' else word for word in arguments))


@pytest.mark.parametrize(
    ('arguments', 'cause'),
    [
        (['index'], 'give --angle, --degrees or --phase-b'),
        (['index', '--preload', '1'], '--preload: see --wanted-preload of gearkin preload; see'),
        (['index', '--measured', 'a.json'], '--measured: see --measured of gearkin preload; see'),
        (['index', '--angle', 'nan'], 'at most a whole turn, not by nan rad'),
        (['index', '--degrees', '361'], 'at most a whole turn, not by 6.30064 rad'),
        (['index', '--angle', '1', '--ring-teeth', '0'], 'must be between 2 and 100000, not 0'),
        (['index', '--angle', '1', '--ring-teeth', '-3'], 'at least 1 tooth, not -3'),
        (['index', '--angle', '1', '--from', '80', '0', '0'], 'tooth 80 is not one of 0 to 79'),
        (['index', '--angle', '1', '--neighbours', '-1'], 'must be between 0 and 1000, not -1'),
        (['index', '--angle', '1', '--json', '-', '--drawing', '-'], 'not --json and --drawing'),
        (['index', '--angle', '1', '--ring-teeth', '2000', '--drawing', 'a.svg'], '1000 teeth'),
        (['preload', *SOFT], 'one of the arguments --angle --degrees --setting'),
        ([*ANGLE], '--branch-stiffness is missing'),
        ([*ANGLE, '--branch-stiffness', '1'], '--shaft-length is missing'),
        ([*ANGLE, *SOFT, '--shaft-length', '1'], 'exclude each other'),
        ([*ANGLE, '--branch-stiffness', '1', '1', '1'], 'one value or two, not 3'),
        ([*ANGLE, *SOFT, '--backlash', '-1'], 'backlash must be finite and not negative'),
        ([*ANGLE, *SOFT, '--load', '2'], '--load needs --measured'),
        ([*ANGLE, *SOFT, '--plot', 'plot.xyz'], 'plot.xyz: the suffix'),
        (['preload', '--wanted-preload', '1e9', *SOFT], 'at most a whole turn'),
    ],
)
def test_unusable_input_gets_one_clear_line_and_no_file(arguments, cause, tmp_path, monkeypatch):
    if '--plot' in arguments:
        pytest.importorskip('matplotlib')
    monkeypatch.chdir(tmp_path)
    assert cause in refusal(*arguments)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.slow
@pytest.mark.parametrize('arguments', [('--help',), ('--angle', '0.001', *PAPER)])
def test_a_pipe_that_knows_no_seconds_gets_the_rest(arguments):
    done = gearkin('preload', *arguments, env=os.environ | {'PYTHONIOENCODING': 'ascii'})
    assert (done.returncode, done.stderr) == (0, '')
    assert '\\xb7m' in done.stdout


@pytest.mark.parametrize('count', [1, 3])
def test_branches_that_cannot_be_braced_are_refused(count, tmp_path):
    config = tmp_path / 'branches.yaml'
    names = ', '.join('abc'[:count])
    config.write_text(f'/**:\n  ros__parameters:\n    branches: [{names}]\n')
    for command in (['index', '--phase-b'], ['preload', '--angle', '0.001', *SOFT]):
        error = refusal(*command, '--config', config)
        assert f'exactly two branches are needed, not {count}' in error
