# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""One actuator: the same results to the last bit from single messages and from batches.

It holds for all that a room below decodes, judges, counts, corrects, loads or encodes in batches.
"""

import math
import struct
from contextlib import suppress
from dataclasses import replace
from functools import cache, partial
from itertools import pairwise

import numpy as np
import pytest
from calibrations import calibration
from hypothesis import given, settings
from hypothesis import strategies as st
from live import SECOND, rotor_bytes
from wire import micro_ros_bytes

from gear_kinematics.kinematics import Branch
from gear_kinematics.kinematics.loads import Bodies
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.state.gear_state import GearState
from gear_kinematics.wire.joint_reader import JointReader, RejectedInputError

ROTOR, ENCODER = '/rotor_state', '/output_encoder'
TOPICS = (
    *('output_state', 'body_poses', 'corrected_state', 'corrected_interval'),
    *('branch_loads', 'joint_loads'),
)
START, PERIOD = 100 * SECOND, SECOND // 100
MULTI = NodeParameters.load()
BRACED = {'preload': 3.0, 'branch_stiffness': (2000.0,), 'loads': Bodies(0.05, 2e-5, 0.02, 3e-6)}
ABSOLUTE = {
    'output_encoder_reference': 'absolute',
    'transmission_error_limit': 0.05,
    'transmission_error_max_gap': 0.02,
}
AHEAD = 20  # periods by which the clock of the output's encoder is
BRANCHES = tuple(Branch(name, 2.1 * k, 0.01 * k) for k, name in enumerate('abc'))
KINDS = {
    'multi-turn': MULTI,
    'with loads': replace(MULTI, **BRACED),
    'range and torque': replace(MULTI, rotor_encoder_range=25.0, rotor_effort_factor=0.5),
    'single-turn': replace(MULTI, rotor_encoder='single_turn', rotor_direction=-1, rotor_zero=0.3),
    'referenced turns': replace(MULTI, rotor_encoder='single_turn', **ABSOLUTE),
    'referenced zero': replace(MULTI, **ABSOLUTE),
    'another mechanism': replace(MULTI, branches=BRANCHES, output_joint='wrist', rotor_joint=''),
}
ODD = rotor_bytes(START, position=[0.3])
CHANGES = {
    'jump': {'offset': 100.0},
    'far jump': {'offset': 6e9},
    'stray': {'position': 1e4},
    'not finite': {'position': math.nan},
    'no velocity': {'velocity': None},
    'no effort': {'effort': None},
    'huge effort': {'effort': 1e300},
    'unstamped': {'stamp': 0},
    'repeated': {'step': 0, 'late': 1},
    'out of order': {'step': -SECOND // 2},
    'clock reset': {'step': -5 * SECOND},
    'gap': {'step': 3 * SECOND},
    'other joint': {'names': 'other'},
    'two names': {'names': 'rotor other'},
    'no message': {'data': b'no message'},
    'empty': {'data': b''},
    'too large': {'position': 1e17},
    'big-endian': {'data': rotor_bytes(START, position=[1.0], little_endian=False)},
    'unnormalised': {'data': ODD[:4] + struct.pack('<iI', 99, 3 * SECOND) + ODD[12:]},
    'micro-ROS': {'data': micro_ros_bytes(START + 1, ['rotor'], [0.5], [1.0], [])},
}
COUNTS = (
    *('received', 'rejected', 'of_others', 'duplicates', 'zero_stamps', 'unnormalised_stamps'),
    *('resets', 'missing_joint', 'last', 'zero', 'origin', 'segment', 'referenced'),
)


@cache
def message(stamp, names, *numbers):
    return rotor_bytes(stamp, names.split(), *([] if n is None else [n] for n in numbers))


def messages(changes, factor, encoder_every):
    """A rotor that swings, changed at places, and every so many times the output's encoder.

    Velocities and efforts are in another unit, by a factor.
    """
    found, stamp, offset = [], START, 0.0
    for k in range(150):
        change = CHANGES.get(changes.get(k), {})
        phase = 0.012 * (k - change.get('late', 0))
        state = {'position': 30.0 * math.sin(phase), 'velocity': 36.0 * factor * math.cos(phase)}
        state |= {
            'step': PERIOD,
            'names': 'rotor',
            'effort': factor * math.cos(3.0 * phase),
            'offset': 0.0,
        }
        state |= change
        stamp += state['step']
        offset += state['offset']
        numbers = state['position'] + offset, state['velocity'], state['effort']
        data = message(state.get('stamp', stamp), state['names'], *numbers)
        found.append((ROTOR, stamp + 1000, state.get('data', data)))
        found.append(('/other', stamp, b''))
        if encoder_every and k % encoder_every == 0:
            angle = -30.0 / 19.0 * math.sin(phase + 0.012 * AHEAD)
            found.append((ENCODER, stamp + 2000, message(stamp + AHEAD * PERIOD, 'shaft', angle)))
    return found


def read(data):
    """Return the decoded values of a valid message, which a reader of several joints has."""
    try:
        return JointReader('rotor').read(data)
    except RejectedInputError:
        return data


def one_by_one(gear, part, read=bytes):
    """What `batch` and `encode_batch` return, from single messages."""
    samples, corrections, errors, encoded = [], [], [], []
    for row, (topic, received, data) in enumerate(part):
        with suppress(RejectedInputError):
            if topic == ENCODER:
                errors += gear.encoder(data, partial(int, received))
            elif topic == ROTOR:
                sample = gear.rotor(read(data), partial(int, received))
                stamp, position, *both = sample
                numbers = [math.nan if each is None else each for each in both]
                state = row, received, gear.segment, gear.referenced
                samples.append((stamp, *map(float, position), *numbers, *state))
                corrections.append(gear.correction)
                errors += gear.errors
                encoded.append(dict(gear.encode()))
    return samples, corrections, errors, encoded


@pytest.mark.parametrize('kind', KINDS)
@settings(max_examples=50)
@given(
    st.dictionaries(st.integers(0, 149), st.sampled_from([*CHANGES]), max_size=6),
    st.sampled_from([1.0, 0.0, 9.55]),
    st.sampled_from([0, 1, 2, 60]),
    st.lists(st.integers(0, 450), max_size=4),
)
def test_many_messages_at_once_give_what_each_gives(kind, changes, factor, encoder_every, cuts):
    """Positions, velocities, corrections, loads, errors and all counts."""
    single, many = (GearState(KINDS[kind], calibration()) for _ in range(2))
    single.choose(TOPICS)
    many.choose(TOPICS)
    everything = messages(changes, factor, encoder_every)
    for k, (begin, end) in enumerate(pairwise(sorted({0, *cuts, len(everything)}))):
        part = everything[begin:end]
        expected = one_by_one(single, part)
        if k % 2:  # a batch and single messages can follow each other
            assert repr(one_by_one(many, part, read)) == repr(expected)  # NaN is NaN, 0 is not -0
            continue
        samples, corrections, errors, encoded = expected
        found = many.batch(part, ROTOR, ENCODER)
        columns = zip(*(column.tolist() for column in found.samples[:9]), strict=True)
        assert repr([*columns]) == repr(samples)
        np.testing.assert_array_equal(
            np.transpose(found.correction), np.reshape(corrections, (-1, 4)), strict=True
        )
        assert found.errors == errors
        for topic, data in many.encode_batch(found).items():
            assert data == [each.get(topic, b'') for each in encoded]
    for count in COUNTS:
        assert getattr(many.input, count) == getattr(single.input, count)
    for part in ('plausibility', 'velocity_field', 'effort_field', 'turns'):
        # But for what makes single messages faster, and what is said of batches only.
        apart = {'_even': None, '_most': None}
        states = [vars(getattr(each.input, part)) | apart for each in (many, single)]
        assert repr(states[0]) == repr(states[1])
    assert many.output_encoder.comparison.matched == single.output_encoder.comparison.matched
