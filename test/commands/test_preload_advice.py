"""From ramps at several turns of the ring gear to the pins that leave no play."""

import json
import math

import numpy as np
import pytest
from blocked_bags import refusal
from braced_gears import BracedGear
from gear_recordings import quantised, ramps, write_csv

from gear_kinematics.commands.cli import main

GEAR = BracedGear(closing=80 / 76, backlash=0.004, friction=0.5)
TURNS = (0.0, 0.08, 0.15, 0.4, 0.6)  # degrees
LOAD = 2.0  # N·m


@pytest.fixture(scope='module')
def recordings(tmp_path_factory):
    folder = tmp_path_factory.mktemp('turns')
    torque = ramps(*[(6.0, 60)] * 4, *[(30.0, 90)] * 3)
    random = np.random.default_rng(5)
    paths = []
    for turn in TURNS:
        met = max(math.radians(turn + 0.004 * random.standard_normal()), 0.0)
        angle = quantised(GEAR.angles(torque, met), 1e-5)
        noisy = torque + 0.02 * random.standard_normal(len(torque))
        paths.append(write_csv(folder / f'gear_turn_{turn}.csv', angle=angle, torque=noisy))
    return [str(path) for path in paths]


@pytest.fixture(scope='module')
def advice(recordings, tmp_path_factory):
    path = tmp_path_factory.mktemp('advice') / 'ramps.json'
    options = ['--preloads', '--preload-unit', 'deg', '--load', str(LOAD), '--json', str(path)]
    assert main(['lost-motion', *recordings, *options]) == 0
    return path


@pytest.mark.slow
def test_ramps_at_several_turns_tell_the_least_one_without_play(advice):
    found = json.loads(advice.read_text('utf-8'))['preload']
    assert (found['unit'], found['ring_turns'], found['cause']) == ('deg', True, None)
    least = found['least']
    assert least['low'] <= GEAR.least(LOAD) <= least['high']
    assert least['high'] - least['low'] < 0.1 * least['value']
    price = found['price']
    true = GEAR.drag(GEAR.least(LOAD)) - GEAR.friction
    assert abs(price['value'] - true) <= price['expanded_uncertainty'] < true
    assert len(found['readings']) == len(TURNS)
    judged = [item['within'] for item in found['left_out'] if item['within'] is not None]
    assert len(judged) >= 10
    assert sum(judged) >= 0.8 * len(judged)


def test_index_gives_the_pins_for_it(advice, capsys):
    assert main(['index', '--measured', str(advice), '--load', str(LOAD), '--json', '-']) == 0
    found = json.loads(capsys.readouterr().out)
    least = json.loads(advice.read_text('utf-8'))['preload']['least']
    # The upper end of the interval suffices with a probability of 97.5 %.
    assert found['wanted']['ring_turn'] == pytest.approx(least['high'])
    assert found['measured']['least'] == pytest.approx(least)
    assert found['wanted']['preload'] == pytest.approx(GEAR.preload(least['high']), rel=0.05)
    assert main(['index', '--measured', str(advice), '--load', str(LOAD)]) == 0
    output = capsys.readouterr().out
    assert 'measured: no play under 2 N·m from ' in output
    assert 'N·m more friction' in output


def test_index_for_another_load_needs_less(advice, capsys):
    turns = []
    for load in ([], ['--load', '1'], ['--load', '2']):
        assert main(['index', '--measured', str(advice), *load, '--json', '-']) == 0
        turns.append(json.loads(capsys.readouterr().out)['measured']['least'])
    assert turns[0]['low'] <= GEAR.end <= turns[0]['high']
    assert turns[1]['low'] <= GEAR.least(1.0) <= turns[1]['high']
    assert turns[0]['value'] < turns[1]['value'] < turns[2]['value']


@pytest.mark.parametrize(
    ('arguments', 'complaint'),
    [
        (['--load', '2'], '--load needs --measured'),
        (['--measured', 'FILE', '--branch-stiffness', '300', '--shaft-stiffness', 'inf'],
         '--measured contains the stiffness and backlash, give no others'),
        (['--measured', 'FILE', '--ring-teeth', '100'], 'measured on a gear with other teeth'),
        (['--measured', 'nowhere.json'], 'nowhere.json: No such file or directory'),
        (['--measured', 'OTHER'], 'not the JSON of gearkin lost-motion with --preloads'),
    ],
)  # fmt: skip
def test_index_refuses_in_one_line(advice, tmp_path, arguments, complaint):
    other = tmp_path / 'other.json'
    other.write_text('{"recordings": []}', 'utf-8')
    paths = {'FILE': advice, 'OTHER': other}
    assert complaint in refusal('index', *(paths.get(word, word) for word in arguments))


def test_settings_without_a_unit_cannot_be_pinned(advice, tmp_path):
    found = json.loads(advice.read_text('utf-8'))
    found['preload']['ring_turns'] = False
    path = tmp_path / 'numbers.json'
    path.write_text(json.dumps(found), 'utf-8')
    assert 'its settings are plain numbers' in refusal('index', '--measured', path)


@pytest.mark.slow
def test_report_and_picture_show_the_least_setting(recordings, tmp_path, capsys):
    page = tmp_path / 'page.html'
    options = ['--preloads', '--preload-unit', 'deg', '--html', str(page)]
    assert main(['lost-motion', *recordings, *options]) == 0
    output = capsys.readouterr().out
    assert 'summary: no play without a load from the setting 0.2' in output
    assert 'Each setting was predicted from the others. Within ±: backlash ' in output
    text = page.read_text('utf-8')
    for panel in ('backlash over the preload', 'friction over the preload', 'least setting'):
        assert panel in text


@pytest.mark.parametrize(
    ('options', 'complaint'),
    [
        (['--load', '2'], '--load needs --preloads'),
        (['--preload-unit', 'deg'], '--preload-unit needs --preloads'),
        (['--preloads', '--trend'], '--preloads cannot be combined with --trend'),
        (['--preloads', '(gear)'], "'gear' is no setting"),
        (['--preloads', r'turn_(0)'], 'at 3 settings, not at 1'),
    ],
)
def test_unusable_options_get_one_line(recordings, options, complaint):
    assert complaint in refusal('lost-motion', *recordings[:2], *options)


def test_where_few_settings_show_play_there_are_bounds(recordings, tmp_path, capsys):
    path = tmp_path / 'few.json'
    few = [recordings[0], *recordings[3:]]
    options = ['--preloads', '--preload-unit', 'deg', '--json', str(path)]
    assert main(['lost-motion', *few, *options]) == 0
    output = capsys.readouterr().out
    assert 'summary: the play ends between the settings 0 deg and 0.4 deg; no ±: 1 recor' in output
    assert 'backlash: measured: below ' in output
    found = json.loads(path.read_text('utf-8'))['preload']
    assert found['least'] is found['price'] is None
    assert found['model']['play']['line'] is None
    assert 'no least turn with a ±: 1 recording shows play' in refusal('index', '--measured', path)
