# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The comparison by code that the node does not run finds what the usual one cannot."""

import math
from dataclasses import replace
from functools import partial

import made_bags
import pytest
from live import rotor_bytes
from node_loop import answered
from replaying import edited
from shipped_bags import BAGS, JOINT_STATE, OUTPUT, POSES, ROTOR, read_bag

from gear_kinematics.kinematics import GearRatio, RotorTurns
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.report.document import Verdict
from gear_kinematics.validation import validate
from gear_kinematics.validation.causes import FindingCause
from gear_kinematics.validation.findings import sentence

DEFAULT = NodeParameters.load()
START, STEP = 10**18, 2_000_000  # ns
SINGLE = NodeParameters.load(BAGS / 'single_turn_encoder' / 'actuator.yaml')


def answers_to(name, parameters) -> list:
    """The rotor states of a shipped bag, with the outputs of the node as it is now."""
    rotor = [message for message in read_bag(BAGS / name) if message[0] == ROTOR]
    return answered(parameters, rotor)


def scaled(monkeypatch) -> None:
    """Let the output turn a millionth too far."""
    right = GearRatio.output_angle

    def wrong(self, turns, angle, xp):
        output_turns, rest = right(self, turns, angle, xp)
        return output_turns, rest * (1.0 + 1e-6)

    monkeypatch.setattr(GearRatio, 'output_angle', wrong)


def miscounted(monkeypatch) -> None:
    """Lose a turn at the 500th sample."""
    right = RotorTurns.update

    def wrong(self, *arguments):
        self.updates = getattr(self, 'updates', 0) + 1
        self.periods += self.updates == 500
        right(self, *arguments)

    monkeypatch.setattr(RotorTurns, 'update', wrong)


@pytest.mark.parametrize(('plant', 'name', 'parameters'), [
    (None, 'driver_faults', DEFAULT), (None, 'servo_point_to_point', DEFAULT),
    (None, 'constant_speed_3000rpm', DEFAULT), (None, 'single_turn_encoder', SINGLE),
    (scaled, 'servo_point_to_point', DEFAULT), (miscounted, 'single_turn_encoder', SINGLE),
])  # fmt: skip
def test_a_fault_of_the_node_itself_is_found(plant, name, parameters, monkeypatch, tmp_path):
    bag = BAGS / name
    if plant:
        plant(monkeypatch)
        bag = made_bags.folder(tmp_path / 'bag', answers_to(name, parameters))
    assert validate(bag, parameters).passed
    report = validate(bag, parameters, independent=True)
    assert report.passed == report.independent.passed == (plant is None)
    assert report.independent.compared == sum(topic.compared for topic in report.topics)
    assert (report.independent.first_wrong is None) == (plant is None)
    if plant is None:
        assert max(report.independent.errors.values()) < 1e-13
    else:
        assert report.verdict == Verdict.FAIL
        assert [each.cause for each in report.causes][:1] == [FindingCause.INDEPENDENT]


def test_another_zero_agrees_unless_judged_strictly(tmp_path):
    homed = replace(DEFAULT, rotor_zero=0.7)
    bag = made_bags.folder(tmp_path / 'bag', answers_to('servo_point_to_point', homed))
    report = validate(bag, DEFAULT, independent=True).independent
    assert (report.passed, report.turns_taken) == (True, 1)
    assert not validate(bag, DEFAULT, independent=True, strict=True).independent.passed


@pytest.mark.parametrize(('topic', 'compared'), [(OUTPUT, 196), (POSES, 197)])
def test_damaged_and_foreign_outputs_are_not_compared(topic, compared, tmp_path):
    messages = answers_to('servo_point_to_point', DEFAULT)[:300]
    last = max(k for k, message in enumerate(messages) if message[0] == topic)
    messages[last] = *messages[last][:2], b'\0\1\0\0'
    messages = [m for k, m in enumerate(messages) if k > 0]  # the first input is lost
    bag = made_bags.folder(tmp_path / 'bag', messages)
    report = validate(bag, DEFAULT, independent=True).independent
    assert (report.compared, report.not_compared) == (compared, 200 - compared)
    assert report.passed


