"""gearkin index and preload as someone who sets a preload runs them."""

import json
import os
from fractions import Fraction
from itertools import pairwise
from xml.etree import ElementTree as ET

import pytest
from blocked_bags import gearkin, refusal

from gear_kinematics.commands.cli import main

PAPER = ('--branch-stiffness', 'inf', '--shaft-diameter', '0.012', '--shaft-length', '0.151')
SOFT = ('--branch-stiffness', '3000', '2000', '--shaft-stiffness', '1000')
SECOND = 4.848136811095360e-6  # rad


def answer(capsys, *arguments: str) -> dict:
    assert main([*arguments, '--json', '-']) == 0
    return json.loads(capsys.readouterr().out)


def holes(setting: dict) -> tuple[int, int, int]:
    return setting['tooth'], setting['ring_hole'], setting['chassis_hole']


def turn_of(ring_teeth: int, tooth: int, ring_hole: int, chassis_hole: int) -> Fraction:
    turn = Fraction(tooth, ring_teeth) + Fraction(ring_hole, ring_teeth + 1)
    return (turn + Fraction(chassis_hole, ring_teeth + 2)) % 1


def test_index_says_which_holes_to_pin_in_words(capsys):
    assert main(['index', '--angle', '0.001', *PAPER]) == 0
    out = capsys.readouterr().out
    assert '265680 positions, one every 4.878″' in out
    assert 'ring hole 78 in chassis hole 1, tooth 2' in out
    assert 'ring hole 78 in chassis hole 42, tooth 42: the same position' in out
    assert '3′ 24.878″ for a wanted 3′ 26.265″ (-1.387″)' in out
    assert '1.118 N·m for a wanted 1.125 N·m (-0.0076 N·m)' in out
    assert all(len(line) <= 80 for line in out.splitlines() if not line.startswith('remark'))


def test_index_for_a_preload_steps_by_the_preload_of_the_paper(capsys):
    found = answer(capsys, 'index', '--preload', '0.5', *PAPER)
    assert found['wanted']['preload'] == pytest.approx(0.5, rel=1e-14)
    preloads = [row['preload'] for row in found['positions_around']]
    for lower, higher in pairwise(preloads):
        assert higher - lower == pytest.approx(0.0266, abs=5e-5)
    errors = [row['preload_error'] for row in found['positions_around']]
    assert errors == pytest.approx([preload - 0.5 for preload in preloads], abs=1e-15)
    assert min(errors, key=abs) == errors[3]


def test_index_closes_the_backlash_first_and_turns_either_way(capsys):
    one_way = answer(capsys, 'index', '--preload', '0.5', '--backlash', '0.002', *SOFT)
    back = answer(capsys, 'index', '--preload', '-0.5', '--backlash', '0.002', *SOFT)
    turn = one_way['wanted']['ring_turn']
    assert turn == pytest.approx(76 / 80 * (0.002 + 0.5 * (1 / 3e3 + 1 / 2e3 + 1 / 1e3)))
    assert back['wanted']['ring_turn'] == -turn
    assert back['wanted']['preload'] == pytest.approx(0.5, rel=1e-12)
    assert back['positions_around'][3]['preload'] == one_way['positions_around'][3]['preload']


def test_index_turns_on_from_a_setting(capsys):
    start = ('23', '17', '5')
    found = answer(capsys, 'index', '--degrees', '-0.01', '--from', *start, '--neighbours', '0')
    assert (found['ring_holes'], found['chassis_holes'], found['positions']) == (81, 82, 265_680)
    [row] = found['positions_around']
    assert (row['steps'], row['preload']) == (0, None)
    turned = turn_of(80, *holes(row['settings'][0])) - turn_of(80, 23, 17, 5)
    turned -= round(turned)
    assert float(turned) * 360.0 == pytest.approx(-0.01, abs=4.879 / 2 / 3600)
    assert row['ring_turn'] == pytest.approx(float(turned) * 1296e3 * SECOND, abs=1e-15)
    bodies = [Fraction(setting['body_turn']) for setting in row['settings']]
    from_start = [body - Fraction(found['from']['body_turn']) for body in bodies]
    ways = [abs(way - round(way)) for way in from_start]
    assert ways[0] < ways[1]


