"""What `gearkin watch` shows, and whom its server answers, without a node."""

import asyncio
import io
import json
import math
import re
import time
from contextlib import asynccontextmanager
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import pytest
from rich.console import Console
from watching import WatcherStandIn

from gear_kinematics.commands.cli import main
from gear_kinematics.kinematics import GearRatio
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.parameters.new_config import new_config
from gear_kinematics.watch import drivers
from gear_kinematics.watch.drivers import Driver
from gear_kinematics.watch.gear import Joint, Status
from gear_kinematics.watch.graph import known_as
from gear_kinematics.watch.page import drawing
from gear_kinematics.watch.recording import Recorded
from gear_kinematics.watch.text import line, list_drivers, table
from gear_kinematics.watch.view import (
    Reading,
    Sentence,
    View,
    motion_of,
    readings_of,
    recording_in_words,
    sentence,
    state_of,
)
from gear_kinematics.watch.watcher import Answer
from gear_kinematics.wire import topics

tornado_websocket = pytest.importorskip('tornado.websocket', reason='no tornado is installed')
from tornado.httpclient import AsyncHTTPClient, HTTPRequest  # noqa: E402, an extra

from gear_kinematics.watch.server import Server  # noqa: E402, needs it

ROOT = Path(__file__).resolve().parents[2]
JOINT_STATE = 'sensor_msgs/msg/JointState'
POSE_ARRAY = 'geometry_msgs/msg/PoseArray'
HOSTILE = 'm\x1b[2J<img src=x onerror=alert(1)>'
DRIVERS = (Driver('/motor/joint_states', ('brake', 'm1'), 999.6, 2), Driver('/odd', (), 0.0, 1))


# Which topic is which


def test_topics_are_known_by_their_names_in_any_namespace():
    expected = {'rotor_state': JOINT_STATE, 'output_encoder': JOINT_STATE}
    found = {'/left/rotor_state': JOINT_STATE, '/left/output_encoder': JOINT_STATE, '/x': 'y'}
    assert known_as(expected, found) == {
        'rotor_state': '/left/rotor_state',
        'output_encoder': '/left/output_encoder',
    }


def test_the_only_remapped_topic_of_a_type_is_known():
    expected = {'rotor_state': JOINT_STATE, 'output_encoder': JOINT_STATE, 'poses': POSE_ARRAY}
    found = {
        '/motor/joint_states': JOINT_STATE,
        '/output_encoder': JOINT_STATE,
        '/others': POSE_ARRAY,
    }
    assert known_as(expected, found) == {
        'rotor_state': '/motor/joint_states',
        'output_encoder': '/output_encoder',
        'poses': '/others',
    }


def test_two_remapped_topics_of_a_type_are_not_guessed():
    expected = {'rotor_state': JOINT_STATE, 'output_encoder': JOINT_STATE}
    assert known_as(expected, {'/a': JOINT_STATE, '/b': JOINT_STATE}) == {}


def test_a_topic_of_another_type_is_another_topic():
    assert known_as({'rotor_state': JOINT_STATE}, {'/rotor_state': POSE_ARRAY}) == {}


# Words


def gear_node(**changes):
    """Stand in for a node that has told everything."""
    joints = {
        topics.OUTPUT_STATE: Joint(math.radians(-370.0), -1.0, 0.001),
        topics.CORRECTED_STATE: Joint(math.radians(-370.25), None, 0.001),
        topics.CORRECTED_INTERVAL: Joint(math.radians(0.5 / 60.0), None, 0.001),
        topics.TRANSMISSION_ERROR: Joint(math.radians(-1.5 / 60.0), None, 0.001),
    }
    values = {'peak to peak (rad)': str(math.radians(3.0 / 60.0))}
    node = {
        'name': '/left/gear_state_publisher',
        'running': True,
        'known': True,
        'restarts': 0,
        'gear': GearRatio(-19),
        'parameters': replace(NodeParameters.load(), transmission_error_limit=math.radians(0.1)),
        'statuses': {
            'transmission error': Status('transmission error', 0, 'ok', values, time.monotonic())
        },
        'joint': joints.get,
    }
    return SimpleNamespace(**{**node, **changes})


