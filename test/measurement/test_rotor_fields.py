# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Velocities and efforts of drivers that are no rad/s and N·m of the rotor."""

import math
import re
from dataclasses import replace

import numpy as np
import pytest
from gear_recordings import Samples, write_recording
from live import rotor_bytes
from simulated_encoders import stamps

from gear_kinematics.bag import Bag
from gear_kinematics.commands.cli import main
from gear_kinematics.measurement.rotor_fields import questions, recorded_questions
from gear_kinematics.measurement.sentences import Observation
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.state.statuses import Condition

TIMES = np.arange(0.0, 8.0, 0.01)
OUTPUT = np.clip(np.abs(TIMES - 4.0) * -2.0 + 8.0, 0.0, 7.5)  # rad: there, a rest, and back
ROTOR = -19.0 * OUTPUT
SPEED = np.gradient(ROTOR, TIMES)
CONTRADICTS = 'the velocities contradict the positions: they seem to be '


def recorded(folder, factor, efforts, wrap):
    rotor = np.remainder(ROTOR + wrap / 2, wrap) - wrap / 2 if wrap else ROTOR
    messages = Samples(stamps(TIMES), rotor, efforts, velocities=factor * SPEED)
    return write_recording(folder / 'bag', messages, Samples(stamps(TIMES), OUTPUT))


@pytest.mark.parametrize('wrap', [0.0, math.tau, 25.0])
@pytest.mark.parametrize(
    ('factor', 'efforts', 'asked'),
    [
        (1.0, np.sin(TIMES), []),
        (0.0, None, [CONTRADICTS + '0']),
        (30.0 / math.pi, None, [CONTRADICTS + 'rpm']),
        (0.5 / math.pi, None, [CONTRADICTS + 'turns/s']),
        (180.0 / math.pi, None, [CONTRADICTS + 'deg/s']),
        (-1.0 / 19.0, None, [CONTRADICTS + 'the velocity of the output']),
        (-0.3, None, [CONTRADICTS + 'an unknown quantity, -0.3 times the slope']),
        (1.0, 0.0 * TIMES, ['the effort is 0 throughout the motion, and is taken as absent']),
        (1.0, 700.0 * np.sin(TIMES), ['efforts of up to 700 N·m at the rotor are more']),
    ],
)
def test_wrong_fields_are_named(factor, efforts, asked, wrap, tmp_path, capsys, monkeypatch):
    """By info, which does not know the ratio, and by commission."""
    path = recorded(tmp_path, factor, efforts, wrap)
    assert main(['info', str(path)]) == 0
    told = capsys.readouterr().out
    assert ('/rotor_state: ' in told) is bool(asked)
    if 'output' not in ''.join(asked):
        assert all(f'/rotor_state: {each}' in told for each in asked)
    monkeypatch.chdir(tmp_path)
    read, by_topic = [], Bag.by_topic
    monkeypatch.setattr(Bag, 'by_topic', lambda *a: read.append(a) or by_topic(*a))
    assert main(['commission', str(path)]) == 0
    assert len(read) == 1  # once for the encoders and for these fields
    told = capsys.readouterr().out
    if wrap == math.tau and CONTRADICTS in ''.join(asked):
        asked = [*asked, '100 Hz is too slow to count turns at a max_rotor_speed of 650 rad/s']
    assert [
        line[5 : 5 + len(want)] for line, want in zip(told.splitlines()[1:], asked, strict=True)
    ] == asked


def test_stamps_that_repeat_are_named(tmp_path):
    """8 different stamps of 800, as without their nanoseconds."""
    rotor = Samples(stamps(np.floor(TIMES)), ROTOR)
    path = write_recording(tmp_path / 'bag', rotor, Samples(stamps(TIMES), OUTPUT))
    with Bag(path) as bag:
        [(_, asked)] = recorded_questions(bag, '/rotor_state', {'rotor': None})
    assert asked == Observation.STAMPS_REPEAT(count=792, total=800)


def test_stamps_that_are_missing_are_named():
    data = [rotor_bytes(0, position=[float(position)]) for position in ROTOR]
    [asked] = questions(data, stamps(TIMES).tolist(), 'rotor')
    assert asked == Condition.UNSTAMPED(messages='800 messages')


