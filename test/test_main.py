# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""How both programs start and end: signals, closed streams, and what is missing."""

import json
import os
import shlex
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace

import pytest
from blocked_bags import (
    BAGS,
    DEADLINE,
    GEARKIN,
    BlockedBag,
    finished,
    gearkin,
    started,
    wait_until,
)

from gear_kinematics.commands.extras import remedy
from gear_kinematics.ros.workarounds import shared_memory
from gear_kinematics.ros.workarounds.shared_memory import check_shared_memory

pytestmark = pytest.mark.slow

BAG = BAGS / 'servo_point_to_point'
NODE = [sys.executable, '-P', '-m', 'gear_kinematics.ros']
PIPES = {'stdout': subprocess.PIPE, 'stderr': subprocess.PIPE}
READY = 'gear ratio'


# What needs no ROS.


@pytest.mark.parametrize('option', ['--version', '--help'])
def test_the_node_answers_without_ros(option, tmp_path):
    (tmp_path / 'rclpy.py').write_text('raise SystemExit("rclpy was imported")')
    path = os.pathsep.join([str(tmp_path), os.environ.get('PYTHONPATH', '')])
    command = [*NODE, option, '--ros-args', '-p', 'rotor_joint:=m1']
    done = finished(command, env=os.environ | {'PYTHONPATH': path})
    assert (done.returncode, done.stderr) == (0, '')
    first = 'gear_state_publisher 0.' if option == '--version' else 'usage: gear_state_publisher '
    assert done.stdout.startswith(first)


def test_a_node_refuses_arguments_that_ros_would_ignore():
    done = finished([*NODE, '--params-file', 'actuator.yaml', '--ros-args'])
    said = "unknown arguments ['--params-file', 'actuator.yaml']: those of ROS follow --ros-args"
    assert (done.returncode, done.stderr) == (2, f'gear_state_publisher: {said}\n')


def test_what_follows_ros_args_is_for_ros(tmp_path):
    done = finished(
        [*NODE, '--ros-args', '--help'], env=os.environ | {'ROS_LOG_DIR': str(tmp_path)}
    )
    assert (done.returncode, done.stdout) == (2, '')
    assert '--help' in done.stderr


# Signals.


def has(pid: int, number: signal.Signals, disposition: str) -> bool:
    """Tell whether a process catches (SigCgt) or ignores (SigIgn) a signal."""
    status = Path(f'/proc/{pid}/status').read_text('utf-8')
    [mask] = (line.split()[1] for line in status.splitlines() if line.startswith(disposition))
    return bool(int(mask, 16) >> (number - 1) & 1)


def wait_for_handlers(process) -> None:
    """Wait until a program handles signals: SIGTERM, which Python does not by itself."""
    wait_until(lambda: has(process.pid, signal.SIGTERM, 'SigCgt'), 'handlers of signals')


def interrupted_starts(command, longest: float, count: int, **options) -> Iterator[tuple]:
    """Interrupt a program at moments all over its start, every other time twice; yields the ends.

    The moments are what is tested; nothing is waited for.
    """
    for k in range(count):
        moment = (k + 0.5) / count
        with started(command, **PIPES, **options) as process:
            wait_for_handlers(process)
            time.sleep(moment * longest)
            process.send_signal(signal.SIGINT)
            if k % 2:
                time.sleep(0.05 * (7 * k % count) / count)
                process.send_signal(signal.SIGINT)
            output, errors = process.communicate(timeout=DEADLINE)
        if READY in errors:
            longest *= moment  # the first start may have been slow
        yield process.returncode, output, errors


def test_nothing_heavy_is_imported_before_signals_are_handled():
    code = 'import sys, gear_kinematics.__main__; print(*sorted(sys.modules))'
    done = gearkin(code=code)
    imported = {name for name in done.stdout.split() if name.startswith('gear_kinematics.')}
    names = ('__main__', 'ros', 'ros.workarounds', 'ros.workarounds.shared_memory')
    assert imported == {f'gear_kinematics.{name}' for name in names}
    assert not {'numpy', 'rclpy', 'argparse', 'rich', 'yaml'} & set(done.stdout.split())


