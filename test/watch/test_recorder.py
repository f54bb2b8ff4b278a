# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""`gearkin record` beside a node and a driver that begin later, and where there is nothing."""

import argparse
import contextlib
import re
from dataclasses import replace
from threading import Event
from types import SimpleNamespace
from unittest.mock import MagicMock

import pytest
from blocked_bags import refusal
from live import Participant
from rclpy.qos import DurabilityPolicy, QoSProfile
from rclpy.qos import ReliabilityPolicy as Offer
from sensor_msgs.msg import JointState
from watching import (
    DEADLINE,
    ENCODER,
    ENCODER_RATE,
    JUDGED,
    MOTOR,
    NAMESPACE,
    NODE,
    driving,
    gearkin,
    node,
)

from gear_kinematics.bag import Bag
from gear_kinematics.commands.cli import main
from gear_kinematics.commands.record import kept
from gear_kinematics.parameters import NodeParameters, default_config
from gear_kinematics.watch import gear
from gear_kinematics.watch import recorder as module
from gear_kinematics.watch.polled import Taken
from gear_kinematics.watch.recorder import Recorder
from gear_kinematics.wire.cdr import JointStateTemplate
from gear_kinematics.wire.topics import JOINT_STATE


@pytest.mark.live
@pytest.mark.slow
def test_what_a_node_hears_and_publishes_is_recorded_as_it_is_named(tmp_path, capsys):
    with (
        contextlib.ExitStack() as beside,
        gearkin(tmp_path, 'record', 'monday', '--node', NODE) as recording,
    ):
        recording.wait_for('waiting for a gear_state_publisher')
        beside.enter_context(node(tmp_path))
        recording.wait_for('recording /diagnostics')
        with contextlib.closing(Participant('listening')) as listening, driving(1000, 'sent'):
            for topic in (ENCODER, MOTOR, f'{NAMESPACE}/output_state'):
                recording.wait_for(f'recording .*{topic}')
            heard = []  # a line of the summary has a rate only after some messages
            listening.node.create_subscription(JointState, ENCODER, heard.append, 10)
            listening.wait_until(lambda: len(heard) > ENCODER_RATE, 'a second of the encoder')
            capsys.readouterr()
    assert recording.process.returncode == 0
    assert re.search(rf' {ENCODER}: \d+ messages, [1-9]\d+ Hz\n', recording.text())
    assert recording.text().endswith('prove it: gearkin validate monday\n')
    assert 'already registered' not in recording.text()  # a name in use
    with Bag(tmp_path / 'monday') as bag:
        assert bag.topics.keys() >= {
            MOTOR, ENCODER, '/diagnostics',
            *(f'{NAMESPACE}/{topic}' for topic in ('output_state', 'body_poses', 'referenced')),
        }  # fmt: skip
    kept = NodeParameters.load(tmp_path / 'monday' / 'actuator.yaml')
    assert (kept.rotor_joint, kept.home_max_speed) == ('m1', 10.0)
    main(['validate', str(tmp_path / 'monday')])
    assert re.search(JUDGED, said := capsys.readouterr().out), said


@pytest.mark.live
@pytest.mark.slow
@pytest.mark.parametrize('running', [True, False])
def test_what_hears_nothing_says_so_and_leaves_nothing(running, tmp_path):
    with (
        node(tmp_path) if running else contextlib.nullcontext(),
        gearkin(tmp_path, 'record', 'monday', '--node', NODE) as recording,
    ):
        recording.wait_for('recording /diagnostics' if running else 'waiting')
    cause = f'no driver was heard on {MOTOR}' if running else 'no gear_state_publisher runs'
    assert recording.process.returncode == 2
    assert f'gearkin: nothing was recorded: {cause}' in recording.text().splitlines()[-1]
    assert not (tmp_path / 'monday').exists()


@pytest.mark.parametrize('offered', [Offer.RELIABLE, Offer.BEST_EFFORT])
def test_driver_that_starts_later_finds_a_subscription_of_its_reliability(offered, monkeypatch):
    monkeypatch.setattr(module, 'Graph', lambda _: SimpleNamespace(gears=['/left/gear']))
    opened, drivers = [], []

    def subscribe(_type, _topic, _call, qos, **_):
        opened.append(SimpleNamespace(qos=qos, handle=NoMessage(), msg_type=None, raw=True))
        return opened[-1]

    node = SimpleNamespace(
        create_subscription=subscribe,
        destroy_subscription=opened.remove,
        get_subscriber_names_and_types_by_node=lambda *_: [('/motor', [JOINT_STATE])],
        get_publisher_names_and_types_by_node=lambda *_: [],
        get_publishers_info_by_topic=lambda _: drivers,
    )
    recorder = Recorder(node, SimpleNamespace(write_all=lambda _: None))
    recorder.poll()
    assert {each.qos.reliability for each in opened} == {Offer.RELIABLE, Offer.BEST_EFFORT}
    assert {each.qos.durability for each in opened} == {DurabilityPolicy.VOLATILE}
    drivers.append(SimpleNamespace(qos_profile=QoSProfile(depth=1, reliability=offered)))
    recorder.poll()
    assert [each.qos.reliability for each in opened] == [offered]
    _, polled = recorder._open['/motor']
    assert [polled._subscription] == opened