@pytest.mark.parametrize('wrap', [0.0, math.tau, 25.0])
@pytest.mark.parametrize('readings', [0, 2, 300])
def test_steps_that_no_rotor_can_make_are_named(readings, wrap, tmp_path):
    """As of a corrupt reading, or a drive that restarts; wraps of the encoder are none."""
    positions = ROTOR.copy()
    positions[400 : 400 + readings] += 11.0 if wrap else 80.0
    wrapped = np.remainder(positions + wrap / 2, wrap) - wrap / 2 if wrap else positions
    rotor = Samples(stamps(TIMES), wrapped)
    path = write_recording(tmp_path / 'bag', rotor, Samples(stamps(TIMES), OUTPUT))
    with Bag(path) as bag:
        told = [
            str(asked) for _, asked in recorded_questions(bag, '/rotor_state', {'rotor': None})
        ]
    if not readings:
        assert told == []
    elif wrap:
        assert len(told) <= 1
    else:
        (said,) = told
        jumps = "the rotor's encoder jumped by -80 rad at"
        assert said.startswith('rejected: implausible 2' if readings < 3 else jumps)


def test_rejected_positions_and_a_clock_that_is_set_back_are_named():
    positions, stamped = ROTOR.copy(), stamps(TIMES)
    positions[[200, 300, 301]] = math.nan, math.inf, 1e300
    stamped[500:] -= 295_000_000
    pairs = zip(map(int, stamped), positions, strict=True)
    data = [rotor_bytes(stamp, position=[position]) for stamp, position in pairs]
    told = [*map(str, questions(data, [0] * len(data), 'rotor', steps=True))]
    assert told == [
        'rejected: position not finite 2, position too large 1, out of order 29',
        f'the clock was set back by at least 0.285 s just after {stamped[499] / 1e9:.3f} s',
    ]


def test_a_motor_that_only_sends_nan_is_named():
    """As one without power on the topic of an arm."""
    received = stamps(TIMES).tolist()
    data = [rotor_bytes(stamp, ['m1', 'm2'], [0.0, math.nan]) for stamp in received]
    asked = {
        joint: [*map(str, questions(data, received, joint, steps=True))] for joint in ('m1', 'm2')
    }
    assert asked == {'m1': [], 'm2': ['rejected: position not finite 800']}


def test_stamps_of_milliseconds_as_seconds_are_named():
    received = stamps(TIMES)
    data = [
        rotor_bytes(int(1000 * (stamp - received[0]) + 1), position=[position])
        for stamp, position in zip(received, ROTOR, strict=True)
    ]
    (told,) = questions(data, received.tolist(), 'rotor', steps=True)
    assert told.condition is Condition.STAMPS_TOO_FAST
    assert told.values == {'factor': pytest.approx(1000.0)}


@pytest.mark.parametrize('counts', [16384.0, 100.0])
def test_counts_of_an_encoder_are_named(counts):
    """They are no rad, unlike positions with one decimal, and those of a rotor at rest."""
    counted, radians = np.rint(ROTOR / math.tau * counts), np.round(ROTOR, 1)
    for positions, told in (counted, [Observation.COUNTS()]), (radians, []), (0.0 * ROTOR, []):
        pairs = zip(map(int, stamps(TIMES)), positions, strict=True)
        data = [rotor_bytes(stamp, position=[position]) for stamp, position in pairs]
        assert [*questions(data, [0] * len(data), 'rotor')] == told


@pytest.mark.parametrize('limits', [None, (650.0, 6500.0)])
def test_motion_beyond_the_limits_of_a_node_is_named(limits):
    """As of a driver that sends degrees; a recording alone has no limits."""
    degrees = np.degrees(100.0 * TIMES)
    data = [
        rotor_bytes(int(stamp), position=[float(position)])
        for stamp, position in zip(stamps(TIMES), degrees, strict=True)
    ]
    told = [
        str(each) for each in questions(data, [0] * len(data), 'rotor', None, limits, steps=True)
    ]
    said = '5730 rad/s exceed max_rotor_speed: let the driver send rad, stamped in s and ns, or '
    assert told == [f'{said}set the limit to that of the motor'] * bool(limits)


