# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Tables as benches write them: each is read as without its fault, or refused."""

import math
from dataclasses import replace

import numpy as np
import pytest

from gear_kinematics.measurement.columns import Sources
from gear_kinematics.measurement.lost_motion import measure
from gear_kinematics.measurement.reading import read, read_encoders
from gear_kinematics.measurement.recording import RecordingError

ARCMIN = math.radians(1.0 / 60.0)


@pytest.fixture
def gear(config):
    return replace(config, gear_ratio='-30')


@pytest.fixture
def table(shared_path):
    return lambda name: shared_path(f'data/faults/file_{name}.csv')


@pytest.mark.parametrize(
    ('name', 'given'),
    [
        ('0_reference_ramps', {}),
        ('comment_lines', {}),
        ('decimal_comma', {}),
        ('last_line_cut', {}),
        ('trailing_separators', {}),
        ('units_in_second_row', {}),
        ('word_degrees', {'angle': 'angle_degrees', 'torque': 'torque_Nmm'}),
        ('motor_side', {}),
    ],
)
def test_ramps_in_other_dialects(table, gear, name, given):
    recording = read(table(name), gear, Sources(**given))
    figures = measure(recording, gear).figures
    assert figures.hysteresis.value == pytest.approx(13.8 * ARCMIN, abs=0.3 * ARCMIN)
    on_rotor = [text for text in recording.columns if ' of the rotor [' in text]
    assert len(on_rotor) == 2 * (name == 'motor_side')


@pytest.mark.parametrize(
    ('name', 'given', 'rows'),
    [
        ('0_reference_encoders', {}, 1320),
        ('time_in_ms', {}, 1320),
        ('rotor_wraps', {}, 1320),
        ('time_in_iso8601', {}, 1199),
        ('one_row_out_of_order', {}, 1319),
        ('index_in_brackets', {'rotor': 'position[0]', 'output': 'position[1]'}, 1320),
        ('degrees_without_unit', {'unit': 'deg'}, 1320),
    ],
)
def test_encoders_in_other_dialects(table, gear, name, given, rows):
    recording, both = read_encoders(table(name), gear, Sources(**given))
    assert len(both.measured) == rows
    lost = measure(recording, gear).transmission.lost_motion
    assert lost.value == pytest.approx(18.0 * ARCMIN, abs=0.6 * ARCMIN)


def test_times_in_iso_8601(table, gear):
    _, both = read_encoders(table('time_in_iso8601'), gear)
    # The file has a sample each 40 ms.
    np.testing.assert_allclose(both.seconds, 0.04 * np.arange(len(both.seconds)), atol=1e-6)


@pytest.mark.parametrize(
    ('name', 'given', 'cause'),
    [
        ('arm_moves_freely', {}, r'the output turns by 100° under torque'),
        ('degrees_without_unit', {}, 'speeds of .* as in degrees: .* --angle-unit'),
        ('vesc_tool', {'rotor': 'tachometer', 'output': 'encoder_position'}, '--angle-unit'),
    ],
)  # fmt: skip
def test_what_cannot_be_known_is_refused_in_one_line(table, gear, name, given, cause):
    with pytest.raises(RecordingError, match=cause) as caught:
        read(table(name), gear, Sources(**given))
    assert '\n' not in str(caught.value)


@pytest.mark.parametrize(
    ('content', 'cause'),
    [
        ('time,angle_arcmin,torque\n0,1,2\n', 'the unit arcmin is not known'),
        ('time,angle,torque\ns,gon,Nm\n0,1,2\n', 'the unit gon is not known'),
        ('rotor,output\n1.5,20\n359.5,30.5\n', 'rotor has turns of 360'),
    ],
)
def test_units_are_never_assumed(tmp_path, gear, content, cause):
    path = tmp_path / 'r.csv'
    path.write_text(content, 'utf-8')
    angle = next((name for name in content.split('\n')[0].split(',') if 'angle' in name), None)
    with pytest.raises(RecordingError, match=cause):
        read(path, gear, Sources(angle=angle))
