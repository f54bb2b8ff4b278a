# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The file of a calibration: what is read is what was written, and nothing else is accepted."""

import os
from fractions import Fraction

import pytest
import yaml
from calibrations import calibration
from hypothesis import given, settings
from hypothesis import strategies as st
from refusals import refused

from gear_kinematics.correction.calibration_file import (
    SCHEMA,
    Calibration,
    CalibrationError,
    Order,
    Spans,
    Stop,
)
from gear_kinematics.kinematics import Branch, GearRatio, Mechanism

MISSING = 'missing'


def mechanism(ring: int, satellite: int) -> Mechanism:
    return Mechanism(ring, satellite, 0.0011, (Branch('a'),))


def order(**changes):
    return {'name': 'a', 'cycles': '1', 'cos': 0.0, 'sin': 0.0} | changes


@pytest.fixture
def file(tmp_path):
    """Write a calibration with entries changed, or deleted where they are MISSING."""

    def write(**changes):
        document = yaml.safe_load(calibration().text()) | changes
        document = {name: value for name, value in document.items() if value != MISSING}
        path = tmp_path / 'calibration.yaml'
        path.write_text(yaml.safe_dump(document), 'utf-8')
        return path

    return write


numbers = st.floats(-0.2, 0.2)
positive = st.floats(1e-12, 0.2)
texts = st.text(st.characters(categories=['L', 'N', 'P', 'S']) | st.just(' '), max_size=10)


@settings(max_examples=60)
@given(
    st.lists(
        st.builds(
            Order, texts, st.fractions(Fraction(1, 19), 99, max_denominator=99), numbers, numbers
        ),
        max_size=3,
    ),
    st.lists(st.builds(Stop, positive, numbers), max_size=3),
    texts,
    numbers,
)
def test_what_is_read_is_what_was_written(tmp_path_factory, orders, stops, created, constant):
    made = calibration(
        orders=tuple(orders), hysteresis=tuple(stops), created=created, constant=constant
    )
    path = tmp_path_factory.mktemp('files') / 'calibration.yaml'
    path.write_text(made.text(), 'utf-8')
    assert Calibration.load(path) == made


def test_file_without_teeth_torque_and_compliance_is_read(tmp_path):
    made = calibration(
        ring_teeth=None,
        satellite_teeth=None,
        gear_ratio=Fraction(1457, 26),
        compliance=None,
        spans=Spans((-1.0, 1.0), None, (0.0, 6.0), 10.0),
    )
    path = tmp_path / 'calibration.yaml'
    path.write_text(made.text(), 'utf-8')
    assert Calibration.load(path, GearRatio(1457, 26)) == made


def test_file_says_what_its_numbers_are():
    document = yaml.safe_load(calibration().text())
    assert document['schema'] == SCHEMA == 'gear_kinematics/calibration/1'
    assert document['units'] == {'angle': 'rad', 'torque': 'N·m', 'speed': 'rad/s', 'time': 's'}
    assert document['gear_ratio'] == '-19'
    assert document['orders'][2] == {
        'name': 'output × 1',
        'cycles': '1/19',
        'cos': 5e-4,
        'sin': 7e-4,
    }


