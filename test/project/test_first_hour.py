# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Every command of docs/first_hour.md, in its order, beside what `make simulator` runs."""

import contextlib
import os
import re
import shlex
import signal
import subprocess
import sys
from importlib import import_module
from pathlib import Path

import pytest
import yaml
from blocked_bags import DEADLINE, finished, gearkin_here, wait_until
from live import Participant
from rclpy.qos import QoSProfile
from terminals import Person
from watching import GEARKIN, JUDGED, gearkin

from gear_kinematics.parameters import default_value

pytestmark = [pytest.mark.live, pytest.mark.slow]

ROOT = Path(__file__).resolve().parents[2]
PAGE = (ROOT / 'docs/first_hour.md').read_text('utf-8')
COMMANDS = re.findall(r'^    (\S.*)$', PAGE, re.MULTILINE)
MAKEFILE = (ROOT / 'Makefile').read_text('utf-8')
ENTRY = """
import sys
sys.modules['mujoco'] = None  # which the page does not install
from gear_kinematics.__main__ import {0}
sys.exit({0}())
"""
STUB = f"""#!{sys.executable} -IS
import signal
for number in (signal.SIGINT, signal.SIGTERM):
    signal.signal(number, signal.SIG_DFL)
print('runs', flush=True)
signal.pause()
"""
RARER = '-p gear_simulator:rate:=250.0'
"""A quarter of the messages, which take most of the processors' time here."""
TOLD = {
    'gearkin replay bags/servo_point_to_point --as rotor_command': '3000 messages',
    'gearkin validate monday --config config/simulated_actuator.yaml': JUDGED,
    'gearkin loads monday --config config/simulated_actuator.yaml': 'preload that would have held',
    'python examples/bench.py new.csv': 'the rotor is free',
    'gearkin lost-motion new.csv': r'the output rests anywhere within 0\.',
    'gearkin lost-motion new.csv worn.csv': 'worn against new: .*significant',
    'gearkin loads monday --config worn.yaml': 'was out of mesh',
    'gearkin lost-motion new.csv loose.csv': r'loose\.csv: .*the output rests anywhere',
    next(each for each in COMMANDS if '--live' in each): 'The gear has the ratio -19 ',
}
"""What commands print; all but these are looked at below."""


@pytest.fixture(scope='module')
def folder(tmp_path_factory) -> Path:
    """A folder like that of the sources, to write into."""
    folder = tmp_path_factory.mktemp('sources')
    for name in ('bags', 'config', 'examples'):
        (folder / name).symlink_to(ROOT / name)
    return folder


@pytest.fixture(scope='module')
def nodes(tmp_path_factory):
    """Run `make simulator` in a virtual environment with its programs alone; Ctrl-C ends it."""
    venv = tmp_path_factory.mktemp('venv')
    (venv / 'bin').mkdir()
    for name in ('gear_simulator', 'gear_state_publisher'):
        program = venv / f'{name}.py'
        program.write_text(ENTRY.format(name))
        code = f'PYTHONPATH={ROOT} exec {sys.executable} -P {program} "$@" {RARER}'
        (venv / 'bin' / name).write_text(f'#!/bin/sh\n{code}\n')
        (venv / 'bin' / name).chmod(0o755)
    (venv / 'demo.stamp').touch()
    log = venv / 'log'
    with log.open('w') as stream:
        process = subprocess.Popen(
            ['make', 'simulator', f'VENV={venv}'], cwd=ROOT, stdout=stream, stderr=stream,
            start_new_session=True, env={**os.environ, 'ROS_LOG_DIR': str(venv)},
        )  # fmt: skip
    try:
        yield log
    finally:
        os.killpg(process.pid, signal.SIGINT)
        process.wait(DEADLINE)

        def ended() -> bool:
            with contextlib.suppress(ProcessLookupError):
                os.killpg(process.pid, 0)
                return False
            return True

        wait_until(ended, 'the end of both nodes')
    assert 'Traceback' not in log.read_text()


@pytest.fixture(scope='module')
def person():
    """Somebody with a ROS installation."""
    person = Participant('person')
    yield person
    person.close()


def run(folder: Path, command: str) -> str:
    """Run a command to its end, here if it reads files alone; returns what it prints."""
    first, *words = shlex.split(command)
    if words[0] in {'loads', 'lost-motion', 'validate'}:
        done = gearkin_here(*words, cwd=folder)
    else:
        program = [*GEARKIN] if first == 'gearkin' else [sys.executable]
        done = finished([*program, *words], cwd=folder, timeout=300.0)
    codes = {0, 1} if words[0] in {'commission', 'loads', 'validate'} else {0}
    assert done.returncode in codes, done.stdout + done.stderr
    return done.stdout + done.stderr


def test_a_newcomer_needs_no_more_words():
    assert len(PAGE.split()) <= 900


def test_what_make_runs_is_what_the_page_says():
    assert re.search(r"^    pip install '\.\[ros,measure\]'$", PAGE, re.MULTILINE)
    [file] = re.findall('config=(.*);', MAKEFILE)
    recipe = MAKEFILE.replace('$$config', file)
    started = [command for command in COMMANDS if command.startswith('gear_s')]
    assert len(started) == 2
    assert all(f'$(BIN)/{command}' in recipe for command in started)


