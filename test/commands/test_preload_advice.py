"""From the advice of ramps at several turns of the ring gear to the pins."""

import json

import numpy as np
import pytest
from advising import readings
from blocked_bags import refusal
from braced_gears import BracedGear

from gear_kinematics.commands.cli import main
from gear_kinematics.measurement.preload.advice import advise
from gear_kinematics.measurement.wording import plain

GEAR = BracedGear(closing=80 / 76, backlash=0.004, friction=0.5)
TURNS = np.radians((0.0, 0.08, 0.15, 0.35, 0.45, 0.6))
LOAD = 2.0  # N·m


@pytest.fixture(scope='module')
def ramps_json(tmp_path_factory):
    """The JSON of recordings that scatter by 1 %."""
    found = readings(GEAR, TURNS.tolist(), 0.01, np.random.default_rng(5))
    advice = plain(vars(advise(found, GEAR.closing, LOAD)))
    path = tmp_path_factory.mktemp('advice') / 'ramps.json'
    preload = {'closing': GEAR.closing, 'load': LOAD, 'cause': None, **advice}
    path.write_text(json.dumps({'preload': preload}), 'utf-8')
    return path


def changed(path, folder, **keys):
    found = json.loads(path.read_text('utf-8'))
    found['preload'].update(keys)
    (folder / 'changed.json').write_text(json.dumps(found), 'utf-8')
    return folder / 'changed.json'


def test_index_gives_the_pins_for_the_upper_end(ramps_json, capsys):
    assert main(['index', '--measured', str(ramps_json), '--load', str(LOAD), '--json', '-']) == 0
    found = json.loads(capsys.readouterr().out)
    least = found['measured']['least']
    assert least['low'] <= GEAR.least(LOAD) <= least['high'] < 1.1 * GEAR.least(LOAD)
    assert found['wanted']['ring_turn'] == pytest.approx(least['high'])
    assert found['wanted']['preload'] == pytest.approx(GEAR.preload(least['high']), rel=0.1)
    assert main(['index', '--measured', str(ramps_json), '--load', str(LOAD)]) == 0
    output = capsys.readouterr().out
    assert 'measured: both branches stay in mesh under 2 N·m from ' in output
    assert 'added friction: ' in output


def test_index_takes_the_load_of_the_file(ramps_json, tmp_path, capsys):
    assert main(['index', '--measured', str(ramps_json)]) == 0
    assert 'both branches stay in mesh under 2 N·m from ' in capsys.readouterr().out
    path = changed(ramps_json, tmp_path, load=None, added_friction=None)
    assert main(['index', '--measured', str(path)]) == 0
    assert 'measured: hysteresis falls no further from ' in capsys.readouterr().out
    assert 'made without --load, not for 2 N·m' in refusal(
        'index', '--measured', path, '--load', '2'
    )


@pytest.mark.parametrize(
    ('arguments', 'complaint'),
    [
        (['--load', '2'], '--load needs --measured'),
        (['--measured', 'FILE', '--branch-stiffness', '300', '--shaft-stiffness', 'inf'],
         '--measured contains the stiffness and backlash, give no others'),
        (['--measured', 'FILE', '--ring-teeth', '100'], 'measured on a gear with other teeth'),
        (['--measured', 'FILE', '--load', '3'], 'made for 2 N·m, not for 3 N·m'),
        (['--measured', 'nowhere.json'], 'nowhere.json: No such file or directory'),
        (['--measured', 'OTHER'], 'not the JSON of gearkin lost-motion with --preloads'),
    ],
)  # fmt: skip
def test_index_refuses_in_one_line(ramps_json, tmp_path, arguments, complaint):
    other = tmp_path / 'other.json'
    other.write_text('{"recordings": []}', 'utf-8')
    paths = {'FILE': ramps_json, 'OTHER': other}
    assert complaint in refusal('index', *(paths.get(word, word) for word in arguments))


def test_only_turns_with_an_interval_can_be_pinned(ramps_json, tmp_path):
    path = changed(ramps_json, tmp_path, closing=None)
    assert 'its settings are plain numbers' in refusal('index', '--measured', path)
    path = changed(ramps_json, tmp_path, cause='no figure clearly falls')
    assert 'no least turn: no figure clearly falls' in refusal('index', '--measured', path)