def test_index_gives_the_phase_of_branch_b(capsys):
    odd = ('--ring-teeth', '61', '--satellite-teeth', '58')
    found = answer(capsys, 'index', '--phase-b', *odd)
    assert found['wanted']['phase'] == pytest.approx(1296e3 / 122 * SECOND, rel=1e-12)
    braced = answer(capsys, 'index', '--phase-b', '--preload', '0.5', *odd, *SOFT)
    assert braced['wanted']['preload'] == pytest.approx(0.5, rel=1e-9)
    turn = 58 / 61 * 0.5 * (1 / 3e3 + 1 / 2e3 + 1 / 1e3)
    assert braced['wanted']['ring_turn'] == pytest.approx(found['wanted']['phase'] + turn)
    assert main(['index', '--phase-b', *odd]) == 0
    assert '2° 57′ 02.951″ of it' in capsys.readouterr().out
    assert answer(capsys, 'index', '--phase-b')['wanted']['phase'] == pytest.approx(0.0, abs=1e-16)


def test_index_draws_the_pinned_holes(tmp_path, capsys):
    path = tmp_path / 'pin.svg'
    assert main(['index', '--angle', '0.001', '--drawing', str(path), '--mirrored']) == 0
    words = [text.text for text in ET.parse(path).iterfind('.//{*}text')]  # noqa: S314, our own
    assert 'Ring hole 78 in chassis hole 1' in words
    assert 'turn 3′ 24.878″ for a wanted 3′ 26.265″ (-1.387″)' in words
    assert any((word or '').startswith('Seen along the z axis') for word in words)
    assert 'ring hole 78 in chassis hole 1' in capsys.readouterr().out
    assert main(['index', '--angle', '0.001', '--drawing', '-']) == 0
    assert ET.fromstring(capsys.readouterr().out).get('width') == '210mm'  # noqa: S314, our own


def test_preload_of_a_ring_turn(capsys):
    """One step of the paper's vernier, and the split by the equations of the specification."""
    found = answer(
        capsys, 'preload', '--setting', '4', '74', '3', '--from', '3', '76', '2', *PAPER
    )
    assert found['ring_turn'] == pytest.approx(4.878 * SECOND, rel=1e-4)
    assert found['preload'] == pytest.approx(0.0266, abs=5e-5)
    assert found['stiffness']['shaft'] == pytest.approx(1069.0, abs=0.5)
    assert found['stiffness']['branch_a'] is None  # rigid
    assert found['threshold_a'] is None  # never
    assert found['threshold_b'] == pytest.approx(-found['preload'])
    assert found['play'] == 0.0

    soft = answer(capsys, 'preload', '--angle', '-0.002', *SOFT, '--max-load', '4')
    kAe, kB = 3e3 * 1e3 / 4e3, 2e3
    T0 = 80 / 76 * 0.002 / (1 / 3e3 + 1 / 2e3 + 1 / 1e3)
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
    split = soft['split']
    assert split['load'] == pytest.approx([-4, -3, -2, soft['threshold_b'], -1, 0, 1, 2, 3, 4])
    inside = [
        k
        for k, load in enumerate(split['load'])
        if soft['threshold_b'] <= load <= soft['threshold_a']
    ]
    assert len(inside) >= 5
    for k in inside:
        load = split['load'][k]
        assert split['branch_a'][k] == pytest.approx(T0 - kAe * load / (kAe + kB))
        assert split['branch_b'][k] == pytest.approx(T0 + kB * load / (kAe + kB), abs=1e-12)
    assert split['branch_a'][:3] == [4.0, 3.0, 2.0]
    assert split['branch_b'][:3] == [0.0, 0.0, 0.0]


@pytest.mark.parametrize(('wish', 'figure'), [('preload', 'preload'), ('threshold', 'limit')])
def test_preload_finds_the_ring_turn_for_a_wish(wish, figure, capsys):
    found = answer(capsys, 'preload', f'--wanted-{wish}', '2', '--backlash', '0.001', *SOFT)
    assert found[figure] == pytest.approx(2.0, rel=1e-12)
    turn = ('--angle', repr(found['ring_turn']))
    turned = answer(capsys, 'preload', *turn, '--backlash', '0.001', *SOFT)
    assert turned['setting'] == found['setting']
    assert turned[figure] == pytest.approx(2.0, rel=1e-12)
    nearest = found['setting']
    assert nearest['ring_turn'] == pytest.approx(found['ring_turn'], abs=4.879 / 2 * SECOND)
    pins = [str(hole) for hole in holes(nearest)]
    pinned = answer(capsys, 'preload', '--setting', *pins, '--backlash', '0.001', *SOFT)
    assert pinned[figure] == pytest.approx(nearest[figure], rel=1e-9)