@pytest.mark.parametrize(
    ('send', 'number'), [(os.killpg, signal.SIGINT), (os.kill, signal.SIGTERM)]
)
def test_what_ends_make_ends_both_nodes(tmp_path, send, number):
    """Ctrl-C reaches all processes, and SIGTERM make alone."""
    (tmp_path / 'bin').mkdir()
    (tmp_path / 'demo.stamp').touch()
    for name in ('gear_simulator', 'gear_state_publisher'):
        # As the nodes do, it takes SIGINT, which a shell lets its background jobs ignore.
        (tmp_path / 'bin' / name).write_text(STUB)
        (tmp_path / 'bin' / name).chmod(0o755)
    command = ['make', '--no-print-directory', 'simulator', f'VENV={tmp_path}']
    with subprocess.Popen(
        command, cwd=ROOT, stdout=subprocess.PIPE, start_new_session=True
    ) as make:
        assert [make.stdout.readline(), make.stdout.readline()] == [b'runs\n'] * 2
        send(make.pid, number)
        assert make.stdout.read() == b''  # once all that has it open has ended


@pytest.mark.usefixtures('nodes')
def test_every_command_with_pip_alone_does_what_the_page_says(folder):
    looked_at = 'make', '.', 'pip', 'gear_simulator', 'gear_state_publisher', 'ros2'
    with contextlib.ExitStack() as motion:
        for command in COMMANDS:
            first, *words = shlex.split(command, comments=True)
            if command == 'gearkin watch':
                with gearkin(folder, 'watch') as page:
                    page.wait_for(r'http://127\.')
            elif '--loop' in words:
                motion.enter_context(gearkin(folder, *words))
            elif first == 'sed':
                subprocess.run(['sh', '-c', command], check=True, cwd=folder)
            elif words[0] == 'record':
                recording = motion.enter_context(contextlib.ExitStack())
                recorder = recording.enter_context(gearkin(folder, *words))
                recorder.wait_for('recording (?=.*/rotor_state).*/output_state')
            elif command in TOLD:
                said = run(folder, command)
                if '--live' in words and not (folder / words[-1]).exists():
                    said = run(folder, command)  # a busy machine lost too much
                assert re.search(TOLD[command], said), said
                if words[0] == 'replay':
                    recording.close()  # by Ctrl-C
                elif '--live' in words:
                    motion.close()
            elif words[-1] in {'wear', 'worn.csv', 'loose.csv'}:
                said = run(folder, command)
            elif words[-1] == 'power_cycle':
                assert 'at 0.000 rad' in run(folder, command)
                home(folder)
            else:
                assert first in looked_at
    assert 'preload of 0.31 N·m is left' not in said  # it was worn twice
    loose = run(folder, 'gearkin lost-motion loose.csv')
    [(value, uncertainty)] = re.findall(r'rests anywhere within (\S+) ± ([\d.]+)′', loose)
    assert abs(float(value) - 7.6) <= float(uncertainty) <= 4.0
    figures = run(folder, 'gearkin lost-motion new.csv -v')
    for name, put_in in (('friction', 0.1), (r'stiffness 0\.6 to 2 N·m', 3788.0)):
        [(value, uncertainty)] = re.findall(rf'{name}: value: (\S+) ± (\S+)', figures)
        assert abs(float(value) - put_in) <= float(uncertainty)
    found = yaml.safe_load((folder / 'found.yaml').read_text('utf-8'))
    assert found['/**']['ros__parameters']['rotor_joint'] == default_value('rotor_joint')


def home(folder: Path) -> None:
    """Home as the page says, once the shaft rests."""
    assert '`h` and `y` in `gearkin watch --text`' in PAGE
    with Person(folder, 'watch', '--text') as watching:
        watching.wait_for('connected')
        watching.wait_for(r'Set it to 0\.0°', keys='h')
        watching.wait_for(r'is now at 0\.0°', keys='hy')
        watching.type('q')
        assert watching.end() == 0


@pytest.mark.usefixtures('nodes')
def test_commands_of_ros2_name_what_there_is(person):
    """The wheels have no `ros2`: what it would send is sent here."""
    for command in COMMANDS:
        match shlex.split(command):
            case 'ros2', 'launch', 'gear_kinematics', file:
                assert (ROOT / 'launch' / file).is_file()
            case 'ros2', 'topic', 'pub', '--once', topic, kind, values:
                message_type = found(kind)
                publisher = person.node.create_publisher(message_type, topic, QoSProfile(depth=10))
                expected = [('gear_simulator', kind)]
                person.wait_until(lambda t=topic, e=expected: listeners(person, t) == e, topic)
                publisher.publish(message_type(**yaml.safe_load(values)))
            case 'ros2', 'service', 'call', name, kind, *values:
                client = person.node.create_client(found(kind), name)
                person.wait_until(client.service_is_ready, name)
                request = found(kind).Request(**yaml.safe_load(*values or ['{}']))
                answer = person.answer_to(lambda c=client, r=request: c.call_async(r))
                assert answer.success or name.endswith('home')  # while it turns
            case 'ros2', 'bag', 'record', *options:
                assert options[:2] == ['--storage', 'mcap']
                for topic in options[4:]:
                    person.wait_until(
                        lambda topic=topic: person.node.count_publishers(topic), topic
                    )
            case ['ros2', *_]:
                pytest.fail(command)


def listeners(person: Participant, topic: str) -> list[tuple[str, str]]:
    """The nodes that listen to a topic, and its types."""
    known = person.node.get_subscriptions_info_by_topic(topic)
    return [(listener.node_name, listener.topic_type) for listener in known]


def found(kind: str) -> type:
    """The type of a name such as std_srvs/srv/Trigger."""
    package, room, name = kind.split('/')
    return getattr(import_module(f'{package}.{room}'), name)
