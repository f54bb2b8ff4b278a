# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Driver and node on two hosts, while the network loses packets and its cable is pulled.

Everything happens once, in `run`; each test holds one claim against what was seen. The listeners
are on the node's host: what they do not hear, the node has not published.
"""

import time
from contextlib import ExitStack, contextmanager
from itertools import pairwise
from typing import NamedTuple

import pytest
from blocked_bags import wait_until
from endpoints import (
    PERIOD,
    Driver,
    Line,
    Listener,
    Report,
    number_of,
    reading,
    rotor_message,
    running,
)
from live import PATIENT, SECOND
from network import Cable, NoNetworkError, two_hosts
from replaying import assert_right, valid_samples

from gear_kinematics.ros.live import running_node

pytestmark = [pytest.mark.live, pytest.mark.slow]

LINES = {
    'best_effort': Line('BEST_EFFORT', 10, 'single_turn'),
    'reliable': Line('RELIABLE', 10, 'multi_turn'),
    'reliable_and_deep': Line('RELIABLE', 2000, 'single_turn'),
}
# The other one goes on with the driver's next heartbeat, whose period in Fast DDS is 3 s.
PROMPT = ('best_effort', 'reliable')
LOSS = 2  # % of the packets, in each direction
CUTS = (20, 160)  # messages that are sent while the cable is out
# rad/s. Half a turn takes 8 messages: so many are not lost in a row but by a pulled cable.
MAX_ROTOR_SPEED = 40.0
HOME_MAX_SPEED = 100.0
"""rad/s. In 0.1 s it is a way for which that rotor takes 5 s at its output: so long, lines can be
homed one after another while the driver pauses."""


class Cut(NamedTuple):
    """What came after a pulled cable."""

    returned: int
    """The first message that was sent after the return of the cable."""
    reports: dict[str, Report]
    """Before anybody homed."""


class Run(NamedTuple):
    """What was seen; dictionaries are by line."""

    sent: int
    """Messages of the driver to each line."""
    zeros: dict[str, list[float]]
    """After each homing."""
    begin: dict[str, Report]
    """After the first homing, before any loss."""
    lossy: dict[str, Report]
    """Before the first cut."""
    cuts: list[Cut]
    end: dict[str, Report]
    outputs: dict[str, list[list[bytes]]]
    """output_state and body_poses, from the message of the first homing on."""
    arrived: int
    """Packets at the node's host."""
    dropped: int
    """Those of them that were dropped."""

    def answered(self, name) -> list[int]:
        """Return the numbers of the driver's messages that were answered."""
        states, _ = self.outputs[name]
        return [number_of(state) for state in states]


class Bench:
    """The driver, the listeners by line, and the cable, in hand."""

    def __init__(self, driver: Driver, listeners: dict[str, Listener], cable: Cable) -> None:
        self.driver = driver
        self.listeners = listeners
        self.cable = cable

    def reports(self) -> dict[str, Report]:
        """Wait for the next report of every node."""
        now = time.time_ns()

        def new():
            found = {name: listener.report() for name, listener in self.listeners.items()}
            return all(report and report.stamp > now for report in found.values()) and found

        return wait_until(new, 'reports')

    def wait_for(self, name, number) -> None:
        """Wait until a line has answered the driver's message of a number, or one after it."""
        wait_until(lambda: self.listeners[name].newest() >= number, f'{number} on {name}')

    def settle(self, *names) -> int:
        """Pause the driver until lines have answered all that it sent; returns how many."""
        sent = self.driver.pause()
        for name in names:
            self.wait_for(name, sent - 1)
        return sent

    def home(self, name) -> float:
        """Home a node, whose shaft may turn, and give its new zero."""
        return self.listeners[name].home()

    def cut(self, length) -> Cut:
        """Pull the cable for some messages."""
        with self.cable.pulled():
            begin = self.driver.sent()
            wait_until(lambda: self.driver.sent() >= begin + length, 'messages sent in vain')
        returned = self.driver.sent()
        for name in PROMPT:
            self.wait_for(name, returned)
        return Cut(returned, self.reports())


def lost(report) -> int:
    return int(report.values['lost messages'])


@contextmanager
def node(name, folder):
    """Run the node of a line; in the end it has exit code 0 and shows no traceback."""
    log = folder / f'{name}.log'
    arguments = ['--ros-args', '-r', f'__ns:=/{name}',
                 '-p', f'rotor_encoder:={LINES[name].encoder}',
                 '-p', f'max_rotor_speed:={MAX_ROTOR_SPEED}',
                 '-p', f'home_max_speed:={HOME_MAX_SPEED}', *PATIENT]  # fmt: skip
    with (
        log.open('w', encoding='utf-8') as stream,
        running_node(arguments, stdout=stream, stderr=stream) as process,
    ):
        yield
    text = log.read_text(encoding='utf-8')
    assert process.returncode == 0, text
    assert 'Traceback' not in text, text


