# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""gearkin lost-motion as a user runs it."""

import json
import math
import re
import struct
import sys
from pathlib import Path

import numpy as np
import pytest
from blocked_bags import BAGS, facts, gearkin, refusal
from gear_recordings import Gear, Samples, creep, ramps, write_csv, write_recording
from lxml import html

from gear_kinematics.commands.cli import main

GEAR = Gear(play=0.02, stiffness=300.0, friction=0.5)


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


def test_a_report_in_a_pipe_is_its_answer_and_with_v_the_figures(recording, capsys):
    assert main(['lost-motion', str(recording)]) == 0
    arcmin = math.degrees(GEAR.play + 2 * GEAR.friction / GEAR.stiffness) * 60.0
    (line,) = capsys.readouterr().out.splitlines()
    said = re.fullmatch(
        r'gear\.csv: At zero torque the output rests anywhere within ([\d.]+) ± [\d.]+′ '
        r'after ±(?:3\.\d+|4) N·m\. Of it, ([\d.]+) ± [\d.]+′ is play; the rest is friction\.',
        line,
    )
    assert float(said[1]) == pytest.approx(arcmin, abs=0.1)
    assert float(said[2]) == pytest.approx(math.degrees(GEAR.play) * 60.0, abs=0.2)
    assert main(['lost-motion', '-v', str(recording)]) == 0
    told = facts(capsys.readouterr().out)
    value = told['hysteresis at zero torque: value'].split(' ± ')[0]
    assert float(value) == pytest.approx(arcmin, abs=0.1)
    assert told['stiffness 20 to 40 N·m: value'].endswith(' N·m/rad')
    assert told['rated torque'] == '40 N·m'


def test_json_has_each_figure_with_unit_value_and_uncertainty(recording, capsys):
    assert main(['lost-motion', str(recording), '--json', '-']) == 0
    document = json.loads(capsys.readouterr().out)
    assert (document['schema'], document['version']) == ('gear_kinematics/lost_motion', 3)
    assert document['coverage'] == 0.95
    (found,) = document['recordings']
    assert found['recording'] == 'gear.csv'
    expected = {
        'hysteresis': ('rad', GEAR.play + 2 * GEAR.friction / GEAR.stiffness),
        'friction': ('N·m', GEAR.friction),
        'backlash': ('rad', GEAR.play),
    }
    for name, (unit, value) in expected.items():
        assert found[name]['unit'] == unit
        assert found[name]['value'] == pytest.approx(value, rel=0.05)
        assert found[name]['expanded_uncertainty'] > 0.0
    assert found['backlash']['low'] < GEAR.play < found['backlash']['high']
    for group in found['ramps']:
        value = group['hysteresis']['value']
        assert value == pytest.approx(expected['hysteresis'][1], rel=0.05), group['amplitude']
    assert found['lost_motion']['unit'] == 'rad'
    top = found['stiffness'][-1]
    assert (round(top['low']), round(top['high']), top['unit']) == (20, 40, 'N·m/rad')
    assert top['value'] == pytest.approx(GEAR.stiffness, rel=1e-3)
    assert found['measured'] is False
    assert found['transmission'] is None


def test_a_limit_decides_the_exit_code_and_is_a_test_case(recording, tmp_path, capsys):
    report = tmp_path / 'report.xml'
    limits = ['--max-hysteresis', '90', '--min-stiffness', '250', '--junit', str(report)]
    assert main(['lost-motion', str(recording), *limits]) == 0
    assert capsys.readouterr().out.startswith('gear.csv: verdict: passed. The hysteresis of ')
    assert main(['lost-motion', str(recording), *limits, '--max-backlash', '60']) == 1
    first, second, *_ = capsys.readouterr().out.splitlines()
    assert first.startswith('gear.csv: verdict: failed: The backlash of 68.')
    assert 'hysteresis' in second
    suite = html.fromstring(report.read_bytes()).find('.//testsuite')
    assert (suite.get('tests'), suite.get('failures')) == ('3', '1')
    (failure,) = suite.findall('.//failure')
    assert failure.get('message').startswith('the backlash of 68.')


def test_limits_of_a_printed_table_are_in_the_json(tmp_path, capsys):
    torque = ramps(*[(4.0, 150)] * 3)
    angle = np.round(np.degrees(creep(GEAR, torque)), 4)
    printed = write_csv(tmp_path / 'gear.csv', angle_deg=angle, torque=torque)
    assert main(['lost-motion', str(printed), '--max-backlash', '60', '--json', '-']) == 1
    (found,) = json.loads(capsys.readouterr().out)['recordings']
    assert found['limits']['backlash']['holds'] is False


