# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""gearkin validate as a user or a CI job runs it."""

import hashlib
import html
import json
import os
import re
import shlex
from itertools import product
from xml.etree import ElementTree as ET

import jsonschema
import numpy as np
import pytest
from blocked_bags import (
    BAGS,
    DEADLINE,
    GEARKIN,
    BlockedBag,
    gearkin,
    gearkin_here,
    refusal,
    running_gearkin,
    wait_until,
)
from calibrations import calibration
from replaying import edited
from shipped_bags import CONFIGS, JOINT_STATE, ROTOR, TYPES, read_bag
from terminals import ENVIRONMENT, Terminal

from gear_kinematics.bag.writing import BagWriter
from gear_kinematics.commands.cli import main
from gear_kinematics.wire.batches import FIELDS

SERVO = BAGS / 'servo_point_to_point'
CONFIG = CONFIGS / 'actuator.yaml'
SAMPLES = 300
CORRECTED = ('corrected_state', 'corrected_interval')
OLD_REPORT = '{\n  "made_by": "gearkin validate"\n}\n'


@pytest.mark.parametrize(('name', 'code', 'verdict', 'error'), [
    ('good', 0, 'passed', ''), ('wrong', 1, 'failed', ''),
    ('garbage.mcap', 2, 'unusable', 'gearkin: garbage.mcap: not a bag of a known kind\n'),
])  # fmt: skip
def test_the_verdict_is_the_exit_code(name, code, verdict, error, bags):
    done = gearkin_here('validate', name, cwd=bags)
    assert (done.returncode, done.stderr) == (code, error)
    lines = done.stdout.splitlines()
    assert re.match(f'{name}: verdict: {verdict}[:;] ', lines[0])
    assert ('300 inputs, 1 of 600 outputs wrong, ' in lines[0]) == (name == 'wrong')
    assert all(line.startswith(f'{name}: ') for line in lines)
    assert done.stdout.isprintable() or done.stdout.replace('\n', '').isprintable()


@pytest.mark.slow
def test_what_a_recorder_loses_at_the_edges_is_said_and_fails_in_strict_mode_only(bags):
    done = gearkin_here('validate', '-v', 'late', cwd=bags)
    assert done.returncode == 0
    assert done.stdout.startswith('late: verdict: passed; 300 inputs')
    skipped = '40 messages skipped: the recording had just begun'
    assert f'late: finding: {skipped}\n' in done.stdout
    assert re.search('^late: /body_poses: .*; left out: 40', done.stdout, re.MULTILINE)
    for run, options in ((gearkin_here, []), (gearkin, ['--jobs', '2'])):
        done = run('validate', '--strict', *options, 'late', cwd=bags)
        assert done.returncode == 1
        assert '/body_poses: 40 messages missing, the first at ' in done.stdout


def test_the_node_chooses_among_sets_of_topics_and_the_joint_of_wrong_outputs_is_named(
    tmp_path, capsys
):
    path = tmp_path / 'arm'
    with BagWriter(path) as writer:
        for side, topic in product(('/left', '/right'), TYPES):
            writer.add_topic(side + topic, TYPES[topic])
        for topic, received, data in read_bag(SERVO)[:300]:
            whole = edited(data, JOINT_STATE, with_shoulder) if topic == ROTOR else data
            sides = f'/left{topic}', f'/right{topic}'
            writer.write_all((name, received, whole) for name in sides)
    words = ['validate', str(path), '--joint']
    assert 'which topic is rotor_state? /left' in refusal(*words, 'elbow', report='.*')
    assert main([*words, 'elbow', '--node', '/left/gear_state_publisher']) == 0
    assert main([*words, 'elbow', '--output-topic', '/right/output_state']) == 0
    capsys.readouterr()
    assert main([*words, 'shoulder', '--output-topic', '/right/output_state']) == 1
    assert capsys.readouterr().out.startswith(
        f'{path}: verdict: failed: the outputs are not those of shoulder: they are those of '
        'elbow; repeat with --joint elbow; 100 inputs, '
    )


