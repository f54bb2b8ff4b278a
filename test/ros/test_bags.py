"""Recorded bags, replayed through the core and into the real node over DDS."""

import hashlib
import math
import re
import time
from collections import Counter
from dataclasses import dataclass, field
from itertools import pairwise
from pathlib import Path

import oracle
import pytest
import replaying
import yaml
from rosbags.convert import convert
from rosbags.highlevel import AnyReader
from shipped_bags import BAGS

from gear_kinematics.kinematics import RotorTurns, solve
from gear_kinematics.ros.live import Replay, running_node


@dataclass(frozen=True)
class Recording:
    """A bag, and facts about it from its README or from the data itself."""

    name: str
    messages: int
    """Rotor messages in it."""
    compared: int
    """Rotor messages that have an output."""
    topic: str = '/rotor_state'
    joint: str = 'rotor'
    single_turn: bool = False
    speed_up: float = 1.0
    """Of the replay into the node."""
    rejected: dict[str, int] = field(default_factory=dict)


SHIPPED = [
    Recording('servo_point_to_point', 3000, 3000),
    Recording('constant_speed_3000rpm', 3000, 3000),
    Recording('single_turn_encoder', 2500, 2500, single_turn=True),
    Recording(
        'driver_faults',
        1314,
        1265,
        rejected={
            'out of order': 12,
            'position not finite': 12,
            'joint missing': 12,
            'position missing': 13,
        },
    ),
]
REAL = [
    Recording('feetech_servos', 954, 954, '/servo/out/state', 'q0', speed_up=10.0),
    Recording('pr2_joints', 1325, 1325, '/joint_states', 'laser_tilt_mount_joint', speed_up=4.0),
]


@pytest.fixture(
    scope='module', params=SHIPPED + REAL, ids=[recording.name for recording in SHIPPED + REAL]
)
def recording(request) -> Recording:
    return request.param


@pytest.fixture(scope='module')
def bag_path(recording, shared_path, tmp_path_factory) -> Path:
    """The bag itself; a ROS 1 bag converted by rosbags."""
    if recording in SHIPPED:
        return BAGS / recording.name
    source = shared_path(f'data/bags/{recording.name}')
    (ros1, *_) = [*source.glob('*.bag'), None]
    if ros1 is None:
        return source
    converted = tmp_path_factory.mktemp('converted') / recording.name
    convert(
        [ros1],
        converted,
        dst_storage='mcap',
        dst_version=9,
        compress=None,
        compress_mode='none',
        default_typestore=None,
        typestore=replaying.TYPESTORE,
        exclude_topics=[],
        include_topics=[recording.topic],
        exclude_msgtypes=[],
        include_msgtypes=[],
    )
    return converted


@pytest.fixture(scope='module')
def rotor_messages(recording, bag_path) -> list[tuple[int, bytes]]:
    messages = read(bag_path, recording.topic)
    assert len(messages) == recording.messages
    return messages


@pytest.fixture(scope='module')
def samples(recording, rotor_messages) -> list[replaying.Sample]:
    valid, rejected = replaying.valid_samples(
        [data for _, data in rotor_messages],
        joint=recording.joint,
        single_turn=recording.single_turn,
    )
    assert len(valid) == recording.compared
    assert rejected == recording.rejected
    return valid


def read(path: Path, topic: str) -> list[tuple[int, bytes]]:
    with AnyReader([path], default_typestore=replaying.TYPESTORE) as reader:
        connections = [c for c in reader.connections if c.topic == topic]
        return [(received, bytes(data)) for _, received, data in reader.messages(connections)]


@pytest.mark.slow
def test_the_core_gives_what_the_rotor_topic_calls_for(recording, samples, actuator):
    turns = RotorTurns(single_turn=recording.single_turn, max_speed=650.0, max_acceleration=6500.0)
    positions = []
    for sample in samples:
        turns.update(sample.position, sample.stamp, sample.velocity)
        positions.append(turns.relative_to(0.0, 1))
    state = solve(actuator, [p.angle for p in positions], rotor_turns=[p.turns for p in positions])
    worst = replaying.Worst()
    compared = 0
    for k, sample in enumerate(samples):
        expected = replaying.expected_motion(sample.position, sample.turns)
        worst.add_angle(oracle.angle_error(state.output_angle[k], expected.output_angle))
        for b, branch in enumerate(expected.branches):
            for actual, centre in (
                (state.satellite_centre, branch.satellite_centre),
                (state.oldham_centre, branch.oldham_centre),
            ):
                worst.add_position(oracle.point_error(actual[k, b], centre, 0.0011))
        compared += 1
    assert compared == recording.compared
    assert worst.angle <= replaying.BOUND
    assert worst.position <= replaying.BOUND