@pytest.mark.parametrize(('command', 'unused'), [
    ('--version', 'bag commands correction kinematics parameters report wire'),
    ('--help', 'bag correction measurement parameters plotting state validation'),
    (f'info {BAG}', 'plotting shape validation watch'),
    (f'validate {BAG}', 'measurement plotting watch'),
    ('describe', 'measurement state validation watch'),
], ids=lambda text: text.split()[0])  # fmt: skip
def test_a_command_imports_no_room_that_it_does_not_use(command, unused):
    code = f'try:\n {GEARKIN}\nfinally: print(*sys.modules)'
    done = gearkin(*command.split(), code=code)
    assert done.returncode == 0
    assert 'gear_kinematics.share' in done.stdout.split()
    rooms = {f'gear_kinematics.{room}' for room in unused.split()}
    assert not {'rclpy', 'scipy', 'matplotlib', *rooms} & set(done.stdout.split())


@pytest.mark.live
def test_a_node_interrupted_at_any_moment_of_its_start_ends_cleanly(tmp_path):
    environment = os.environ | {'ROS_LOG_DIR': str(tmp_path)}
    with started(NODE, **PIPES, env=environment) as process:
        wait_for_handlers(process)
        begun = time.monotonic()
        assert READY in process.stderr.readline()
        longest = 1.2 * (time.monotonic() - begun)
        process.send_signal(signal.SIGINT)
        assert process.wait(DEADLINE) == 0
    early = 0
    for code, output, errors in interrupted_starts(NODE, longest, 10, env=environment):
        assert (code, output) == (0, ''), errors
        assert 'Traceback' not in errors
        early += READY not in errors
    assert early >= 3, 'most of the signals came too late to tell anything'


def test_gearkin_interrupted_at_any_moment_of_its_start_ends_cleanly(tmp_path):
    folder = tmp_path / 'results'
    folder.mkdir()
    command = [sys.executable, '-c', GEARKIN, 'compute']
    with BlockedBag(BAG, tmp_path / 'blocked') as blocked:
        command += [str(blocked.path), str(folder / 'out')]
        with started(command, **PIPES) as process:
            wait_for_handlers(process)
            begun = time.monotonic()
            blocked.reader()
            longest = 1.2 * (time.monotonic() - begun)
        for ended in interrupted_starts(command, longest, 6):
            assert ended == (130, '', '')
            assert not list(folder.iterdir())


def gearkin_doing(main: str) -> tuple[int, str, str]:
    """Run gearkin with something else to do, which can interrupt() it."""
    done = gearkin(
        code=f"""
import os, signal, sys, time
from gear_kinematics.__main__ import gearkin
from gear_kinematics.commands import cli
def interrupt():
    os.kill(os.getpid(), signal.SIGINT)
{main}
cli.main = main
sys.exit(gearkin())
"""
    )
    return done.returncode, done.stdout, done.stderr


def test_a_second_signal_does_not_disturb_the_clean_up_after_the_first():
    ended = gearkin_doing("""
def main():
    try:
        interrupt()
        time.sleep(60.0)
    finally:
        interrupt()
        print('cleaned up')
""")
    assert ended == (130, 'cleaned up\n', '')


def test_an_interruption_that_python_drops_is_repeated():
    ended = gearkin_doing("""
class Interrupting:
    def __del__(self):
        interrupt()
        time.sleep(60.0)
def main():
    Interrupting()
    time.sleep(60.0)
""")
    assert ended == (130, '', '')


