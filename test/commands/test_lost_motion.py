"""gearkin lost-motion as a user runs it."""

import json
import math
import re
import struct
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from blocked_bags import facts, refusal
from dask_cluster import cluster
from gear_recordings import Gear, Samples, creep, ramps, write_csv, write_recording
from lxml import html
from simulated_ramps import SCENARIOS, simulate

from gear_kinematics.commands import lost_motion
from gear_kinematics.commands.cli import main
from gear_kinematics.lost_motion import Columns, measure, read_csv
from gear_kinematics.lost_motion.curves import panels
from gear_kinematics.lost_motion.tables import key
from gear_kinematics.lost_motion.task import Outcome, measure_recording
from gear_kinematics.lost_motion.wording import rounded
from gear_kinematics.state.uncertainty import Component, Estimate

GEAR = Gear(play=0.02, stiffness=300.0, friction=0.5)


KNOWN: dict[str, Outcome] = {}


def measured_once(task, progress):
    """Measure a recording unless that has been done, in the same way."""
    written = task.path.stat().st_mtime_ns if task.path.exists() else None
    key = repr((replace(task, number=0, path=task.path.absolute()), written))
    if key not in KNOWN:
        KNOWN[key] = measure_recording(task, progress)
    return KNOWN[key]


@pytest.fixture(autouse=True)
def share_outcomes(monkeypatch):
    """What is tested here is what the command makes of them."""
    monkeypatch.setattr(lost_motion, 'measure_recording', measured_once)


@pytest.fixture(scope='module')
def recording(tmp_path_factory):
    torque = ramps(*[(4.0, 150)] * 3, *[(40.0, 300)] * 2)
    angle = np.degrees(creep(GEAR, torque))
    folder = tmp_path_factory.mktemp('csv')
    return write_csv(folder / 'gear.csv', angle_deg=angle, torque=torque)


@pytest.fixture(scope='module')
def motion(tmp_path_factory):
    ideal = np.concatenate([np.linspace(0.0, 15.0, 9000), np.linspace(15.0, 0.0, 9000)])
    output = ideal + 1e-3 * np.sin(19 * ideal) - 2e-3 * (np.arange(18000) < 9000)
    folder = tmp_path_factory.mktemp('csv')
    return write_csv(folder / 'motion.csv', rotor=-19.0 * ideal, output=output)


def test_plain_report_tells_figures_with_their_units(recording, capsys):
    assert main(['lost-motion', str(recording)]) == 0
    told = facts(capsys.readouterr().out)
    arcmin = math.degrees(GEAR.play + 2 * GEAR.friction / GEAR.stiffness) * 60.0
    assert float(told['hysteresis at zero torque: value'].removesuffix(' arcmin')) == (
        pytest.approx(arcmin, abs=0.1)
    )
    assert float(told['backlash (play model): in degrees'].removesuffix('°')) == (
        pytest.approx(math.degrees(GEAR.play), abs=0.002)
    )
    assert told['backlash (play model): from'] == '3 loops to 4 N·m'
    assert told['stiffness 20 to 40 N·m: value'].endswith(' N·m/rad')
    assert told['rated torque'] == '40 N·m (largest ramps)'


def test_report_says_what_is_inferred(recording, motion, capsys):
    assert main(['lost-motion', str(recording)]) == 0
    output = capsys.readouterr().out
    assert 'Inferred, not measured' in output
    assert main(['lost-motion', str(motion)]) == 0
    output = capsys.readouterr().out
    assert 'Inferred' not in output


def test_figures_that_their_uncertainty_exceeds_are_named_beside_the_table(
    tmp_path, actuator, capsys
):
    """The second of two large loops is three times as soft."""
    torque = ramps(*[(4.0, 150)] * 3, *[(40.0, 300)] * 2)
    angle = creep(GEAR, torque) * np.where(np.arange(len(torque)) < 3000, 1.0, 3.0)
    path = write_csv(tmp_path / 'changed.csv', angle=angle, torque=torque)
    assert main(['lost-motion', str(path)]) == 0
    output = capsys.readouterr().out
    told = facts(output)
    assert told['hysteresis at zero torque: value']
    assert 'stiffness 20 to 40 N·m: value' not in told
    assert told['20 to 40 N·m, ramps to 40 N·m: both']
    value, uncertainty = re.search(
        r'Too uncertain to tell.* stiffness 20 to 40 N·m \((\d+) ± (\d+) N·m/rad\)', output
    ).groups()
    assert float(value) < float(uncertainty)
    report = measure(read_csv(path, actuator, Columns(), 0.01), actuator)
    headline = {label for _, label, _ in key(report).facts()}
    assert 'hysteresis [arcmin]' in headline
    assert 'stiffness [N·m/rad]' not in headline


