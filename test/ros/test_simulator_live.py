# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The node gear_simulator as a process: its messages, commands and services, in real time."""

import math
import os
import re
import signal
import subprocess
import sys
import time
from itertools import pairwise
from pathlib import Path
from types import SimpleNamespace

import pytest
from live import DEADLINE, Participant, rotor_state, stamp_of
from rclpy.parameter import Parameter
from rclpy.qos import QoSProfile
from rclpy.serialization import deserialize_message
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64
from std_srvs.srv import SetBool, Trigger

from gear_kinematics.parameters import ConfigError
from gear_kinematics.parameters.files import given_parameters
from gear_kinematics.ros.simulator import GearSimulator, SimulatedGear

pytestmark = pytest.mark.live

PROGRAM = 'import sys; from gear_kinematics.__main__ import gear_simulator as run; sys.exit(run())'
COMMAND = [sys.executable, '-P', '-c', PROGRAM]
NAMESPACE = f'/simulated_{os.getpid()}'
RATE = 500.0  # Hz: each message takes those who hear it processor time


class Bench(Participant):
    """What is connected to a simulated actuator: a controller, a load, and a recorder."""

    def __init__(self, log):
        super().__init__('bench', NAMESPACE)
        self._log, qos = log, QoSProfile(depth=2000)
        self.process: subprocess.Popen | None = None
        self.rotor: list[JointState] = []
        self.output: list[JointState] = []
        self.node.create_subscription(JointState, 'rotor_state', self.rotor.append, qos)
        self.node.create_subscription(JointState, 'output_encoder', self.output.append, qos)

        def keep_newest(message):  # beside which a busy reader misses the others
            self.newest = message

        self.newest = JointState()
        self.node.create_subscription(JointState, 'rotor_state', keep_newest, 1)
        self._commands = self.node.create_publisher(JointState, 'rotor_command', qos)
        self._loads = self.node.create_publisher(Float64, 'load_torque', qos)

    def connect(self) -> None:
        self.wait_until(lambda: self.rotor and self.output, 'both encoders')

        def heard() -> bool:  # once the simulator has discovered both publishers
            self.command(position=[1.0])
            self._loads.publish(Float64(data=0.1))
            moved = abs(self.rotor[-1].position[0] - 1.0) < 1e-2
            return moved and self.output[-1].effort[0] == 0.1

        self.wait_until(heard, 'the simulator')
        self.load(0.0)

    def command(self, **values) -> None:
        self._commands.publish(rotor_state(0, **values))

    def load(self, torque: float) -> None:
        """Load the output, and wait until it is loaded, unless it cannot be."""
        self._loads.publish(Float64(data=torque))
        if abs(torque) <= 1e6:
            self.wait_until(lambda: self.output and self.output[-1].effort[0] == torque, 'a load')

    def rest(self, messages: int = 150) -> tuple[JointState, JointState]:
        """Wait until neither shaft turns, from some messages after now."""
        self.rotor.clear()
        self.output.clear()
        begin = time.time_ns()

        def resting() -> bool:
            if min(len(self.rotor), len(self.output)) <= messages:
                return False
            recent = self.rotor[-50:] + self.output[-50:]
            still = all(abs(message.velocity[0]) < 1e-3 for message in recent)
            # A busy reader receives late what was sent before.
            return still and all(stamp_of(message) >= begin for message in recent)

        self.wait_until(resting, 'both shafts to rest')
        return self.rotor[-1], self.output[-1]

    def call(self, service: str, **values) -> str:
        kind = SetBool if values else Trigger
        client = self.node.create_client(kind, f'gear_simulator/{service}')
        self.wait_until(client.service_is_ready, service)
        answer = self.answer_to(lambda: client.call_async(kind.Request(**values)))
        assert answer.success
        return answer.message

    def up_to_date(self) -> bool:
        """Whether the latest state is of the present time; 0.4 s are those of a busy machine."""
        return abs(time.time_ns() - stamp_of(self.newest)) < 4e8

    def text(self) -> str:
        return self._log.read_text('utf-8')


@pytest.fixture(scope='module')
def bench(tmp_path_factory):
    folder = tmp_path_factory.mktemp('simulator')
    log = folder / 'simulator.log'
    bench = Bench(log)
    with log.open('w') as stream:
        process = subprocess.Popen(
            [*COMMAND, '--ros-args', '-r', f'__ns:={NAMESPACE}', '-p', f'rate:={RATE}'],
            stdout=stream, stderr=stream, env={**os.environ, 'ROS_LOG_DIR': str(folder)},
        )  # fmt: skip
    bench.process, bench.alive = process, lambda: process.poll() is None
    try:
        bench.connect()
        yield bench
        process.send_signal(signal.SIGINT)
        assert process.wait(DEADLINE) == 0
        assert 'Traceback' not in bench.text()
    finally:
        process.kill()
        bench.close()


def test_it_says_what_computes_the_motion(bench):
    assert 'simulating a gear of ratio -19 with ' in bench.text()


