"""The benchmarks run, and what they compare with does the same job."""

import json
import math
import subprocess
import sys
import time
from pathlib import Path

import lossy_link
import oracle
import pytest
import textbook_node
from compiled import NotBuiltError, rclcpp_node
from live import DEADLINE, SECOND, Peer, rotor_state, stamp_of
from processes import Program, private_surroundings, program
from rotor_driver import RotorState

BENCHMARK = Path(__file__).resolve().parents[2] / 'benchmark'
ROTOR_ANGLES = [0.0, 1.0, -30.0, 314.0]
ACTUATOR = oracle.Numbers(80, 76, 0.0011, ((0.0, 0.04), (math.pi, -0.04)))


@pytest.mark.slow
@pytest.mark.parametrize(
    'arguments',
    [
        ['kinematics.py', '--samples', '1000', '--rounds', '1'],
        ['compute.py', '--messages', '300', '--rounds', '1'],
        ['validation.py', '--messages', '300', '--rounds', '1', '--memory', '300'],
        ['preload_advice.py', '--seeds', '5', '--settings', 'five, turns'],
        ['calibration.py', '--gears', '1', '--duration', '20', '--scenario', 'usual'],
    ],
    ids=lambda arguments: arguments[0],
)
def test_benchmark_prints_its_results_as_json(arguments):
    assert finite_numbers(results_of(*arguments))


@pytest.mark.live
@pytest.mark.slow
def test_benchmark_of_the_live_node_loses_none_of_a_hundred_messages():
    done = run('live.py', '--rates', '1000', '--seconds', '0.1', '--rounds', '1')
    results = json.loads(done.stdout)
    assert finite_numbers(results)
    assert results['rates']['1000']['node']['delivered'] == 1.0
    # A line says why there is no C++ node if there is none.
    lines = [] if 'C++' in results['rates']['1000'] else ['no C++ node: ']
    assert [line[:13] for line in done.stderr.splitlines()] == lines


@pytest.mark.live
@pytest.mark.slow
def test_compiled_node_publishes_what_the_textbook_node_does():
    try:
        compiled = (str(rclcpp_node()),)
    except NotBuiltError as error:
        pytest.skip(str(error))
    assert answers(compiled) == answers(program('textbook_node.py'))


def answers(command) -> list[tuple]:
    """Let a node answer a message for each of ROTOR_ANGLES, and give what it publishes."""
    with private_surroundings() as surroundings:
        peer = Peer(surroundings.arguments[-1].removeprefix('__ns:='))
        try:
            with Program(command, surroundings):
                probe = peer.stamp()
                while not answer(peer, probe, 0.0, patience=0.1):
                    pass
                return [answer(peer, peer.stamp(), angle) for angle in ROTOR_ANGLES]
        finally:
            peer.close()


def answer(peer, stamp, angle, patience=DEADLINE) -> tuple | None:
    """Give output_state and body_poses for a message, or nothing if they do not come in time."""
    peer.send(rotor_state(stamp, ['other', 'rotor'], *[[9.0, angle]] * 3))
    deadline = time.monotonic() + patience
    topics = [peer.received[topic] for topic in ('output_state', 'body_poses')]
    answered = peer.wait_until(
        lambda: (
            all(messages and stamp_of(messages[-1]) == stamp for messages in topics)
            or (time.monotonic() > deadline and 'late')
        ),
        'an answer',
    )
    return None if answered == 'late' else tuple(messages[-1] for messages in topics)


def test_time_to_close_a_gap_counts_from_the_sending_of_the_lost_message(monkeypatch):
    period, lost = 2_000_000, (10, 30)  # ns; numbers of messages
    arrivals = lossy_link.Arrivals()
    for number in range(50):
        sent = SECOND + number * period
        # Those that came meanwhile wait for the lost one, which is sent again after 40 ms.
        closed = [SECOND + n * period + 40_000_000 for n in lost if n <= number]
        now = max([sent + 500_000, *closed])
        monkeypatch.setattr(lossy_link.time, 'time_ns', lambda t=now: t)
        arrivals.add(RotorState().encode(sent, number))
    assert len(arrivals) == 50
    assert arrivals.gaps(500) == pytest.approx([0.04, 0.04])


def results_of(program, *options):
    """Run a benchmark and take what it prints."""
    return json.loads(run(program, *options).stdout)


def run(program, *options) -> subprocess.CompletedProcess[str]:
    """Run a benchmark."""
    return subprocess.run(
        [sys.executable, str(BENCHMARK / program), *options, '--json'],
        check=True, capture_output=True, text=True, timeout=120.0,
    )  # fmt: skip


def finite_numbers(results) -> list[float]:
    """Give every number, each of which is finite."""
    if isinstance(results, dict | list):
        parts = results.values() if isinstance(results, dict) else results
        return [number for part in parts for number in finite_numbers(part)]
    assert not isinstance(results, float) or math.isfinite(results)
    return [] if isinstance(results, str) else [results]


@pytest.mark.parametrize('rotor_angle', ROTOR_ANGLES)
def test_textbook_node_moves_as_the_mechanism_does(rotor_angle):
    expected = oracle.expected_motion(ACTUATOR, oracle.rotor_angle_of(rotor_angle))
    output_angle = textbook_node.output_angle(rotor_angle)
    assert oracle.angle_error(output_angle, expected.output_angle) <= 1e-12
    centres = [branch.satellite_centre for branch in expected.branches]
    centres += [branch.oldham_centre for branch in expected.branches]
    for centre, wanted in zip(textbook_node.centres(rotor_angle), centres, strict=True):
        assert oracle.point_error(centre, wanted, ACTUATOR.eccentricity) <= 1e-12