def test_values_are_those_of_the_topics():
    rotor = SimpleNamespace(age=0.0023, rate=999.6)
    assert list(readings_of(gear_node(), rotor)) == [
        Reading('output angle', '-370.000°', '-6.45772 rad'),
        Reading('rotor angle', '7030.000°', '19.528 turns'),
        Reading('output speed', '-9.55 rpm', 'rotor 181.4 rpm'),
        Reading('input', '1000 Hz', 'last message 2 ms ago'),
        Reading('corrected angle', '-370.250°', '± 30.000″ (95 %)'),
        Reading(
            'transmission error',
            '-1′ 30.000″',
            'peak to peak 3′ 00.000″ in 10 s, limit 6′ 00.000″',
        ),
    ]


def test_values_that_are_out_of_date_say_so():
    output = Joint(0.1, None, 90.0)
    silent = gear_node(joint={topics.OUTPUT_STATE: output}.get)
    rotor = SimpleNamespace(age=61.0, rate=0.0)
    found = {reading.name: reading for reading in readings_of(silent, rotor)}
    assert found['output angle'].tone == 'bad'
    assert found['last output'].value == '2 min ago'
    assert found['input'] == Reading('input', '0 Hz', 'last message 1 min ago', 'bad')
    unheard = SimpleNamespace(age=None, rate=0.0)
    assert Reading('input', '0 Hz', 'no message yet', 'bad') in readings_of(silent, unheard)


def test_drawing_and_curve_get_angles_within_a_turn():
    motion = motion_of(gear_node())
    assert motion['output'] == pytest.approx(-10.0)
    assert motion['rotor'] == pytest.approx(7030.0 - 20 * 360.0)
    assert motion['error'] == pytest.approx(-90.0)
    assert motion['window'] == 10.0
    nothing = motion_of(gear_node(joint={}.get))
    assert 'rotor' not in nothing
    assert 'error' not in nothing


@pytest.mark.parametrize(
    ('gear', 'state', 'words'),
    [
        (None, None, 'No gear_state_publisher is running'),
        (gear_node(restarts=-1, running=False), None, 'is not running. Start it'),
        (gear_node(running=False), 'ended', 'has ended. Waiting'),
        (gear_node(known=False), 'connecting', 'Connecting'),
        (gear_node(), 'connected', 'Also running: /right; choose with --node'),
    ],
)
def test_state_of_the_node_is_told(gear, state, words):
    told = state_of(gear, ['/right'] if gear else [])
    assert told.get('state') == state
    assert words in told['words']


def documented_messages():
    page = (ROOT / 'docs/diagnostics.md').read_text('utf-8')
    rows = re.findall(r'^\| `([^`]+)` \| (OK|WARN|ERROR) \|', page, re.MULTILINE)
    assert len(rows) >= 10
    return rows


@pytest.mark.parametrize(('message', 'level'), documented_messages())
def test_every_message_of_diagnostics_is_put_into_words_with_advice(message, level):
    status = Status('rotor input', ['OK', 'WARN', 'ERROR'].index(level), message, {}, 100.0)
    told = sentence(status, 101.0)
    if level == 'OK':
        assert told == Sentence('Rotor input: healthy.')
        return
    kind, tone = {'WARN': ('warning', 'notable'), 'ERROR': ('error', 'bad')}[level]
    assert told.tone == tone
    assert re.fullmatch(rf'Rotor input: {kind}, {re.escape(message)}\. [A-Z].{{15,}}\.', told.text)


def test_diagnostics_that_no_longer_come_are_told():
    status = Status('rotor input', 0, 'ok', {}, 100.0)
    told = sentence(status, 105.04)
    assert told == Sentence('Rotor input: no diagnostics for 5.0 s.', 'bad')