def test_the_rated_torque_can_be_told(recording, capsys):
    assert main(['lost-motion', str(recording), '--rated-torque', '50', '--json', '-']) == 0
    (found,) = json.loads(capsys.readouterr().out)['recordings']
    assert found['rated_torque'] == 50.0
    assert [(s['low'], round(s['high'], 3)) for s in found['stiffness']] == [
        (0.0, 7.5),
        (7.5, 25.0),
        (25.0, 40.0),
    ]


@pytest.mark.slow
def test_motion_has_a_transmission_error(motion, capsys):
    assert main(['lost-motion', '-v', str(motion)]) == 0
    output = capsys.readouterr().out
    assert 'to tell lost motion from a delay between the encoders' in output
    assert 'Inferred' not in output
    assert main(['lost-motion', str(motion), '--json', '-']) == 0
    (found,) = json.loads(capsys.readouterr().out)['recordings']
    assert found['gear_ratio'] == '-19'
    assert found['transmission']['reversals']['value'] == pytest.approx(2e-3, abs=1e-5)
    assert 'hysteresis' not in found


@pytest.mark.slow
def test_plots_and_pages_need_nothing_from_elsewhere(recording, motion, tmp_path, capsys):
    plot, page = tmp_path / 'plot.png', tmp_path / 'page.html'
    assert main(['lost-motion', str(motion), '--plot', str(plot)]) == 0
    width, height = struct.unpack('>II', plot.read_bytes()[16:24])
    assert width > height > 500
    assert main(['lost-motion', str(recording), str(motion), '--html', str(page)]) == 0
    tree, plots = page_of(page)
    assert not tree.xpath('//@src | //link')
    assert [h.text for h in tree.xpath('//h2')] == ['gear.csv', 'motion.csv']
    assert len(plots) == 3  # two of the ramps, one of the motion
    for drawn in plots:
        for trace in drawn['data']:
            x = trace.get('x', drawn['time'])
            assert 2000 >= len(x) == len(trace['y']) > 1
    capsys.readouterr()


def page_of(path):
    """Parse a page; gives its elements, and its figures."""
    parser = html.HTMLParser(encoding='utf-8')
    tree = html.document_fromstring(path.read_bytes(), parser=parser)
    scripts = tree.xpath('//script[@data-figure]')
    return tree, [json.loads(script.text) for script in scripts]


@pytest.mark.parametrize(
    ('arguments', 'complaint'),
    [
        (['nowhere.csv'], 'nowhere.csv: No such file'),
        (['nowhere'], 'nowhere: no such file or folder'),
        (['{recording}', '--plot', 'x.txt'], 'x.txt: the suffix must be .png or'),
        (['{recording}', '--json', '-', '--html', '-'], 'only one report can go to stdout'),
        (['{motion}', '--rotor-column', 'phi'], "no column 'phi'; there are: output, rotor"),
        (['{motion}', '--ratio', '19:1'], 'a gear ratio must be an integer, a fraction or a dec'),
        (['{recording}', '--rated-torque=nan'], '--rated-torque'),
        (['{recording}', '--output-counts=2.5'], '--output-counts'),
        (['{recording}', '--angle-unit=gon'], '--angle-unit'),
        (['{recording}', '--group', 'x*'], 'group x*: there is no recording that matches'),
        (['{recording}', '--group', '*'], 'group *: there is only the group *'),
    ],
)
def test_unusable_arguments_get_one_line(recording, motion, arguments, complaint):
    given = [a.format(recording=recording, motion=motion) for a in arguments]
    assert complaint in refusal('lost-motion', *given)


def test_unusable_recording_does_not_keep_the_others(recording, tmp_path, capsys):
    flat = write_csv(tmp_path / 'flat.csv', angle=np.zeros(500), torque=np.zeros(500))
    assert main(['lost-motion', str(flat), str(recording), '--json', '-']) == 2
    captured = capsys.readouterr()
    error, taken, assumed = captured.err.splitlines()
    cause = 'no torque ramp that goes to one side, to the other and back to zero'
    assert error == f'gearkin: {flat}: {cause}'
    assert taken == (
        'gear.csv: no times, angle at the output [deg] from angle_deg, '
        'torque at the output [N·m, assumed] from torque, 4201 of 4201 rows'
    )
    assert assumed.startswith('gear.csv: units are assumed, as none is given: N·m for torque; ')
    (found,) = json.loads(captured.out)['recordings']
    assert found['recording'] == 'gear.csv'


@pytest.mark.parametrize('column', ['angle', 'torque'])
def test_garbage_in_one_recording_keeps_no_other(recording, tmp_path, column, capsys):
    torque = np.concatenate(
        [np.linspace(0, 4, 99), np.linspace(4, -4, 199), np.linspace(-4, 0, 99)]
    )
    columns = {'angle': torque / 300.0, 'torque': torque}
    columns[column] = columns[column].copy()
    columns[column][150] = 1e200
    spoilt = write_csv(tmp_path / 'spoilt.csv', **columns)
    assert main(['lost-motion', str(spoilt), str(recording), '--json', '-']) in {0, 2}
    captured = capsys.readouterr()
    assert 'Traceback' not in captured.err
    assert captured.err.count('gearkin: ') <= 1
    assert json.loads(captured.out)['recordings'][-1]['recording'] == 'gear.csv'


