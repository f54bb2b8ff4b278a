# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Faults beside a running node, of drivers, listeners and clocks: no output is lost or wrong."""

import multiprocessing
import os
import re
import signal
from contextlib import ExitStack, closing, contextmanager, suppress
from itertools import count
from pathlib import Path

import pytest
from driver import MILLISECOND, drive, rotor_position
from expected_outputs import assert_output
from live import (
    DEADLINE,
    PATIENT,
    SECOND,
    START,
    STATES,
    Listener,
    Peer,
    connected,
    live_node,
    parameter,
    rotor_state,
    stamp_of,
)
from rclpy.duration import Duration
from rclpy.qos import QoSProfile
from rosgraph_msgs.msg import Clock
from std_srvs.srv import Trigger

from gear_kinematics.ros.live import running_node

pytestmark = pytest.mark.live

ERROR = 2
names = (f'/faults_{os.getpid()}_{number}' for number in count())

# Processes that start quickly, without the threads of this one.
forks = multiprocessing.get_context('forkserver')
forks.set_forkserver_preload(['rclpy.node', 'sensor_msgs.msg'])


def assert_answered(received, sent, *, joined_late=False, left_early=False) -> None:
    """Check that no output to the messages sent, given by their stamps, is lost or wrong.

    With `joined_late`, outputs may be missing before the first one, and after the last one with
    `left_early`.
    """
    for name in STATES:
        messages, due = received[name], sent
        if joined_late:
            due = sent[sent.index(stamp_of(messages[0])) :]
        if left_early:
            due = due[: len(messages)]
        assert [stamp_of(message) for message in messages] == due
        for message in messages:
            assert_output(name, message, rotor_position(stamp_of(message)))


# Driving and listening.


def message_at(stamp):
    return rotor_state(stamp, position=[rotor_position(stamp)])


def rejected_in(status) -> str | None:
    values = {pair.key: pair.value for pair in status.values}
    return values.get('rejected: out of order')


def heard(listener) -> int:
    """Count the outputs received on every topic."""
    return min(len(listener.received[name]) for name in STATES)


def newest(listener) -> int:
    """Return the newest stamp received on every topic; 0 if there is none."""
    outputs = [listener.received[name] for name in STATES]
    return min(stamp_of(messages[-1]) if messages else 0 for messages in outputs)


# Processes that die.


@contextmanager
def swept(pid):
    """Remove the shared memory of a process that is killed within."""
    held = []
    for file in Path(f'/proc/{pid}/fd').iterdir():
        with suppress(FileNotFoundError):  # closed meanwhile
            held.append(file.readlink())
    yield
    for lock in held:
        if re.fullmatch('fastrtps_[0-9a-f]{16}_el', lock.name):  # of its own memory
            Path(str(lock).removesuffix('_el')).unlink(missing_ok=True)
            lock.unlink(missing_ok=True)


class KillableDriver:
    """A driver process, connected and waiting, which then publishes until it is killed."""

    def __init__(self, peer, start) -> None:
        """Start the process; the stamps of its messages are from `start` on, ns."""
        self._go, self._acknowledged = forks.Event(), forks.RawValue('q')
        arguments = f'{peer.namespace}/rotor_state', start, self._go, self._acknowledged
        self._process = forks.Process(target=drive, args=arguments, daemon=True)
        self._process.start()
        self.go = self._go.set

    def kill(self) -> int:
        """Kill it; returns the last stamp that was acknowledged."""
        if self._process.is_alive():
            with swept(self._process.pid):
                self._process.kill()
                self._process.join()
        return self._acknowledged.value


def test_driver_killed_and_restarted_five_times(tmp_path):
    with connected(tmp_path) as peer, ExitStack() as stack:
        arrived = {}
        # The middleware takes seconds to connect a new driver: all are started before.
        starts = range(START, 6 * START, START)
        drivers = {start: KillableDriver(peer, start) for start in starts}
        for driver in drivers.values():
            stack.callback(driver.kill)
        for start, driver in drivers.items():
            driver.go()
            peer.wait_until(lambda s=start: newest(peer) >= s + 50 * MILLISECOND, 'outputs')
            arrived[start] = driver.kill()
            peer.wait_until(lambda s=start: newest(peer) >= arrived[s], 'what has arrived')
        peer.status()  # whatever else comes meanwhile is wrong

        def ends():
            return {stamp_of(peer.received[name][-1]) for name in STATES}

        # What was not acknowledged is not awaited above: one of its outputs may be under way.
        peer.wait_until(lambda: len(ends()) == 1, 'the last output on every topic')
        sent = []
        for start, last in arrived.items():
            # What the node took, but had not acknowledged yet, is answered as well.
            stamps = (stamp_of(message) for name in STATES for message in peer.received[name])
            taken = (stamp for stamp in stamps if start <= stamp < start + START)
            sent += range(start, max(last, *taken) + 1, MILLISECOND)
        assert_answered(peer.received, sent)


