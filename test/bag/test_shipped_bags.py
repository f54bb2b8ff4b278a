# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The shipped bags: their outputs at 50 digits, and what their README says of them."""

import hashlib
import math
import re
from itertools import pairwise

import pytest
import replaying
import yaml
from rosbags.highlevel import AnyReader
from shipped_bags import BAGS

SHIPPED = {
    'servo_point_to_point': (3000, {}),
    'constant_speed_3000rpm': (3000, {}),
    'single_turn_encoder': (2500, {}),
    'driver_faults': (
        1265,
        {
            'out of order': 12,
            'position not finite': 12,
            'joint missing': 12,
            'position missing': 13,
        },
    ),
}
"""Numbers of outputs, and of rejected messages by cause."""


def read(name, topic) -> list[bytes]:
    with AnyReader([BAGS / name], default_typestore=replaying.TYPESTORE) as reader:
        connections = [c for c in reader.connections if c.topic == topic]
        return [bytes(data) for _, _, data in reader.messages(connections)]


@pytest.mark.slow
@pytest.mark.parametrize('name', SHIPPED)
def test_the_recorded_outputs_are_what_the_rotor_topic_calls_for(name):
    single_turn = name == 'single_turn_encoder'
    samples, rejected = replaying.valid_samples(
        read(name, '/rotor_state'), single_turn=single_turn
    )
    assert (len(samples), rejected) == SHIPPED[name]
    outputs = samples, read(name, '/output_state'), read(name, '/body_poses')
    assert len({*map(len, outputs)}) == 1
    # All are recomputed by two methods in test_validator.py, which needs less time than 50 digits.
    replaying.assert_right(*(each[::5] for each in outputs))
    # The rate is that of a real driver.
    steps = [b.stamp - a.stamp for a, b in pairwise(samples)]
    assert sorted(steps)[len(steps) // 2] <= replaying.SECOND / 500 * 1.01
    if single_turn:
        assert all(0.0 <= sample.position < math.tau for sample in samples)
        turns = [sample.turns for sample in samples]
        assert max(turns) >= 10
        assert min(turns) <= -10


@pytest.mark.parametrize('name', SHIPPED)
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