@pytest.mark.slow
def test_the_node_publishes_what_the_rotor_topic_calls_for(
    recording, rotor_messages, samples, record_property
):
    namespace = f'/replay_{recording.name}'
    arguments = ['--ros-args', '-r', f'__ns:={namespace}', '-p', f'rotor_joint:={recording.joint}']
    if recording.single_turn:
        arguments += ['-p', 'rotor_encoder:=single_turn']
    with running_node(arguments), Replay(namespace) as replay:
        replay.wait_for_node(recording.joint)
        begin, start = rotor_messages[0][0], time.monotonic()
        for received, data in rotor_messages:
            replay.receive_until(start + (received - begin) * 1e-9 / recording.speed_up)
            replay.send(data)
        wanted = {
            '/rotor_state': recording.messages,
            '/output_state': recording.compared,
            '/body_poses': recording.compared,
        }
        replay.wait_until(lambda: Counter(topic for topic, *_ in replay.received) == wanted, 10.0)
        received = {
            topic: [data for name, _, data in replay.received if name == topic] for topic in wanted
        }
    worst = replaying.compare_messages(samples, received['/output_state'], received['/body_poses'])
    record_property('worst_angle', worst.angle)
    record_property('worst_position', worst.position)
    assert worst.angle <= replaying.BOUND
    assert worst.position <= replaying.BOUND


@pytest.mark.slow
@pytest.mark.parametrize('recording', SHIPPED, ids=lambda r: r.name, scope='module')
def test_the_recorded_outputs_are_what_the_rotor_topic_calls_for(samples, bag_path):
    worst = replaying.compare_messages(
        samples,
        [data for _, data in read(bag_path, '/output_state')],
        [data for _, data in read(bag_path, '/body_poses')],
    )
    assert worst.angle <= replaying.BOUND
    assert worst.position <= replaying.BOUND


@pytest.mark.parametrize('recording', SHIPPED, ids=lambda r: r.name, scope='module')
def test_a_shipped_recording_was_made_at_the_rate_of_a_real_driver(samples):
    steps = [b.stamp - a.stamp for a, b in pairwise(samples)]
    assert sorted(steps)[len(steps) // 2] <= replaying.SECOND / 500 * 1.01


def test_the_single_turn_recording_wraps_and_returns():
    messages = [data for _, data in read(BAGS / 'single_turn_encoder', '/rotor_state')]
    samples, _ = replaying.valid_samples(messages, single_turn=True)
    assert all(0.0 <= sample.position < math.tau for sample in samples)
    turns = [sample.turns for sample in samples]
    assert max(turns) >= 10
    assert min(turns) <= -10


@pytest.mark.parametrize('name', [recording.name for recording in SHIPPED])
def test_shipped_bags_are_named_as_rosbag2_names_them(name):
    [file] = (BAGS / name).glob(f'{name}*')
    assert re.fullmatch(r'.+_(\d+)\.([a-zA-Z0-9])+', file.name)  # required by rosbag2's reindexer
    assert file.stem == f'{name}_0'
    document = yaml.safe_load((BAGS / name / 'metadata.yaml').read_text())
    metadata = document['rosbag2_bagfile_information']
    assert metadata['relative_file_paths'] == [file.name]
    assert [part['path'] for part in metadata['files']] == [file.name]
    assert f'relative_file_paths:\n- {file.name}\n'.encode() in file.read_bytes()  # its own copy


def test_shipped_bags_are_small_and_as_their_readme_says():
    stated = dict(
        re.findall(r'^([0-9a-f]{64})  (\S+)$', (BAGS / 'README.md').read_text(), re.MULTILINE)
    )
    files = [p for folder in BAGS.iterdir() if folder.is_dir() for p in folder.glob('*')]
    files = [path for path in files if path.suffix != '.pyc']
    assert {
        hashlib.sha256(path.read_bytes()).hexdigest(): path.relative_to(BAGS).as_posix()
        for path in files
    } == stated
    assert sum(path.stat().st_size for path in files) < 3_000_000
