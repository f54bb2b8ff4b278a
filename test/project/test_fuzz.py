# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Bytes of every kind, into the node over DDS and into the harnesses of the fuzzer."""

import math
import random
import resource
import struct
import time
from contextlib import closing, suppress
from copy import deepcopy
from dataclasses import replace
from functools import partial
from itertools import starmap
from pathlib import Path

import pytest
from geometry_msgs.msg import Pose, PoseArray
from harnesses import harness
from live import SECOND, START, STATES, Participant, live_node, parameter, rotor_bytes, rotor_state
from rclpy.qos import QoSProfile
from rclpy.serialization import serialize_message
from sensor_msgs.msg import Imu, JointState
from std_msgs.msg import String
from wire import encoded, micro_ros_bytes

from gear_kinematics.parameters import NodeParameters
from gear_kinematics.state.rotor_input import RotorInput
from gear_kinematics.state.state_messages import state_messages
from gear_kinematics.wire.joint_reader import RejectedInputError, Rejection

CORPUS = sorted((Path(__file__).parents[1] / 'corpus').glob('*/*'))
FOREIGN = [
    serialize_message(message)
    for message in (String(data='rotor'), PoseArray(poses=[Pose()] * 4), Imu())
]
COUNT = 10_000  # hostile payloads
VALID_EVERY, WAIT_EVERY = 20, 500  # of them; the node's queue holds four times as many
STEP = SECOND // 1000
PROBES = START // 2  # ns
FAR_FUTURE = 10**18  # ns: beyond all stamps that valid messages have, and before the clock's
LARGEST = 2**51 * math.tau  # rad: beyond it a position is too large
VALUES = (
    *(math.nan, math.inf, -math.inf, 1.7e308, -1e301, 1e300, 1e17, 5e-324, -0.0),
    *(-LARGEST, LARGEST, math.nextafter(LARGEST, math.inf)),
)
LENGTHS = (0, 1, 2, 7, 100, 2**16, 2**29, 2**31 - 1, 2**31, 2**32 - 1)
STAMPS = ((0, 1), (99, SECOND - 1), (-1, 0), (2**31 - 1, SECOND), (-(2**31), 2**32 - 1))
NUMBERS = (
    *(struct.pack('<d', value) for value in VALUES),
    *(struct.pack('<I', length) for length in LENGTHS),
    *(struct.pack('<iI', *stamp) for stamp in STAMPS),
)


@pytest.mark.parametrize('file', CORPUS, ids=lambda file: f'{file.parent.name}-{file.name}')
def test_corpus_of_the_fuzzer(file):
    harness(file.parent.name).check(file.read_bytes())


