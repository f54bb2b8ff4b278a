# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Reports written by hand, one for each outcome; the numbers are chosen, not computed."""

import math
from dataclasses import replace

from gear_kinematics.kinematics import Branch, Mechanism
from gear_kinematics.report.document import Verdict
from gear_kinematics.validation.causes import FindingCause
from gear_kinematics.validation.independent import IndependentReport
from gear_kinematics.validation.report import (
    BagReport,
    FieldReport,
    Finding,
    Gap,
    InputReport,
    Series,
    TopicReport,
)

START = 1_700_000_000_123_456_789
"""Stamp of the first sample, ns."""
HOSTILE = '</script><img src=x onerror=alert(1)>&"\''
"""A name that wants to be markup."""
CONTROL = 'run\x1b[31m\x00\n\u202e\ud800\ufffe'
"""A name that no terminal and no XML file should get as it is."""

POSITION = FieldReport(
    'position', 'rad', 1e-9, 4000, 0, 0, 3.2e-15, 1.1e-15, START + 2_500_000_000, 785.398163
)
OUTPUT = TopicReport(
    '/output_state',
    messages=4000,
    compared=4000,
    missing=0,
    extra=0,
    duplicates=0,
    out_of_order=0,
    fields=(
        POSITION,
        replace(POSITION, name='velocity', unit='rad/s', max_error=4.4e-14, rms_error=9e-15),
        replace(POSITION, name='effort', unit='N·m', compared=0, max_error=0.0, rms_error=0.0,
                worst_stamp=None, worst_rotor_angle=None),
    ),
)  # fmt: skip
POSES = replace(
    OUTPUT,
    topic='/body_poses',
    fields=(
        replace(POSITION, unit='m', max_error=4.3e-19, rms_error=8.8e-20),
        replace(POSITION, name='orientation', max_error=6.7e-16),
    ),
)
ROTOR = InputReport(
    '/rotor_state',
    'rotor',
    messages=4000,
    valid=4000,
    rate=1000.0,
    duration=3.999,
    max_speed=314.159265,
)


def series(error: float = 3.2e-15, count: int = 400) -> tuple[Series, ...]:
    """Give a run up to speed whose error grows to the given one."""
    time = [4.0 * k / count for k in range(count)]
    rotor = [40.0 * t * t + math.sin(9 * t) for t in time]
    angle = [error * (k / count) ** 8 * math.cos(k) for k in range(count)]
    position = [1.1e-3 * abs(error) * (k / count) ** 4 for k in range(count)]
    return (
        Series('/output_state', time, rotor, {'position': angle}),
        Series('/body_poses', time, rotor, {'position': position}),
    )


PASSING = BagReport(
    'bags/servo',
    Verdict.PASS,
    config='config/actuator.yaml',
    gear_ratio='-19',
    messages=12000,
    rotor=ROTOR,
    topics=(OUTPUT, POSES),
    independent=IndependentReport(12000, 3, 1, {'position': 2e-15}, None, passed=True),
    series=series(),
    mechanism=Mechanism(80, 76, 0.0011, (Branch('a'), Branch('b', cam_phase=math.pi))),
    module=0.0005,
)

FAILING = replace(
    PASSING,
    bag='logs/2026-11-20 Prüfstand 7/läuft.mcap',
    verdict=Verdict.FAIL,
    rotor=replace(
        ROTOR,
        messages=4013,
        valid=4008,
        rejected={'joint missing': 3, 'position not finite': 2},
        duplicates=1,
        zero_stamps=1,
        unnormalised_stamps=7,
        resets=1,
        gaps=2,
        jumps=1,
        overspeed=4,
        referenced=False,
        longest_gaps=(
            Gap(START + 1_800_000_000, 0.0423, 13.2),
            Gap(START + 3_100_000_000, 0.0061, 1.9),
        ),
    ),
    topics=(
        replace(
            OUTPUT,
            messages=4005,
            compared=3997,
            wrong=12,
            missing=11,
            extra=8,
            duplicates=2,
            out_of_order=1,
            first_missing=START + 1_000_000_000,
            first_extra=START + 1_000_000_001,
            faults=(
                Finding(
                    FindingCause.NO_JOINT,
                    stamp=START,
                    count=3,
                    values={'expected': 'shaft', 'name': 'wheel'},
                ),
            ),
            fields=(
                replace(POSITION, max_error=2e-3, rms_error=7.1e-4),
                replace(POSITION, name='velocity', unit='rad/s', non_finite=5),
                replace(POSITION, name='effort', unit='N·m', absent=1, max_error=9.9e-10),
            ),
        ),
        replace(POSES, compared=0, missing=4008, messages=0, fields=()),
    ),
    findings=(
        Finding(FindingCause.ANOTHER_RATIO, values={'ratio': '-29', 'expected': '-19'},
                explains=True),
        Finding(FindingCause.TURNS_TAKEN),
    ),
    series=series(2e-3),
)  # fmt: skip

