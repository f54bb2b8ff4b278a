# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""gearkin completion, as a shell uses it."""

import subprocess

import pytest
from blocked_bags import BAGS, gearkin

from gear_kinematics.commands.cli import COMMANDS, main

ASKED = """
source "$1"
shift
COMP_WORDS=("$@") COMP_CWORD=$(($# - 1)) COMP_LINE="$*" COMP_POINT=${#COMP_LINE}
_shtab_gearkin
printf '%s\\n' "${COMPREPLY[@]}"
"""


@pytest.fixture(scope='module')
def script(tmp_path_factory):
    pytest.importorskip('shtab')
    path = tmp_path_factory.mktemp('completion') / 'gearkin'
    done = gearkin('completion', 'bash')
    assert (done.returncode, done.stderr) == (0, '')
    path.write_text(done.stdout)
    return path


@pytest.mark.parametrize(
    ('words', 'expected'),
    [
        ('gearkin va', {'validate'}),
        ('gearkin validate --rotor', {'--rotor-topic'}),
        ('gearkin plot s', {'scheme', 'slides'}),
        ('gearkin compute --storage m', {'mcap'}),
        ('gearkin info READ', {'README.md'}),
        ('gearkin validate --config set', {'setup.py', 'setup.cfg'}),
    ],
)
def test_bash_completes_commands_options_choices_and_files(script, words, expected):
    command = ['bash', '-c', ASKED, 'bash', script, *words.split()]
    done = subprocess.run(command, cwd=BAGS.parent, capture_output=True, text=True, check=True)
    assert set(done.stdout.split()) == expected


@pytest.mark.parametrize('shell', ['zsh', 'tcsh'])
def test_other_shells_know_every_command(shell, capsys):
    pytest.importorskip('shtab')
    assert main(['completion', shell]) == 0
    text = capsys.readouterr().out
    assert all(command in text for command in COMMANDS)
