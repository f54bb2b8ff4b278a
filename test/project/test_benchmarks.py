# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The benchmarks run, and what they compare with does the same job."""

import json
import math
import subprocess
import sys
from pathlib import Path

import oracle
import pytest
import textbook_node
from replaying import ACTUATOR

BENCHMARK = Path(__file__).resolve().parents[2] / 'benchmark'


@pytest.mark.slow
@pytest.mark.parametrize(
    'arguments',
    [
        ['kinematics.py', '--samples', '1000', '--rounds', '1'],
        ['compute.py', '--messages', '300', '--rounds', '1'],
        ['validation.py', '--messages', '300', '--rounds', '1', '--memory', '300'],
        ['calibration.py', '--gears', '1', '--duration', '20', '--scenario', 'usual'],
        ['twin.py', '--seconds', '0.05', '--rounds', '1'],
        pytest.param(
            ['arm.py', '--kinds', 'arm', '--joints', '2', '--seconds', '0.1', '--rounds', '1'],
            marks=pytest.mark.live,
        ),
    ],
    ids=lambda arguments: arguments[0],
)
def test_benchmark_prints_its_results_as_json(arguments):
    assert finite_numbers(json.loads(run(*arguments).stdout))


@pytest.mark.slow
def test_no_wrong_output_is_called_fine_and_no_real_recording_raises_an_alarm():
    found = json.loads(run('injected_faults.py', '--faults', '140').stdout)
    assert found['alarms'] == {}
    assert len({kind for kind, *_ in found['outcomes']}) == 16
    assert [row for row in found['outcomes'] if row[4]] == []
    assert sum(delay is not None for _, _, _, delay, *_ in found['outcomes']) > 50


@pytest.mark.live
@pytest.mark.slow
def test_benchmark_of_the_live_node_loses_none_of_a_hundred_messages():
    done = run('live.py', '--rates', '1000', '--seconds', '0.1', '--rounds', '1')
    results = json.loads(done.stdout)
    assert finite_numbers(results)
    assert results['rates']['1000']['node']['delivered'] == 1.0
    # A line says why there is no C++ node if there is none.
    lines = [] if 'C++' in results['rates']['1000'] else ['no C++ node: ']
    assert [line[:13] for line in done.stderr.splitlines()] == lines


def run(program, *options) -> subprocess.CompletedProcess[str]:
    """Run a benchmark."""
    return subprocess.run(
        [sys.executable, str(BENCHMARK / program), *options, '--json'],
        check=True, capture_output=True, text=True, timeout=120.0,
    )  # fmt: skip


def finite_numbers(results) -> list[float]:
    """Give every number, each of which is finite."""
    if isinstance(results, dict | list):
        parts = results.values() if isinstance(results, dict) else results
        return [number for part in parts for number in finite_numbers(part)]
    assert not isinstance(results, float) or math.isfinite(results)
    return [] if isinstance(results, str) else [results]


@pytest.mark.parametrize('rotor_angle', [0.0, 1.0, -30.0, 314.0])
def test_textbook_node_moves_as_the_mechanism_does(rotor_angle):
    expected = oracle.expected_motion(ACTUATOR, oracle.rotor_angle_of(rotor_angle))
    output_angle = textbook_node.output_angle(rotor_angle)
    assert oracle.angle_error(output_angle, expected.output_angle) <= 1e-12
    for centre, wanted in zip(textbook_node.centres(rotor_angle), expected.centres, strict=True):
        assert oracle.point_error(centre, wanted, ACTUATOR.eccentricity) <= 1e-12
