# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""What a stranger on the DDS domain, or one who crafts a bag or a config, cannot do.

docs/security.md says what each test stands for.
"""

import io
import json
import os
import re
import shutil
import sqlite3
import sys
import xml.etree.ElementTree as ET
from contextlib import closing
from fnmatch import fnmatch
from functools import cache
from pathlib import Path

import pytest
from blocked_bags import GEARKIN, finished, gearkin, refusal
from gear_recordings import old_recording
from live import live_node
from refusals import refused
from shipped_bags import JOINT_STATE

from gear_kinematics.bag import Bag, BagError
from gear_kinematics.bag.finding import find_bags
from gear_kinematics.commands import cli, output
from gear_kinematics.parameters import ConfigError, NodeParameters

ROOT = Path(__file__).resolve().parents[2]
BAG = ROOT / 'bags/servo_point_to_point'
POLICY = ROOT / 'policies/gear_state_publisher.policy.xml'
ESCAPE = '\x1b[2J\x1b]0;owned\x07'
"""Clears a terminal and renames its window."""


# The access-control policy.


def policy(namespace: str) -> tuple[set[str], set[str]]:
    """Give the DDS topics that the policy lets a node in a namespace write and read."""
    root = ET.parse(POLICY).getroot()  # noqa: S314, the project's own file
    [profile] = root.iterfind('enclaves/enclave/profiles/profile')
    own = f'{namespace}/{profile.get("node")}'
    written, read = set(), set()
    for group in profile:
        [(verb, rule)] = group.attrib.items()
        assert rule == 'ALLOW'
        for element in group:
            name = element.text
            name = own + name[1:] if name[0] == '~' else name
            name = name if name[0] == '/' else f'{namespace}/{name}'
            if verb == 'reply':
                written.add(f'rr{name}Reply')
                read.add(f'rq{name}Request')
            else:
                {'publish': written, 'subscribe': read}[verb].add(f'rt{name}')
    return written, read


@pytest.fixture(scope='module')
def live(tmp_path_factory):
    with live_node(tmp_path_factory.mktemp('node')) as live:
        live.peer.connect()
        live.peer.status()  # all that the node opens at its start is open by now
        yield live


def endpoints(live) -> tuple[set[str], set[str]]:
    """Give the DDS topics that the node writes and reads, as access control sees them."""
    node, who = live.peer.node, ('gear_state_publisher', live.peer.namespace)
    if who not in node.get_node_names_and_namespaces():
        return set(), set()
    written = node.get_publisher_names_and_types_by_node(*who, no_demangle=True)
    read = node.get_subscriber_names_and_types_by_node(*who, no_demangle=True)
    return set(dict(written)), set(dict(read))


def of_one(namespace: str) -> tuple[set[str], set[str]]:
    """Give those topics that a node without `actuators` has."""
    written, read = ({name for name in names if '*' not in name} for names in policy(namespace))
    return written, read


@pytest.mark.live
def test_policy_lists_exactly_what_the_node_offers_and_uses(live):
    expected = of_one(live.peer.namespace)
    live.peer.wait_until(lambda: endpoints(live) == expected, f'{expected}')


@pytest.mark.live
def test_policy_allows_what_each_actuator_of_an_arm_has_and_nothing_else(tmp_path):
    """Topics and services as the contract has them; DDS matches names as fnmatch does."""
    with live_node(tmp_path, '-p', 'actuators:=[shoulder, elbow]') as live:
        namespace = live.peer.namespace
        allowed = policy(namespace)
        topics = 'body_poses', 'markers', 'joint_loads', 'referenced'
        home = f'{namespace}/gear_state_publisher/elbow/home'
        written = {f'rt{namespace}/elbow/{topic}' for topic in topics} | {f'rr{home}Reply'}
        live.peer.wait_until(lambda: written <= endpoints(live)[0], f'{sorted(written)}')
        live.peer.wait_until(lambda: f'rq{home}Request' in endpoints(live)[1], 'homing')
        for found, patterns in zip(endpoints(live), allowed, strict=True):
            assert not [name for name in found if not any(fnmatch(name, p) for p in patterns)]


@pytest.mark.live
def test_simulated_time_needs_the_clock_besides(live):
    before, after = of_one(live.peer.namespace)
    assert live.peer.set(use_sim_time=True).successful
    expected = before, after | {'rt/clock'}
    live.peer.wait_until(lambda: endpoints(live) == expected, '/clock')


@pytest.mark.live
@pytest.mark.parametrize('name', ['frame_prefix', 'output_joint'])
def test_names_that_xml_cannot_hold_are_refused(live, name):
    result = live.peer.set(**{name: ESCAPE})
    assert not result.successful
    assert name in result.reason
    ET.fromstring(live.peer.description().encode())  # noqa: S314, our node's


# Crafted configs and metadata.


@pytest.mark.slow
@pytest.mark.parametrize(
    ('text', 'cause'),
    [
        ("x: !!python/object/apply:os.mkdir ['trace']", "mkdir' has no effect before ROS Lyrical"),
        ('x: &a [rotor], rotor_joint: *a', 'aliases are not supported'),  # as by the node
        ('x: ' + '[' * 10_000, 'nested deeper than 20 levels'),
    ],
    ids=['object', 'alias', 'depth'],
)
def test_configs_make_no_objects_and_end(text, cause, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    path = tmp_path / 'config.yaml'
    path.write_text(f'gear_state_publisher: {{ros__parameters: {{{text}}}}}')
    with refused(ConfigError, path, 'not YAML: ', cause):
        NodeParameters.load(path)
    assert list(tmp_path.iterdir()) == [path]


def merged(levels: int) -> str:
    """Give YAML whose last mapping has 9 to the power of so many keys before they are united."""
    lines = ['- &a0 {k: 1}']
    lines += [
        f'- &a{k} {{!!merge <<: [{", ".join([f"*a{k - 1}"] * 9)}]}}' for k in range(1, levels + 1)
    ]
    return '\n'.join(lines)


@pytest.mark.parametrize(('text', 'cause'), [
    ("more: !!python/object/apply:os.mkdir ['trace']", 'could not determine a constructor'),
    ('more:\n' + merged(3), '2002:merge'), ('more: [&a {b: c}, *a]', None),
], ids=['object', 'merge', 'alias'])  # fmt: skip
def test_metadata_makes_no_objects_and_ends(text, cause, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    bag = shutil.copytree(BAG, tmp_path / 'bag')
    with (bag / 'metadata.yaml').open('a') as file:
        file.write(f'\n{text}\n')
    if cause is None:  # as rosbag2 writes it
        assert Bag(bag).topics == Bag(BAG).topics
    else:
        with pytest.raises(BagError, match=cause):
            Bag(bag)
    assert list(tmp_path.iterdir()) == [bag]


def test_quality_of_a_topic_ends(tmp_path):
    path = crafted_database(tmp_path / 'b.db3', name='/motor', qos=merged(3))
    assert '2002:merge' in refusal('compute', path, tmp_path / 'out')
    assert list(tmp_path.iterdir()) == [path]


# Crafted bags.


def crafted_database(path: Path, *, name='/rotor_state', qos='') -> Path:
    """Make a bag of the oldest schema with one topic and one message."""
    return old_recording(path, [(name, JOINT_STATE)], [(name, 1, b'\0\1\0\0')], qos)


def test_a_link_in_a_bag_is_followed_and_shows_nothing_but_bags(tmp_path):
    bag = Path(shutil.copytree(BAG, tmp_path / 'bag'))
    [file] = bag.glob('*.mcap*')
    file.unlink()
    file.symlink_to(BAG / file.name)
    with Bag(bag) as linked:
        assert sum(1 for _ in linked.messages(linked.topics)) == linked.message_count
    (tmp_path / 'secret').write_text('password')
    for place in (tmp_path / 'secret', '/dev/zero'):
        file.unlink()
        file.symlink_to(place)
        with Bag(bag) as linked, pytest.raises(BagError) as caught:
            next(linked.messages(linked.topics))
        assert str(caught.value) == f'{file}: not a bag of a known kind'


@pytest.mark.timeout(20)
def test_metadata_without_end_is_not_read(tmp_path):
    path = tmp_path / 'metadata.yaml'
    path.symlink_to('/dev/zero')
    with pytest.raises(BagError, match='not a regular file'):
        Bag(tmp_path)


@pytest.mark.timeout(20)
@pytest.mark.parametrize('table', ['topics', 'messages'])
def test_a_database_that_makes_up_rows_is_stopped(table, tmp_path):
    """A view can have rows without end, and no signal interrupts sqlite."""
    path = crafted_database(tmp_path / 'b.db3')
    endless = 'WITH RECURSIVE n(k) AS (SELECT 1 UNION ALL SELECT k + 1 FROM n)'
    with closing(sqlite3.connect(path)) as database:
        database.execute(f'ALTER TABLE {table} RENAME TO real')
        database.execute(f'CREATE VIEW {table} AS {endless} SELECT real.* FROM real, n')  # noqa: S608
    with pytest.raises(BagError, match='more rows than a file of this size'), Bag(path) as bag:
        list(bag.messages(bag.topics))


@pytest.mark.timeout(20)
def test_links_among_bags_lead_in_no_circles(tmp_path):
    bag = shutil.copytree(BAG, tmp_path / 'bag')
    for name in 'ab':  # two of them make 2^40 paths
        (tmp_path / name).symlink_to('.')
    (tmp_path / 'latest').symlink_to(bag.name)
    assert find_bags([str(tmp_path)]).bags == [bag, tmp_path / 'latest']


# Names on the terminal.


@pytest.mark.parametrize('command', ['validate', 'compute', 'replay'])
def test_names_of_topics_do_not_reach_the_terminal_raw(command, tmp_path, capsys):
    path = crafted_database(tmp_path / 'b.db3', name=f'/a{ESCAPE}')
    with closing(sqlite3.connect(path)) as database, database:
        database.execute("INSERT INTO topics SELECT 2, name || 'b', type, 'cdr', '' FROM topics")
    out = [tmp_path / 'out'] if command == 'compute' else []
    code = cli.main([command, *map(str, [path, *out])])
    written = ''.join(capsys.readouterr())
    assert code == 2
    assert r'/a\x1b[2J\x1b]0;owned\x07' in written
    assert not [char for char in written if not char.isprintable() and char != '\n']


def test_names_of_files_do_not_reach_the_terminal_raw(monkeypatch):
    class Terminal(io.StringIO):
        def isatty(self):
            return True

    screen = Terminal()
    monkeypatch.setattr('sys.stderr', screen)
    monkeypatch.setenv('COLUMNS', '200')
    with output.message_progress(f'[/x]{ESCAPE}') as progress:
        progress(1, 2)
    assert r'[/x]\x1b[2J\x1b]0;owned\x07' in screen.getvalue()
    assert ESCAPE not in screen.getvalue()


# Files.


def test_files_are_written_only_where_asked(tmp_path, monkeypatch):
    bag = Path(shutil.copytree(BAG, tmp_path / 'bag'))
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv('HOME', str(tmp_path))
    monkeypatch.setattr('tempfile.tempdir', str(tmp_path))
    before = {path: path.read_bytes() for path in bag.iterdir()}
    assert cli.main(['validate', 'bag', '--json', 'report.json']) == 0
    assert cli.main(['compute', 'bag', 'out']) == 0
    assert {path.name for path in tmp_path.iterdir()} == {'bag', 'report.json', 'out'}
    assert {path: path.read_bytes() for path in bag.iterdir()} == before
    assert json.loads(Path('report.json').read_text())['verdict'] == 'pass'


def test_a_report_is_not_written_through_a_link_that_was_laid_for_it(
    tmp_path, capsys, monkeypatch
):
    monkeypatch.setattr('secrets.token_hex', lambda _: 'guessed')
    victim, target = tmp_path / 'victim', tmp_path / 'report.json'
    victim.write_text('precious')
    (tmp_path / f'.gearkin.{os.getpid()}.guessed.tmp').symlink_to(victim)
    assert cli.main(['validate', str(BAG), '--json', str(target)]) == 2
    assert str(target) in capsys.readouterr().err
    assert victim.read_text() == 'precious'
    assert not target.exists()


# The current folder, which may have come with a recording.


@pytest.fixture
def downloaded(tmp_path) -> Path:
    """Return a folder with bags, and traps for who runs or obeys what else is there."""
    folder = tmp_path / 'downloaded'
    for name in ('one', 'two'):
        shutil.copytree(BAG, folder / name)
    installed = {name.partition('.')[0] for name in sys.modules if not name.startswith('_')}
    for name in {'rclpy', 'sensor_msgs', 'sitecustomize'} | installed:
        (folder / f'{name}.py').write_text("open('trap.sprung', 'w').close()\n")
    for name in ('DEFAULT_FASTRTPS_PROFILES.xml', 'DEFAULT_FASTDDS_PROFILES.xml'):
        os.mkfifo(folder / name)  # a reader hangs
    return folder


@pytest.mark.live
@pytest.mark.slow
@pytest.mark.parametrize(
    'arguments', [['--jobs', '2', 'one', 'two'], ['--live', 'one']], ids=lambda words: words[0]
)
def test_nothing_in_the_current_folder_is_run_or_obeyed(
    arguments, downloaded, tmp_path, monkeypatch
):
    for library in ('FASTRTPS', 'FASTDDS'):
        monkeypatch.delenv(f'{library}_DEFAULT_PROFILES_FILE', raising=False)
    program = tmp_path / 'gearkin'  # a script, beside which Python looks and not in its folder
    program.write_text(f"if __name__ == '__main__': {GEARKIN}")
    done = finished([sys.executable, program, 'validate', *arguments], cwd=downloaded)
    assert done.returncode == 0, done.stderr
    assert not (downloaded / 'trap.sprung').exists()


@pytest.mark.slow
def test_matplotlibrc_in_the_current_folder_is_not_obeyed(tmp_path):
    pytest.importorskip('matplotlib')
    (tmp_path / 'matplotlibrc').write_text('savefig.facecolor: ff0000')
    done = gearkin('describe', '--plot', 'figure.svg', cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert '#ff0000' not in (tmp_path / 'figure.svg').read_text('utf-8')


# What the documents claim.


@cache
def defined_tests() -> frozenset[str]:
    texts = (path.read_text('utf-8') for path in (ROOT / 'test').rglob('test_*.py'))
    definition = re.compile(r'^(?:async )?def (test_\w+)\(', re.MULTILINE)
    return frozenset(name for text in texts for name in definition.findall(text))


@pytest.mark.parametrize('name', ['docs/security.md', 'docs/paper.md', 'QUALITY_DECLARATION.md'])
def test_evidence_is_there(name):
    """Every test and file that a document cites is there."""
    text = (ROOT / name).read_text('utf-8')
    cited = set(re.findall(r'`(test_\w+)`', text))
    assert cited
    assert cited <= defined_tests()
    links = re.findall(r'\]\((?!http)([^)#]+)', text)
    assert all((ROOT / name).parent.joinpath(link).exists() for link in links)