def test_damaged_bag_is_measured_as_far_as_it_goes(tmp_path, capsys):
    torque = ramps(*[(5.0, 5_000)] * 3)
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
    assert found['ramps'][0]['loops'] == 2


def test_motion_with_a_torque_that_is_no_ramp_is_motion(tmp_path, capsys):
    ideal = np.linspace(0.0, 3.0, 3000)
    stamps = 10**18 + np.arange(len(ideal)) * 10**6
    rotor = Samples(stamps, -19.0 * ideal, np.full(len(ideal), 0.1))
    path = write_recording(tmp_path / 'motion', rotor, Samples(stamps, ideal))
    assert main(['lost-motion', str(path), '--json', '-']) == 0
    (found,) = json.loads(capsys.readouterr().out)['recordings']
    assert 'hysteresis' not in found
    assert found['transmission']['travel'] == pytest.approx(3.0)
    assert any(remark.startswith('no torque ramp') for remark in found['remarks'])


@pytest.fixture(scope='module')
def worn(tmp_path_factory):
    """Three recordings of a gear, and three after it has got play; those go further."""
    folder = tmp_path_factory.mktemp('worn')
    random = np.random.default_rng(5)
    paths = []
    for day, state, play, largest in ((1, 'new', 0.002, 40.0), (2, 'worn', 0.01, 50.0)):
        torque = ramps(*[(4.0, 150)] * 4, *[(largest, 300)] * 3)
        for hour in (9, 10, 11):
            gear = Gear(play=play * random.uniform(0.97, 1.03), stiffness=300.0, friction=0.5)
            name = f'030{day}_{hour:02}00_{state}.csv'
            noisy = torque + random.normal(0.0, 0.02, len(torque))
            angle = creep(gear, torque)
            paths.append(str(write_csv(folder / name, angle=angle, torque=noisy)))
    return paths


HYSTERESIS = [math.degrees(play + 1.0 / 300.0) * 60.0 for play in (0.002, 0.01)]  # arcmin


def summary(output: str) -> str:
    (line,) = (line for line in output.splitlines() if line.startswith('summary: '))
    return line


@pytest.mark.slow
def test_groups_are_compared_in_a_sentence_in_json_and_in_a_figure(worn, tmp_path, capsys):
    groups, page = ['--group', '*_new.csv', '--group', '*_worn.csv'], tmp_path / 'x.html'
    report, plot = tmp_path / 'x.json', tmp_path / 'x.png'
    files = ['--json', str(report), '--html', str(page), '--plot', str(plot)]
    assert main(['lost-motion', *groups, *worn, *files]) == 0
    said = re.match(
        r'summary: \*_worn\.csv against \*_new\.csv: '
        r'hysteresis ([\d.]+) → ([\d.]+)′ \(significant\)',
        summary(capsys.readouterr().out),
    )
    assert [float(value) for value in said.groups()] == pytest.approx(HYSTERESIS, rel=0.03)
    names = [path.rpartition('/')[2] for path in worn]
    document = json.loads(report.read_bytes())
    assert [group['recordings'] for group in document['groups']] == [names[:3], names[3:]]
    changes = {change['figure']: change for change in document['changes']}
    change = changes['hysteresis']
    assert change['ratio'] == pytest.approx(HYSTERESIS[1] / HYSTERESIS[0], rel=0.03)
    assert change['low'] < change['ratio'] < change['high']
    assert change['significant']
    assert not changes['friction']['significant']
    assert plot.read_bytes().startswith(b'\x89PNG')
    loops, *_ = page_of(page)[1]
    assert len(loops['data']) == len(worn)


def test_what_was_measured_is_reported_where_a_group_is_unusable(worn, tmp_path, capsys):
    bad, report = tmp_path / '0303_bad.csv', tmp_path / 'x.json'
    bad.write_text('nothing\n', 'utf-8')
    options = ['--group', '*_new.csv', '--group', '*_bad.csv', '--json', str(report)]
    assert main(['lost-motion', *worn[:2], str(bad), *options]) == 2
    *_, told, compared = capsys.readouterr().err.splitlines()
    assert told.startswith(f'gearkin: {bad}: ')
    assert compared == (
        'gearkin: group *_new.csv, *_bad.csv: there is only the group *_new.csv '
        'among the usable recordings; nothing is compared'
    )
    found = json.loads(report.read_bytes())['recordings']
    assert [one['recording'] for one in found] == [path.rpartition('/')[2] for path in worn[:2]]