@pytest.mark.parametrize('end', ['', 'while True: time.sleep(60.0)'], ids=['ends', 'hangs'])
def test_an_import_may_end_before_an_interruption_unless_it_takes_long(end, tmp_path):
    (tmp_path / 'imported.py').write_text(f"""
import __main__, time
try:
    __main__.interrupt()
except KeyboardInterrupt:
    print('lost')
{end}
""")
    ended = gearkin_doing(f"""
def main():
    sys.path.insert(0, {str(tmp_path)!r})
    import imported
    time.sleep(60.0)
""")
    assert ended == (130, '', '')


def test_a_background_job_of_a_script_is_not_interrupted(tmp_path):
    command = ['sh', '-c', 'trap "" INT; exec "$@"', 'sh', sys.executable, '-c', GEARKIN]
    with (
        BlockedBag(BAG, tmp_path / 'blocked') as blocked,
        started([*command, 'validate', str(blocked.path)], **PIPES) as process,
    ):
        blocked.reader()
        assert has(process.pid, signal.SIGINT, 'SigIgn')
        process.send_signal(signal.SIGTERM)
        assert process.wait(DEADLINE) == 130


# Streams that are closed.


def closing(streams: str, *command) -> list[str]:
    """Give the command that runs a program with some streams closed."""
    return ['sh', '-c', f'exec "$@" {streams}', 'sh', *map(str, command)]


@pytest.mark.parametrize('streams', ['>&-', '<&- >&- 2>&-'])
def test_gearkin_needs_no_open_streams(streams, tmp_path):
    report = tmp_path / 'report.json'
    command = [sys.executable, '-c', GEARKIN, 'validate', '--jobs', '2']
    for bags, code in (([BAG, BAGS / 'driver_faults'], 0), ([tmp_path / 'none'], 2)):
        done = finished(closing(streams, *command, *bags, '--json', report))
        assert done.returncode == code, done.stderr
        assert 'Traceback' not in done.stderr
        assert bool(done.stdout) == (code == 0 and '>&-' not in streams.split())
    assert [bag['verdict'] for bag in json.loads(report.read_text())['bags']] == ['unusable']


@pytest.mark.live
def test_a_node_opens_nothing_in_place_of_a_closed_stream(tmp_path):
    command = closing('<&- >&- 2>&-', *NODE)
    with started(command, env=os.environ | {'ROS_LOG_DIR': str(tmp_path)}) as process:
        wait_until(lambda: READY in ''.join(map(Path.read_text, tmp_path.iterdir())), 'its log')
        for number in range(3):
            assert Path(f'/proc/{process.pid}/fd/{number}').samefile('/dev/null')
        process.send_signal(signal.SIGINT)
        assert process.wait(DEADLINE) == 0


def test_an_error_that_cannot_be_said_has_its_exit_code():
    with Path('/dev/full').open('w') as full:
        assert gearkin('validate', 'nowhere', stderr=full).returncode == 2


@pytest.mark.parametrize(
    ('program', 'argument', 'unbuffered'),
    [
        ('gearkin', '--help', ''),
        ('gearkin', '--help', '1'),
        ('gearkin', 'describe', ''),
        ('gearkin', 'describe', '1'),
        ('gear_simulator', '--help', ''),
    ],
)
def test_what_cannot_be_printed_is_one_line_and_a_closed_pipe_none(program, argument, unbuffered):
    env = os.environ | {'PYTHONUNBUFFERED': unbuffered}
    command = f'{shlex.quote(sys.executable)} -c "$0" {argument}'
    code = f'import sys; from gear_kinematics.__main__ import {program} as p; sys.exit(p())'
    full = finished(['sh', '-c', f'{command} > /dev/full', code], env=env)
    said = f'{program}: [Errno 28] No space left on device\n'
    assert (full.returncode, full.stderr) == (2, said)
    closed = finished(['bash', '-o', 'pipefail', '-c', f'{command} | :', code], env=env)
    assert (closed.returncode, closed.stderr) == (0, '')


# What is not installed.

