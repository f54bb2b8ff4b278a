"""Bytes of every kind, into the node over DDS and into the harnesses of the fuzzer."""

import math
import random
import re
import resource
import struct
import time
from collections import Counter
from contextlib import ExitStack
from functools import cache
from itertools import pairwise
from pathlib import Path
from typing import NamedTuple

import numpy as np
import oracle
import pytest
import replaying
from diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from geometry_msgs.msg import Pose, PoseArray
from harnesses import harness
from live import DEADLINE, SECOND, START, STATES, live_node, rotor_bytes
from rclpy.qos import QoSProfile
from rclpy.serialization import serialize_message
from sensor_msgs.msg import Image, Imu, JointState
from std_msgs.msg import Header, String
from wire import micro_ros_bytes

from gear_kinematics.ros.live import replay_node
from gear_kinematics.ros.workarounds.executor import make_executor

ROOT = Path(__file__).resolve().parents[2]
FOREIGN = [
    serialize_message(message)
    for message in (
        String(data='rotor'), Header(frame_id='rotor'), PoseArray(poses=[Pose()] * 4), Image(),
        Imu(), DiagnosticArray(status=[DiagnosticStatus(name='rotor')]), KeyValue(key='rotor'),
    )
]  # fmt: skip
"""Messages of other types."""

CORPUS = sorted((ROOT / 'test' / 'corpus').glob('*/*'))

MUTATIONS, BATCH = 15_000, 20  # hostile payloads
COUNT = 100_000  # of them into the node
VALID_EVERY = 20  # of them comes a valid message
WINDOW = 1000  # messages that the node may be behind: half of what its queue holds
STEP = SECOND // 1000
FAR_FUTURE = 10**18  # ns: beyond all stamps that valid messages have, and before the clock's
GREATEST = 1e300  # velocities and efforts beyond count as not finite
LARGEST = 2**51 * math.tau  # rad: beyond it a position is too large
COUNTED = re.compile('received|published|rejected: .*|.* stamps|clock resets')
NUMBERS = (
    *(math.nan, math.inf, -math.inf, 1.7e308, -1e301, 1e300, 1e17, 5e-324, -0.0),
    *(-LARGEST, LARGEST, math.nextafter(LARGEST, math.inf)),
)


@pytest.mark.parametrize('file', CORPUS, ids=lambda file: f'{file.parent.name}-{file.name}')
def test_corpus_of_the_fuzzer(file):
    harness(file.parent.name).check(file.read_bytes())


class Answer(NamedTuple):
    """What a message calls for."""

    stamp: int
    """ns; 0 stands for the node's clock."""
    position: float
    velocity: float | None
    effort: float | None


class Contract:
    """The node's table of bad input, applied to messages as rclpy decodes them."""

    def __init__(self) -> None:
        self.counts = Counter()
        self.last = 0
        self._decode = harness('messages').reference_joint_state

    def answer(self, data: bytes) -> Answer | None:
        """Give the answer that a message calls for, and count what diagnostics count."""
        self.counts['received'] += 1
        message = self._decode(data)
        cause = self._fault(message)
        if cause in {'', 'out of order'}:
            order = '<' if data[1] & 1 else '>'
            (nanoseconds,) = struct.unpack_from(f'{order}I', data, 8)
            self.counts['unnormalised stamps'] += nanoseconds >= SECOND
        if cause:
            self.counts[f'rejected: {cause}'] += 1
            return None
        stamp = message.stamp or time.time_ns()
        self.counts['zero stamps'] += not message.stamp
        self.counts['duplicate stamps'] += stamp == self.last
        self.counts['clock resets'] += stamp < self.last - SECOND
        self.counts['published'] += 1
        self.last = stamp
        index = message.names.index(b'rotor')
        rates = (
            values[index] if index < len(values) and abs(values[index]) <= GREATEST else None
            for values in (message.velocity, message.effort)
        )
        return Answer(message.stamp, message.position[index], *rates)

    def _fault(self, message) -> str:
        if message is None:
            return 'not a JointState'
        if message.stamp >= 2**31 * SECOND:
            return 'stamp out of range'
        if b'rotor' not in message.names:
            return 'joint missing'
        index = message.names.index(b'rotor')
        if index >= len(message.position):
            return 'position missing'
        if not math.isfinite(message.position[index]):
            return 'position not finite'
        if abs(message.position[index]) > LARGEST:
            return 'position too large'
        if message.stamp and 0 < self.last - message.stamp <= SECOND:
            return 'out of order'
        return ''


