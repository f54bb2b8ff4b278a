# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Recordings by `ros2 bag record`: correct ones pass, and each fault is found."""

import math
import random
import struct
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
import replaying
from made_bags import folder, mcap_file, read
from replaying import SECOND
from rosbag2_recorder import Message, record
from rosbags.typesys import Stores, get_types_from_msg, get_typestore
from shipped_bags import BAGS, CONFIGS, JOINT_STATE, OUTPUT, POSES, ROTOR, TYPES, read_bag
from validating import validate

from gear_kinematics.bag.roles import Topics
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.report.document import Verdict
from gear_kinematics.validation.causes import FindingCause
from gear_kinematics.validation.findings import findings
from gear_kinematics.validation.recorder import BACK, BEFORE, NO_INPUT
from gear_kinematics.validation.report import Finding
from gear_kinematics.validation.task import Task
from gear_kinematics.validation.validate_bag import validate_bag

RECORDED = BAGS.parents[1] / 'shared' / 'data' / 'recorded'
TOPICS = (ROTOR, OUTPUT, POSES)
RATES = {  # Hz: a recording, and which of its messages; the output follows from each alone
    50: ('servo_point_to_point', 10),
    100: ('servo_point_to_point', 5),
    200: ('constant_speed_3000rpm', 5),
    500: ('servo_point_to_point', 1),
    1000: ('constant_speed_3000rpm', 1),
}


@pytest.fixture(scope='module')
def traffic() -> dict[int, list[Message]]:
    """The messages of 6 s at each rate."""

    def at(name: str, every: int) -> list[Message]:
        messages = [Message(*message) for message in read_bag(BAGS / name)]
        count = dict.fromkeys(TOPICS, 0)
        kept = []
        for message in messages:
            if count[message.topic] % every == 0:
                kept.append(message)
            count[message.topic] += 1
        length = messages[-1].received - messages[0].received + 2_000_000
        times = math.ceil(6 * SECOND / length)
        return [shifted(m, k * length) for k in range(times) for m in kept]

    return {rate: at(*source) for rate, source in RATES.items()}


@pytest.fixture(scope='module')
def config() -> NodeParameters:
    """Without limits, as the rotor is taken back in no time where a recording is repeated."""
    return replace(NodeParameters.load(), max_rotor_speed=1e6, max_rotor_acceleration=1e9)


def shifted(message: Message, nanoseconds: int) -> Message:
    """Return a message at another time."""
    stamp = stamp_of(message) + nanoseconds
    data = bytearray(message.data)
    struct.pack_into('<iI', data, 4, *divmod(stamp, SECOND))
    return Message(message.topic, message.received + nanoseconds, bytes(data))


def stamp_of(message: Message) -> int:
    seconds, nanoseconds = struct.unpack_from('<iI', message.data, 4)
    return seconds * SECOND + nanoseconds


def recording(traffic: dict[int, list[Message]], seed: int) -> list[Message]:
    """Record from before, or up to a second after, the start of the node to before its end."""
    rng = random.Random(seed)  # noqa: S311, of faults, not of secrets
    rate = list(RATES)[seed % len(RATES)]
    messages = traffic[rate]
    start, end = messages[0].received, messages[-1].received
    node_is_late = rng.random() < 0.3
    if node_is_late:
        begun = start + SECOND
        messages = [m for m in messages if m.topic == ROTOR or m.received > begun]
    first = rng.random() < 0.5
    return record(
        messages,
        rng,
        begin=start - SECOND if first else start + round(rng.uniform(0.0, 1.0) * SECOND),
        end=end + SECOND if rng.random() < 0.3 else end - SECOND // 3,
        late=rng.choice([0.004, 0.03, 0.7]),
    )