def test_recording_is_described_with_its_losses():
    counts = {'/rotor_state': 1000, '/output_state': 998}
    recorded = Recorded(Path('monday'), 1.04, counts, 2, '')
    assert recording_in_words(recorded) == 'monday: 1998 messages in 1.0 s, 2 lost'
    unnumbered = recorded._replace(lost=None)
    assert recording_in_words(unnumbered).endswith('losses not counted')


# The terminal


FULL = View(
    node='/left/gear_state_publisher',
    state='connected',
    readings=(Reading('output angle', '12.5°', '0.2 rad'), Reading('input', '0 Hz', '', 'bad')),
    sentences=(Sentence(f'Rotor input: error, {HOSTILE}.', 'bad'),),
    recording='monday: 3 messages in 1.0 s, 0 lost',
    drivers=DRIVERS,
    gear=1,
)


def printed(renderable, **options) -> str:
    stream = io.StringIO()
    Console(file=stream, width=120, force_terminal=True, color_system=None, **options).print(
        renderable
    )
    return stream.getvalue()


def test_line_says_all_of_a_moment():
    assert line(FULL) == (
        '/left/gear_state_publisher connected | output angle 12.5° (0.2 rad); input 0 Hz | '
        'Rotor input: error, m\\x1b[2J<img src=x onerror=alert(1)>. | '
        'recording monday: 3 messages in 1.0 s, 0 lost'
    )
    assert line(View(words='No node.')) == 'no node | No node.'


def test_table_shows_values_and_keys():
    text = printed(table(FULL, Answer('Recording to monday.', done=True)))
    for part in ('output angle', '12.5°', '● recording to monday', 'Recording to monday.'):
        assert part in text
    assert 'h home   r stop recording   q end' in text
    ended = View(state='ended', failure='monday: No space left on device')
    assert 'No space left' in printed(table(ended))


def test_table_lists_drivers_as_long_as_there_is_no_node():
    text = printed(table(View(drivers=DRIVERS)))
    assert re.search(r'/motor/joint_states +brake, m1 +1000 Hz', text)
    assert 'gearkin init' in text


def test_names_do_not_reach_the_terminal_raw():
    hostile = Driver('/odd', (HOSTILE,), 1.0, 1)
    view = View(state='connected', sentences=FULL.sentences, failure=HOSTILE)
    shown = printed(table(view, Answer(HOSTILE, done=False)))
    shown += printed(table(View(drivers=(hostile,)))) + line(view)
    stream = io.StringIO()
    list_drivers([hostile], Console(file=stream))
    assert '\x1b' not in shown.replace('\x1b[0m', '') + stream.getvalue()


def test_drivers_are_listed_with_joints_and_rates():
    stream = io.StringIO()
    console = Console(file=stream)
    list_drivers(DRIVERS, console)
    list_drivers([], console)
    assert stream.getvalue().splitlines() == [
        '/motor/joint_states: joints: brake, m1',
        '/motor/joint_states: rate: 1000 Hz',
        '/motor/joint_states: drivers: 2',
        '/odd: rate: 0 Hz',
        'There are no topics of type JointState yet.',
    ]


# gearkin init