ROS = ": source a ROS 2 installation, or pip install 'gear_kinematics[ros]'"
PYTHON = f' for {sys.executable}: install it, or build gear_kinematics with another Python, as by '
PYTHON += 'python3 -m colcon build'


@pytest.mark.parametrize(
    ('program', 'package', 'remedy'),
    [
        ('gearkin', 'rclpy', ROS),
        ('gear_state_publisher', 'visualization_msgs', ROS),
        # colcon starts programs by its own Python, which can lack what the workspace has.
        ('gearkin', 'numpy', PYTHON),
    ],
)
def test_without_a_package_there_is_one_line_that_says_what_to_do(program, package, remedy):
    code = (
        f'import sys; sys.modules[{package!r}] = None\n'
        f'from gear_kinematics.__main__ import {program}; sys.exit({program}())'
    )
    done = gearkin(*(['demo'] if program == 'gearkin' else []), code=code)
    assert (done.returncode, done.stdout) == (2, '')
    assert done.stderr == f'{program}: {package} is not installed{remedy}\n'


def test_without_middleware_there_is_one_line_that_names_the_extra():
    """The wheels of rclpy bring none by themselves; these are the words of their import."""
    words = 'librmw_fastrtps_cpp.so: cannot open shared object file: No such file or directory'
    line = remedy(ImportError(f'{words}\nThe C extension could not be imported'))
    assert "pip install 'ros-jazzy-rclpy[fastrtps]'" in line


# Shared memory.


def in_shared_memory(size: str, *command: object) -> list[str]:
    """Give the command that runs a program with so much shared memory, which nobody else sees."""
    unshare = ['unshare', '--mount'] if os.geteuid() == 0 else ['unshare', '-r', '--mount']
    mount = f'mount -t tmpfs -o size={size} none /dev/shm'
    mounted = [*unshare, 'sh', '-c', f'{mount} && exec "$@"', 'sh']
    try:
        subprocess.run([*mounted, 'true'], check=True, capture_output=True, text=True)
    except FileNotFoundError:
        pytest.skip('unshare is not installed')
    except subprocess.CalledProcessError as error:
        pytest.skip(f'mount namespaces need root: {error.stderr.strip()}')
    return [*mounted, *map(str, command)]


@pytest.mark.parametrize('command', [['demo'], None])
def test_without_shared_memory_there_is_one_line_and_no_bus_error(command):
    program = 'gearkin' if command else 'gear_state_publisher'
    words = [sys.executable, '-c', GEARKIN, *command] if command else NODE
    done = finished(in_shared_memory('4k', *words))
    assert (done.returncode, done.stdout) == (2, '')
    assert done.stderr == (
        f'{program}: ROS cannot start, /dev/shm is full: remove what crashed processes left '
        'there, or enlarge it (docker run --shm-size)\n'
    )


@pytest.mark.live
def test_a_node_warns_of_little_shared_memory_and_starts(tmp_path):
    environment = os.environ | {'ROS_LOG_DIR': str(tmp_path)}
    with started(in_shared_memory('200k', *NODE), env=environment, **PIPES) as process:
        lines = iter(process.stderr.readline, '')
        warning = next(lines)
        assert warning.startswith('gear_state_publisher: only 200 KiB are free in /dev/shm, ')
        assert any(READY in line for line in lines)
        process.send_signal(signal.SIGINT)
        assert process.wait(DEADLINE) == 0


@pytest.mark.parametrize(
    ('free', 'participants', 'warned'),
    [(1024, 1, False), (1023, 1, True), (2047, 2, True), (2048, 2, False), (8, 1, True)],
)
def test_a_mebibyte_of_shared_memory_is_enough_for_a_participant(
    free, participants, warned, monkeypatch
):
    status = SimpleNamespace(f_frsize=1024, f_bavail=free)
    monkeypatch.setattr(shared_memory.os, 'statvfs', lambda _: status)
    warning = check_shared_memory(participants)
    assert f'only {free} KiB are free' in warning if warned else warning is None
