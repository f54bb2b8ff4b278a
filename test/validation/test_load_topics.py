# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The loads in recordings: the node's pass, and what differs is found and named."""

from dataclasses import replace

import pytest
import validating
from node_loop import answered
from shipped_bags import BAGS, ROTOR, read_bag
from validating import topic_of

from gear_kinematics.kinematics.loads import Bodies
from gear_kinematics.report.document import Verdict
from gear_kinematics.validation.causes import FindingCause

NAMES = {'branch_loads': '/branch_loads', 'joint_loads': '/joint_loads'}
HEAVY = Bodies(0.05, 2e-5, 0.02, 3e-6, 4e-5, 0.4)


def loaded(messages, config):
    """Add the loads that the node publishes."""
    return answered(config, messages, topics=NAMES)


@pytest.fixture(params=[Bodies(), HEAVY], ids=['at rest', 'with masses'])
def braced(request, config):
    """Parameters of a preloaded gear."""
    return replace(config, preload=1.5, branch_stiffness=(3000.0,), loads=request.param)


def validate(messages, config):
    return validating.validate(messages, config, further=NAMES)


@pytest.mark.parametrize('bag', ['servo_point_to_point', 'driver_faults'])
def test_what_a_node_publishes_passes(bag, braced):
    report = validate(loaded(read_bag(BAGS / bag), braced), braced)
    assert report.verdict == Verdict.PASS, report.findings
    for name in NAMES.values():
        found = topic_of(report, name)
        assert found.compared == found.messages > 1000
        for field in found.fields:
            assert field.max_error == 0.0
            # With masses, what follows a gap by less than 20 ms is not judged.
            assert field.compared > (0.6 if braced.loads == HEAVY else 0.99) * found.messages


@pytest.mark.parametrize('number', [100, 1500])
def test_homing_interrupts_no_loads(number, config):
    """The acceleration of heavy bodies, which takes 20 ms to find, is that of before.

    The rotor stands at its zero when the message of the first number comes.
    """
    heavy = replace(config, preload=1.5, branch_stiffness=(3000.0,), loads=HEAVY)
    inputs = [m for m in read_bag(BAGS / 'servo_point_to_point') if m[0] == ROTOR]
    topics = 'output_state', 'body_poses', *NAMES
    report = validate(answered(heavy, inputs, topics=topics, home_after=number), heavy)
    assert report.verdict == Verdict.PASS, report.findings


def test_recording_that_lacks_inputs_passes(braced):
    """The node has seen the messages that a recorder loses, and its acceleration rests on them."""
    messages = loaded(read_bag(BAGS / 'servo_point_to_point'), braced)
    inputs = [k for k, m in enumerate(messages) if m[0] == '/rotor_state']
    lost = {*inputs[1000:1010], inputs[2000]}
    report = validate([m for k, m in enumerate(messages) if k not in lost], braced)
    assert report.verdict == Verdict.PASS, report.findings


@pytest.mark.parametrize(
    ('topic', 'place', 'field'),
    [('/branch_loads', -8, 'torque'), ('/branch_loads', -32, 'stand-off'),
     ('/joint_loads', -48, 'force'), ('/joint_loads', -8, 'couple')],
)  # fmt: skip
def test_number_that_differs_is_named(topic, place, field, config):
    report = of_changed_number(topic, place, config)
    assert report.verdict == Verdict.FAIL
    faulty = [f.name for f in topic_of(report, topic).fields if not f.passed]
    assert faulty == [field]


def test_wrench_out_of_the_plane_is_no_message_of_the_topic(config):
    report = of_changed_number('/joint_loads', -32, config)  # the force along z
    assert report.verdict == Verdict.FAIL
    (fault,) = topic_of(report, '/joint_loads').faults
    assert (fault.cause, fault.count) == (FindingCause.MALFORMED, 1)


def of_changed_number(topic, place, config):
    braced = replace(config, preload=1.5, branch_stiffness=(3000.0,))
    messages = loaded(read_bag(BAGS / 'servo_point_to_point'), braced)
    row = next(k for k, m in enumerate(messages) if k > 4000 and m[0] == topic)
    name, received, data = messages[row]
    changed = bytearray(data)
    changed[place + 7 + len(data)] ^= 0x40  # in the exponent of a float64
    messages[row] = name, received, bytes(changed)
    return validate(messages, braced)


def test_missing_loads_are_found(config):
    braced = replace(config, preload=1.5, branch_stiffness=(3000.0,))
    messages = loaded(read_bag(BAGS / 'servo_point_to_point'), braced)
    dropped = [k for k, m in enumerate(messages) if m[0] == '/joint_loads'][1500:1503]
    report = validate([m for k, m in enumerate(messages) if k not in dropped], braced)
    assert topic_of(report, '/joint_loads').missing == 3
    assert topic_of(report, '/branch_loads').missing == 0


def test_loads_of_another_preload_fail(config):
    braced = replace(config, preload=1.5, branch_stiffness=(3000.0,))
    messages = loaded(read_bag(BAGS / 'servo_point_to_point'), braced)
    report = validate(messages, replace(braced, preload=1.6))
    assert report.verdict == Verdict.FAIL
    assert not topic_of(report, '/branch_loads').passed