def test_plot_that_cannot_be_made_loses_no_report(recording, motion, tmp_path, capsys):
    report = tmp_path / 'x.json'
    files = ['--plot', str(tmp_path / 'x.png'), '--json', str(report)]
    assert main(['lost-motion', str(recording), str(motion), *files]) == 2
    told = 'gearkin: --plot: the recordings have no torque ramps in common\n'
    assert capsys.readouterr().err.endswith(f'--angle-unit\n{told}')
    assert len(json.loads(report.read_bytes())['recordings']) == 2


@pytest.mark.slow
def test_recordings_of_no_group_keep_their_own_torque(worn, capsys):
    options = ['--group', '*_0900_new*', '--group', '*_1000_new*', '--json', '-']
    assert main(['lost-motion', worn[1], worn[3], worn[0], *options]) == 0
    captured = capsys.readouterr()
    said = [line for line in captured.err.splitlines() if line.startswith('gearkin: ')]
    assert said == ['gearkin: 0302_0900_worn.csv: is of no group, and not compared']
    document = json.loads(captured.out)
    assert [round(found['rated_torque']) for found in document['recordings']] == [40, 40, 50]
    names = [group['name'] for group in document['groups']]
    assert names == ['*_0900_new*', '*_1000_new*']


def test_recordings_of_one_name_are_told_apart(worn, tmp_path, capsys):
    paths = []
    for folder, source in (('before', worn[0]), ('after', worn[3])):
        (tmp_path / folder).mkdir()
        paths.append(tmp_path / folder / 'ramps.csv')
        paths[-1].write_bytes(Path(source).read_bytes())
    assert main(['lost-motion', *map(str, paths)]) == 0
    assert '/after against ' in summary(capsys.readouterr().out)


def another_gear(folder):
    """Record four turns of the output of a gear with the ratio -58/3."""
    ideal = np.linspace(0.0, 25.0, 9000)
    output = (ideal + 1e-3 * np.sin(ideal + 1.0)) % (2.0 * math.pi)
    return write_csv(folder / 'other.csv', rotor=-58.0 / 3.0 * ideal, output=output)


@pytest.mark.parametrize('option', ['--ratio', '--config'])
def test_any_ratio_can_be_given(tmp_path, capsys, option):
    config = tmp_path / 'other.yaml'
    config.write_text("/**: {ros__parameters: {gear_ratio: '-58/3'}}", 'utf-8')
    given = {'--ratio': '-58/3', '--config': str(config)}[option]
    words = ['lost-motion', str(another_gear(tmp_path)), option, given, '--json', '-']
    assert main(words) == 0
    (found,) = json.loads(capsys.readouterr().out)['recordings']
    assert found['gear_ratio'] == '-58/3'
    assert found['transmission']['forward']['value'] == pytest.approx(2e-3, rel=1e-3)


def test_a_recording_of_another_ratio_is_unusable(tmp_path, capsys):
    words = ['lost-motion', str(another_gear(tmp_path)), '--max-hysteresis', '90', '--junit', '-']
    assert main(words) == 2
    said = capsys.readouterr()
    cause = 'other.csv: The recording does not have the ratio -19: the recorded ratio is 19.33'
    assert f'gearkin: {cause}' in said.err.replace('-19.33', '19.33')
    assert 'failures="1"' in said.out
    assert main([*words[:-2], '--max-backlash', '90', '-v']) == 2
    found = re.findall(r'finding: The (\w+)', capsys.readouterr().out)
    assert found == ['hysteresis', 'backlash']  # as without a wrong ratio


def test_without_scipy_only_comparisons_are_missing():
    """One process for all commands, as none of them can import it."""
    extra, missing = "gear_kinematics[measure]'", 'gear.csv: No such file'
    ramps = Path(__file__).resolve().parents[2] / 'docs' / 'examples' / 'ramps.csv'
    expected = {
        'lost-motion gear.csv': (2, missing),
        f'lost-motion -q {ramps} {ramps}': (2, extra),
        'calibrate gear.csv': (2, missing),
        'commission gear.csv': (2, missing),
        f'validate {BAGS / "servo_point_to_point"}': (0, ''),
        'lost-motion --help': (0, ''),
        '--help': (0, ''),
    }
    code = f"""
import json, sys
sys.path[:] = {sys.path!r}
sys.modules['scipy'] = None
from blocked_bags import gearkin_here
done = [gearkin_here(*command.split()) for command in {[*expected]!r}]
print(json.dumps([(each.returncode, each.stderr) for each in done]))
"""
    done = gearkin(code=code)
    assert done.returncode == 0, done.stderr
    for (code, said), (wanted, told) in zip(
        json.loads(done.stdout), expected.values(), strict=True
    ):
        assert (code, len(said.splitlines())) == (wanted, 1 if told else 0)
        assert told in said