def test_both_encoders_come_together_at_their_rate_in_real_time(bench):
    def together():
        """Return a second of stamps, none of which got lost on a busy machine."""
        bench.rotor.clear()
        bench.output.clear()
        bench.wait_until(lambda: len(bench.output) >= RATE, '1 s of messages')
        rotor, output = (
            [stamp_of(message) for message in messages][:495]
            for messages in (bench.rotor, bench.output)
        )
        begin = max(rotor[0], output[0])
        found = [[s for s in stamps if s >= begin][:450] for stamps in (rotor, output)]
        return found[0] == found[1] and found[0]

    rotor = bench.wait_until(together, 'both encoders at the same times')
    bench.wait_until(bench.up_to_date, 'stamps of the present time')
    steps = [after - before for before, after in pairwise(rotor)]
    assert sorted(steps)[len(steps) // 2] == pytest.approx(1e9 / RATE, abs=1e4)


def test_position_is_held_against_a_load(bench):
    bench.command(position=[20.0])
    bench.wait_until(lambda: abs(bench.rotor[-1].position[0] - 20.0) < 1e-3, 'the position')
    bench.load(1.9)
    bench.wait_until(lambda: bench.rotor[-1].effort[0] > 0.05, 'the torque')
    rotor, output = bench.rest()
    assert rotor.name == ['rotor']
    assert rotor.position[0] == pytest.approx(20.0, abs=1e-3)
    assert rotor.effort[0] == pytest.approx(1.9 / 19.0, abs=0.1 / 19.0 + 1e-3)
    # Both branches are in mesh: 3000 + 3000·1069/4069 N·m/rad.
    turned = 1.9 / 3788.0
    assert output.position[0] == pytest.approx((-20.0 / 19.0 + turned) % math.tau, abs=1e-4)
    bench.load(0.0)


def test_what_cannot_be_followed_is_one_warning_a_second(bench):
    bench.command(position=[20.0])
    bench.rest()
    for name, command in {
        "no joint 'rotor' in it; there are: wheel": lambda: bench.command(
            names=['wheel'], position=[1.0]
        ),
        'no value in it is finite': lambda: bench.command(position=[math.nan]),
        "no joint 'rotor' in it; there are none": lambda: bench.command(names=[]),
        'nan N·m is not within': lambda: bench.load(math.nan),
        '1e+308 N·m is not within': lambda: bench.load(1e308),
    }.items():
        before = bench.text()

        def said(before=before, name=name, command=command):
            command()
            return name in bench.text()[len(before) :]

        bench.wait_until(said, name)
    moments = [
        float(line.split('] [')[1]) for line in bench.text().splitlines() if 'rejected' in line
    ]
    assert len(moments) - 1 <= moments[-1] - moments[0] + 0.5
    assert bench.rotor[-1].position[0] == pytest.approx(20.0, abs=1e-3)


def test_either_shaft_is_locked_and_released(bench):
    """`test/twin` has what a locked shaft does."""
    bench.command(position=[20.0])
    _, before = bench.rest()
    for shaft in ('rotor', 'output'):
        assert bench.call(f'lock_{shaft}', data=True) == f'the {shaft} is locked'
    bench.load(100.0)
    bench.command(position=[50.0])
    rotor, output = bench.rest()
    assert rotor.position[0] == pytest.approx(20.0, abs=1e-3)
    assert output.position[0] == pytest.approx(before.position[0], abs=1e-3)
    bench.load(0.0)
    for shaft in ('rotor', 'output'):
        assert bench.call(f'lock_{shaft}', data=False) == f'the {shaft} is free'
    bench.wait_until(lambda: abs(bench.rotor[-1].position[0] - 50.0) < 1e-3, 'the position')


def test_a_power_cycle_loses_the_turns_of_the_rotor_alone(bench):
    bench.command(position=[50.0])
    bench.wait_until(lambda: abs(bench.rotor[-1].position[0] - 50.0) < 1e-3, 'the position')
    _, output = bench.rest()
    said = bench.call('power_cycle')
    assert said == 'the driver is on again: the rotor is free, at 0.000 rad'
    rotor, after = bench.rest()
    assert rotor.position[0] == pytest.approx(0.0, abs=1e-2)
    assert after.position[0] == pytest.approx(output.position[0], abs=1e-3)


def test_time_that_is_not_made_up_for_is_left_out_and_said(bench):
    bench.process.send_signal(signal.SIGSTOP)
    time.sleep(0.8)  # what a busy processor does
    bench.process.send_signal(signal.SIGCONT)
    bench.wait_until(lambda: 's to catch up with real time' in bench.text(), 'a warning')
    bench.wait_until(bench.up_to_date, 'stamps of the present time')


def test_an_arm_follows_one_command_and_tells_all_joints_in_one_message(context):
    """Positions by the ratios: 2.5 rad of the elbow's rotor, which counts backwards.

    The preload, T0 = 2 N·m, is an interference of 2 (2/3000 + 1/1069) = 3.204 mrad.
    """
    file = Path(__file__).resolve().parents[2] / 'config/simulated_arm.yaml'
    given = given_parameters(file, 'gear_simulator') | {'elbow.wear': 0.0027, 'rotor_counts': 0}
    overrides = [Parameter(name, value=value) for name, value in given.items()]
    node = GearSimulator(context=context, namespace='/arm', parameter_overrides=overrides)
    sent, warnings = {}, []
    node.send, node._warn = sent.update, warnings.append
    command = JointState(name=['wrist_motor', 'tool', 'elbow_motor'], position=[10.0, 1.0, 2.5])
    node._on_command(command)
    for gear in node._gears:
        gear.driver.advance(2.0, 0.0)
    node._due = time.monotonic_ns()
    node._step()
    rotor, output = (
        deserialize_message(sent[topic], JointState) for topic in ('rotor_state', 'output_encoder')
    )
    assert rotor.name == ['rotor', 'elbow_motor', 'wrist_motor']
    assert output.name == ['shoulder', 'elbow', 'wrist']
    assert rotor.position.tolist() == pytest.approx([0.0, 2.5, 10.0], abs=1e-3)
    # Both branches are in mesh; the wrist has a play of 0.29 mrad.
    expected = [0.0, 2.5 / 19.0, math.tau - 10.0 / 101.0]
    assert output.position.tolist() == pytest.approx(expected, abs=3e-4)
    assert len(rotor.velocity) == len(output.effort) == 3
    node._on_command(JointState(name=['tool'], position=[1.0]))
    fault = "no joint 'rotor' or 'elbow_motor' or 'wrist_motor' in it; there are: tool"
    assert warnings == [f'rotor_command rejected: {fault}']
    services = {each.srv_name for each in node.services}
    assert {f'~/{gear.name}/wear' for gear in node._gears} <= services
    first, second, _ = node._gears
    worn = [node._wear(gear, None, SimpleNamespace()).message for gear in (first, second, first)]
    assert worn == [
        *2 * ['the flanks lost 2.70 mrad: a preload of 0.31 N·m is left'],
        'the flanks lost 2.70 mrad: the output has 2.20 mrad of play',
    ]
    node.destroy_node()


@pytest.mark.parametrize('notice', ['', 'the rotor is held'])
def test_motion_that_is_not_that_of_the_gear_is_a_warning(notice):
    warnings, model = [], SimpleNamespace(notice=notice)
    driver = SimpleNamespace(advance=lambda *_: None)
    node = SimpleNamespace(
        _due=time.monotonic_ns(),
        _period=10**12,
        _compare_clocks=lambda: None,
        _gears=[SimulatedGear('', 'rotor', 'output', model, driver)],
        _offset=0,
        send=tuple,
        _encoders=(),
        _warn=warnings.append,
    )
    GearSimulator._step(node)
    assert (warnings, model.notice) == ([notice] * bool(notice), '')


def test_all_parameters_but_wear_are_read_only(context):
    node = GearSimulator(context=context, namespace='/read_only')
    given = {'preload': 1.0, 'rotor_zero': 1.0, 'rate': 10.0, 'use_sim_time': True, 'wear': 0.001}
    results = node.set_parameters([Parameter(name, value=given[name]) for name in given])
    assert [result.successful for result in results] == [False, False, False, False, True]
    assert not node.get_clock().ros_time_is_active
    node.destroy_node()


def test_parameters_that_cannot_be_are_refused(context, tmp_path):
    for name, value, cause in (
        ('drop_out', 0.0, 'did you mean `dropout`?'),
        ('loads.rotor_inertia', 0.0, 'loads.rotor_inertia must be'),
        # The steps of a simulated clock would set stamps back.
        ('use_sim_time', True, 'use_sim_time must be false: gear_simulator moves the gear in'),
    ):
        given = [Parameter(name, value=value)]
        with pytest.raises(ValueError, match=re.escape(cause)):
            GearSimulator(context=context, namespace='/refused', parameter_overrides=given)
    file = tmp_path / 'other.yaml'
    file.write_text('/other: {ros__parameters: {preload: 1.0}}', 'utf-8')
    with pytest.raises(ConfigError, match='no parameters of /gear_simulator in it'):
        GearSimulator(context=context, parameter_files=[file])


@pytest.mark.parametrize(('names', 'followed', 'said'), [
    (['m1'], [1.0], ''),
    (['m1', 'm2'], [], 'rotor_command rejected: 2 joints in it: set rotor_joint to one of them'),
    ([], [], 'rotor_command rejected: 0 joints in it: set rotor_joint to one of them'),
])  # fmt: skip
def test_without_a_name_the_only_joint_of_a_command_is_followed(names, followed, said):
    positions, warnings = [], []
    driver = SimpleNamespace(follow=lambda command: positions.append(command.position))
    gear = SimulatedGear('', '', 'output', None, driver)
    node = SimpleNamespace(_gears=[gear], _warn=warnings.append)
    command = JointState(name=names, position=[1.0, 2.0][: len(names)])
    GearSimulator._on_command(node, command)
    assert (positions, ''.join(warnings)) == (followed, said)