def test_json_is_in_si_units_and_has_every_figure(recording, capsys):
    assert main(['lost-motion', str(recording), '--json', '-']) == 0
    document = json.loads(capsys.readouterr().out)
    assert (document['schema'], document['version']) == ('gear_kinematics/lost_motion', 1)
    assert document['coverage'] == 0.95
    (found,) = document['recordings']
    assert found['recording'] == 'gear.csv'
    small, large = found['hysteresis']['figures']
    assert small['play_model']['play']['value'] == pytest.approx(GEAR.play, abs=5e-5)
    assert small['hysteresis'].keys() == {
        'value', 'standard_uncertainty', 'degrees_of_freedom', 'expanded_uncertainty', 'repeats'
    }  # fmt: skip
    assert large['stiffness'][-1]['both']['value'] == pytest.approx(GEAR.stiffness, rel=1e-3)
    assert found['hysteresis']['measured'] is False
    assert found['transmission'] is None


def test_rated_torque_and_ranges_can_be_told(recording, capsys):
    arguments = ['--rated-torque', '50', '--stiffness-torques', '30', '10', '--json', '-']
    assert main(['lost-motion', str(recording), *arguments]) == 0
    (found,) = json.loads(capsys.readouterr().out)['recordings']
    assert found['hysteresis']['settings']['rated_torque'] == 50.0
    assert found['hysteresis']['rated_by'] == 'given'
    stiffness = found['hysteresis']['figures'][-1]['stiffness']
    assert [(s['low'], round(s['high'], 3)) for s in stiffness] == [(0.0, 10.0), (10.0, 30.0)]


@pytest.mark.slow
def test_at_one_speed_a_delay_must_be_known(motion, capsys):
    assert main(['lost-motion', str(motion)]) == 0
    output = capsys.readouterr().out
    assert 'tell the delay with --delay, in rows' in output
    assert 'lost motion on reversals' not in output
    assert main(['lost-motion', str(motion), '--json', '-']) == 0
    (found,) = json.loads(capsys.readouterr().out)['recordings']
    assert found['transmission']['lost_motion'] is found['transmission']['delay'] is None
    assert found['transmission']['reversals']['value'] == pytest.approx(2e-3, abs=1e-5)


@pytest.mark.slow
def test_transmission_error_of_both_encoders(motion, capsys):
    assert main(['lost-motion', str(motion), '--json', '-', '--delay', '0']) == 0
    (found,) = json.loads(capsys.readouterr().out)['recordings']
    transmission = found['transmission']
    assert transmission['lost_motion']['value'] == pytest.approx(2e-3, abs=1e-5)
    orders = {order['name']: order for order in transmission['orders']}
    assert orders['rotor × 1']['cycles'] == '19'
    assert orders['rotor × 1']['forward']['value'] == pytest.approx(1e-3, rel=1e-3)
    assert orders['teeth × 2']['forward'] is None
    assert found['hysteresis'] is None


@pytest.mark.slow
@pytest.mark.parametrize('suffix', ['png', 'svg', 'pdf'])
def test_plot_is_an_image_of_its_suffix(recording, motion, tmp_path, suffix, capsys):
    starts = {'png': b'\x89PNG', 'svg': b'<?xml', 'pdf': b'%PDF'}
    for source in (recording, motion):
        target = tmp_path / f'{source.stem}.{suffix}'
        assert main(['lost-motion', str(source), '--plot', str(target)]) == 0
        assert target.read_bytes().startswith(starts[suffix])
        if suffix == 'png':
            width, height = struct.unpack('>II', target.read_bytes()[16:24])
            assert (width, height) == (1800, 780)  # two panels
    assert capsys.readouterr().out


@pytest.mark.slow
def test_page_needs_nothing_from_elsewhere(recording, motion, tmp_path, capsys):
    target = tmp_path / 'page.html'
    assert main(['lost-motion', str(recording), str(motion), '--html', str(target)]) == 0
    tree = html.document_fromstring(target.read_bytes(), parser=html.HTMLParser(encoding='utf-8'))
    assert not tree.xpath('//@src | //link')
    assert [h.text for h in tree.xpath('//h2')] == ['gear.csv', 'motion.csv']
    plots = [json.loads(s.text) for s in tree.xpath('//script[@type="application/json"]')]
    assert len(plots) == 2
    for plot in plots:
        axes = {name for name in plot['layout'] if name.startswith('xaxis')}
        assert axes == {'xaxis1', 'xaxis2'}
        for trace in plot['data']:
            assert len(trace['x']) == len(trace['y']) > 1
            assert len(trace['x']) <= 2000
    assert plots[1]['layout']['xaxis2']['type'] == 'log'
    marked = {note['text'] for note in plots[1]['layout']['annotations']}
    assert 'rotor × 1, satellite × 1' in marked
    assert capsys.readouterr().out