def test_preload_reads_well(capsys, monkeypatch):
    for name, value in {'FORCE_COLOR': '1', 'TERM': 'dumb', 'COLUMNS': '100'}.items():
        monkeypatch.setenv(name, value)
    assert main(['preload', '--wanted-threshold', '2', *SOFT]) == 0
    out = capsys.readouterr().out
    assert 'branch a 3000 N·m/rad, branch b 2000 N·m/rad, shaft 1000 N·m/rad' in out
    assert '1.455 N·m in both branches without a load' in out
    assert 'while |load| < 2 N·m: 2750 N·m/rad' in out
    assert 'leaves mesh at +5.333 N·m; branch b alone: 2000 N·m/rad' in out
    assert 'leaves mesh at -2 N·m; branch a alone: 750 N·m/rad' in out
    rows = [line.split() for line in out.splitlines() if line.endswith('leaves mesh ')]
    assert [row[:3] for row in rows] == [['-2.000', '2.000', '0.000'], ['5.333', '0.000', '5.333']]
    assert main(['preload', '--angle', '0.0001', '--backlash', '0.001', *SOFT]) == 0
    out = capsys.readouterr().out
    assert 'none; a play of 3′ 04.553″ remains' in out
    assert 'leaves mesh' not in out
    assert main(['preload', '--angle', '0.0001', *PAPER]) == 0
    assert 'never leaves mesh' in capsys.readouterr().out


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


ANGLE = ('preload', '--angle', '1')


@pytest.mark.parametrize(
    ('arguments', 'cause'),
    [
        (['index'], 'give --angle, --degrees, --preload, --measured or --phase-b'),
        (['index', '--preload', '1'], '--preload needs the stiffness of branches and shaft'),
        (['index', '--angle', 'nan'], 'at most a whole turn, not by nan rad'),
        (['index', '--degrees', '361'], 'at most a whole turn, not by 6.30064 rad'),
        (['index', '--angle', '1', '--ring-teeth', '0'], 'must be between 2 and 100000, not 0'),
        (['index', '--angle', '1', '--ring-teeth', '-3'], 'at least 1 tooth, not -3'),
        (['index', '--angle', '1', '--from', '80', '0', '0'], 'tooth 80 is not one of 0 to 79'),
        (['index', '--angle', '1', '--neighbours', '-1'], 'must be 0 to 1000, not -1'),
        (['index', '--angle', '1', '--backlash', '0.1'], '--branch-stiffness is missing'),
        (['index', '--angle', '1', '--mirrored'], '--mirrored needs --drawing'),
        (['index', '--angle', '1', '--json', '-', '--drawing', '-'], 'not --json and --drawing'),
        (['index', '--angle', '1', '--ring-teeth', '2000', '--drawing', 'a.svg'], '1000 teeth'),
        ([*ANGLE], 'stiffness of branches and shaft is missing'),
        ([*ANGLE, '--branch-stiffness', '1'], '--shaft-length is missing'),
        ([*ANGLE, *SOFT, '--shaft-length', '1'], 'exclude each other'),
        ([*ANGLE, '--branch-stiffness', '1', '1', '1'], 'one value or two, not 3'),
        ([*ANGLE, *SOFT, '--backlash', '-1'], 'backlash must be finite and not negative'),
        ([*ANGLE, *SOFT, '--max-load', '0'], '--max-load must be finite'),
        ([*ANGLE, *SOFT, '--plot', 'plot.xyz'], 'plot.xyz: the suffix'),
        ([*ANGLE, *PAPER, '--shear-modulus', '0'], 'shear modulus must be'),
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
    done = gearkin('index', *arguments, env=os.environ | {'PYTHONIOENCODING': 'ascii'})
    assert (done.returncode, done.stderr) == (0, '')
    assert '\\xb7m' in done.stdout


@pytest.mark.parametrize('count', ['1', '3'])
def test_branches_that_cannot_be_braced_are_refused(count, tmp_path):
    config = tmp_path / 'branches.yaml'
    names = ', '.join('abc'[: int(count)])
    config.write_text(f'/**:\n  ros__parameters:\n    branches: [{names}]\n')
    for command in (['index', '--phase-b'], ['preload', '--angle', '0.001', *SOFT]):
        error = refusal(*command, '--config', config)
        assert f'exactly two branches are needed, not {count}' in error