def with_shoulder(message) -> None:
    """Put another joint before that of the rotor."""
    message.name = ['shoulder', 'elbow']
    for field in FIELDS:
        own = getattr(message, field)
        setattr(message, field, np.append(0.5 + 0.9 * own, own))


@pytest.mark.slow
@pytest.mark.parametrize(('run', 'options'), [(gearkin_here, []), (gearkin, ['--jobs', '2'])])
def test_the_worst_verdict_of_many_counts_and_failed_bags_come_first(run, options, bags):
    done = run('validate', *options, 'good', 'garbage.mcap', 'wrong', cwd=bags)
    assert done.returncode == 2
    assert done.stderr == 'gearkin: garbage.mcap: not a bag of a known kind\n'
    assert re.findall(r'^(\S+): verdict: (\w+)', done.stdout, re.MULTILINE) == [
        ('wrong', 'failed'),
        ('garbage.mcap', 'unusable'),
        ('good', 'passed'),
    ]
    assert done.stdout.startswith('summary: 3 bags: 1 passed, 1 failed, 1 unusable\n')
    assert gearkin_here('validate', 'wrong', 'good', cwd=bags).returncode == 1


def test_all_shipped_bags_pass_each_with_its_own_config():
    done = gearkin_here('validate', '-v', 'bags', cwd=BAGS.parent)
    assert (done.returncode, done.stderr) == (0, '')
    configs = dict(re.findall(r'^bags/(\S+): config: (.+?);', done.stdout, re.MULTILINE))
    assert configs == {
        'constant_speed_3000rpm': str(CONFIG),
        'driver_faults': str(CONFIG),
        'servo_point_to_point': str(CONFIG),
        'single_turn_encoder': 'bags/single_turn_encoder/actuator.yaml',
    }


@pytest.mark.parametrize(('name', 'options', 'code'), [
    ('wrong', ['--tolerance-angle', '1.9e-9'], 1), ('wrong', ['--tolerance-angle', '2.1e-9'], 0),
    ('wrong', ['--tolerance-position', '1'], 1),
    ('good', ['--tolerance-angle', '0', '--tolerance-position', '0'], 0), ('shifted', [], 1),
    ('namespaced', [], 0), ('good', ['--ratio', '-19'], 0), ('good', ['--ratio', '-39/2'], 1),
    ('good', ['--rotor-topic', '/rotor_state', '--output-topic', '/output_state'], 0),
    ('good', ['--rotor-topic', '/output_state', '--output-topic', '/rotor_state'], 1),
])  # fmt: skip
def test_options_decide(name, options, code, bags, capsys):
    assert main(['validate', str(bags / name), *options]) == code
    assert (code == 2) == bool(capsys.readouterr().err)


@pytest.mark.parametrize(('options', 'cause'), [
    (['--tolerance-effort=-1e-9'], '--tolerance-effort: must be between 0 and 1e+06, not -1e-9'),
    (['--tolerance-position', 'nan'], '--tolerance-position: must be between 0 and 1e+06, not'),
    (['--tolerance-angle', 'small'], "must be a number, not 'small'; see gearkin validate"),
    (['--poses-topic', '/output_state'], 'good: topic /output_state is of type sensor_msgs'),
    (['--output-topic', '/nope'], 'good: no topic /nope of type sensor_msgs'),
    (['--json', '-', '--junit', '-'], 'only one report can go to stdout'),
    (['--config', 'missing.yaml'], 'No such file'), (['--config', 'broken.yaml'], 'not YAML'),
    (['missing.mcap'], 'missing.mcap: no bag there'), (['*.nothing'], '*.nothing: no bag there'),
    (['--jobs', '0'], '--jobs: must be at least 1, not 0'),
    (['--jobs', '2', '--live'], '--live: not allowed with argument --jobs'),
])  # fmt: skip
def test_unusable_arguments_get_one_line_and_code_2(options, cause, bags, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / 'broken.yaml').write_text('{')
    assert cause in refusal('validate', bags / 'good', *options, report='.*')