@pytest.fixture
def listening(monkeypatch, tmp_path):
    """Run in an empty folder, beside two drivers."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(drivers, 'listen', lambda _: list(DRIVERS))
    return tmp_path


@pytest.mark.parametrize(
    ('arguments', 'cause'),
    [
        ([], 'which joint is the rotor? Choose with --topic and --joint'),
        (['--joint', 'm11'], 'no joint m11; did you mean `m1`?; there are: brake, m1'),
        (
            ['--topic', 'motor/joint_state'],
            'no topic /motor/joint_state of type JointState; did you mean `/motor/joint_states`?',
        ),
        (['--topic', '/odd'], 'no message with joints in 4 s'),
        (['-o', 'nowhere/a.yaml', '--joint', 'm1'], 'nowhere/a.yaml: No such file or directory'),
    ],
)
def test_init_says_why_it_writes_nothing(listening, capsys, arguments, cause):
    assert main(['init', *arguments]) == 2
    told = capsys.readouterr()
    assert told.err == f'gearkin: {cause}\n'
    assert '/motor/joint_states: joints: brake, m1' in told.out
    assert not list(listening.iterdir())


def test_init_writes_what_is_named(listening, capsys):
    assert main(['init', '--topic', '/motor/joint_states', '--joint', 'm1', '-o', 'a b.yaml']) == 0
    assert NodeParameters.load(listening / 'a b.yaml').rotor_joint == 'm1'
    command = "gear_state_publisher --ros-args --params-file 'a b.yaml' -r rotor_state:="
    assert f'\n    {command}/motor/joint_states\n' in capsys.readouterr().out


def test_init_writes_to_stdout_and_lists_elsewhere(listening, capsys):
    assert main(['init', '--joint', 'm1', '-o', '-']) == 0
    told = capsys.readouterr()
    assert told.out == new_config('/motor/joint_states', 'm1', 'actuator.yaml')
    assert '/motor/joint_states: joints: brake, m1' in told.err
    assert not list(listening.iterdir())


def test_init_without_a_driver_says_so(listening, monkeypatch, capsys):
    monkeypatch.setattr(drivers, 'listen', lambda _: [])
    assert main(['init', '--wait', '0.5']) == 2
    assert 'no topic of type JointState in 0.5 s' in capsys.readouterr().err
    assert not list(listening.iterdir())


# The server


@pytest.fixture
def watcher() -> WatcherStandIn:
    return WatcherStandIn(FULL)


@asynccontextmanager
async def serving(watcher):
    server = Server(watcher)
    ended = False
    task = asyncio.create_task(server.run(lambda: ended))
    try:
        yield server.address
    finally:
        ended = True
        await task


async def fetch(url, **headers) -> tuple[int, str, dict]:
    request = HTTPRequest(url, headers=headers, request_timeout=20.0)
    answer = await AsyncHTTPClient().fetch(request, raise_error=False)
    return answer.code, answer.body.decode(), answer.headers


@asynccontextmanager
async def connected(address):
    url = address.replace('http', 'ws', 1) + 'live'
    request = HTTPRequest(url, headers={'Origin': origin_of(address)})
    connection = await tornado_websocket.websocket_connect(request)
    yield connection
    connection.close()
    while connection.close_code is None and await connection.read_message() is not None:
        pass


async def refused(address, **headers) -> bool:
    """Whether neither the page nor the WebSocket is to be had."""
    code, text, _ = await fetch(address, **headers)
    assert (code == 403) == ('script' not in text)
    return code == 403 == await handshake(address, **headers)


async def handshake(address, **headers) -> int:
    """Ask for a WebSocket, and give the status of the answer."""
    asked = {'Upgrade': 'websocket', 'Connection': 'Upgrade', 'Sec-WebSocket-Version': '13'}
    asked |= {'Sec-WebSocket-Key': 'dGhlIHNhbXBsZSBub25jZQ=='}
    return (await fetch(f'{address}live', **asked, **headers))[0]


def origin_of(address: str) -> str:
    return address.rsplit('/', 2)[0]


def test_page_comes_with_the_token_of_its_address(watcher):
    async def run():
        async with serving(watcher) as address:
            assert re.fullmatch(r'http://127\.0\.0\.1:\d+/[\w-]{32}/', address)
            code, page, _ = await fetch(address)
            assert code == 200
            assert '<title>gearkin watch</title>' in page
            assert f'connect-src ws://{origin_of(address)[7:]}' in page
            assert not re.findall(r'(?:src|href)="(?!data:,")', page)
            again = Server(watcher)
            assert again.address.split('/')[3] != address.split('/')[3]
            again.close()

    asyncio.run(run())


def test_wrong_token_is_refused(watcher):
    async def run():
        async with serving(watcher) as address:
            origin = origin_of(address)
            for token in ('wrong', address.split('/')[3][:-1], '%00', 'é'):
                assert await refused(f'{origin}/{token}/', Origin=origin)
            assert (await fetch(f'{origin}/'))[0] == 404

    asyncio.run(run())


def test_other_origin_is_refused(watcher):
    async def run():
        async with serving(watcher) as address:
            origin = origin_of(address)
            for other in ('http://evil.example', 'null', 'http://127.0.0.1:1', f'{origin}.evil'):
                assert await refused(address, Origin=other)
            assert await handshake(address) == 403  # a browser names its origin
            async with connected(address):
                pass

    asyncio.run(run())


def test_other_host_is_refused(watcher):
    async def run():
        async with serving(watcher) as address:
            port = origin_of(address).rpartition(':')[2]
            for host in ('evil.example', f'evil.example:{port}', '127.0.0.1.evil.example', '['):
                assert await refused(address, Host=host, Origin=f'http://{host}')
            # As through a forwarded port.
            for host in ('localhost:8000', f'127.0.0.1:{port}'):
                code, page, _ = await fetch(address, Host=host)
                assert code == 200
                assert f'connect-src ws://{host}"' in page

    asyncio.run(run())


def test_page_is_neither_kept_nor_framed(watcher):
    async def run():
        async with serving(watcher) as address:
            for path in (address, f'{origin_of(address)}/wrong/'):
                _, _, headers = await fetch(path)
                assert headers['Cache-Control'] == 'no-store'
                assert headers['Content-Security-Policy'] == "frame-ancestors 'none'"
                assert headers['Referrer-Policy'] == 'no-referrer'
                assert 'Server' not in headers

    asyncio.run(run())


def test_views_come_at_most_thirty_times_a_second_after_the_drawing(watcher):
    async def run():
        async with serving(watcher) as address, connected(address) as connection:
            first = json.loads(await connection.read_message())
            assert first['drawing'].count('<use ') == 5
            view = json.loads(await connection.read_message())['view']
            assert view['readings'][0] == {
                'name': 'output angle', 'value': '12.5°', 'detail': '0.2 rad', 'tone': '',
            }  # fmt: skip
            assert view['drivers'][0]['joints'] == ['brake', 'm1']
            begin, count = time.monotonic(), 0
            while time.monotonic() < begin + 0.5:
                count += 'view' in json.loads(await connection.read_message())
            elapsed = time.monotonic() - begin
            assert 2 <= count <= 1 + 30.0 * elapsed

    asyncio.run(run())


def test_buttons_ask_the_watcher_and_show_its_answer(watcher):
    commands = {
        '{"do": "home"}': ('home',),
        '{"do": "record"}': ('record',),
        '{"do": "stop"}': ('stop',),
        '{"do": "configure", "topic": "/m", "joint": "m1"}': ('configure', '/m', 'm1'),
    }
    unknown = ['', '[]', '{}', '{"do": "exit"}', '{"do": "configure"}', '"home"', b'\xff']

    async def run():
        async with serving(watcher) as address, connected(address) as connection:

            async def answer_to(command):
                await connection.write_message(command, binary=isinstance(command, bytes))
                while 'answer' not in (message := json.loads(await connection.read_message())):
                    pass
                return message['answer']

            for command, asked in commands.items():
                assert await answer_to(command) == {'text': f'{asked[0]}.', 'done': True}
                assert watcher.asked[-1] == asked
            for command in unknown:
                answer = await answer_to(command)
                assert answer == {'text': 'There is no such command.', 'done': False}
            assert len(watcher.asked) == len(commands)
            await connection.write_message(json.dumps({'do': 5000 * 'x'}))
            while await connection.read_message() is not None:
                pass
            assert connection.close_code == 1009  # too large

    asyncio.run(run())


def test_port_that_is_taken_is_told(watcher):
    server = Server(watcher)
    port = int(origin_of(server.address).rpartition(':')[2])
    with pytest.raises(OSError, match='in use'):
        Server(watcher, port)
    server.close()


def test_of_a_ratio_there_is_no_drawing():
    assert drawing(None, 0.0) == '<p>Of this gear only the ratio is known, not its bodies.</p>'