def test_several_recordings_are_compared(recording, motion, capsys, monkeypatch):
    monkeypatch.setenv('COLUMNS', '120')
    monkeypatch.setenv('FORCE_COLOR', '1')
    assert main(['lost-motion', str(recording), str(motion)]) == 0
    output = capsys.readouterr().out
    assert 'transmission accuracy' in output
    assert output.count('gear.csv') == 2


@pytest.mark.parametrize(
    ('arguments', 'complaint'),
    [
        (['nowhere.csv'], 'nowhere.csv: No such file'),
        (['nowhere'], 'nowhere: no such file or folder'),
        (
            ['{recording}', '{motion}', '--plot', 'x.png'],
            'the recordings have no figure in common',
        ),
        (['{recording}', '--plot', 'x.txt'], 'x.txt: the suffix of a plot must be one of'),
        (['{recording}', '--json', '-', '--html', '-'], 'only one report can go to stdout'),
        (['{motion}', '--rotor-column', 'phi'], "no column 'phi'; there are: output, rotor"),
    ],
)
def test_unusable_arguments_get_one_line(recording, motion, arguments, complaint):
    given = [a.format(recording=recording, motion=motion) for a in arguments]
    assert complaint in refusal('lost-motion', *given)


@pytest.mark.parametrize(
    'given',
    [
        *(f'--rated-torque={value}' for value in ('0', '-1', 'nan', 'inf', 'much')),
        '--counts=0',
        '--output-counts=2.5',
        '--angle-unit=gon',
    ],
)
def test_options_out_of_range_are_refused(recording, given):
    assert given.partition('=')[0] in refusal('lost-motion', recording, given)


def test_unusable_recording_does_not_keep_the_others(recording, tmp_path, capsys):
    flat = write_csv(tmp_path / 'flat.csv', angle=np.zeros(500), torque=np.zeros(500))
    assert main(['lost-motion', str(flat), str(recording), '--json', '-']) == 2
    captured = capsys.readouterr()
    assert captured.err == (
        f'gearkin: {flat}: no torque ramp that goes to one side, to the other and back to zero\n'
    )
    (found,) = json.loads(captured.out)['recordings']
    assert found['recording'] == 'gear.csv'


@pytest.mark.parametrize('value', [1.4e154, 1e200])
@pytest.mark.parametrize('column', ['angle', 'torque'])
def test_garbage_in_one_recording_keeps_no_other(recording, tmp_path, column, value, capsys):
    torque = np.concatenate(
        [np.linspace(0, 4, 99), np.linspace(4, -4, 199), np.linspace(-4, 0, 99)]
    )
    columns = {'angle': torque / 300.0, 'torque': torque}
    columns[column] = columns[column].copy()
    columns[column][150] = value
    spoilt = write_csv(tmp_path / 'spoilt.csv', **columns)
    assert main(['lost-motion', str(spoilt), str(recording), '--json', '-']) in {0, 2}
    captured = capsys.readouterr()
    assert 'Traceback' not in captured.err
    assert len(captured.err.splitlines()) <= 1
    assert json.loads(captured.out)['recordings'][-1]['recording'] == 'gear.csv'


@pytest.mark.slow
def test_report_needs_neither_matplotlib_nor_plotly(recording):
    program = (
        'import sys; sys.modules["matplotlib"] = sys.modules["plotly"] = None\n'
        'from gear_kinematics.commands.cli import main\n'
        f'assert main(["lost-motion", {str(recording)!r}]) == 0\n'
        f'print(main(["lost-motion", {str(recording)!r}, "--plot", "x.png"]))\n'
    )
    done = subprocess.run(
        [sys.executable, '-c', program],
        env={'PYTHONPATH': ':'.join(filter(None, sys.path)), 'PYTHONIOENCODING': 'utf-8'},
        capture_output=True,
        text=True,
        encoding='utf-8',
        check=False,
    )
    assert done.stdout.splitlines()[-1] == '2'
    assert (
        done.stderr
        == "gearkin: matplotlib is not installed: pip install 'gear_kinematics[plot]'\n"
    )


