# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Files that gearkin writes: it replaces its own, and never a recording."""

import json
import os
import shutil
from pathlib import Path

import pytest
from blocked_bags import BAGS, refusal

from gear_kinematics.commands.cli import main
from gear_kinematics.parameters.atomic_file import replace_file
from gear_kinematics.report.mark import is_report

SERVO = BAGS / 'servo_point_to_point'
RAMPS = BAGS.parent / 'docs' / 'examples' / 'ramps.csv'
STIFFNESS = ['--branch-stiffness', '3000', '--shaft-stiffness', '1000']
NOTES = '# made by gearkin, and then much work\n'


@pytest.fixture
def work(tmp_path, monkeypatch):
    """A folder with recordings, in which gearkin runs."""
    shutil.copy(SERVO / 'servo_point_to_point_0.mcap', tmp_path / 'k1.mcap')
    shutil.copy(SERVO / 'servo_point_to_point_0.mcap', tmp_path / 'k2.mcap')
    shutil.copytree(BAGS / 'driver_faults', tmp_path / 'bag')
    shutil.copy(RAMPS, tmp_path / 'before.csv')
    for name in ('samples.txt', 'bench.mf4', 'before.csv.gz'):
        shutil.copy(RAMPS, tmp_path / name)
    (tmp_path / 'link').symlink_to('k1.mcap')
    (tmp_path / 'my.yaml').write_text('/**: {ros__parameters: {module: 0.0005}}\n')
    (tmp_path / 'notes.md').write_text(NOTES)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def contents(folder: Path) -> dict[Path, bytes]:
    return {path: path.read_bytes() for path in folder.rglob('*') if path.is_file()}


RECORDINGS = {
    'validate --junit k1.mcap k2.mcap': 'a recording',
    'validate --json link k2.mcap': 'a recording',
    'validate --json ./bag/metadata.yaml k2.mcap': 'a recording',
    'validate --json k2.mcap k2.mcap': 'what is read',
    'validate --json my.yaml k2.mcap --config my.yaml': 'what is read',
    'lost-motion --json samples.txt samples.txt': 'what is read',
    'lost-motion --plot before.csv samples.txt': 'a recording',
    'calibrate samples.txt -o before.csv': 'a recording',
    'describe --json before.csv': 'a recording',
    'describe --json bench.mf4': 'a recording',
    'describe --json before.csv.gz': 'a recording',
    'index --degrees 1 --json k1.mcap': 'a recording',
    'animate k1.mcap': 'a recording',
}


@pytest.mark.parametrize('force', [[], ['--force']], ids=['', 'force'])
@pytest.mark.parametrize('command', RECORDINGS)
def test_a_recording_is_never_replaced(command, force, work):
    before = contents(work)
    error = refusal(*command.split(), *force)
    assert f': {RECORDINGS[command]} is never replaced; name a file to write' in error
    assert contents(work) == before


@pytest.mark.parametrize(
    'command',
    ['describe --json notes.md', 'describe --html notes.md', 'validate k1.mcap --junit notes.md'],
)
def test_other_files_are_replaced_only_by_force(command, work, capsys):
    before = contents(work)
    assert refusal(*command.split()) == (
        f'{command.split()[-2]} notes.md: exists, and is no report of gearkin; --force replaces it'
    )
    assert contents(work) == before
    assert main([*command.split(), '--force']) == 0
    assert is_report(work / 'notes.md')
    capsys.readouterr()


@pytest.mark.parametrize('target', ['missing', 'laid'])  # nothing, or itself
@pytest.mark.parametrize('command', ['mjcf -o', 'describe --json', 'calibrate samples.txt -o'])
def test_nothing_is_written_through_a_link_to_nothing(command, target, work):
    (work / 'laid').symlink_to(target)
    assert 'laid: it is a link to nothing; name a file to write' in refusal(
        *command.split(), 'laid', '--force'
    )
    assert not (work / 'missing').exists()
    with pytest.raises(OSError, match='a link to nothing'):  # laid after the check
        replace_file(work / 'laid', b'')


def test_a_figure_replaces_no_other_picture(work):
    pytest.importorskip('matplotlib')
    from PIL import Image  # noqa: PLC0415, comes with matplotlib

    for name, command in (('a.png', ['plot', 'scheme']), ('a.gif', ['animate'])):
        Image.new('RGB', (9, 9)).save(work / name)
        before = contents(work)
        assert f'FILE {name}: exists, and is no ' in refusal(*command, name)
        assert contents(work) == before


REPORTS = {
    'a.json': ['describe', '--json'],
    'a.xml': ['validate', 'k1.mcap', '--junit'],
    'a.html': ['describe', '--html'],
    'a.gif': ['animate', '--rate', '90'],
    **{
        f'a.{suffix}': ['preload', '--degrees', '1', *STIFFNESS, '--plot']
        for suffix in ('png', 'svg', 'pdf')
    },
}


@pytest.mark.parametrize('name', REPORTS)
def test_each_kind_of_report_is_recognised(name, work, capsys):
    pytest.importorskip('matplotlib')
    assert main([*REPORTS[name], name]) == 0
    written = (work / name).read_bytes()
    assert is_report(work / name)
    (work / name).write_bytes(written.replace(b'gearkin', b'another'))
    assert not is_report(work / name)
    capsys.readouterr()


def test_a_report_is_replaced_by_the_next(work, capsys):
    for form in ('--json', '--html'):
        assert main(['describe', form, 'a.json']) == 0
    assert (work / 'a.json').read_text().startswith('<!DOCTYPE html>')
    capsys.readouterr()


def test_an_empty_file_is_filled(work, capsys):
    """As mktemp makes it."""
    (work / 'empty').touch()
    assert main(['describe', '--json', 'empty']) == 0
    assert json.loads((work / 'empty').read_text())['gear_ratio'] == '-19'
    assert main(['describe', '--json', '/dev/null', '--html', '/dev/null']) == 0
    capsys.readouterr()


@pytest.mark.parametrize(
    ('arguments', 'error'),
    [
        (['--json', 'none/a.json'], 'none/a.json: No such file or directory'),
        (['--json', 'notes.md/a.json'], 'notes.md/a.json: Not a directory'),
        (['--json', 'bag', '--force'], 'bag: Is a directory'),
        (['--json', 'a', '--html', './a'], '--json and --html would both write ./a'),
    ],
)
def test_a_file_that_cannot_be_written_is_named_before_any_work(arguments, error, work):
    before = contents(work)
    assert refusal('validate', 'k1.mcap', *arguments) == error
    assert contents(work) == before


def test_a_calibration_replaces_a_calibration_alone(work):
    error = '-o notes.md: exists, and is no calibration of gearkin'
    assert error in refusal('calibrate', 'samples.txt', '-o', 'notes.md')
    report = work / 'report.json'
    assert main(['describe', '--json', str(report)]) == 0
    assert refusal('calibrate', 'samples.txt', '-o', report)
    assert is_report(report)


def test_a_folder_that_must_not_be_written_is_refused_at_once(work, monkeypatch):
    """Tests may run as root, who may write everywhere."""
    monkeypatch.setattr(os, 'access', lambda path, _: path != work)
    assert refusal('validate', 'k1.mcap', '--json', 'a.json') == 'a.json: Permission denied'