@pytest.mark.parametrize(
    ('wrong', 'fault'),
    [
        ({'schema': 'gear_kinematics/calibration/2'}, 'no calibration: its `schema` is not'),
        ({'units': {'angle': 'deg'}}, '`units` must be'),
        ({'half_widht': 1.0}, 'unknown: half_widht'),
        ({'half_width': MISSING, 'spans': MISSING}, 'missing: half_width, spans'),
        ({'half_width': float('nan')}, 'half_width must be a finite number, not nan'),
        ({'half_width': 10**400}, 'half_width must be a finite number, not 1000'),
        ({'half_width': 0.0}, 'half_width must be greater than 0'),
        ({'constant': None}, 'constant must be a finite number, not None'),
        ({'gear_ratio': '1/0'}, "gear_ratio must be an exact ratio such as '-19' or '1457/26'"),
        ({'gear_ratio': '0'}, 'gear_ratio must be an exact ratio'),
        ({'orders': [3]}, 'orders[0] must have named values, not 3'),
        ({'orders': 3}, 'orders must be a list of any length, not 3'),
        (
            {'spans': {'speed': [1.0], 'torque': None, 'angle': [0.0, 1.0], 'time': 1.0}},
            'spans.speed must be a list of 2 numbers, not [1.0]',
        ),
        ({'orders': [order(cycles='1/99999989')]}, 'must repeat within 67108864 rotor turns'),
        ({'orders': [order(cos=3.0, sin=-1.0)]}, "an error of 3.16 rad is no gear's"),
        (
            {'half_width': 0.2, 'outside_half_width': 0.3},
            'an interval of ± 0.2 rad is too wide for a gear; are its numbers in rad?',
        ),
        ({'hysteresis': [{'radius': 0.0, 'coefficient': 1.0}]}, 'a radius of the hysteresis must'),
        (
            {'spans': {'speed': [1.0, -1.0], 'torque': None, 'angle': [0.0, 1.0], 'time': 1.0}},
            'a compliance needs the span of the torque; a span must not end',
        ),
        (b'', 'no calibration: its `schema` is not'),
        (b'schema: [', 'not YAML'),
        (b'\xff\xfe\x00', 'codec'),
        (2**18 * b'#' + b'\n', 'longer than 262144 bytes'),
        (b'a: [' + 10_000 * b'0, ' + b']', 'more than 8192 values'),
        (b'a: !!int ""', 'does not fit its tag'),
    ],
)
def test_fault_of_a_file_is_named_with_the_file(file, wrong, fault):
    path = file(**wrong if isinstance(wrong, dict) else {})
    if isinstance(wrong, bytes):
        path.write_bytes(wrong)
    with refused(CalibrationError, path, fault):
        Calibration.load(path)


def test_missing_file_is_named(tmp_path):
    with pytest.raises(CalibrationError, match=r'none\.yaml: No such file or directory'):
        Calibration.load(tmp_path / 'none.yaml')
    with pytest.raises(CalibrationError, match='Is a directory'):
        Calibration.load(tmp_path)
    os.mkfifo(tmp_path / 'pipe')
    with pytest.raises(CalibrationError, match=r'pipe: not a regular file'):
        Calibration.load(tmp_path / 'pipe')
    with pytest.raises(CalibrationError, match='null'):
        Calibration.load(tmp_path / 'a\0b')


@pytest.mark.parametrize(
    ('gear', 'there'),
    [
        (mechanism(61, 58), r'gear ratio -58/3 \(ring 61, satellite 58 teeth\)'),
        (mechanism(40, 38), r'gear ratio -19 \(ring 40, satellite 38 teeth\)'),
        (GearRatio(19), 'gear ratio 19'),
    ],
)
def test_calibration_of_another_gear_is_refused_naming_both(file, gear, there):
    own = r'gear ratio -19 \(ring 80, satellite 76 teeth\)'
    with pytest.raises(CalibrationError, match=f'yaml: calibrated for {own}, not for {there}$'):
        Calibration.load(file(), gear)


def test_calibration_by_ratio_fits_every_gear_of_that_ratio(file):
    path = file(ring_teeth=None, satellite_teeth=None)
    assert Calibration.load(path, mechanism(40, 38)).gear_ratio == -19
    with pytest.raises(CalibrationError, match='calibrated for gear ratio -19, not for'):
        Calibration.load(path, mechanism(61, 58))


def test_lines_of_another_file_are_not_shown(tmp_path):
    path = tmp_path / 'passwords'
    path.write_text('root:secret:0\n\tadmin: [hidden\n', 'utf-8')
    with pytest.raises(CalibrationError, match=r'not YAML: .* in line 2$') as error:
        Calibration.load(path)
    assert 'secret' not in str(error.value)
    assert 'hidden' not in str(error.value)