@pytest.fixture(scope='module')
def run(tmp_path_factory) -> Run:
    folder = tmp_path_factory.mktemp('two_hosts')
    environment = {
        # The other host is not on the loopback. There is nobody else, and no way out.
        'ROS_AUTOMATIC_DISCOVERY_RANGE': 'SUBNET',
        # The hosts have one memory, which must not be a way round the cable.
        'FASTDDS_BUILTIN_TRANSPORTS': 'UDPv4',
        'ROS_LOG_DIR': str(folder),
    }
    with ExitStack() as stack:
        patch = stack.enter_context(pytest.MonkeyPatch.context())
        for name, value in environment.items():
            patch.setenv(name, value)
        try:
            driver_host, node_host, cable = stack.enter_context(two_hosts())
        except NoNetworkError as error:
            pytest.skip(str(error))
        with driver_host.entered():
            driver = stack.enter_context(running(Driver, LINES))
        with node_host.entered():
            for name in LINES:
                stack.enter_context(node(name, folder))
            # One for each, since what one line makes up for in a burst can overrun a socket.
            listeners = {name: stack.enter_context(running(Listener, name)) for name in LINES}
        bench = Bench(driver, listeners, cable)

        driver.drive()
        for name in LINES:
            bench.wait_for(name, 0)
        first = bench.settle(*LINES) - 1
        zeros = {name: [bench.home(name)] for name in LINES}
        begin = bench.reports()

        cable.lose(LOSS)
        driver.drive()

        def some_losses():
            reports = bench.reports()
            return lost(reports['best_effort']) > lost(begin['best_effort']) and reports

        lossy = wait_until(some_losses, 'losses in diagnostics')
        cuts = []
        for length in CUTS:
            cuts.append(bench.cut(length))
            zeros['best_effort'].append(bench.home('best_effort'))
        # Without more losses the driver's next heartbeat is enough. By best effort, the last
        # message may be among the lost.
        cable.lose(0)
        sent = bench.settle('reliable', 'reliable_and_deep')
        return Run(
            sent,
            zeros,
            begin,
            lossy,
            cuts,
            bench.reports(),
            {name: listener.outputs(first) for name, listener in listeners.items()},
            node_host.card()['stats64']['rx']['packets'],
            node_host.dropped(),
        )


def test_messages_crossed_the_cable_and_packets_were_lost(run):
    assert run.arrived - run.dropped >= sum(len(run.answered(name)) for name in LINES)
    assert run.dropped > 0


@pytest.mark.parametrize('name', LINES)
def test_no_output_is_wrong_or_out_of_order(run, name):
    encoder = LINES[name].encoder
    states, poses = run.outputs[name]
    answered = run.answered(name)
    assert all(a < b for a, b in pairwise(answered))
    # A zero is the reading at which it was homed.
    places = {reading(number, encoder): place for place, number in enumerate(answered)}
    homings = [places[zero] for zero in run.zeros[name]]
    assert homings[0] == 0
    for homed, last in pairwise([*homings, len(answered) - 1]):
        messages = [rotor_message(number, encoder) for number in answered[homed : last + 1]]
        (zero, *samples), _ = valid_samples(messages, single_turn=encoder == 'single_turn')
        part = slice(homed + 1, last + 1)
        assert_right(samples, states[part], poses[part], zero=zero.position)


def test_a_reliable_driver_that_keeps_its_messages_loses_none(run):
    answered = run.answered('reliable_and_deep')
    assert answered == list(range(answered[0], run.sent))


@pytest.mark.parametrize('name', LINES)
def test_losses_are_counted_in_diagnostics(run, name):
    answered = run.answered(name)
    missing = answered[-1] - answered[0] + 1 - len(answered)
    assert lost(run.end[name]) - lost(run.begin[name]) == missing
    # The longest cut is more than a short history holds.
    assert (missing > 0) == (LINES[name].depth < max(CUTS))


@pytest.mark.parametrize('name', PROMPT)
def test_output_resumes_with_the_messages_of_two_seconds_after_the_cable(run, name):
    answered = run.answered(name)
    for cut in run.cuts:
        first = next(number for number in answered if number >= cut.returned)
        assert (first - cut.returned) * PERIOD < 2 * SECOND


def test_single_turn_encoder_is_not_referenced_after_a_gap_that_could_hide_a_turn(run):
    assert len(run.cuts) == len(CUTS)
    for cut in run.cuts:
        report = cut.reports['best_effort']
        assert 'not referenced' in report.message
        assert report.values['referenced'] == 'false'


def test_single_turn_encoder_stays_referenced_while_no_gap_could_hide_a_turn(run):
    lossy = run.lossy['best_effort']
    assert lost(lossy) > lost(run.begin['best_effort'])
    deep = [cut.reports['reliable_and_deep'] for cut in run.cuts]
    for report in (lossy, *deep, run.end['reliable_and_deep']):
        assert 'not referenced' not in report.message
        assert report.values['referenced'] == 'true'


def test_multi_turn_encoder_is_referenced_whatever_is_lost(run):
    for reports in (run.lossy, *(cut.reports for cut in run.cuts), run.end):
        assert reports['reliable'].values['referenced'] == 'true'