@pytest.fixture(scope='module')
def schema():
    path = BAGS.parent / 'docs' / 'report.schema.json'
    return jsonschema.Draft202012Validator(json.loads(path.read_text('utf-8')))


def test_a_glob_without_a_bag_still_writes_its_reports(schema, tmp_path):
    done = gearkin_here('validate', 'x*', '--json', '-', '--junit', 'report.xml', cwd=tmp_path)
    assert (done.returncode, done.stderr) == (2, 'gearkin: x*: no bag there\n')
    schema.validate(document := json.loads(done.stdout))
    assert document['verdict'] == 'unusable'
    suites = ET.parse(tmp_path / 'report.xml').getroot()  # noqa: S314, our own
    assert [suite.get('errors') for suite in suites] == ['1']


def test_every_form_is_written_beside_the_plain_lines(bags, schema, tmp_path):
    pytest.importorskip('plotly')
    files = {form: tmp_path / f'report.{form}' for form in ('json', 'junit', 'html')}
    files['json'].write_text(OLD_REPORT, encoding='utf-8')
    options = [word for form, path in files.items() for word in (f'--{form}', path)]
    done = gearkin('validate', 'good', 'wrong', *options, cwd=bags)
    assert (done.returncode, done.stderr) == (1, '')
    summary = 'summary: 2 bags: 1 passed, 1 failed, 0 unusable'
    assert done.stdout.startswith(f'{summary}\nwrong: verdict: failed: /output_state ')
    assert sorted(tmp_path.iterdir()) == sorted(files.values())
    schema.validate(json.loads(files['json'].read_text('utf-8')))
    suites = ET.parse(files['junit']).getroot()  # noqa: S314, our own
    assert [suite.get('failures') != '0' for suite in suites] == [False, True]
    page = files['html'].read_text('utf-8')
    assert page.endswith('</html>\n')
    assert page.count('class="motion"') == 2
    assert 'wrong' in page
    # The footer is evidence: how the page was made, and from which parameters.
    command = shlex.join(['gearkin', 'validate', 'good', 'wrong', *map(str, options)])
    assert f'<dd>{html.escape(command)}</dd>' in page
    digest = hashlib.sha256(CONFIG.read_bytes()).hexdigest()
    assert f'<dt>SHA-256 of {CONFIG}</dt><dd>{digest}</dd>' in page
    assert re.search(r'<dt>made</dt><dd>\d{4}-\d\d-\d\d \d\d:\d\d:\d\d UTC</dd>', page)


def test_a_report_that_finds_no_room_leaves_the_old_one(bags, tmp_path):
    report = tmp_path / 'report.json'
    report.write_text(OLD_REPORT, encoding='utf-8')
    # The limit is for gearkin, not for what measures its coverage at the end.
    code = f"""
import resource
unlimited = resource.getrlimit(resource.RLIMIT_FSIZE)
resource.setrlimit(resource.RLIMIT_FSIZE, (1000, unlimited[1]))
try:
    {GEARKIN}
finally:
    resource.setrlimit(resource.RLIMIT_FSIZE, unlimited)
"""
    done = gearkin('validate', bags / 'good', '--json', report, code=code)
    assert (done.returncode, done.stderr) == (2, f'gearkin: {report}: File too large\n')
    assert list(tmp_path.iterdir()) == [report]
    assert report.read_text('utf-8') == OLD_REPORT


def test_a_report_goes_into_a_pipe_and_through_a_link(bags, tmp_path):
    """Neither is replaced by a file: `--json >(jq .)`, or /dev/null."""
    pipe, link, file = (tmp_path / name for name in ('pipe', 'link', 'file'))
    os.mkfifo(pipe)
    file.touch()
    link.symlink_to(file)
    with running_gearkin('validate', bags / 'good', '--json', pipe, '--junit', link) as process:
        assert json.loads(pipe.read_text('utf-8'))['verdict'] == 'pass'
        process.communicate(timeout=DEADLINE)
    assert process.returncode == 0
    assert pipe.is_fifo()
    assert link.is_symlink()
    assert ET.parse(file).getroot().tag == 'testsuites'  # noqa: S314, our own