@pytest.mark.parametrize('seed', range(20))
def test_losses_of_the_recorder_fail_nothing(traffic, config, seed):
    messages = recording(traffic, seed)
    report = validate(messages, config)
    assert report.verdict == Verdict.PASS
    there = {topic: {stamp_of(m) for m in messages if m.topic == topic} for topic in TOPICS}
    for topic in report.topics:
        own = there[topic.topic]
        assert topic.compared == len(own & there[ROTOR])
        left_out = len(own - there[ROTOR]) + len(there[ROTOR] - own)
        assert sum(topic.left_out.values()) == left_out
        assert topic.compared > 0.5 * len(own)
    strict = validate(messages, config, strict=True)
    assert [t.missing + t.extra for t in strict.topics] == [
        sum(t.left_out.values()) for t in report.topics
    ]


# Faults


def edited(message: Message, edit) -> Message:
    return message._replace(data=replaying.edited(message.data, TYPES[message.topic], edit))


def turn_a_little(content) -> None:
    content.position = content.position + 1e-6


def swap_satellites(content) -> None:
    content.poses[0], content.poses[1] = content.poses[1], content.poses[0]


def one_changed(messages: list[Message], topic: str, place: float, edit) -> list[Message]:
    """Change the message at a relative place among those of a topic with an input."""
    there = {stamp_of(m) for m in messages if m.topic == ROTOR}
    own = [k for k, m in enumerate(messages) if m.topic == topic and stamp_of(m) in there]
    chosen = own[round(place * (len(own) - 1))]
    return [edited(m, edit) if k == chosen else m for k, m in enumerate(messages)]


def settled_by(messages: list[Message]) -> int:
    """A second after the last topic began, ns, from which on no loss is excused."""
    return max(next(m.received for m in messages if m.topic == t) for t in TOPICS) + SECOND


