# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""What README and documentation say: commands that run, and every name of the node."""

import re
import shlex
import shutil
import xml.etree.ElementTree as ET
from pathlib import Path

import pytest
import yaml
from gear_recordings import record_both_encoders

from gear_kinematics.commands.cli import COMMANDS, main, make_parser
from gear_kinematics.parameters import BRANCH_PARAMETERS, PARAMETERS, default_value
from gear_kinematics.twin import parameters as twin

ROOT = Path(__file__).resolve().parents[2]
README = (ROOT / 'README.md').read_text('utf-8')
NODE = (ROOT / 'docs/reference/node.md').read_text('utf-8')
SIMULATOR = (ROOT / 'docs/reference/simulator.md').read_text('utf-8')
PAGES = [ROOT / 'README.md', *sorted((ROOT / 'docs').rglob('*.md'))]


def commands(text: str) -> list[list[str]]:
    """Give the words of every gearkin command in a page's blocks, without `gearkin`."""
    lines = re.sub(r'\\\n\s*', '', text).splitlines()
    return [
        words[1:]
        for line in lines
        if re.match(r'( {4})?gearkin [a-z]', line)
        for words in [shlex.split(re.split(' [|>] ', line)[0], comments=True)]
        if words[1] in COMMANDS
    ]


def rows(section: str, page: str = NODE) -> list[list[str]]:
    """Give the cells of the tables in a section of a page on a node."""
    [text] = re.findall(rf'^## {section}\n(.*?)(?=^## |\Z)', page, re.MULTILINE | re.DOTALL)
    lines = re.findall(r'^\| (`.*) \|$', text, re.MULTILINE)
    return [line.split(' | ') for line in lines]


def names(cell: str) -> list[str]:
    return re.findall('`([^`]+)`', cell)


def test_readme_is_one_screen():
    assert len(README.splitlines()) <= 120


def test_scripts_and_styles_state_copyright_and_license():
    """As ruff makes each Python file do."""
    folders = ('bin/*', '.ci/*', 'docs/*.css', 'gear_kinematics/*/*.css', 'gear_kinematics/*/*.js')
    files = [path for folder in folders for path in ROOT.glob(folder)]
    assert files
    for path in files:
        head = path.read_text('utf-8').splitlines()[:2]
        assert any('Copyright 2026' in line and 'Apache-2.0' in line for line in head), path


def test_docstrings_begin_with_what_they_describe():
    folders = ('gear_kinematics/**', 'test/**', 'bags', 'benchmark', 'docs/**', 'examples', 'fuzz')
    files = [path for folder in folders for path in ROOT.glob(f'{folder}/*.py')]
    assert len(files) > 400
    begun = re.compile(r'^ *r?"""(?:Of|The same)\b.*', re.MULTILINE)
    assert not [found for path in files for found in begun.findall(path.read_text('utf-8'))]


def test_every_page_is_in_the_one_index_and_a_how_to_has_its_picture():
    docs = ROOT / 'docs'
    index = (docs / 'index.md').read_text('utf-8')
    pages = {path.stem for path in docs.glob('*.md')} - {'index'}
    of_tables = re.findall(r'\]\((\w+)\.md\)', index)
    of_sidebar = re.findall(r'^(\w+)$', index, re.MULTILINE)
    assert sorted(of_tables) == sorted(of_sidebar) == sorted(pages)
    assert '](docs/index.md)' in README
    [how_to] = re.findall(r':caption: How to\n\n(.*?)```', index, re.DOTALL)
    for page in how_to.split():
        shown = re.findall(r'!\[.+\]\((.+)\)', (docs / f'{page}.md').read_text('utf-8'))
        assert shown or page == 'security'
        assert all((docs / picture).is_file() for picture in shown)


def test_ci_and_hooks_run_what_make_does():
    if not (ROOT / '.github').exists():
        pytest.skip('a source distribution has no hidden files')
    targets = re.findall('^([a-z]+):', (ROOT / 'Makefile').read_text('utf-8'), re.MULTILINE)
    workflow = yaml.safe_load((ROOT / '.github/workflows/test.yml').read_text('utf-8'))
    hooks = yaml.safe_load((ROOT / '.pre-commit-config.yaml').read_text('utf-8'))
    [job] = workflow['jobs'].values()
    run = [step['run'] for step in job['steps'] if 'run' in step]
    hooked = [hook['entry'] for repo in hooks['repos'] for hook in repo['hooks']]
    assert run == ['make test']
    assert {'make lint', 'make test'} <= set(hooked) <= {f'make {target}' for target in targets}


