# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The examples of CONTRIBUTING.md, put where it says and run."""

import json
import re
import sys
from enum import Enum
from pathlib import Path
from types import ModuleType

import pytest

from gear_kinematics.commands import cli
from gear_kinematics.validation import causes, document, input_health

ROOT = Path(__file__).resolve().parents[2]
BAG = ROOT / 'bags' / 'driver_faults'
TEXT = (ROOT / 'CONTRIBUTING.md').read_text('utf-8')
CHECK, FIELD, COMMAND = re.findall(r'```python\n(.*?)```', TEXT, re.DOTALL)
[(NAME, SENTENCE)] = re.findall(r"`([A-Z_]+) = '(.*)'`", TEXT)


def module(source: str) -> ModuleType:
    made = ModuleType('example')
    exec(compile(source, 'CONTRIBUTING.md', 'exec'), vars(made))  # noqa: S102, our own
    return made


@pytest.mark.parametrize('name', ['driver_faults', 'constant_speed_3000rpm'])
def test_a_check_fails_a_bag_and_says_why(name, monkeypatch, capsys):
    more = Enum(
        'FindingCause',
        {**{cause.name: cause.value for cause in causes.FindingCause}, NAME: SENTENCE},
    )
    with monkeypatch.context() as patched:
        patched.setattr(causes, 'FindingCause', more)
        added = (*input_health.CHECKS, module(CHECK).slow_driver)
    monkeypatch.setattr(input_health, 'CHECKS', added)
    slow = name == 'driver_faults'
    assert cli.main(['validate', str(BAG.parent / name), '--json', '-']) == slow
    [bag] = json.loads(capsys.readouterr().out)['bags']
    assert bag['verdict'] == ('fail' if slow else 'pass')
    assert ('/rotor_state has only 500 Hz' in bag['findings']) == slow


def test_a_field_of_the_report_is_in_every_form(monkeypatch, capsys, tmp_path):
    pytest.importorskip('plotly')
    added = eval(FIELD, vars(document))  # noqa: S307, our own
    monkeypatch.setattr(document, 'TOPIC', {**document.TOPIC, **added})
    files = {form: tmp_path / form for form in ('html', 'junit')}
    written = [word for form, path in files.items() for word in (f'--{form}', str(path))]
    assert cli.main(['validate', '-v', str(BAG), *written]) == 0
    assert 'answered: 100 %' in capsys.readouterr().out
    assert 'answered' in files['html'].read_text('utf-8')
    assert 'answered: 100 %' in files['junit'].read_text('utf-8')


def test_a_subcommand_reports_in_every_form(monkeypatch, capsys):
    pytest.importorskip('plotly')
    monkeypatch.setitem(cli.COMMANDS, 'ratio', ('the gear ratio', 'ratio'))
    monkeypatch.setitem(sys.modules, 'gear_kinematics.commands.ratio', module(COMMAND))
    outputs = {}
    for form in ('', '--json', '--html'):
        assert cli.main(['ratio', *([form, '-'] if form else [])]) == 0
        outputs[form] = capsys.readouterr().out
    assert outputs[''] == 'gear ratio: -19\n'
    assert json.loads(outputs['--json']) == {'made_by': 'gearkin ratio', 'gear_ratio': '-19'}
    assert '<dt>gear ratio</dt><dd class="">-19</dd>' in outputs['--html']