@pytest.mark.slow
@pytest.mark.parametrize(('arguments', 'code', 'unbuffered'), [
    (['validate', 'good'], 0, ''), (['validate', 'wrong'], 1, '1'),
    (['validate', 'good', '--json', '-'], 0, '1'), (['validate', 'wrong', '--junit', '-'], 1, ''),
    (['urdf'], 0, ''), (['urdf'], 0, '1'),
])  # fmt: skip
def test_a_closed_pipe_changes_no_exit_code(arguments, code, unbuffered, bags):
    environment = os.environ | {'PYTHONUNBUFFERED': unbuffered}
    with running_gearkin(*arguments, cwd=bags, env=environment) as process:
        process.stdout.close()
        process.stdout = None
        _, errors = process.communicate(timeout=DEADLINE)
    assert (process.returncode, errors) == (code, '')


@pytest.mark.slow
@pytest.mark.parametrize('options', [[], ['--jobs', '2'], ['--json', '-']], ids=' '.join)
def test_a_terminal_gets_tables_and_its_progress_apart(options, bags):
    with Terminal() as shown, Terminal() as progress:
        streams = {'stdout': shown.other, 'stderr': progress.other}
        done = gearkin('validate', 'wrong', *options, cwd=bags, env=ENVIRONMENT, **streams)
        assert done.returncode == 1
        text, bar = shown.text(), progress.text()
    assert '━' in bar  # a bar
    assert 'FAILED' not in bar
    assert '━' not in text
    if '--json' in options:
        assert json.loads(text)['verdict'] == 'fail'
    else:
        assert 'FAILED' in text
        assert '\x1b[' in text  # colours
        assert 'verdict:' not in text  # no plain lines


@pytest.mark.slow
def test_processes_end_with_one_that_is_killed(bags, tmp_path):
    with (
        BlockedBag(SERVO, tmp_path / 'blocked') as blocked,
        running_gearkin('validate', '--jobs', 2, bags / 'good', blocked.path) as process,
    ):
        blocked.reader()
        process.kill()
        wait_until(lambda: not blocked.readers(), 'the end of the processes')


@pytest.mark.live
@pytest.mark.slow
@pytest.mark.parametrize(('bag', 'option', 'topics'), [
    ('rotor_only', '--config', {'output_state'}),
    ('wrong', '--calibration', {'output_state', 'body_poses', *CORRECTED}),
])  # fmt: skip
def test_what_a_live_node_publishes_is_validated_not_what_was_recorded(
    bag, option, topics, bags, other_gear, tmp_path
):
    """Recorded outputs may be wrong; the file of a bag that is none is told on the way."""
    file = tmp_path / 'calibration.yaml'
    file.write_text(calibration().text(), 'utf-8')
    given = [option, {'--config': other_gear, '--calibration': file}[option]]
    bad = bags / 'garbage.mcap'
    done = gearkin('validate', '-v', '--live', bags / bag, bad, *given)
    assert done.returncode == 2
    assert done.stderr == f'gearkin: {bad}: not a bag of a known kind\n'
    assert f'{bags / bag}: verdict: passed; {SAMPLES} inputs' in done.stdout
    compared = re.findall(r': /(\w+): .*?compared: (\d+);', done.stdout)
    assert compared == [(topic, str(SAMPLES)) for topic, _ in compared]
    assert {topic for topic, _ in compared} == topics


@pytest.mark.slow
@pytest.mark.parametrize('words', [['validate', 'good'], ['compute', 'rotor_only', 'OUT']])
def test_recordings_need_neither_ros_nor_plotly(words, bags, tmp_path):
    missing = 'for name in ("rclpy", "plotly"): sys.modules[name] = None'
    given = [tmp_path / 'out' if word == 'OUT' else word for word in words]
    done = gearkin(*given, cwd=bags, code=f'import sys\n{missing}\n{GEARKIN}')
    assert done.returncode == 0, done.stderr