class Payloads:
    """Valid messages, and hostile bytes that were such; the same ones for the same seed."""

    def __init__(self, seed: int) -> None:
        self._random = random.Random(seed)  # noqa: S311, no cryptography
        self._stamp = START
        self._messages = [self._message() for _ in range(300)]
        # Those that leave most messages valid take turns with twice as many that leave few.
        self._mutations = (
            *(self._flip, self._extend, self._change_number, self._change_stamp),
            *(self._cut, self._lengthen, self._swap_order, self._splice, self._noise) * 2,
            *(self._foreign, self._change_encapsulation) * 2,
        )

    def valid(self, last: int) -> bytes:
        """Give a message that is valid behind any other, the `last` accepted stamp of which, ns.

        It is later, or, behind the clock's and all those far in the future, earlier by years.
        """
        self._stamp = last + STEP if START <= last < FAR_FUTURE else START
        return stamped(self._random.choice(self._messages), self._stamp)

    def hostile(self) -> bytes:
        """Give bytes that may be anything; never none, which the middleware does not deliver."""
        r = self._random
        age = r.choice((-STEP, -STEP, -STEP, 0, SECOND // 2, SECOND, SECOND + 1, 9 * SECOND))
        stamp = r.choice((0, *[self._stamp - age] * 9))
        # Few, since each of their numbers with a bit flipped is worked out at 50 digits.
        return r.choice(self._mutations)(stamped(r.choice(self._messages[:8]), stamp))

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

    def _cut(self, data: bytes) -> bytes:
        return data[: self._random.randrange(1, len(data))]

    def _extend(self, data: bytes) -> bytes:
        return data + self._random.randbytes(self._random.choice((1, 3, 4, 12, 15, 16, 64, 4096)))

    def _lengthen(self, data: bytes) -> bytes:
        length = self._random.choice((0, 1, 2, 7, 100, 2**16, 2**29, 2**31 - 1, 2**31, 2**32 - 1))
        return self._written(data, 4, struct.pack('<I', length))

    def _change_number(self, data: bytes) -> bytes:
        return self._written(data, 8, struct.pack('<d', self._random.choice(NUMBERS)))

    def _change_stamp(self, data: bytes) -> bytes:
        r = self._random
        seconds = r.choice((0, 99, 2**31 - 1, -1, -(2**31), r.randrange(2**31)))
        nanoseconds = r.choice((0, 1, SECOND - 1, SECOND, 2**31, 2**32 - 1))
        return data[:4] + struct.pack('<iI', seconds, nanoseconds) + data[12:]

    def _change_encapsulation(self, data: bytes) -> bytes:
        return data[:1] + bytes([self._random.choice((*range(14), 255))]) + data[2:]

    def _swap_order(self, data: bytes) -> bytes:
        return data[:1] + bytes([data[1] ^ 1]) + data[2:]

    def _splice(self, data: bytes) -> bytes:
        other = self._random.choice(self._messages[:8])
        return data[: self._random.randrange(1, len(data))] + other[self._random.randrange(12) :]

    def _noise(self, data: bytes) -> bytes:
        start = data[: self._random.choice((0, 4, 12, 24))]
        return start + self._random.randbytes(self._random.randrange(1, 300))

    def _foreign(self, _data: bytes) -> bytes:
        return self._random.choice(FOREIGN)

    def _written(self, data: bytes, size: int, value: bytes) -> bytes:
        """Write a value over one that is aligned as CDR aligns it."""
        place = 4 + size * self._random.randrange((len(data) - 4) // size)
        return data[:place] + value + data[place + size :]


def stamped(data: bytes, stamp: int) -> bytes:
    return data[:4] + struct.pack('<iI' if data[1] else '>iI', *divmod(stamp, SECOND)) + data[12:]


class Driver:
    """Sends messages to a node and keeps its answers beside those that the contract calls for.

    A context manager.
    """

    def __init__(self, peer) -> None:
        self.contract = Contract()
        self.expected: list[Answer] = []
        self.received: dict[str, list[bytes]] = {topic: [] for topic in STATES}
        self._peer = peer
        self._asked: list[int] = []
        self._resources = ExitStack()
        self.node = self._resources.enter_context(replay_node(peer.namespace))
        self._executor = make_executor(context=self.node.context)
        self._resources.callback(self._executor.shutdown)
        self._executor.add_node(self.node)
        for topic, kind in zip(STATES, (JointState, PoseArray, JointState), strict=True):
            keep = self.received[topic].append
            self.node.create_subscription(kind, topic, keep, QoSProfile(depth=2000), raw=True)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self._resources.close()

    def connect(self) -> None:
        """Wait until the node's answers arrive here, found out by messages that do not count."""
        self._peer.connect(probes=False)
        deadline = time.monotonic() + DEADLINE
        while not self._heard(self.contract.last):
            assert time.monotonic() < deadline, 'the node is not heard'
            self.contract.last += 1
            self._peer.send(rotor_bytes(self.contract.last, ['rotor'], [0.0]))
            pause = time.monotonic() + 0.1 * self.contract.last
            while time.monotonic() < pause and not self._heard(self.contract.last):
                self._spin()
        for messages in self.received.values():
            messages.clear()

    def send(self, data: bytes) -> None:
        """Send a message."""
        delivered = data + bytes(-len(data) % 4)  # the middleware fills words up
        if answer := self.contract.answer(delivered):
            self.expected.append(answer)
            self._asked.append(self.contract.counts['received'])
        self._peer.send(data)

    def wait(self, but: int = 0) -> None:
        """Receive until all messages but a few are behind the node, as its answers tell."""
        deadline = time.monotonic() + DEADLINE
        while self._unanswered() > but:
            assert time.monotonic() < deadline, f'{self._unanswered()} messages are unanswered'
            self._spin()

    def counts(self) -> Counter:
        """Give what diagnostics count, from a report on a second without input."""

        def idle(status):
            values = {pair.key: pair.value for pair in status.values}
            return values['rate (Hz)'] == '0.0' and int(values['received']) >= at_least

        at_least = self.contract.counts['received'] + 1
        _, _, values = self._peer.status(idle, 'a report without input')
        return Counter({key: int(values[key]) for key in values if COUNTED.match(key)})

    def _unanswered(self) -> int:
        answered = min(map(len, self.received.values()))
        if answered == len(self.expected):
            return 0
        return self.contract.counts['received'] - self._asked[answered] + 1

    def _heard(self, stamp: int) -> bool:
        stamps = [{data[4:12] for data in messages} for messages in self.received.values()]
        return all(struct.pack('<iI', *divmod(stamp, SECOND)) in found for found in stamps)

    def _spin(self) -> None:
        assert self._peer.alive(), 'the node has ended'
        self._executor.spin_once(timeout_sec=0.02)


def resident_memory(process) -> int:
    """Give it in bytes."""
    pages = Path(f'/proc/{process.pid}/statm').read_text().split()[1]
    return int(pages) * resource.getpagesize()


@cache
def expected_motion(position: float) -> tuple[float, list[float]]:
    """Give the output angle, and the poses as in a PoseArray."""
    angle = -4 * oracle.rotor_angle_of(position) / 76
    cosine, sine = oracle.mp.cos_sin(angle / 2)
    branches = replaying.expected_motion(position, 0).branches
    centres = [branch.satellite_centre for branch in branches]
    centres += [branch.oldham_centre for branch in branches]
    return float(angle), [float(n) for c in centres for n in (*c, 0, 0, sine, cosine)]


def assert_answered(driver, started: int) -> None:
    """Hold every answer, in order, against what the contract calls for and the oracle."""
    decode = harness('messages')
    states, joints = (
        [decode.reference_joint_state(data) for data in driver.received[topic]]
        for topic in ('output_state', 'mechanism_joint_states')
    )
    arrays = [decode.reference_pose_array(data) for data in driver.received['body_poses']]
    expected = driver.expected
    assert len(states) == len(joints) == len(arrays) == len(expected)

    stamps = np.array([answer.stamp for answer in expected])
    for messages in (states, joints, arrays):
        found = np.array([message.stamp for message in messages])
        by_clock = (started <= found) & (found <= time.time_ns())
        assert np.where(stamps == 0, by_clock, found == stamps).all()

    position, velocity, effort = np.array([answer[1:] for answer in expected], float).T
    motions = [expected_motion(answer.position) for answer in expected]
    angle = np.array([angle for angle, _ in motions])
    assert {state.names for state in states} == {(b'output_shaft',)}
    assert_near(column(states, 'position'), angle)
    assert_near(column(states, 'velocity'), velocity / -19.0)
    with np.errstate(over='ignore'):
        assert_near(column(states, 'effort'), effort * -19.0)
    [names] = {state.names for state in joints}
    assert_near(column(joints, 'position', names.index(b'rotor')), position)
    assert_near(column(joints, 'position', names.index(b'output_shaft')), angle)

    assert {array.frame_id for array in arrays} == {b'stator'}
    poses = np.array([array.numbers for array in arrays]).reshape(-1, 4, 7)
    wanted = np.array([numbers for _, numbers in motions]).reshape(-1, 4, 7)
    assert (poses[..., 6] >= 0.0).all()
    wanted[..., 3:] *= np.where(wanted[..., 6:] < 0.0, -1.0, 1.0)
    tolerance = replaying.BOUND * np.array([replaying.ACTUATOR.eccentricity] * 3 + [1.0] * 4)
    assert (np.abs(poses - wanted) <= tolerance).all()


def column(messages, field: str, index: int = 0) -> np.ndarray:
    """Give a number of each message; NaN where the field is empty."""
    return np.array([(getattr(message, field) or [math.nan] * 9)[index] for message in messages])


def assert_near(found, expected) -> None:
    """Compare to 2 ulp; NaN is NaN, and infinity infinity."""
    assert found.shape == expected.shape
    with np.errstate(invalid='ignore'):
        near = np.abs(found - expected) <= 2.0 * np.spacing(np.abs(expected))
    assert (near | (found == expected) | (np.isnan(found) & np.isnan(expected))).all()


@pytest.mark.slow
def test_mutated_messages_are_read_as_rclpy_reads_them():
    messages, payloads = harness('messages'), Payloads(seed=2)
    taken = 0
    for _ in range(MUTATIONS // BATCH):
        batch = [payloads.hostile() for _ in range(BATCH)]
        messages.check(messages.SEPARATOR.join(batch))
        taken += sum(messages.reference_joint_state(data) is not None for data in batch)
    assert 0.1 * MUTATIONS < taken < 0.9 * MUTATIONS


@pytest.mark.live
@pytest.mark.slow
def test_hostile_bytes_change_nothing(tmp_path):
    # The peer has nothing to listen to: the driver keeps all as bytes.
    elsewhere = {topic: f'elsewhere/{topic}' for topic in STATES}
    with live_node(tmp_path, **elsewhere) as live, Driver(live.peer) as driver:
        driver.connect()
        other_type = driver.node.create_publisher(PoseArray, 'rotor_state', 10)
        # What it sends never arrives, and stands in the way of what it sends next.
        other_driver = live.peer.node.create_publisher(JointState, 'rotor_state', 1)
        payloads, started, memory = Payloads(seed=1), time.time_ns(), 0
        for number in range(COUNT):
            if number % VALID_EVERY == 0:
                driver.send(payloads.valid(driver.contract.last))
            driver.send(payloads.hostile())
            if number % 100 == 0:
                driver.wait(but=WINDOW)
            if number % 1000 == 0:
                other_type.publish(PoseArray())
                other_driver.publish(b'')
            if number == COUNT // 10:
                memory = resident_memory(live.process)
        driver.send(payloads.valid(driver.contract.last))
        driver.wait()
        growth = resident_memory(live.process) - memory
        counts = driver.counts()
        counts.subtract(driver.contract.counts)
        answered_probes = {'received': counts['received'], 'published': counts['received']}
        assert {key: count for key, count in counts.items() if count} == answered_probes
        assert_answered(driver, started)
        lines = live.lines()
    assert growth <= 10e6
    assert len(lines) == len(live.text().splitlines())
    rejects = [line.time for line in lines if 'rejected' in line.text]
    assert min(after - before for before, after in pairwise(rejects)) > 0.95