def test_node_killed_and_restarted_while_the_driver_runs(tmp_path):
    namespace = next(names)
    command = ['--ros-args', '-r', f'__ns:={namespace}', *PATIENT]
    command += parameter('rotor_encoder', 'single_turn')
    command += parameter('home_max_speed', 100.0)
    environment = os.environ | {'ROS_LOG_DIR': str(tmp_path)}
    with closing(Peer(namespace)) as peer:
        home = peer.node.create_client(Trigger, 'gear_state_publisher/home')

        def reference():
            # For a while the middleware takes the killed node's service for ready as well.
            peer.status(
                lambda status: 'not referenced' not in status.message,
                'a reference',
                lambda: home.call_async(Trigger.Request()),
            )

        with running_node(command, env=environment) as process:
            peer.connect()
            # With a full history, what is missing is made up for at once and not every 3 s.
            driver = peer.driver('rotor_state', depth=100)
            sent = []

            def send():
                sent.append(peer.stamp())
                driver.publish(message_at(sent[-1]))

            timer = peer.node.create_timer(0.01, send)
            peer.wait_until(lambda: heard(peer) > 100, 'outputs')
            reference()
            with swept(process.pid):
                process.kill()
                process.wait()
        last = sent[-1]
        # Another participant takes the ports of the killed node: who gets them is found late.
        with closing(Listener(next(names))), running_node(command, env=environment) as process:
            peer.wait_until(lambda: newest(peer) > last, 'outputs')
            level, message, values = peer.status()
            timer.cancel()
            peer.wait_until(lambda: newest(peer) == sent[-1], 'the last outputs')
            received = {
                name: [message for message in peer.received[name] if stamp_of(message) > last]
                for name in STATES
            }
            assert_answered(received, sent, joined_late=True)
            timer.reset()
            reference()
    assert process.returncode == 0
    assert (level, values['referenced']) == (ERROR, 'false')
    assert 'not referenced' in message


def test_clock_that_steps(tmp_path):
    with connected(tmp_path, *parameter('use_sim_time', value=True)) as peer:
        clock = peer.node.create_publisher(Clock, '/clock', QoSProfile(depth=1))
        sent = []
        for seconds in (4000.0, 3999.5, 100.0, 4000.0):
            now, stamp = Clock(), round(seconds * SECOND)
            now.clock.sec, now.clock.nanosec = divmod(stamp, SECOND)

            def publish(now=now):
                clock.publish(now)

            peer.wait_until(
                lambda now=stamp, tick=publish: stamp_of(peer.report(meanwhile=tick)[0]) == now,
                'the time',
            )
            peer.send(*[rotor_state(0, position=[rotor_position(stamp)])] * 20)
            if seconds == 3999.5:  # too little for a new beginning
                peer.status(lambda status: rejected_in(status) == '20', '20 messages out of order')
            else:
                sent += [stamp] * 20
                wanted = len(sent)
                peer.wait_until(lambda n=wanted: heard(peer) == n, 'outputs')
        # The simulated clock stands still, and yet silence is noticed.
        _, _, values = peer.status(lambda status: 'no input' in status.message, 'silence')
        assert_answered(peer.received, sent)
    assert (values['clock resets'], values['rejected: out of order']) == ('1', '20')


# The end.


def test_what_was_received_before_the_signal_is_answered(tmp_path):
    with live_node(tmp_path) as live:
        peer = live.peer
        peer.connect()
        # With a full history, acknowledgement is asked for at once.
        burst = 100
        driver = peer.driver('rotor_state', depth=burst)
        sent = []

        def send_burst():
            for _ in range(burst):
                sent.append(peer.stamp())
                driver.publish(message_at(sent[-1]))

        send_burst()
        peer.wait_until(lambda: newest(peer) == sent[-1], 'answers')
        for _ in range(2):
            send_burst()
            assert driver.wait_for_all_acked(Duration(seconds=DEADLINE))
        received = len(sent)
        live.process.send_signal(signal.SIGTERM)
        while live.process.poll() is None and len(sent) < 1500:
            sent.append(peer.stamp())
            peer.send(message_at(sent[-1]))
        assert live.process.wait(DEADLINE) == 0
        peer.alive = lambda: True
        peer.wait_until(lambda: heard(peer) >= received, 'the last')
        # Whatever else the node has sent is here already.
        before, total = -1, 0
        while total > before:
            before = total
            for _ in range(20):
                peer.receive()
            total = sum(len(peer.received[name]) for name in STATES)
        # A listener on a busy machine may lose the last answers to those that were sent later.
        assert_answered(peer.received, sent, left_early=True)