@pytest.mark.parametrize('page', PAGES, ids=lambda path: path.name)
def test_every_command_in_the_documentation_has_arguments_that_exist(page):
    for words in commands(page.read_text('utf-8')):
        make_parser().parse_args(words)


@pytest.mark.slow
def test_commands_of_the_readme_do_what_it_says(tmp_path, monkeypatch, capsys):
    shutil.copytree(ROOT / 'bags/servo_point_to_point', tmp_path / 'logs/monday')
    shutil.copytree(ROOT / 'docs/examples', tmp_path / 'docs/examples')
    braced = '/**: {ros__parameters: {preload: 3.0, branch_stiffness: [3000.0]}}'
    (tmp_path / 'actuator.yaml').write_text(braced, 'utf-8')
    (tmp_path / 'encoder').mkdir()
    record_both_encoders(tmp_path / 'encoder', 'monday', 'tuesday', 'friday')
    monkeypatch.chdir(tmp_path)
    told = {}
    *live, recording = commands(README)[:4]  # beside a node, as in test/watch
    assert [*live, recording[:2]] == [['init'], ['watch'], ['home'], ['record', 'logs/monday']]
    for words in commands(README)[4:]:
        assert main(words) == 0, capsys.readouterr().err
        told[words[0]] = capsys.readouterr().out
    assert list(told) == ['validate', 'calibrate', 'preload', 'lost-motion', 'loads', 'mjcf']
    assert (tmp_path / 'gear.xml').exists()
    assert 'within the 95 % interval' in told['calibrate']
    assert 'for -1 to' in told['preload']
    assert 'ring hole 60 in chassis hole 10, tooth 11' in told['preload']
    assert 'the output rests anywhere within' in told['lost-motion']
    assert 'verdict: passed. Both branches stayed in mesh over ' in told['loads']
    written = {'monday.html', 'report.xml', 'calibration.html', 'ramps.html', 'loads.html'}
    assert written <= {path.name for path in tmp_path.iterdir()}


def test_every_command_is_in_the_reference():
    pages = (ROOT / 'docs/reference/gearkin').iterdir()
    assert {page.stem for page in pages} == set(COMMANDS)
    for command in COMMANDS:
        page = (ROOT / f'docs/reference/gearkin/{command}.md').read_text('utf-8')
        assert page.startswith(f'# gearkin {command}\n')
        assert page.endswith(f'```{{arguments}} {command}\n```\n')


def test_every_topic_is_in_the_reference():
    policy = ET.parse(ROOT / 'policies/gear_state_publisher.policy.xml')  # noqa: S314, our own
    topics = {
        topic.text.removeprefix('/')
        for topic in policy.iterfind('.//topics/topic')
        if topic.text not in {'/rosout', '/parameter_events'}
    }
    documented = {name.removeprefix('/') for row in rows('Topics') for name in names(row[0])}
    assert documented == {name.rpartition('/')[2] for name in topics}


def documented_parameters(page: str) -> dict[str, str]:
    """Give the default values in the table of a page, by parameter."""
    return {
        name: default
        for cell, given, _ in rows('Parameters', page)
        for name, default in zip(
            names(cell), given.split(', ', len(names(cell)) - 1), strict=False
        )
    }


def test_every_parameter_of_the_simulator_is_in_the_reference_with_its_default():
    documented = documented_parameters(SIMULATOR)
    shown = {name: yaml.safe_load(default) for name, default in documented.items()}
    assert shown == {name: twin.default_value(name) for name in twin.PARAMETERS}


def test_every_parameter_is_in_the_reference_with_its_default():
    documented = documented_parameters(NODE)
    documented.pop('qos_overrides.<topic>.<policy>')
    of_branches = {f'<branch>.{name}' for name in BRANCH_PARAMETERS}
    assert set(documented) == {*PARAMETERS, *of_branches}
    shown = {
        name: yaml.safe_load(documented[name].removesuffix(' (1°)').strip('`'))
        for name in PARAMETERS
    }
    assert shown == {name: default_value(name) for name in PARAMETERS}