@pytest.mark.parametrize(
    ('value', 'spread', 'written'),
    [
        (93.3456, 1.3789, ('93.3', '1.4')),
        (0.00123456, 0.000021, ('0.001235', '0.000021')),
        (-0.004, 0.5, ('0.00', '0.50')),
        (531.7, 134.2, ('532', '134')),
        (2.0, 0.0, ('2', '0')),
        (1 / 3, 1e-13, ('0.333333', '1e-13')),
    ],
)
def test_values_are_written_to_the_second_digit_of_their_uncertainty(value, spread, written):
    normal = Estimate.of_mean([value] * 9, Component(spread / 1.959964))
    assert rounded(normal, 1.0) == written


def test_panels_show_every_loop(recording, actuator):
    small, large = panels(measure(read_csv(recording, actuator, Columns(), 0.01), actuator))
    names = [line.name for line in small.lines]
    assert names.count('torque rising') == names.count('torque falling') == 3
    assert len(large.lines) == 2 * 2 + 1
    for line in large.lines:
        assert np.all(np.abs(line.x) <= 40.0 * 1.02)


def test_damaged_bag_is_measured_as_far_as_it_goes(tmp_path, capsys):
    torque = ramps(*[(5.0, 200)] * 3)
    angle = creep(GEAR, torque)
    stamps = 10**18 + np.arange(len(angle)) * 10**6
    samples = Samples(stamps, -19.0 * angle, torque / -19.0)
    (file,) = write_recording(tmp_path / 'ramps', samples).glob('*.mcap')
    file.write_bytes(file.read_bytes()[: file.stat().st_size * 3 // 4])
    assert main(['lost-motion', str(file), '--json', '-']) == 2
    captured = capsys.readouterr()
    assert captured.err.startswith(f'gearkin: {file}: ')
    assert captured.err.count('\n') == 1
    (found,) = json.loads(captured.out)['recordings']
    assert found['error'] == captured.err.removeprefix('gearkin: ').rstrip('\n')
    assert found['hysteresis']['figures'][0]['loops'] == 2


def test_motion_with_a_torque_that_is_no_ramp_is_motion(tmp_path, capsys):
    ideal = np.linspace(0.0, 3.0, 3000)
    stamps = 10**18 + np.arange(len(ideal)) * 10**6
    rotor = Samples(stamps, -19.0 * ideal, np.full(len(ideal), 0.1))
    path = write_recording(tmp_path / 'motion', rotor, Samples(stamps, ideal))
    assert main(['lost-motion', str(path), '--json', '-']) == 0
    (found,) = json.loads(capsys.readouterr().out)['recordings']
    assert found['hysteresis'] is None
    assert found['transmission']['samples'] == 3000
    assert found['remarks'][0].startswith('no torque ramp')


def test_play_that_ramps_hardly_pass_is_not_separable(tmp_path, capsys):
    """Of 4 N·m, friction takes up 3.9 N·m: the spring beyond the play is hardly loaded."""
    torque = ramps((4.0, 200), (4.0, 200), (4.0, 200))
    angle = creep(Gear(play=0.02, stiffness=300.0, friction=3.9), torque)
    path = write_csv(tmp_path / 'sticky.csv', angle=angle, torque=torque)
    assert main(['lost-motion', str(path)]) == 0
    told = capsys.readouterr().out
    assert 'not separable' in told
    assert 'Record ramps to 11.7 N·m or more.' in told


def test_ramps_much_larger_than_the_friction_do_not_separate_play_from_a_bent_spring(
    tmp_path, capsys
):
    """A soft middle and a gap with a bent spring describe them alike."""
    gear = next(s for s in SCENARIOS if s.name == 'play, hardening spring, large loops only')
    recorded = simulate(gear, np.random.default_rng(3))
    path = write_csv(tmp_path / 'large.csv', angle=recorded.angle, torque=recorded.torque)
    assert main(['lost-motion', str(path)]) == 0
    told = ' '.join(capsys.readouterr().out.split())
    assert 'not separable' in told
    assert 'Ramps to about 4 N·m, in which the spring is less bent, tell' in told


@pytest.mark.parametrize('rows', [0, 15])
def test_a_torque_that_is_later_than_the_angle_makes_the_hysteresis_negative(
    tmp_path, capsys, rows
):
    torque = ramps(*[(4.0, 200)] * 3)
    angle = creep(Gear(play=0.0, stiffness=300.0, friction=0.1), torque)
    late = np.concatenate([np.zeros(rows), torque])[: len(torque)]
    path = write_csv(tmp_path / 'late.csv', angle=angle, torque=late)
    assert main(['lost-motion', str(path)]) == 0
    told = 'The hysteresis is negative' in capsys.readouterr().out
    assert told == (rows > 0)


@pytest.mark.slow
@pytest.mark.parametrize(('pause', 'told'), [(0.0, True), (0.5, False)])
def test_remarks_say_that_pauses_would_show_creep(tmp_path, capsys, pause, told):
    gear = replace(SCENARIOS[0], friction=0.5, noise=0.2, loops=5 * ((40.0, 20.0),), pause=pause)
    time, torque, angle = simulate(gear, np.random.default_rng(3))
    path = write_csv(tmp_path / 'large.csv', time=time, angle=angle, torque=torque)
    assert main(['lost-motion', str(path)]) == 0
    remark = 'of the spring comes from creep, which the recording does not exclude. Pauses of'
    assert (remark in capsys.readouterr().out) == told


@pytest.mark.slow
def test_a_torque_behind_a_filter_is_late(tmp_path, capsys):
    gear = replace(SCENARIOS[0], lag=-0.02)
    recorded = simulate(gear, np.random.default_rng(3))
    path = write_csv(
        tmp_path / 'filtered.csv',
        time=recorded.time,
        angle=recorded.angle,
        torque=recorded.torque,
    )
    assert main(['lost-motion', str(path)]) == 0
    (told,) = re.findall(r'The torque comes ([\d.]+) ± [\d.]+ ms later', capsys.readouterr().out)
    assert float(told) == pytest.approx(20.0, abs=3.0)


def test_remarks_tell_what_a_single_loop_cannot(tmp_path, capsys):
    torque = ramps((4.0, 200))
    path = write_csv(tmp_path / 'one.csv', angle=creep(GEAR, torque), torque=torque)
    assert main(['lost-motion', str(path)]) == 0
    told = capsys.readouterr().out
    assert 'There is no uncertainty where nothing was repeated.' in told
    assert 'All ramps have about the same amplitude' in told
    assert 'The friction exceeds ±0.12 N·m' in told
    assert '± (95 %)' not in told


@pytest.fixture(scope='module')
def worn(tmp_path_factory):
    """Two recordings of a gear, and two after it has got play; the second ones go further."""
    folder = tmp_path_factory.mktemp('worn')
    random = np.random.default_rng(5)
    paths = []
    for name, play, largest in (
        ('0301_0900_new', 0.002, 40.0),
        ('0301_1000_new', 0.002, 40.0),
        ('0302_0900_worn', 0.01, 50.0),
        ('0302_1000_worn', 0.01, 50.0),
    ):
        torque = ramps(*[(4.0, 150)] * 4, *[(largest, 300)] * 3)
        angle = creep(Gear(play=play, stiffness=300.0, friction=0.5), torque)
        angle += 1e-5 * random.standard_normal(len(angle))
        paths.append(str(write_csv(folder / f'{name}.csv', angle=angle, torque=torque)))
    return paths


def summary(output: str) -> str:
    (line,) = (line for line in output.splitlines() if line.startswith('summary: '))
    return line


@pytest.mark.slow
def test_one_sentence_says_what_has_changed_and_what_has_not(worn, capsys):
    assert main(['lost-motion', worn[0], worn[2]]) == 0
    said = summary(capsys.readouterr().out)
    assert said.startswith('summary: 0302_0900_worn.csv against 0301_0900_new.csv, at 40 N·m: ')
    changed, same = said.split('not significant: ')
    arcmin = math.degrees(0.008) * 60.0
    for figure in ('hysteresis', 'backlash'):
        told = re.search(rf'{figure} \S+ → \S+ arcmin \(\+(\S+) ± \S+\), significant', changed)
        assert float(told[1]) == pytest.approx(arcmin, abs=0.3)
    assert 'friction' in same
    assert 'stiffness 20 to 40 N·m' in same
    assert same.endswith('judged by the scatter within single recordings')


@pytest.mark.slow
def test_recordings_are_compared_at_the_least_of_their_rated_torques(worn, capsys):
    assert main(['lost-motion', worn[2], worn[0], '--json', '-']) == 0
    document = json.loads(capsys.readouterr().out)
    for found in document['recordings']:
        assert found['hysteresis']['rated_by'] == 'least of the recordings'
        settings = found['hysteresis']['settings']
        assert settings['rated_torque'] == pytest.approx(40.0, rel=0.01)
        ranges = [(s['low'], s['high']) for s in found['hysteresis']['figures'][-1]['stiffness']]
        assert (settings['corners'][-2], settings['corners'][-1]) in ranges
    changes = {change['figure']: change for change in document['comparison']['changes']}
    backlash = changes['backlash']
    assert backlash['difference']['value'] == pytest.approx(-0.008, abs=1e-4)
    assert backlash['significant']
    assert not changes['friction']['significant']
    assert main(['lost-motion', worn[2], worn[0], '--rated-torque', '20', '--json', '-']) == 0
    document = json.loads(capsys.readouterr().out)
    for found in document['recordings']:
        assert found['hysteresis']['rated_by'] == 'given'
        assert found['hysteresis']['settings']['corners'] == [3.0, 10.0, 20.0]


@pytest.mark.slow
def test_groups_are_compared_by_the_spread_between_their_recordings(worn, capsys):
    for patterns in (['_(new|worn)'], ['*_new.csv', '*_worn.csv']):
        options = [f'--group={pattern}' for pattern in patterns]
        assert main(['lost-motion', *options, *worn, '--json', '-']) == 0
        comparison = json.loads(capsys.readouterr().out)['comparison']
        names = [path.rpartition('/')[2] for path in worn]
        assert [group['recordings'] for group in comparison['groups']] == [names[:2], names[2:]]
        changes = {change['figure']: change for change in comparison['changes']}
        assert changes['backlash']['difference']['value'] == pytest.approx(0.008, abs=1e-4)
        assert changes['backlash']['difference']['repeats'] == 2
    assert main(['lost-motion', *worn, '--group', '_(new|worn)']) == 0
    assert 'within single recordings' not in summary(capsys.readouterr().out)


@pytest.mark.slow
def test_recordings_of_no_group_keep_their_own_torque(worn, capsys):
    options = ['--group', '*_0900_new*', '--group', '*_1000_new*', '--json', '-']
    assert main(['lost-motion', *worn[1:3], worn[0], *options]) == 0
    captured = capsys.readouterr()
    assert captured.err == 'gearkin: 0302_0900_worn.csv: is of no group, and not compared\n'
    document = json.loads(captured.out)
    torques = [
        round(found['hysteresis']['settings']['rated_torque']) for found in document['recordings']
    ]
    assert torques == [40, 40, 50]
    assert [group['name'] for group in document['comparison']['groups']] == [
        '*_1000_new*', '*_0900_new*'
    ]  # fmt: skip


@pytest.mark.parametrize(
    ('arguments', 'complaint'),
    [
        (['--group', '('], '--group (: '),
        (['--group', '(a)(b)'], '--group (a)(b): a regular expression needs one group'),
        (['--group', 'x*'], '--group x*: there is no recording that matches'),
        (['--group', '*'], '--group *: there is only the group *'),
        (['--trend'], '--trend needs 4 recordings'),
        (['--scheduler', 'nonsense'], 'nonsense: no Dask scheduler there: missing port number'),
    ],
)
def test_what_cannot_be_compared_gets_one_line(worn, arguments, complaint):
    assert refusal('lost-motion', *worn[:2], *arguments).startswith(complaint)


@pytest.mark.slow
def test_trend_is_in_order_of_time(worn, capsys):
    shuffled = [worn[k] for k in (2, 0, 3, 1)]
    assert main(['lost-motion', *shuffled, '--trend', '--json', '-']) == 0
    document = json.loads(capsys.readouterr().out)
    names = [path.rpartition('/')[2] for path in worn]
    assert [found['recording'] for found in document['recordings']] == names
    trend = document['trend']
    assert [recording['name'] for recording in trend['recordings']] == names
    assert [round(24 * recording['days'], 6) for recording in trend['recordings']] == [
        0.0, 1.0, 24.0, 25.0
    ]  # fmt: skip
    figures = {figure['figure']: figure for figure in trend['figures']}
    (step,) = figures['backlash']['steps']
    assert (step['since'], step['earliest'], step['latest']) == (names[2],) * 3
    assert step['change']['value'] == pytest.approx(0.008, abs=1e-4)
    assert main(['lost-motion', *shuffled, '--trend']) == 0
    assert summary(capsys.readouterr().out).startswith(f'summary: since {names[2]}: hysteresis +')


@pytest.mark.slow
def test_several_recordings_are_drawn_together(worn, tmp_path, capsys):
    plot, page = tmp_path / 'x.png', tmp_path / 'x.html'
    for way in ([], ['--trend'], ['--group', '_(new|worn)']):
        assert main(['lost-motion', *worn, *way, '--plot', str(plot), '--html', str(page)]) == 0
        width, height = struct.unpack('>II', plot.read_bytes()[16:24])
        assert (width, height) == (3 * 900, 2 * 780)  # two rows of three panels
        tree = html.document_fromstring(
            page.read_bytes(), parser=html.HTMLParser(encoding='utf-8')
        )
        drawn, *_ = (json.loads(s.text) for s in tree.xpath('//script[@type="application/json"]'))
        loops = [trace for trace in drawn['data'] if trace['yaxis'] == 'y1']
        assert len(loops) == 4
        bars = [trace for trace in drawn['data'] if 'error_y' in trace]
        assert len(bars) == 4
        for trace in bars:
            assert len(trace['error_y']['array']) == len(trace['x']) == (2 if way[1:] else 4)
    assert capsys.readouterr().out


@pytest.mark.parametrize('play', [0.0, 0.01])
def test_upper_bounds_of_the_backlash_are_drawn_from_zero_up(tmp_path, capsys, play):
    """Of two gears, of which the first has none."""
    torque, page = ramps(*[(4.0, 150)] * 4), tmp_path / 'x.html'
    random = np.random.default_rng(5)
    paths = []
    for name, own in (('before', 0.0), ('after', play)):
        angle = creep(Gear(play=own, stiffness=300.0, friction=0.5), torque)
        noisy = torque + random.normal(0.0, 0.01, len(torque))
        paths.append(write_csv(tmp_path / f'{name}.csv', angle=angle, torque=noisy))
    assert main(['lost-motion', *map(str, paths), '--html', str(page)]) == 0
    told = capsys.readouterr().out
    pattern = r'^(.*)\.csv: backlash \(play model\): value: below (.*) arcmin'
    bounds = {name: float(limit) for name, limit in re.findall(pattern, told, re.MULTILINE)}
    assert bounds.keys() == ({'before'} if play else {'before', 'after'})
    tree = html.document_fromstring(page.read_bytes(), parser=html.HTMLParser(encoding='utf-8'))
    drawn, *_ = (json.loads(s.text) for s in tree.xpath('//script[@type="application/json"]'))
    (lines,) = (trace for trace in drawn['data'] if trace['name'] == 'upper bounds (95 %)')
    assert lines['x'][::3] == list(range(len(bounds)))
    assert lines['y'][::3] == [0.0] * len(bounds)
    assert lines['y'][1::3] == pytest.approx(list(bounds.values()), rel=0.01)
    values = [t for t in drawn['data'] if t['yaxis'] == lines['yaxis'] and 'error_y' in t]
    assert [trace['x'] for trace in values] == ([[1.0]] if play else [])


@pytest.mark.slow
def test_processes_measure_what_one_does(worn, tmp_path, capsys):
    bad = tmp_path / 'bad.csv'
    bad.write_text('angle,torque\n1,2\n', 'utf-8')
    paths = [*worn, str(bad), str(tmp_path / 'missing.csv')]
    assert main(['lost-motion', *paths, '--json', '-']) == 2
    one = capsys.readouterr()
    assert main(['lost-motion', *paths, '--json', '-', '--jobs', '2']) == 2
    assert capsys.readouterr() == one
    assert len(one.err.splitlines()) == 2


@pytest.mark.slow
def test_cluster_measures_what_one_process_does(worn, tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(Path(worn[0]).parent)  # the workers are elsewhere
    names = [Path(path).name for path in worn]
    assert main(['lost-motion', *names, '--json', '-']) == 0
    one = capsys.readouterr()
    with cluster(tmp_path / 'cluster') as dask:
        dask.add_worker('--no-nanny')
        assert main(['lost-motion', *names, '--json', '-', '--scheduler', dask.address]) == 0
    assert capsys.readouterr() == one


def test_recordings_of_one_name_are_told_apart(worn, tmp_path, capsys):
    paths = []
    for folder, source in (('before', worn[0]), ('after', worn[2])):
        (tmp_path / folder).mkdir()
        paths.append(tmp_path / folder / 'ramps.csv')
        paths[-1].write_bytes(Path(source).read_bytes())
    assert main(['lost-motion', *map(str, paths)]) == 0
    assert f'{paths[1]} against {paths[0]}, at' in summary(capsys.readouterr().out)


def another_gear(folder):
    """Record four turns of the output of a gear with the ratio -58/3."""
    ideal = np.linspace(0.0, 25.0, 9000)
    output = (ideal + 1e-3 * np.sin(ideal + 1.0)) % (2.0 * math.pi)
    return write_csv(folder / 'other.csv', rotor=-58.0 / 3.0 * ideal, output=output)


def test_any_ratio_can_be_given(tmp_path, capsys):
    assert (
        main(['lost-motion', str(another_gear(tmp_path)), '--ratio', '-58/3', '--json', '-']) == 0
    )
    (found,) = json.loads(capsys.readouterr().out)['recordings']
    assert (found['gear_ratio'], found['fitted_ratio']) == ('-58/3', None)
    cycles = {order['name']: order['cycles'] for order in found['transmission']['orders']}
    expected = {'output': ('1', '2'), 'rotor': ('58/3', '116/3')}
    assert cycles == {f'{name} × {k}': n[k - 1] for name, n in expected.items() for k in (1, 2)}
    assert found['transmission']['forward']['value'] == pytest.approx(2e-3, rel=1e-3)


def test_ratio_can_be_that_of_the_parameter_file(tmp_path, capsys):
    config = tmp_path / 'other.yaml'
    config.write_text("/**: {ros__parameters: {gear_ratio: '-58/3'}}", 'utf-8')
    assert main(['lost-motion', str(another_gear(tmp_path)), '--config', str(config)]) == 0
    assert facts(capsys.readouterr().out)['gear ratio'] == '-58/3'


def test_ratio_is_estimated_and_the_gears_that_have_it_are_named(tmp_path, capsys):
    path = str(another_gear(tmp_path))
    assert main(['lost-motion', path, '--fit-ratio', '--json', '-']) == 0
    (found,) = json.loads(capsys.readouterr().out)['recordings']
    fitted = found['fitted_ratio']
    assert found['gear_ratio'] == fitted['simplest'] == '-58/3'
    assert fitted['measured']['value'] == pytest.approx(-58.0 / 3.0, abs=1e-6)
    assert fitted['measured']['expanded_uncertainty'] < 1e-4
    assert fitted['tooth_pairs'] == [[61, 58], [122, 116], [183, 174]]
    assert found['transmission']['forward']['value'] == pytest.approx(2e-3, rel=1e-3)
    assert main(['lost-motion', path, '--fit-ratio']) == 0
    output = capsys.readouterr().out
    assert re.search(r'estimated as -19\.333\d+ ± 0\.0000\d+, and taken as -58/3\.', output)
    assert 'a ratio: 61/58, 122/116, 183/174.' in output


@pytest.mark.slow
def test_fitted_ratio_of_the_config_keeps_the_orders_of_its_teeth(motion, capsys):
    assert main(['lost-motion', str(motion), '--fit-ratio', '--json', '-']) == 0
    (found,) = json.loads(capsys.readouterr().out)['recordings']
    assert found['gear_ratio'] == '-19'
    assert 'teeth × 1' in {order['name'] for order in found['transmission']['orders']}


@pytest.mark.parametrize(
    ('given', 'complaint'),
    [
        (['--ratio', '0'], 'argument --ratio: a gear ratio must not be 0'),
        (['--ratio', '19:1'], 'a gear ratio must be an integer, a fraction or a decimal, such as'),
        (['--ratio', '-19', '--fit-ratio'], 'not allowed with argument --ratio'),
    ],
)
def test_what_is_no_ratio_is_refused(motion, given, complaint):
    assert complaint in refusal('lost-motion', motion, *given)


def test_ratio_cannot_be_estimated_without_both_angles(recording):
    error = '--fit-ratio needs the angles of rotor and output'
    assert refusal('lost-motion', recording, '--fit-ratio').endswith(error)


@pytest.mark.slow
def test_positions_of_two_gears_are_combined_and_compared(tmp_path, capsys):
    torque = ramps(*[(4.0, 60)] * 3, (40.0, 80))
    for name, play in {
        'old_pos1': 0.02,
        'old_pos2': 0.022,
        'new_pos1': 5e-3,
        'new_pos2': 6e-3,
    }.items():
        angle = creep(GEAR._replace(play=play), torque)
        write_csv(tmp_path / f'{name}.csv', angle=angle, torque=torque)
    paths = [str(path) for path in sorted(tmp_path.glob('*.csv'), reverse=True)]
    assert main(['lost-motion', *paths, '--positions', '--json', '-']) == 0
    document = json.loads(capsys.readouterr().out)
    gears = {item['gear'] for item in document['positions']}
    assert gears == {'old.csv', 'new.csv'}
    assert [g['name'] for g in document['comparison']['groups']] == ['old.csv', 'new.csv']
    error = '--positions cannot be combined with --trend'
    assert refusal('lost-motion', *paths, '--positions', '--trend') == error