@pytest.mark.parametrize(('rejected', 'outputs'), [(None, 400), (math.nan, 200), (1e30, 200)])
def test_each_of_two_equal_stamps_has_its_own_outputs(rejected, outputs, tmp_path):
    """The first of them has none if it is rejected."""
    positions = [0.001 * k for k in range(200)]
    if rejected:
        positions[::2] = 100 * [rejected]
    states = [
        (ROTOR, START + k, rotor_bytes(START + k - k % STEP, position=[position]))
        for k, position in zip(range(0, 100 * STEP, STEP // 2), positions, strict=True)
    ]
    bag = made_bags.folder(tmp_path / 'bag', answered(DEFAULT, states))
    report = validate(bag, DEFAULT, independent=True).independent
    assert (report.compared, report.not_compared, report.passed) == (outputs, 0, True)


@pytest.mark.parametrize('late', [(OUTPUT, POSES), (POSES,)])
def test_stamps_that_come_again_in_a_restarted_simulation_have_their_own_inputs(late, tmp_path):
    """The first pass begins before the node runs, or before its poses are recorded."""
    states = [
        (ROTOR, START + k * STEP, rotor_bytes(START + k % 1000 * STEP, position=[0.02 * k]))
        for k in range(2000)
    ]
    settled = START + 100 * STEP
    messages = [m for m in answered(DEFAULT, states) if m[0] not in late or m[1] > settled]
    bag = made_bags.folder(tmp_path / 'bag', messages)
    report = validate(bag, DEFAULT, independent=True)
    assert report.passed
    assert report.independent.passed
    assert report.independent.compared == len(messages) - len(states)


@pytest.mark.parametrize(('back', 'speed'), [(149.25, 40.0), (2.06, 630.0), (3.5, 400.0)])
def test_turns_are_taken_from_the_outputs_where_the_clock_was_set_back(back, speed, tmp_path):
    """The node rejects the stamps meanwhile, and its velocities tell that a turn was made."""
    single = replace(SINGLE, max_rotor_speed=max(SINGLE.max_rotor_speed, speed / 0.9))
    stamps = [START + k * STEP - round(back * STEP) * (k >= 500) for k in range(1000)]
    positions = [1e-9 * STEP * speed * k % math.tau for k in range(1000)]
    states = [
        (ROTOR, START + k * STEP, rotor_bytes(stamps[k], position=[angle], velocity=[speed]))
        for k, angle in enumerate(positions)
    ]
    bag = made_bags.folder(tmp_path / 'bag', answered(single, states))
    report = validate(bag, single, independent=True)
    assert report.passed
    assert report.independent.passed


@pytest.mark.parametrize('stamp', [0, START + 494 * STEP])
def test_a_turn_is_found_that_is_lost_beside_a_late_stamp_or_none(stamp, monkeypatch, tmp_path):
    miscounted(monkeypatch)
    stamps = [START + k * STEP for k in range(1000)]
    stamps.insert(499, stamp)
    states = [
        (ROTOR, START + k * STEP - 1, rotor_bytes(stamp, position=[0.08 * k % math.tau]))
        for k, stamp in enumerate(stamps)
    ]
    bag = made_bags.folder(tmp_path / 'bag', answered(SINGLE, states))
    assert not validate(bag, SINGLE, independent=True).independent.passed


def test_that_stamps_are_lacking_is_said(tmp_path):
    """A node gives its own time to inputs without any, which tells no output of which it is."""
    states = [(ROTOR, START + k * STEP, rotor_bytes(0, position=[0.001 * k])) for k in range(200)]
    bag = made_bags.folder(tmp_path / 'bag', answered(DEFAULT, states))
    assert validate(bag, DEFAULT).passed
    report = validate(bag, DEFAULT, independent=True)
    lacking = 'independently, nothing could be compared: no output has the stamp of an input'
    assert (report.passed, lacking in map(sentence, report.findings)) == (False, True)


def test_a_gap_between_readings_hides_turns_but_no_other_zero(tmp_path):
    """In 20 ms the rotor can make a turn; from 2 s on, the output is off by less than one."""
    states = [
        (ROTOR, START + k * STEP, rotor_bytes(START + k * STEP, position=[0.08 * k % math.tau]))
        for k in range(0, 2000, 10)
    ]
    off = partial(
        edited, kind=JOINT_STATE, edit=lambda m: setattr(m, 'position', m.position + 0.01)
    )
    messages = [
        (topic, at, off(data) if topic == OUTPUT and at > START + 1000 * STEP else data)
        for topic, at, data in answered(SINGLE, states, topics=('output_state',))
    ]
    bag = made_bags.folder(tmp_path / 'bag', messages)
    assert not validate(bag, SINGLE, independent=True).independent.passed