UNUSABLE = BagReport(
    'logs/truncated.db3',
    Verdict.UNUSABLE,
    error='logs/truncated.db3: no bag: database disk image is malformed at offset 8192',
)

DAMAGED = replace(
    PASSING,
    bag='logs/power_cut.mcap',
    verdict=Verdict.UNUSABLE,
    error='logs/power_cut.mcap: chunk at offset 1048576 is cut short after 2310 messages',
    messages=2310,
)

HOSTILE_FINDING = Finding(
    FindingCause.VELOCITY_IS,
    values={'rotor': InputReport('', '', velocity_is=HOSTILE)},
    explains=True,
)
CONTROL_FINDING = replace(
    HOSTILE_FINDING, values={'rotor': InputReport('', '', velocity_is=CONTROL)}, explains=False
)
HOSTILE_NAMES = replace(
    FAILING,
    bag=HOSTILE,
    config=HOSTILE,
    gear_ratio=HOSTILE,
    error=HOSTILE,
    rotor=replace(ROTOR, topic=HOSTILE, joint=HOSTILE, rejected={HOSTILE: 1}),
    topics=(
        replace(OUTPUT, topic=HOSTILE, faults=(replace(HOSTILE_FINDING, explains=False),),
                fields=(replace(POSITION, name=HOSTILE, unit=HOSTILE, max_error=1.0),)),
    ),
    findings=(HOSTILE_FINDING,),
    series=(Series(HOSTILE, [0.0, 1.0], [0.0, 1.0], {HOSTILE: [0.0, 1.0]}),),
)  # fmt: skip

UNPRINTABLE = replace(
    UNUSABLE,
    bag=CONTROL,
    config=CONTROL,
    error=CONTROL,
    rotor=replace(ROTOR, topic=CONTROL, joint=CONTROL, rejected={CONTROL: 1}),
    topics=(replace(OUTPUT, topic=CONTROL, faults=(CONTROL_FINDING,)),),
    findings=(CONTROL_FINDING,),
)

EMPTY = BagReport('', Verdict.FAIL)
"""Nothing is known but that it fails."""

NOT_FINITE = replace(
    FAILING,
    bag='logs/nan',
    rotor=replace(ROTOR, rate=math.inf, max_speed=math.nan),
    topics=(
        replace(
            OUTPUT,
            fields=(
                replace(POSITION, max_error=math.nan, rms_error=math.inf, non_finite=4000),
                replace(POSITION, name='velocity', tolerance=0.0),
                replace(POSITION, name='effort', max_error=math.nan),
            ),
        ),
    ),
    series=(
        Series(
            '/output_state',
            [0.0, math.nan],
            [0.0, math.inf],
            {'position': [math.nan, -math.inf], 'velocity': [0.0, math.inf]},
        ),
    ),
)

EXACT = replace(
    PASSING,
    bag='bags/computed',
    topics=tuple(
        replace(
            topic, fields=tuple(replace(f, max_error=0.0, rms_error=0.0) for f in topic.fields)
        )
        for topic in PASSING.topics
    ),
    series=series(0.0),
)
"""Not a bit of difference."""


ALL = (PASSING, FAILING, UNUSABLE, DAMAGED, HOSTILE_NAMES, UNPRINTABLE, EMPTY, NOT_FINITE, EXACT)
