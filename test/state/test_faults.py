# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The table of faults of a driver: what is counted, diagnosed, and found in a recording."""

import math
import struct
from dataclasses import replace
from typing import Any, NamedTuple

import pytest
from live import SECOND, rotor_bytes
from node_loop import answered
from shipped_bags import ROTOR
from validating import validate

from gear_kinematics.bag import Message
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.report.document import Verdict
from gear_kinematics.state.belief import VelocityMeaning
from gear_kinematics.state.gear_state import GearState
from gear_kinematics.state.monitors import Connections
from gear_kinematics.state.statuses import Condition, Fact
from gear_kinematics.validation.causes import FindingCause

MULTI = NodeParameters.load()
SINGLE = replace(MULTI, rotor_encoder='single_turn', max_rotor_speed=100.0)
START, PERIOD, COUNT = 100 * SECOND, SECOND // 100, 120
SPEED, STEP = 20.0, 1e-3  # rad/s, and rad: the resolution of the encoder
UNKNOWN_AT_FIRST = Condition.WERE_UNKNOWN(count=1)  # until homed after the first message
APART = 'offset', 'nanoseconds'  # of the position, and s and ns of the stamp


class Row(NamedTuple):
    """What a driver does, and what is said of it."""

    driven: list[dict[str, Any] | bytes]
    """What is changed of the good message of each number."""
    counted: dict[str, Any]
    """The counts that are not 0."""
    diagnosed: tuple[Fact, ...] = ()
    found: FindingCause | None = None
    settings: NodeParameters = MULTI
    verdict: Verdict = Verdict.PASS
    also: FindingCause | None = None
    burst: int = 1  # messages that are received together


def message(number: int, changed) -> bytes:
    if isinstance(changed, bytes):
        return changed
    position = STEP * round(SPEED * number / 100 / STEP + number % 2)
    fields = {'stamp': START + number * PERIOD, 'position': [position], **changed}
    fields['position'] = [each + fields.get('offset', 0.0) for each in fields['position']]
    parts = fields.get('nanoseconds') or divmod(fields['stamp'], SECOND)
    data = rotor_bytes(**{name: fields[name] for name in fields if name not in APART})
    return data[:4] + struct.pack('<iI', *parts) + data[12:]


def part(changed, first=60, count=1) -> list[dict[str, Any] | bytes]:
    """Let some messages be others."""
    return [changed if first <= k < first + count else {} for k in range(COUNT)]


def rejected(cause: str, changed) -> Row:
    """Return the row of messages that are rejected, which are more than half of all."""
    bad = COUNT // 2 + 1
    told = Condition.REJECTED(counts={cause: bad})
    found = FindingCause.MOSTLY_REJECTED
    counted = {'rejected': {cause: bad}}
    return Row(part(changed, 20, bad), counted, (told,), found, verdict=Verdict.FAIL)


def moved(offset=0.0, stamp=0) -> list[dict[str, Any]]:
    """Let all messages from the middle on have another position, rad, or stamp, ns."""
    late = [{'stamp': START + k * PERIOD + stamp, 'offset': offset} for k in range(60, COUNT)]
    return 60 * [{}] + late


def at_speed(speed: float, **fields) -> list[dict[str, Any]]:
    return [{'position': [speed * k / 100 + STEP * (k % 2)], **fields} for k in range(COUNT)]