def test_an_encoder_at_the_output_is_missed_only_where_one_is_connected(monkeypatch):
    monkeypatch.setattr(module, 'Graph', lambda _: SimpleNamespace(gears=['/left/gear']))
    monkeypatch.setattr(module, 'Polled', MagicMock())
    own = ['/left/rotor_state', '/left/output_encoder']
    drivers = []
    node = SimpleNamespace(
        get_subscriber_names_and_types_by_node=lambda *_: [(t, [JOINT_STATE]) for t in own],
        get_publisher_names_and_types_by_node=lambda *_: [],
        get_publishers_info_by_topic=lambda _: drivers,
    )
    recorder = Recorder(node, MagicMock())
    recorder.poll()
    assert recorder.inputs == {'/left/rotor_state'}
    drivers.append(MagicMock())
    recorder.poll()
    assert recorder.inputs == {*own}


def test_outputs_of_two_nodes_on_one_topic_are_awaited_by_the_inputs_of_both(monkeypatch):
    gears = ['/left/gear', '/right/gear']
    monkeypatch.setattr(module, 'Graph', lambda _: SimpleNamespace(gears=gears))
    monkeypatch.setattr(module, 'Polled', MagicMock())
    node = SimpleNamespace(
        get_subscriber_names_and_types_by_node=lambda _, place: [(f'{place}/m', [JOINT_STATE])],
        get_publisher_names_and_types_by_node=lambda *_: [
            ('/joint_states', [JOINT_STATE]),
            ('/diagnostics', ['diagnostic_msgs/msg/DiagnosticArray']),  # once a second
        ],
        get_publishers_info_by_topic=lambda _: [],
    )
    recorder = Recorder(node, MagicMock())
    recorder.poll()
    assert recorder._inputs_of == {'/joint_states': {'/left/m', '/right/m'}}


def test_a_mistyped_node_is_named_beside_those_that_run(monkeypatch):
    running = []
    monkeypatch.setattr(module, 'Graph', lambda _: SimpleNamespace(gears=[*running]))
    monkeypatch.setattr(Recorder, '_look', lambda *_: None)
    recorder = Recorder(None, SimpleNamespace(write_all=lambda _: None), 'left/geer')
    told = [recorder.poll() or recorder.absent for running[:] in ([], ['/left/gear'])]
    hint = 'did you mean `/left/gear`? there are: /left/gear'
    assert told == ['', f'/left/geer is not running; {hint}']


def test_an_actuator_is_chosen_in_a_file_alone(tmp_path):
    error = '--actuator chooses in --config FILE: running arms are recorded whole'
    assert refusal('record', str(tmp_path / 'monday'), '--actuator', 'elbow') == error
    assert not [*tmp_path.iterdir()]


def test_the_parameters_of_each_node_that_answers_are_kept(tmp_path):
    ratios = {'/gear': '-19', '/left/gear': '1457/26'}
    default = NodeParameters.load(default_config())
    running = {name: {'': replace(default, gear_ratio=ratios[name])} for name in ratios}
    files = kept(argparse.Namespace(calibration=None), running | {'/right/gear': {}})
    (path := tmp_path / 'actuator.yaml').write_bytes(files.pop('actuator.yaml'))
    assert not files
    assert {name: NodeParameters.load(path, name).gear_ratio for name in ratios} == ratios


def test_a_node_that_is_homed_meanwhile_is_recorded_with_its_first_zero(
    tmp_path, monkeypatch, capsys
):
    default, zeros, asked = NodeParameters.load(default_config()), [0.0], Event()

    def answer(_node, _name, **_):
        found = {'': replace(default, rotor_zero=zeros[-1])}
        asked.set()
        return found

    def show(recorder, *_):
        recorder.poll()
        assert asked.wait(DEADLINE)
        zeros.append(1.5)  # rad, by ~/home
        recorder.inputs.add(MOTOR)
        recorder.heard[MOTOR] = SimpleNamespace(count=1, mean_rate=0.0, lost=0)

    monkeypatch.setattr(module, 'Graph', lambda _: SimpleNamespace(gears=['/gear']))
    monkeypatch.setattr(Recorder, '_look', lambda *_: None)
    monkeypatch.setattr(gear, 'parameters_of', answer)
    monkeypatch.setattr('gear_kinematics.watch.text.show_recording', show)
    monkeypatch.setattr(
        'gear_kinematics.ros.live.replay_node', lambda *_: contextlib.nullcontext()
    )
    folder = tmp_path / 'on monday'
    assert main(['record', str(folder)]) == 0
    assert NodeParameters.load(folder / 'actuator.yaml').rotor_zero == 0.0
    assert capsys.readouterr().out.endswith(f"\nprove it: gearkin validate '{folder}'\n")


