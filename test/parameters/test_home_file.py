# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The home file: read by what was written to it, whole whatever happens, and else refused."""

import signal
import subprocess
import sys
from dataclasses import replace

import pytest
import yaml
from refusals import refused

from gear_kinematics.parameters import NodeParameters
from gear_kinematics.parameters.arm import actuators_of
from gear_kinematics.parameters.atomic_file import replace_file
from gear_kinematics.parameters.files import ConfigError
from gear_kinematics.parameters.home_file import read_home, write_home

NODE = '/gear_state_publisher'
SINGLE = {'': NodeParameters.load()}
HOMED = {'': replace(SINGLE[''], rotor_zero=28.969, rotor_joint='0x1: é')}
OLD = """\
schema: gear_kinematics/home/1
homed: 2026-03-01 12:00 UTC
rotor_zero: 28.969
gear_ratio: '-19'
rotor_joint: rotor
rotor_direction: 1
rotor_encoder: multi_turn
"""
"""As the first version has written it: what is on the disks of users must be read for ever."""


@pytest.fixture
def path(tmp_path):
    return tmp_path / 'home.yaml'


def test_what_is_read_is_what_was_written(path):
    assert read_home(path, HOMED, NODE) is None
    write_home(path, HOMED, NODE)
    zeros, homed = read_home(path, HOMED, NODE)
    assert (zeros, homed[-4:]) == ({'': 28.969}, ' UTC')
    path.write_text(OLD, 'utf-8')
    assert read_home(path, SINGLE, NODE) == ({'': 28.969}, '2026-03-01 12:00 UTC')


@pytest.mark.parametrize(('entries', 'cause'), [
    ({'gear_ratio': '1457/26'}, "its gear_ratio is '1457/26', not '-19'"),
    ({'rotor_encoder': 'single_turn'}, "its rotor_encoder is 'single_turn', not 'multi_turn'"),
    ({'rotor_zero': float('nan')}, 'rotor_zero must be between'),
    ({'schema': 'gear_kinematics/home/2'}, "its schema is 'gear_kinematics/home/2', not"),
    ({'rotor_joint': 'm' * 200_000}, "its rotor_joint is 'mmm"),
    ({'rotor_zero': 'm' * 200_000}, 'rotor_zero must be of type float'),
], ids=lambda value: str(value)[:60])  # fmt: skip
def test_other_gear_or_odd_value_is_refused_in_a_line(path, entries, cause):
    path.write_text(yaml.safe_dump(yaml.safe_load(OLD) | entries), 'utf-8')
    with refused(ConfigError, path, cause) as caught:
        read_home(path, SINGLE, NODE)
    assert len(str(caught.value)) < 500


def test_file_of_an_arm_has_the_zeros_of_what_was_homed(path):
    """And is refused for other actuators, for another gear, and for a single one."""
    arm = actuators_of({'actuators': ['shoulder', 'elbow'], 'elbow.rotor_zero': 2.5})
    write_home(path, {'elbow': arm['elbow']}, NODE)
    zeros, _ = read_home(path, arm, NODE)
    assert zeros == {'elbow': 2.5}
    other = replace(arm['elbow'], rotor_direction=-1)
    for actuators, cause in (
        ({'elbow': other}, 'its elbow.rotor_direction is 1, not -1'),
        ({'shoulder': arm['shoulder']}, "its 'elbow' is not in `actuators`"),
        (SINGLE, "its schema is 'gear_kinematics/home/2', not 'gear_kinematics/home/1'"),
    ):
        with pytest.raises(ConfigError, match=cause):
            read_home(path, actuators, NODE)


@pytest.mark.parametrize('target', ['elsewhere.yaml', 'nothing.yaml'])
def test_link_is_neither_read_nor_written_through(path, tmp_path, target):
    (tmp_path / 'elsewhere.yaml').write_text(OLD, 'utf-8')
    path.symlink_to(target)
    with pytest.raises(ConfigError, match='must not be a link'):
        read_home(path, HOMED, NODE)
    with pytest.raises(OSError, match='it is a link'):
        write_home(path, HOMED, NODE)
    assert path.is_symlink()
    assert (tmp_path / 'elsewhere.yaml').read_text('utf-8') == OLD
    assert not (tmp_path / 'nothing.yaml').exists()


def test_zero_of_another_node_is_refused(path):
    write_home(path, HOMED, '/left/gear_state_publisher')
    with pytest.raises(ConfigError, match="its node is '/left/gear_state_publisher', not '/gear_"):
        read_home(path, HOMED, NODE)


def test_old_zero_is_removed_where_the_new_one_cannot_be_written(path, monkeypatch):
    write_home(path, HOMED, NODE)

    def full(*_, **_options):
        raise OSError(28, 'No space left on device')

    monkeypatch.setattr('gear_kinematics.parameters.atomic_file.os.fsync', full)
    with pytest.raises(OSError, match='No space left'):
        write_home(path, {'': replace(HOMED[''], rotor_zero=1.0)}, NODE)
    monkeypatch.undo()
    assert read_home(path, HOMED, NODE) is None
    write_home(path, HOMED, NODE)
    # Root may write to a folder that is read-only, so both operations are made to fail.
    monkeypatch.setattr('gear_kinematics.parameters.atomic_file.os.fsync', full)
    monkeypatch.setattr('pathlib.Path.unlink', full)
    with pytest.raises(OSError, match='its zero is out of date'):
        write_home(path, {'': replace(HOMED[''], rotor_zero=1.0)}, NODE)
    with pytest.raises(OSError, match=r'device$'):  # without a file to delete
        write_home(path.with_name('new.yaml'), HOMED, NODE)


@pytest.mark.parametrize(
    ('moment', 'old', 'left'),
    [('os.fsync', OLD, 1), ('os.fsync', '', 0), ('pathlib.Path.replace', OLD, 2)],
)
def test_process_that_is_killed_leaves_the_old_file_and_hinders_no_other(
    path, tmp_path, moment, old, left
):
    if old:
        path.write_text(old, 'utf-8')
    program = (
        'import os, pathlib, signal, sys\n'
        'from gear_kinematics.parameters.atomic_file import replace_file\n'
        'def kill(*_): os.kill(os.getpid(), signal.SIGKILL)\n'
        f'{moment} = kill\n'
        f"replace_file(pathlib.Path(sys.argv[1]), b'new', new={not old})\n"
    )
    process = subprocess.run([sys.executable, '-c', program, path], check=False)
    assert process.returncode == -signal.SIGKILL
    assert not old or path.read_text('utf-8') == old
    assert len([*tmp_path.iterdir()]) == left
    replace_file(path, b'newer', new=not old)
    assert path.read_bytes() == b'newer'