def moment(messages: list[Message], place: float) -> int:
    """A time at which outputs are always judged, ns."""
    begin, end = settled_by(messages), messages[-1].received
    return begin + round(place * (end - SECOND // 3 - begin))


def five_poses_missing(messages: list[Message], place: float) -> list[Message]:
    after = moment(messages, place)
    own = [k for k, m in enumerate(messages) if m.topic == POSES and m.received > after][:5]
    return [m for k, m in enumerate(messages) if k not in own]


def doubled(messages: list[Message], place: float) -> list[Message]:
    there = {stamp_of(m) for m in messages if m.topic == ROTOR}
    own = [k for k, m in enumerate(messages) if m.topic == OUTPUT and stamp_of(m) in there]
    first = round(place * (len(own) - 10))
    chosen = set(own[first : first + 10])
    return [m for k, m in enumerate(messages) for _ in range(1 + (k in chosen))]


def node_killed(messages: list[Message], place: float) -> list[Message]:
    last = moment(messages, 0.6 * place + 0.1)
    return [m for m in messages if m.topic == ROTOR or m.received <= last]


FAULTS = {
    'angle off by 1e-6': (
        lambda messages, place: one_changed(messages, OUTPUT, place, turn_a_little),
        'position: error 1e-6 rad at ',
    ),
    'satellites swapped': (
        lambda messages, place: one_changed(messages, POSES, place, swap_satellites),
        'exceeds the tolerance of the position',
    ),
    'five poses missing': (five_poses_missing, '5 messages missing'),
    'doubled outputs': (doubled, '10 messages too many'),
    'node killed': (node_killed, 'the node may have ended, or lagged behind'),
}


@pytest.mark.parametrize('place', [0.0, 0.5, 1.0], ids=['beginning', 'middle', 'end'])
@pytest.mark.parametrize('fault', FAULTS)
@pytest.mark.parametrize('seed', range(5))
def test_a_fault_is_found_wherever_it_is(traffic, config, seed, fault, place):
    change, said = FAULTS[fault]
    report = validate(change(recording(traffic, seed), place), config)
    assert report.verdict == Verdict.FAIL
    assert any(said in finding.text for finding in findings(report))


@pytest.mark.parametrize('finish', [True, False])
def test_recording_that_was_never_closed_is_named(traffic, config, finish, tmp_path):
    report = validate_bag(Task(mcap_file(tmp_path / 'b.mcap', traffic[50], finish=finish), config))
    assert report.passed
    assert (Finding(FindingCause.NOT_CLOSED) in report.findings) is not finish


@pytest.mark.parametrize('doubled_input', [True, False])
def test_where_merged_recordings_overlap_each_message_is_judged_once(
    traffic, config, doubled_input, tmp_path
):
    """The first may end, and the second begin, between an input and its output."""
    messages = traffic[50]
    inputs = [k for k, m in enumerate(messages) if m.topic == ROTOR]
    begin, end = inputs[60] + 1, inputs[120] + 1
    merged = [
        m
        for k, m in enumerate(messages)
        for _ in range(1 + (begin <= k < end and (doubled_input or m.topic != ROTOR)))
    ]
    report = validate_bag(Task(folder(tmp_path / 'bag', merged), config))
    assert report.passed is doubled_input
    assert [t.extra for t in report.topics] == 2 * [0 if doubled_input else 60]
    said = [found for found in report.findings if found.cause == FindingCause.TWICE]
    assert said == ([Finding(FindingCause.TWICE, ROTOR, count=60)] if doubled_input else [])


@pytest.mark.parametrize('seed', range(5))
def test_a_loss_after_a_quiet_period_is_found_at_once(traffic, config, seed):
    """A recorder without losses for some time has settled before a second has passed."""
    rng = random.Random(seed)  # noqa: S311, of faults, not of secrets
    messages = traffic[500]
    begin = messages[0].received + SECOND
    recorded = record(messages, rng, begin=begin, end=messages[-1].received, late=0.004)
    after = settled_by(recorded) - 2 * SECOND // 3
    lost = [k for k, m in enumerate(recorded) if m.topic == POSES and m.received > after][:5]
    report = validate([m for k, m in enumerate(recorded) if k not in lost], config)
    assert report.verdict == Verdict.FAIL
    assert [t.missing for t in report.topics] == [0, 5]


@pytest.mark.parametrize(
    ('pause', 'begin', 'end', 'excused'),
    [
        (2.0, 0.0, 0.05, True),
        (2.0, 0.0, 0.9, True),  # of 4 s
        (0.3, 0.0, 0.05, False),  # too short for a restart
        (2.0, 0.01, 0.05, False),  # the node had heard the driver
        (2.0, 0.0, 1.2, False),
        (2.0, 0.0, 9.0, False),  # the node did not survive
    ],
)
def test_inputs_that_a_node_misses_after_a_restart_of_the_driver_fail_nothing(
    traffic, config, pause, begin, end, excused
):
    """The recorder may have found the driver before the node, which misses nothing at 0.8 s."""
    back = stamp_of(traffic[100][0]) + 3 * SECOND
    paused = (-2.8, -2.2), (-pause, 0.0)
    there = [
        m
        for m in traffic[100]
        if not any(a * SECOND < stamp_of(m) - back < b * SECOND for a, b in paused)
    ]
    from_, to = (back + after * SECOND for after in (begin, end))
    lost = [m for m in there if m.topic != ROTOR and from_ <= stamp_of(m) < to]
    messages = [m for m in there if m not in lost]
    report = validate(messages, config)
    assert report.passed is excused
    count = len(lost) // 2
    assert [t.left_out for t in report.topics] == 2 * [{BACK: count} if excused else {}]
    assert [t.missing for t in validate(messages, config, strict=True).topics] == 2 * [count]


def test_after_a_restart_outputs_of_one_topic_alone_are_missing(traffic, config):
    """The other one shows that the node heard the driver at once."""
    back = stamp_of(traffic[100][0]) + 3 * SECOND
    there = [m for m in traffic[100] if not back - 2 * SECOND < stamp_of(m) < back]
    lost = [m for m in there if m.topic == POSES and 0 <= stamp_of(m) - back < SECOND // 2]
    report = validate([m for m in there if m not in lost], config)
    assert report.verdict == Verdict.FAIL
    assert [t.missing for t in report.topics] == [0, len(lost)]
    assert [t.left_out for t in report.topics] == [{}, {}]


def test_a_driver_that_often_pauses_does_not_restart_each_time(traffic, config):
    """It sends for 0.3 s in each second, and the node misses two thirds of that."""
    begin = stamp_of(traffic[100][0])
    active = [m for m in traffic[100] if stamp_of(m) - begin < 0.3 * SECOND]
    messages = [
        shifted(m, second * SECOND)
        for second in range(12)
        for m in active
        if m.topic == ROTOR or second < 2 or stamp_of(m) - begin >= 0.2 * SECOND
    ]
    report = validate(messages, config)
    assert report.verdict == Verdict.FAIL
    assert [t.missing for t in report.topics] == [200, 200]


def test_an_output_for_a_rejected_input_is_extra(traffic, config):
    """Its input was recorded, but has no output. The next two got lost, in a simulation."""
    messages = [m._replace(received=m.received + 20 * SECOND) for m in traffic[500][:3000]]

    def spoil(content) -> None:
        content.position = np.array([math.nan])

    k = next(k for k, m in enumerate(messages) if k > 1500 and m.topic == ROTOR)
    messages[k] = edited(messages[k], spoil)
    lost = [m for m in messages[k + 1 :] if m.topic == ROTOR][:2]
    report = validate([m for m in messages if m not in lost], config)
    assert report.verdict == Verdict.FAIL
    assert [(t.extra, t.first_extra) for t in report.topics] == [(1, stamp_of(messages[k]))] * 2
    assert [t.left_out for t in report.topics] == [{NO_INPUT: 2}] * 2


def test_outputs_of_another_time_are_extra(traffic, config):
    """Stamps before or after all inputs are excused only if they were received then."""
    messages = list(traffic[500][:3000])
    for k, nanoseconds in ((1500, 100 * SECOND), (1800, -100 * SECOND)):
        (output,) = [m for m in messages[k : k + 3] if m.topic == OUTPUT]
        stranger = shifted(output, nanoseconds)._replace(received=output.received)
        messages.insert(messages.index(output) + 1, stranger)
    report = validate(messages, config)
    assert report.verdict == Verdict.FAIL
    assert [t.extra for t in report.topics] == [2, 0]


def at_rate(messages: list[Message], rate: float) -> list[Message]:
    """Let a simulation, or the playback of a bag, run faster than real time."""
    begin = messages[0].received
    return [m._replace(received=begin + round((m.received - begin) / rate)) for m in messages]


@pytest.mark.parametrize('rate', [0.2, 1, 5])
def test_a_simulation_need_not_run_in_real_time(traffic, config, rate):
    """The ages of messages change by more than the 10 s that they may differ from each other."""
    once = traffic[50]
    length = once[-1].received - once[0].received + SECOND // 50
    there = at_rate([shifted(m, k * length) for k in range(3) for m in once], rate)
    inputs = [m for m in there if m.topic == ROTOR]
    lost = [inputs[round(place * len(inputs))] for place in (0.1, 0.6, 0.9)]
    messages = [m for m in there if m not in lost]
    report = validate(messages, config)
    assert report.verdict == Verdict.PASS
    assert [t.left_out for t in report.topics] == [{NO_INPUT: 3}] * 2


@pytest.mark.parametrize('rate', [1, 3])
def test_losses_in_every_pass_of_a_bag_that_loops_fail_nothing(traffic, config, rate):
    """What was lost in one pass was recorded with the same stamp in another."""
    once = traffic[500]
    length = once[-1].received - once[0].received + SECOND // 100
    messages = [m._replace(received=m.received + k * length) for k in range(4) for m in once]
    messages = at_rate(messages, rate)
    inputs = [k for k, m in enumerate(messages) if m.topic == ROTOR]
    each = len(inputs) // 4
    lost = {k for n in (1, 2) for k in inputs[n * each : n * each + 35]}
    lost |= {k for n in (0.3, 1.4, 3.6) for k in inputs[round(n * each) : round(n * each) + 5]}
    kept = [m for k, m in enumerate(messages) if k not in lost]
    report = validate(kept, config)
    assert report.verdict == Verdict.PASS
    assert report.rotor.resets == 3
    assert [t.left_out for t in report.topics] == [{NO_INPUT: 85}] * 2
    kept.insert(len(kept) * 2 // 3, next(m for m in kept if m.topic == OUTPUT))
    assert [t.extra for t in validate(kept, config).topics] == [1, 0]


def test_a_driver_slower_than_a_hertz_may_be_recorded_too(traffic, config):
    own = {topic: [m for m in traffic[500] if m.topic == topic][:40] for topic in TOPICS}
    slow = [shifted(own[topic][k], 2 * k * SECOND) for k in range(40) for topic in TOPICS]
    report = validate(slow[1:-1], config)  # the first input and the last poses got lost
    assert report.verdict == Verdict.PASS
    assert [t.compared for t in report.topics] == [39, 38]


# Single-turn encoders


@pytest.fixture(scope='module')
def single_turn() -> tuple[dict, list[Message]]:
    messages = [Message(*message) for message in read_bag(BAGS / 'single_turn_encoder')]
    return NodeParameters.load(CONFIGS / 'single_turn.yaml'), messages


def output_turns(message: Message) -> float:
    """The rotor angle of an output, turns."""
    (angle,) = replaying.decode(message.data, JOINT_STATE).position
    return -19.0 * angle / math.tau


def test_turns_before_the_recording_are_taken_from_the_outputs(single_turn):
    config, messages = single_turn
    later = messages[len(messages) // 2 :]
    assert abs(output_turns(next(m for m in later if m.topic == OUTPUT))) > 1.0
    report = validate(later, config)
    assert report.verdict == Verdict.PASS
    assert FindingCause.TURNS_TAKEN in [found.cause for found in report.findings]
    assert all(field.max_error < 1e-12 for topic in report.topics for field in topic.fields)


@pytest.mark.parametrize('seed', range(5))
def test_turns_are_taken_again_after_holes_that_hide_some(single_turn, seed):
    config, messages = single_turn
    rng = random.Random(seed)  # noqa: S311, of faults, not of secrets
    inputs = [k for k, m in enumerate(messages) if m.topic == ROTOR]
    lost = set()
    for hole in rng.sample(range(200, len(inputs) - 200, 150), 5):
        lost |= set(inputs[hole : hole + rng.randrange(20, 90)])
    report = validate([m for k, m in enumerate(messages) if k not in lost], config)
    assert report.verdict == Verdict.PASS
    assert [t.left_out for t in report.topics] == [{NO_INPUT: len(lost)}] * 2


@pytest.mark.parametrize('lost', [0, 1])
@pytest.mark.parametrize('outputs', ['publish', 'withhold'])
def test_outputs_that_a_node_withholds_are_not_missing(single_turn, outputs, lost):
    config, messages = single_turn
    homed = 2000  # of 2500 inputs
    inputs = [k for k, m in enumerate(messages) if m.topic == ROTOR]
    left_out = {k for k, m in enumerate(messages) if m.topic != ROTOR and k < inputs[homed]}
    left_out |= {k for k in range(inputs[-100], inputs[-100 + lost]) if k not in inputs}
    config = replace(config, unreferenced_outputs=outputs)
    recorded = [m for k, m in enumerate(messages) if k not in left_out]
    report = validate(recorded, config, strict=True)
    missing = (0 if outputs == 'withhold' else homed) + lost
    assert [topic.missing for topic in report.topics] == [missing, missing]
    assert report.verdict == (Verdict.FAIL if missing else Verdict.PASS)


def test_turns_are_taken_from_poses_that_are_recorded_alone(single_turn):
    """Between two holes of the rotor's topic, before the output's topic was recorded."""
    config, messages = single_turn
    messages = messages[len(messages) // 2 :]
    inputs = [k for k, m in enumerate(messages) if m.topic == ROTOR]
    hole = set(inputs[40:100])
    begun = messages[inputs[90]].received
    recorded = [
        m
        for k, m in enumerate(messages)
        if k not in hole and (m.topic != OUTPUT or m.received > begun)
    ]
    report = validate(recorded, config)
    assert report.verdict == Verdict.PASS
    assert report.topics[1].compared > report.topics[0].compared


def slipped(messages: list[Message], begin: float) -> list[Message]:
    """Let the output be a turn of the rotor behind, from a share of the recording on."""

    def slip(content) -> None:
        content.position = content.position - math.tau / 19

    after = begin * len(messages)
    return [
        edited(m, slip) if m.topic == OUTPUT and k >= after else m for k, m in enumerate(messages)
    ]


def test_a_turn_lost_by_the_node_is_found(single_turn, traffic, config):
    single, messages = single_turn
    assert validate(slipped(messages, 0.5), single).verdict == Verdict.FAIL
    # Turns of poses and angle have to agree.
    report = validate(slipped(messages, 0.0), single)
    assert [t.passed for t in report.topics] == [True, False]
    # Those of a multi-turn encoder are not inferred.
    assert validate(slipped(traffic[500][:900], 0.0), config).verdict == Verdict.FAIL


# The shared recordings

JUDGED = {  # compared, and left out, of each output topic; counted by their stamps
    'calm_1': [(2959, {NO_INPUT: 41}), (2959, {NO_INPUT: 41})],
    'calmr_2': [(2422, {BEFORE: 578}), (2422, {BEFORE: 578})],
    'doc200_1': [(667, {BEFORE: 20}), (667, {BEFORE: 20})],
    'doc200_2': [(368, {}), (368, {NO_INPUT: 1})],
    'opt_6': [(2959, {BEFORE: 2, NO_INPUT: 3}), *[(2959, {BEFORE: 2, NO_INPUT: 2})] * 2],
    'q500_1': [(1045, {NO_INPUT: 51}), (1045, {NO_INPUT: 52})],
    'q50_1': [(68, {BEFORE: 96}), (68, {BEFORE: 96})],
}


@pytest.mark.skipif(not RECORDED.is_dir(), reason='no recordings of rosbag2 beside this checkout')
@pytest.mark.parametrize('name', JUDGED)
def test_recordings_of_rosbag2_pass(config, name):
    task = Task(RECORDED / name, config)
    report = validate_bag(task)
    assert report.verdict == Verdict.PASS
    assert [(t.compared, t.left_out) for t in report.topics] == JUDGED[name]
    assert all(f.max_error < 1e-12 for t in report.topics for f in t.fields)


@pytest.mark.parametrize('rate', [50, 200])
def test_a_loss_where_a_bag_begins_anew_at_once_fails_nothing(traffic, config, rate):
    start = stamp_of(traffic[rate][0])
    once = [m for m in traffic[rate] if stamp_of(m) < start + 2 * SECOND]
    length = once[-1].received - once[0].received + SECOND // 1000
    messages = [m._replace(received=m.received + k * length) for k in range(3) for m in once]
    last = [k for k, m in enumerate(messages) if m.topic == ROTOR][len(once) // 3 * 2 - 1]
    report = validate(messages[:last] + messages[last + 1 :], config)
    assert report.verdict == Verdict.PASS
    assert [t.left_out for t in report.topics] == [{NO_INPUT: 1}] * 2


@pytest.mark.parametrize('passes', [2, 3])
@pytest.mark.parametrize('at', [0, 5, 300])
def test_an_output_lost_in_one_pass_is_not_answered_by_another(traffic, config, passes, at):
    """The input of the next pass, which has the same stamp, was not recorded."""
    start = stamp_of(traffic[500][0])
    once = [m for m in traffic[500] if stamp_of(m) < start + 2 * SECOND]
    length = once[-1].received - once[0].received + SECOND // 100
    messages = [
        m._replace(received=m.received + k * length) for k in range(passes + 1) for m in once
    ]
    each = len(once) // 3

    def nth(topic: str, turn: int) -> int:
        return [k for k, m in enumerate(messages) if m.topic == topic][turn * each + at]

    lost = {nth(OUTPUT, 1), *(nth(ROTOR, turn) for turn in range(2, passes + 1))}
    report = validate([m for k, m in enumerate(messages) if k not in lost], config)
    assert report.verdict == Verdict.FAIL
    assert [t.missing for t in report.topics] == [1, 0]
    assert [t.left_out for t in report.topics] == [{NO_INPUT: passes - 1}] * 2


def test_losses_at_the_restart_of_a_real_loop_fail_with_a_third_behind_it(shared_path, config):
    """The third repeats the second, but the inputs of what the second lost are not recorded."""
    path = shared_path('data/faults/rec_loop_two_lost.mcap')
    messages = [Message(*message) for message in read(path, [ROTOR, OUTPUT])]
    rotor = [m for m in messages if m.topic == ROTOR]
    restart = next(b.received for a, b in pairwise(rotor) if stamp_of(b) < stamp_of(a))
    second = [m for m in messages if m.received >= restart]
    outputs = [m for m in second if m.topic == OUTPUT]
    given = {stamp_of(m) for m in outputs}
    lost = [m for m in second if m.topic == ROTOR and stamp_of(m) not in given]
    answers = [shifted(outputs[0], stamp_of(m) - stamp_of(outputs[0])) for m in lost]
    third = sorted([*(m for m in second if m not in lost), *answers], key=lambda m: m.received)
    length = messages[-1].received - restart + SECOND // 10
    behind = [m._replace(received=m.received + length) for m in third]
    for recorded in (messages, messages + behind):
        report = validate(recorded, config, Topics(poses=''))
        assert report.verdict == Verdict.FAIL
        assert [t.missing for t in report.topics] == [2]


@pytest.mark.parametrize(
    ('little_endian', 'missing', 'strict'),
    [(True, 0, False), (False, 6, False), (True, 7, False), (True, 6, True)],
)
def test_what_the_recorder_says_that_it_lost_is_said_and_skipped(
    tmp_path, monkeypatch, little_endian, missing, strict
):
    """As Lyrical's publishes it once in a while, for all topics on which it lost something."""
    topic, kind = '/events/rosbag2_messages_lost', 'rosbag2_interfaces/msg/MessagesLostEvent'
    store = get_typestore(Stores.ROS2_JAZZY)
    count = 'string topic\nuint64 in_transport\nuint64 in_recorder\n'
    store.register(get_types_from_msg(count, f'{kind}TopicStat'))
    store.register(get_types_from_msg(f'string node\n{kind}TopicStat[] lost\n', kind))
    event, loss = store.types[kind], store.types[f'{kind}TopicStat']
    told = [[(OUTPUT, 2, 3), ('/camera', 7, 0)], [(OUTPUT, 1, 0)]]
    messages = [Message(*message) for message in read_bag(BAGS / 'servo_point_to_point')[:4500]]
    places = [row for row, message in enumerate(messages) if message.topic == OUTPUT]
    for row in places[1000 : 1000 + missing][::-1]:
        del messages[row]
    for losses in told:
        data = store.serialize_cdr(
            event('/rosbag2_recorder', [loss(*each) for each in losses]),
            kind,
            little_endian=little_endian,
        )
        messages.append(Message(topic, messages[-1].received, bytes(data)))
    monkeypatch.setitem(TYPES, topic, kind)
    monkeypatch.setattr('made_bags.JAZZY', store)
    task = Task(folder(tmp_path / 'bag', messages), NodeParameters.load(), strict=strict)
    report = validate_bag(task)
    skipped = 0 if strict or missing > 6 else missing
    assert report.passed is (skipped == missing)
    assert sum(topic.missing for topic in report.topics) == missing - skipped
    assert sum(sum(topic.left_out.values()) for topic in report.topics) == skipped
    said = [found for found in report.findings if found.cause == FindingCause.RECORDER_LOST]
    assert said == [Finding(FindingCause.RECORDER_LOST, OUTPUT, count=6)]