def test_a_node_that_has_ended_is_not_asked_for_its_parameters(monkeypatch):
    monkeypatch.setattr(gear, 'Graph', lambda _: SimpleNamespace(gears=['/left/gear']))
    monkeypatch.setattr(gear, 'GearNode', lambda *_: SimpleNamespace(arm={}))  # it has no `look`
    monkeypatch.setattr(gear, 'SingleThreadedExecutor', lambda **_: MagicMock())
    assert gear.parameters_of(SimpleNamespace(context=None), '/gear') == {}


def test_a_node_that_this_participant_has_yet_to_find_is_waited_for(monkeypatch):
    """Two participants of a process find a node up to seconds apart."""
    found = iter([[], [], ['/gear']])
    asked = SimpleNamespace(arm={}, seen=False, poll=lambda: None)
    asked.look = lambda graph, **_: asked.arm.update(dict.fromkeys(graph.gears, 'parameters'))
    monkeypatch.setattr(gear, 'Graph', lambda _: SimpleNamespace(gears=next(found)))
    monkeypatch.setattr(gear, 'GearNode', lambda *_: asked)
    monkeypatch.setattr(gear, 'SingleThreadedExecutor', lambda **_: MagicMock())
    given = gear.parameters_of(SimpleNamespace(context=None), '/gear', runs=True)
    assert given == {'/gear': 'parameters'}


class NoMessage(contextlib.nullcontext):
    def take_message(self, _type, _raw):
        return None


def test_a_message_that_the_middleware_repeats_is_recorded_at_its_time(monkeypatch):
    """The second input comes 3 s after its output; the clock of the driver is 50 s behind."""
    monkeypatch.setattr(module, 'Graph', lambda _: SimpleNamespace(gears=[]))
    second, millisecond, behind = 10**9, 10**6, 50 * 10**9
    arrivals = {
        '/rotor_state': [(0, second), (10, 4 * second), (20, 4 * second)],
        '/output_state': [(0, second), (10, second + 10 * millisecond)],
    }
    bag = SimpleNamespace(written=[], add_topic=lambda *_: None)
    bag.write_all = bag.written.extend
    recorder = Recorder(None, bag)
    for topic, times in arrivals.items():
        taken = [
            Taken(b'', received, second - behind * ('rotor' in topic) + sent * millisecond)
            for sent, received in times
        ]
        polled = SimpleNamespace(take=lambda taken=taken: taken, last=taken[-1])
        recorder._open[topic] = 'sensor_msgs/msg/JointState', polled
    recorder.poll()
    assert [(topic, received - second) for topic, received, _ in bag.written] == [
        ('/rotor_state', 0), ('/output_state', 0),
        ('/rotor_state', 10 * millisecond), ('/output_state', 10 * millisecond),
        ('/rotor_state', 20 * millisecond),
    ]  # fmt: skip


@pytest.mark.parametrize(
    ('arrivals', 'last_input', 'recorded', 'waited', 'told'),
    [
        ({0.0: [1, 2, 3]}, 3, [1, 2, 3], 0.0, 0),
        ({0.0: [1], 0.05: [2, 3]}, 3, [1, 2, 3], 0.1, 0),
        ({0.0: [1], 1.5: [2], 3.0: [4]}, 3, [1, 2, 4], 3.0, 1),  # the node rejects the last input
        ({float(s): [s] for s in range(9)}, 8, [*range(6)], 5.0, 1),  # it does not catch up
    ],
)
def test_the_outputs_of_a_busy_node_are_recorded_to_the_last_input(
    arrivals, last_input, recorded, waited, told, monkeypatch
):
    clock, template = [0.0], JointStateTemplate(['m1'], velocity=False, effort=False)
    ticking = {'monotonic': lambda: clock[0], 'sleep': lambda s: clock.append(clock.pop() + s)}
    monkeypatch.setattr(module, 'time', SimpleNamespace(**ticking))

    def opened(arrivals):
        polled = SimpleNamespace(last=None)

        def take():
            due = [stamp for time in [*arrivals] if time <= clock[0] + 1e-9
                   for stamp in arrivals.pop(time)]  # fmt: skip
            new = [Taken(template.encode(stamp, [0.0]), stamp, stamp) for stamp in due]
            polled.last = new[-1] if new else polled.last
            return new

        polled.take = take
        return JOINT_STATE, polled

    bag = SimpleNamespace(written=[], add_topic=lambda *_: None)
    bag.write_all = bag.written.extend
    recorder, said = Recorder(None, bag), []
    recorder.inputs, recorder._inputs_of = {MOTOR}, {'/output_state': {MOTOR}}
    recorder._open = {
        MOTOR: opened({0.0: [1, last_input], 0.1: [50]}),
        '/output_state': opened(dict(arrivals)),
    }
    recorder.end(lambda: said.append('waiting'))
    outputs = [received for topic, received, _ in bag.written if topic == '/output_state']
    assert (outputs, len(said)) == (recorded, told)
    assert clock[0] == pytest.approx(waited, abs=0.11)  # s, of one look
    assert [received for topic, received, _ in bag.written if topic == MOTOR] == [1, last_input]