class Payloads:
    """Valid messages, and hostile bytes that were such; the same ones for the same seed."""

    def __init__(self, seed: int) -> None:
        self._random = random.Random(seed)  # noqa: S311, no cryptography
        self._messages = [self._message() for _ in range(300)]
        # Those that leave most messages valid take turns with twice as many that leave few.
        few = (self._cut, self._splice, self._change_encapsulation, self._noise, self._foreign)
        self._mutations = (self._flip, self._extend, self._write, self._write, *few, *few)

    def valid(self, last: int) -> bytes:
        """Give a message that is valid behind any other, the `last` accepted stamp of which, ns.

        It is later, or, behind the clock's and all those far in the future, earlier by years.
        """
        stamp = last + STEP if START <= last < FAR_FUTURE else START
        return stamped(self._random.choice(self._messages), stamp)

    def hostile(self, last: int = START) -> bytes:
        """Give bytes that may be anything; never none, which the middleware does not deliver."""
        r = self._random
        age = r.choice((-STEP, -STEP, -STEP, 0, SECOND // 2, SECOND, SECOND + 1, 9 * SECOND))
        stamp = r.choice((0, *[max(0, min(last, FAR_FUTURE) - age)] * 9))
        return r.choice(self._mutations)(stamped(r.choice(self._messages), stamp))

    def _message(self) -> bytes:
        r = self._random
        names = r.choice((['rotor'], ['rotor'], ['brake', 'rotor'], ['rotor', 'brake', 'fan']))
        fields = (
            0,
            names,
            [r.uniform(-1e6, 1e6)] * len(names),
            [r.uniform(-600.0, 600.0)] * r.choice((0, len(names))),
            [r.uniform(-0.9, 0.9)] * r.choice((0, len(names))),
        )
        if r.random() < 0.2:
            return micro_ros_bytes(*fields)
        frame_id, little_endian = r.choice(('', 'base')), r.random() < 0.8
        return rotor_bytes(*fields, frame_id=frame_id, little_endian=little_endian)

    def _flip(self, data: bytes) -> bytes:
        flipped = bytearray(data)
        for _ in range(self._random.choice((1, 1, 1, 2))):
            flipped[self._random.randrange(len(data))] ^= 1 << self._random.randrange(8)
        return bytes(flipped)

    def _extend(self, data: bytes) -> bytes:
        return data + self._random.randbytes(self._random.choice((1, 3, 4, 12, 15, 16, 64, 4096)))

    def _write(self, data: bytes) -> bytes:
        """Write a number over one that is aligned as CDR aligns it: a stamp, a length, a value."""
        value = self._random.choice(NUMBERS)
        first = self._random.randrange(2)  # often the stamp
        place = 4 + first * len(value) * self._random.randrange((len(data) - 4) // len(value))
        return data[:place] + value + data[place + len(value) :]

    def _cut(self, data: bytes) -> bytes:
        return data[: self._random.randrange(1, len(data))]

    def _change_encapsulation(self, data: bytes) -> bytes:
        return data[:1] + bytes([self._random.choice((*range(14), 255))]) + data[2:]

    def _splice(self, data: bytes) -> bytes:
        other = self._random.choice(self._messages)
        return data[: self._random.randrange(1, len(data))] + other[self._random.randrange(12) :]

    def _noise(self, data: bytes) -> bytes:
        start = data[: self._random.choice((0, 4, 12, 24))]
        return start + self._random.randbytes(self._random.randrange(1, 300))

    def _foreign(self, _data: bytes) -> bytes:
        return self._random.choice(FOREIGN)


def stamped(data: bytes, stamp: int) -> bytes:
    return data[:4] + struct.pack('<iI' if data[1] else '>iI', *divmod(stamp, SECOND)) + data[12:]


LIMITS = {'max_rotor_speed': 1e6, 'max_rotor_acceleration': 1e9}
"""With which nearly any angle is plausible, whatever the clocks of node and test say."""


class Answers(Participant):
    """Keeps a node's answers as bytes, and those of the library, which other tests prove."""

    def __init__(self, namespace: str) -> None:
        super().__init__('answers', namespace)
        self.input = RotorInput(replace(NodeParameters.load(), **LIMITS))
        self._states = state_messages(NodeParameters.load())
        self.received: dict[str, list[bytes]] = {topic: [] for topic in STATES}
        self.expected: dict[str, list[bytes]] = {topic: [] for topic in STATES}
        self._probes: dict[str, list[bytes]] = {topic: [] for topic in STATES}
        for topic, kind in zip(STATES, (JointState, PoseArray, JointState), strict=True):
            keep, qos = partial(self._keep, topic), QoSProfile(depth=2000)
            self.node.create_subscription(kind, topic, keep, qos, raw=True)

    def _keep(self, topic: str, data: bytes) -> None:
        probe = data[4:8] == struct.pack('<i', PROBES // SECOND)
        (self._probes if probe else self.received)[topic].append(data)

    def expect(self, data: bytes) -> None:
        """Note what the node has to answer; an answer by its clock has the stamp 0 here."""
        delivered = data + bytes(-len(data) % 4)  # the middleware fills words up
        zero_stamps = self.input.zero_stamps
        try:
            sample = self.input.accept(delivered, time.time_ns)
        except RejectedInputError:
            return
        for topic, answer in encoded(self._states, sample, STATES).items():
            zero = self.input.zero_stamps > zero_stamps
            self.expected[topic].append(stamped(answer, 0) if zero else answer)

    def is_sure(self, data: bytes) -> bool:
        """Whether the answer does not depend on how fast messages without stamps arrive."""
        if data[4:12] != bytes(8):
            return True
        latest, judged = time.time_ns(), set[tuple[int, int]]()
        for now in (min(latest, self.input.last.stamp), latest):
            alone = deepcopy(self.input)
            with suppress(RejectedInputError):
                alone.accept(data + bytes(-len(data) % 4), partial(int, now))
            judged.add((alone.rejected[Rejection.IMPLAUSIBLE], alone.plausibility.jumps))
        return judged == {
            (self.input.rejected[Rejection.IMPLAUSIBLE], self.input.plausibility.jumps)
        }

    def wait(self, peer) -> None:
        """Wait until every answer has come."""
        wanted = len(self.expected[STATES[0]])
        self.wait_until(
            lambda: not peer.alive() or all(len(of) >= wanted for of in self.received.values()),
            f'{wanted} answers',
        )

    def connect(self, peer) -> None:
        """Wait until the answers arrive here, found out by messages that do not count."""
        peer.connect(probes=False)
        for number in range(1, 1000):
            probe = rotor_state(PROBES + number, position=[0.0])
            peer.send(probe)
            patience = time.monotonic() + 0.1 * number
            self.wait_until(
                lambda t=patience: all(self._probes.values()) or time.monotonic() > t, 'a probe'
            )
            if all(self._probes.values()):
                self.input.accept(serialize_message(probe), time.time_ns)
                return


def resident_memory(process) -> int:
    """Give it in bytes."""
    pages = Path(f'/proc/{process.pid}/statm').read_text().split()[1]
    return int(pages) * resource.getpagesize()


@pytest.mark.live
@pytest.mark.slow
def test_hostile_bytes_change_nothing(tmp_path):
    # The peer has nothing to listen to: the answers are kept as bytes.
    elsewhere = {topic: f'elsewhere/{topic}' for topic in STATES}
    with (
        live_node(tmp_path, *sum(starmap(parameter, LIMITS.items()), ()), **elsewhere) as live,
        closing(Answers(live.peer.namespace)) as answers,
    ):
        answers.connect(live.peer)
        # What the one sends never arrives, and what the other sends blocks what it sends next.
        other_type = answers.node.create_publisher(PoseArray, 'rotor_state', 10)
        other_driver = live.peer.node.create_publisher(JointState, 'rotor_state', 1)
        payloads, memory, last = Payloads(seed=1), 0, 0
        for number in range(COUNT + 1):
            # Two readings in a row by the clock would be as far apart as its process is busy.
            valid = number % VALID_EVERY == 0 or last >= FAR_FUTURE
            batch = [payloads.valid(last)] if valid else []
            for data in [*batch, payloads.hostile(last)]:
                if not answers.is_sure(data):
                    continue
                answers.expect(data)
                live.peer.send(data)
                last = answers.input.last.stamp
            if number % WAIT_EVERY == 0:
                answers.wait(live.peer)
                other_type.publish(PoseArray())
                other_driver.publish(b'')
            if number == COUNT // 10:
                memory = resident_memory(live.process)
        growth = resident_memory(live.process) - memory
        _, _, counts = live.peer.status(
            lambda status: any((p.key, p.value) == ('rate (Hz)', '0.0') for p in status.values),
            'a report on a second without input',
        )
        lines = live.lines()
    rejected = {f'rejected: {cause}': count for cause, count in answers.input.rejected.items()}
    expected = rejected | {
        'duplicate stamps': answers.input.duplicates,
        'zero stamps': answers.input.zero_stamps,
        'unnormalised stamps': answers.input.unnormalised_stamps,
        'clock resets': answers.input.resets,
    }
    assert len(rejected) >= 6
    assert {key: int(counts[key]) for key in expected} == expected
    for topic, messages in answers.received.items():
        for found, wanted in zip(messages, answers.expected[topic], strict=True):
            by_clock = struct.unpack_from('<iI', wanted, 4) == (0, 0)
            assert (stamped(found, 0) if by_clock else found) == wanted
    assert growth <= 2.5e6
    assert len(lines) == len(live.text().splitlines())
    for cause in rejected:
        warned = [line.time for line in lines if cause in line.text]
        assert len(warned) - 1 <= warned[-1] - warned[0] + 0.5  # one a second