JUMPED = Condition.JUMPED(angle=pytest.approx(100.0, abs=0.01), time=pytest.approx(100.6))
WRAPS = Condition.WRAPS(angle=math.tau, setting='rotor_encoder to single_turn')
TOO_SELDOM = Condition.TOO_SELDOM(
    rate=pytest.approx(100.0),
    limit=650.0,
    speed=pytest.approx(80.0 * math.pi),
    least=pytest.approx(1.25 * 650.0 / math.pi),
    other=', or send velocities',
)
OUTSIDE = Condition.OUTSIDE(
    angle_deg=pytest.approx(-71.77, abs=0.01), low_deg=0.0, high_deg=math.degrees(1.0)
)
ROWS = {
    'none': Row(part({}), {}),
    'another joint beside': Row(
        part({'names': ['wheel']}, count=3), {'of_others': 3}, found=FindingCause.OF_OTHERS
    ),
    'array sizes': rejected('array sizes', {'names': ['rotor', 'wheel']}),
    'named twice': rejected('array sizes', {'names': ['rotor', 'rotor'], 'position': [0.1, 5.0]}),
    'no position': rejected('position missing', {'position': []}),
    'NaN': rejected('position not finite', {'position': [math.nan]}),
    'far away': rejected('position too large', {'position': [1e17]}),
    'garbage': rejected('not a JointState', b'\xde\xad\xbe\xef' * 40),
    'impossible stamp': rejected('stamp out of range', {'nanoseconds': (2**31 - 1, SECOND)}),
    'out of order': rejected('out of order', {'stamp': START + 18 * PERIOD}),
    'stray reading': Row(
        part({'position': [1e4]}),
        {'rejected': {'implausible': 1}},
        (Condition.REJECTED(counts={'implausible': 1}),),
    ),
    'stray reading within reach': Row(
        part({'offset': 3.0}),
        {},
        (Condition.TAKEN_BACK(count=1, angle=pytest.approx(3.0, abs=0.3), time=100.6),),
        FindingCause.SET_BACK,
    ),
    'repeated stamp': Row(part({'stamp': START + 59 * PERIOD}), {'duplicates': 1}),
    'late stamp': Row(part({'stamp': START + 61 * PERIOD - 100_000}), {}),
    'no stamp': Row(part({'stamp': 0}), {'zero_stamps': 1}, found=FindingCause.ZERO_STAMPS),
    'no stamps, in bursts': Row(
        [{'stamp': 0, 'position': [math.sin(0.4 * k)]} for k in range(COUNT)],
        {'zero_stamps': COUNT},
        found=FindingCause.ZERO_STAMPS,
        burst=6,
    ),
    'driver without stamps restarts in a burst': Row(
        [{'stamp': 0, 'offset': 100.0 * (k > 62)} for k in range(COUNT)],
        {'zero_stamps': COUNT, 'rejected': {'implausible': 2}},
        (
            Condition.JUMPED(angle=pytest.approx(100.0, abs=2.0), time=pytest.approx(100.6)),
            Condition.NOT_REFERENCED(),
            Condition.REJECTED(counts={'implausible': 2}),
        ),
        FindingCause.JUMPED,
        also=FindingCause.ZERO_STAMPS,
        burst=6,
    ),
    'no stamp, and a reading that repeats': Row(
        part({'stamp': 0}),
        {'zero_stamps': 1},
        (Condition.ZERO_STAMPS(count=1), UNKNOWN_AT_FIRST),
        FindingCause.ZERO_STAMPS,
        replace(MULTI, rotor_encoder_range=1000.0),
    ),
    'constant stamp, and a reading that repeats': Row(
        [{'stamp': START} for _ in range(COUNT)],
        {'duplicates': COUNT - 1},
        (Condition.REPEATED_STAMPS(count=COUNT - 1), UNKNOWN_AT_FIRST),
        FindingCause.REPEATED_STAMPS,
        replace(MULTI, rotor_encoder_range=1000.0),
    ),
    'constant stamp': Row(
        [{'stamp': START} for _ in range(COUNT)],
        {'duplicates': COUNT - 1},
        (Condition.REPEATED_STAMPS(count=COUNT - 1),),
        FindingCause.REPEATED_STAMPS,
    ),
    'unnormalised stamp': Row(
        part({'nanoseconds': (99, SECOND + 60 * PERIOD)}), {'unnormalised_stamps': 1}
    ),
    'clock set back': Row(moved(stamp=-2 * SECOND), {'resets': 1}, found=FindingCause.SET_BACK),
    'milliseconds as seconds': Row(
        [{'stamp': START + 1000 * k * PERIOD} for k in range(COUNT)],
        {},
        found=FindingCause.SET_BACK,
    ),
    'clock runs backwards': Row(
        [{'stamp': START + 2 * (COUNT - k) * SECOND} for k in range(COUNT)],
        {'resets': COUNT - 1},
        (Condition.CLOCKS_ALTERNATE(count=COUNT - 2),),
        FindingCause.SET_BACK,
    ),
    'two drivers with clocks of their own': Row(
        [
            {'stamp': START + k * PERIOD + k % 2 * 3 * SECOND, 'offset': 9.0 * (k % 2)}
            for k in range(COUNT)
        ],
        {'resets': COUNT // 2 - 1},
        (Condition.CLOCKS_ALTERNATE(count=COUNT // 2 - 2),),
        FindingCause.SET_BACK,
    ),
    'bag in a loop': Row(
        [{'stamp': START + k % 30 * 4 * PERIOD} for k in range(COUNT)],
        {'resets': COUNT // 30 - 1},
        found=FindingCause.SET_BACK,
    ),
    'turns unseen': Row(
        moved(stamp=SECOND),
        {'jumps': 1},
        (Condition.GAP(gap=pytest.approx(1.01)), Condition.NOT_REFERENCED()),
        FindingCause.JUMPS,
        SINGLE,
    ),
    'turns unknown after a clock was set back': Row(
        moved(stamp=-2 * SECOND),
        {'resets': 1},
        (
            Condition.NOT_REFERENCED(),
            Condition.CLOCK_SET_BACK(size=pytest.approx(1.99), time=100.59),
        ),
        FindingCause.SET_BACK,
        SINGLE,
    ),
    'impossible step within a turn': Row(
        moved(offset=1.7),
        {'jumps': 1},
        (Condition.TURNED_TOO_FAR(gap=pytest.approx(0.01)), Condition.NOT_REFERENCED()),
        FindingCause.JUMPS,
        SINGLE,
    ),
    'impossible step at the same stamp': Row(
        [
            {'stamp': START + (k - (k > 59)) * PERIOD, 'offset': 1.7 * (k > 59)}
            for k in range(COUNT)
        ],
        {'duplicates': 1, 'jumps': 1},
        (Condition.TURNED_TOO_FAR(gap=pytest.approx(0.0)), Condition.NOT_REFERENCED()),
        FindingCause.JUMPS,
        replace(SINGLE, max_rotor_speed=200.0),
    ),
    'driver restarts': Row(
        moved(offset=100.0),
        {'rejected': {'implausible': 2}},
        (JUMPED, Condition.NOT_REFERENCED(), Condition.REJECTED(counts={'implausible': 2})),
        FindingCause.JUMPED,
    ),
    'positions wrap': Row(
        [{'position': [math.fmod(SPEED * k / 100, math.tau)]} for k in range(COUNT)],
        {'rejected': {'implausible': 6}},
        (WRAPS, Condition.NOT_REFERENCED(), Condition.REJECTED(counts={'implausible': 6})),
        FindingCause.JUMPED,
    ),
    'messages too few for turns': Row(
        part({}),
        {'jumps': COUNT - 1},
        (TOO_SELDOM, Condition.NOT_REFERENCED()),
        FindingCause.JUMPED,
        replace(SINGLE, max_rotor_speed=650.0),
        also=FindingCause.JUMPS,
    ),
    'rpm': Row(
        at_speed(50.0, velocity=[1500.0 / math.pi]),
        {},
        (Condition.VELOCITIES_ARE(meaning=VelocityMeaning.RPM),),
        FindingCause.VELOCITY_IS,
    ),
    'outside of the range': Row(
        part({}), {}, (OUTSIDE,), FindingCause.OUTSIDE, replace(MULTI, output_range=(0.0, 1.0))
    ),
}


def recorded_of(row: Row, gear: GearState) -> list[Message]:
    driven = [message(*each) for each in enumerate(row.driven)]
    stamps = [START + k * PERIOD + 500 for k in range(COUNT)]
    stamps = [stamps[k - k % row.burst] + 20_000 * (k % row.burst) for k in range(COUNT)]
    messages = [(ROTOR, stamp, data) for stamp, data in zip(stamps, driven, strict=True)]
    homed = 1 if row.settings.rotor_period else -1
    return answered(row.settings, messages, gear=gear, home_after=homed)


@pytest.mark.parametrize(
    'fault', ['driver restarts', 'positions wrap', 'messages too few for turns']
)
def test_input_that_loses_turns_is_named_before_the_outputs_that_are_missing(fault):
    settings = ROWS[fault].settings
    recorded = recorded_of(ROWS[fault], GearState(settings))
    outputs = [row for row, (topic, *_) in enumerate(recorded) if topic == '/output_state']
    found = validate([m for row, m in enumerate(recorded) if row not in outputs[50:60]], settings)
    assert found.verdict == Verdict.FAIL
    assert [each.cause for each in found.causes][:1] == [FindingCause.JUMPED]
    assert found.topics[0].missing == 10


@pytest.mark.parametrize('fault', ROWS)
def test_a_fault_is_counted_diagnosed_and_found(fault):
    row = ROWS[fault]
    gear = GearState(row.settings)
    gear.monitor.last_input = 0.0
    recorded = recorded_of(row, gear)
    report = gear.report(0.0, Connections())['rotor input']
    assert tuple(report.facts) == row.diagnosed
    found = validate(recorded, row.settings)
    names = (
        *('rejected', 'of_others', 'duplicates', 'zero_stamps', 'unnormalised_stamps'),
        *('resets', 'jumps'),
    )
    counts = {name: getattr(found.rotor, name) for name in names}
    assert {name: count for name, count in counts.items() if count} == row.counted
    for name in set(names) - {'jumps'}:
        assert getattr(gear.input, name) == counts[name]
    causes = {finding.cause for finding in found.findings}
    some = bool(row.counted.get('rejected')) and row.found is not FindingCause.MOSTLY_REJECTED
    assert causes == {row.found, row.also, FindingCause.REJECTED if some else None} - {None}
    assert found.verdict == row.verdict
    assert all(field.passed for topic in found.topics for field in topic.fields)
