"""Outputs against recomputed ones: what was changed in a recording is found."""

import struct
from pathlib import Path

import pytest

from gear_kinematics import parameters
from gear_kinematics.bag import BagError, BagMessage, read_bag, write_bag
from gear_kinematics.validation import validate

BAGS = Path(__file__).resolve().parents[1] / 'bags'
TOPICS = ('/rotor_state', '/output_state', '/body_poses')


@pytest.fixture(scope='module')
def config() -> dict:
    return parameters.load(parameters.default_config())


@pytest.fixture(scope='module')
def recorded() -> list[BagMessage]:
    return list(read_bag(BAGS / 'servo_point_to_point', TOPICS))[:900]


def change_number(data: bytes, value_offset: int, difference: float) -> bytes:
    """Add to a float64 that stands so far from the end of the message."""
    start = len(data) - value_offset
    (value,) = struct.unpack_from('<d', data, start)
    return data[:start] + struct.pack('<d', value + difference) + data[start + 8 :]


def change_one(messages: list[BagMessage], topic: str, change) -> list[BagMessage]:
    """Change the 100th message of a topic; None drops it, a list takes its place."""
    changed = []
    count = 0
    for message in messages:
        count += message.topic == topic
        if message.topic == topic and count == 100:
            changed += [message._replace(data=data) for data in change(message.data)]
        else:
            changed.append(message)
    return changed


def test_a_good_recording_agrees(recorded, config):
    validation = validate(recorded, config)
    assert validation.agrees(1e-12)
    assert [topic.compared for topic in validation.topics] == [300, 300]
    assert (validation.received, validation.rejected) == (300, 0)


def test_a_recording_of_faults_counts_the_rejected(config):
    validation = validate(read_bag(BAGS / 'driver_faults', TOPICS), config)
    assert validation.agrees(1e-12)
    assert (validation.received, validation.rejected) == (1314, 49)
    assert [topic.compared for topic in validation.topics] == [1265, 1265]


# From the end of an output_state: effort, its count and padding, velocity, likewise, position.
POSITION = 40
# From the end of body_poses: the last pose's quaternion and position, 7 numbers a pose.
LAST_W, LAST_Z_OF_QUATERNION, LAST_Y = 8, 16, 48


@pytest.mark.parametrize(
    ('topic', 'offset', 'difference', 'field', 'expected'),
    [
        ('/output_state', POSITION, 3e-12, 'worst_angle', 3e-12),
        ('/body_poses', LAST_Y, 3e-12 * 0.0011, 'worst_position', 3e-12),
        ('/body_poses', LAST_Z_OF_QUATERNION, 3e-12, 'worst_angle', 6e-12),
    ],
)
def test_a_number_that_is_off_is_found(
    recorded, config, topic, offset, difference, field, expected
):
    changed = change_one(recorded, topic, lambda data: [change_number(data, offset, difference)])
    validation = validate(changed, config)
    assert not validation.agrees(1e-12)
    assert validation.agrees(1e-11)
    (found,) = (t for t in validation.topics if t.topic == topic)
    assert getattr(found, field) == pytest.approx(expected, rel=0.02)


def test_a_message_that_lacks_or_is_too_many_is_found(recorded, config):
    for change, missing, extra in (
        (lambda _: [], 1, 0),
        (lambda data: [data, data], 0, 1),
    ):
        (state, poses) = validate(change_one(recorded, '/output_state', change), config).topics
        assert (state.missing, state.extra, state.agrees(1.0)) == (missing, extra, False)
        assert poses.agrees(1e-12)


def test_a_shifted_stamp_is_missing_and_extra(recorded, config):
    def shift(data: bytes) -> list[bytes]:
        seconds, nanoseconds = struct.unpack_from('<iI', data, 4)
        return [data[:4] + struct.pack('<iI', seconds, nanoseconds - 1) + data[12:]]

    _, poses = validate(change_one(recorded, '/body_poses', shift), config).topics
    assert (poses.missing, poses.extra, poses.compared) == (1, 1, 299)


def test_a_negated_quaternion_is_the_same_rotation(recorded, config):
    def negate(data: bytes) -> list[bytes]:
        for offset in (LAST_W, LAST_Z_OF_QUATERNION):
            (value,) = struct.unpack_from('<d', data, len(data) - offset)
            data = change_number(data, offset, -2.0 * value)
        return [data]

    assert validate(change_one(recorded, '/body_poses', negate), config).agrees(1e-12)


def test_another_mechanism_does_not_agree(recorded, config):
    assert not validate(recorded, {**config, 'ring_teeth': 81}).agrees(1e-3)


def test_nothing_recorded_does_not_agree(config):
    assert not validate([], config).agrees(1.0)


def test_a_topic_that_is_not_in_the_bag_is_named():
    with pytest.raises(BagError, match=r'servo_point_to_point.*no messages on /nothing'):
        list(read_bag(BAGS / 'servo_point_to_point', ['/nothing']))


def test_a_bag_that_is_not_there_is_named(tmp_path):
    with pytest.raises(BagError, match='nowhere'):
        list(read_bag(tmp_path / 'nowhere', TOPICS))


@pytest.mark.parametrize('storage', ['mcap', 'sqlite3'])
def test_written_bags_are_read_back(recorded, tmp_path, storage):
    write_bag(tmp_path / 'bag', recorded, storage=storage)
    assert list(read_bag(tmp_path / 'bag', TOPICS)) == recorded