def test_two_drivers_of_one_joint_do_not_make_their_velocities_wrong():
    drivers = [(0, 0.0, 20.0), (3_100_000, 3.0, -35.0)]
    times = [
        (k * 8_000_000 + late, zero, speed) for k in range(1000) for late, zero, speed in drivers
    ]
    data = [
        rotor_bytes(10**9 + t, position=[zero + 1e-9 * speed * t], velocity=[speed])
        for t, zero, speed in times
    ]
    asked = [*questions(data, [10**9 + t for t, *_ in times], 'rotor', steps=True)]
    assert [each.condition for each in asked] == [Condition.JUMPED, Condition.TWO_MOTIONS]


def test_a_known_range_of_the_positions_is_used():
    """In readings at 40 Hz that come in bursts, wraps after 25 rad are no equal steps."""
    n = np.arange(320)
    turned = 2.5 * n + 3.0 * np.sin(n / 40)
    received = [10**9 + 55_000_000 * (-(-5 * k // 11)) + 1000 * k for k in n.tolist()]
    data = [
        rotor_bytes(t, position=[math.remainder(x, 25.0)], velocity=[100.0])
        for t, x in zip(received, turned, strict=True)
    ]
    parameters = replace(NodeParameters.load(), rotor_joint='rotor', rotor_encoder_range=25.0)
    parameters = replace(parameters, max_rotor_speed=200.0)
    assert not [*questions(data, received, 'rotor', steps=True, parameters=parameters)]


def test_other_joints_of_the_same_time_repeat_no_stamp():
    """As of an arm and its grippers, whose publishers share a topic."""
    data = [
        rotor_bytes(int(stamp), names=[name], position=[float(position)])
        for stamp, position in zip(stamps(TIMES), ROTOR, strict=True)
        for name in ('rotor', 'left_gripper', 'right_gripper')
    ]
    assert [*questions(data, [*range(len(data))], 'rotor')] == []


@pytest.mark.parametrize(
    ('rate', 'velocity', 'asked'),
    [
        (50, [], ['.*, or let the driver read and send at 259 Hz or more, or send velocities']),
        (50, [15.0], []),
        (
            50,
            [0.0],
            [
                CONTRADICTS + '0',
                '50 Hz is too slow .* to 126 rad/s or less, .*, or send velocities',
            ],
        ),
        (20, [15.0], ['20 Hz is too slow .* or let the driver read and send at 259 Hz or more']),
        (500, [], []),
    ],
)
def test_messages_too_few_for_turns_are_named_unless_velocities_help(rate, velocity, asked):
    times = np.arange(0.0, 4.0, 1.0 / rate)
    positions = np.mod(15.0 * times, math.tau)[:, np.newaxis].tolist()
    both = zip(map(int, stamps(times)), positions, strict=True)
    data = [rotor_bytes(stamp, position=position, velocity=velocity) for stamp, position in both]
    found = questions(data, [0] * len(data), 'rotor', None, (650.0, 6500.0))
    matches = [re.fullmatch(said, str(each)) for said, each in zip(asked, found, strict=True)]
    assert all(matches)


def test_noise_of_positions_at_a_steady_speed_is_no_delay_of_the_velocities():
    speed = np.minimum(np.arange(30_000) * 0.5, 50.0)
    noise = np.random.default_rng(1).uniform(-0.01, 0.01, (4, len(speed)))
    received = stamps(np.arange(len(speed)) / 100)
    for position in np.cumsum(speed) / 100 + noise:
        each = zip(received, position.tolist(), speed.tolist(), strict=True)
        data = [rotor_bytes(t, position=[p], velocity=[v]) for t, p, v in each]
        assert not [*questions(data, received, 'rotor')]


@pytest.mark.parametrize(('size', 'asked'), [(50.0, 0), (0.01, 1)])
def test_velocities_of_0_fit_a_rotor_that_stands_before_and_after_a_step(size, asked):
    """As of a driver that begins anew with another zero, unlike one that turns on."""
    steps = np.where(np.arange(800) == 400, 50.0, 0.0) + (size < 1.0) * size * np.arange(800)
    times, positions = np.arange(800) * 0.01 + 6.0 * (np.arange(800) >= 400), np.cumsum(steps)
    data = [
        rotor_bytes(t, position=[p], velocity=[0.0])
        for t, p in zip(stamps(times), positions, strict=True)
    ]
    found = [str(each) for each in questions(data, stamps(times), 'rotor')]
    assert found.count(CONTRADICTS + '0') == asked
