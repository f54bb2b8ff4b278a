# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The report as JSON, and its schema."""

import copy
import json
import math
import re
from dataclasses import dataclass, fields, replace
from fractions import Fraction
from pathlib import Path

import jsonschema
import numpy as np
import pytest
import report_samples as samples

from gear_kinematics.report import json as strict_json
from gear_kinematics.report.document import Document
from gear_kinematics.statistics.uncertainty import Estimate
from gear_kinematics.validation.document import document
from gear_kinematics.validation.findings import findings
from gear_kinematics.validation.report import BagReport

DOCS = Path(__file__).resolve().parents[2] / 'docs'


def to_json(reports):
    return strict_json.to_json(document(reports))


OF_ARMS = {'actuator', 'actuators'}
"""Fields that reports on one gear lack."""


@pytest.fixture(scope='module')
def schema():
    return json.loads((DOCS / 'report.schema.json').read_text('utf-8'))


@pytest.fixture(scope='module')
def strict(schema):
    """Admit what the schema names, and nothing besides."""
    closed = copy.deepcopy(schema)
    for part in (closed, *closed['$defs'].values()):
        if 'properties' in part:
            assert sorted(part['required']) == sorted(part['properties'].keys() - OF_ARMS)
            part['additionalProperties'] = False
    return jsonschema.Draft202012Validator(closed)


def loads(text):
    return json.loads(text, parse_constant=lambda name: pytest.fail(f'{name} is no JSON'))


def sane(report):
    # A ratio that is none is refused; the hostile one is.
    return replace(report, gear_ratio='-19')


def test_every_report_follows_the_schema(schema, strict):
    jsonschema.Draft202012Validator.check_schema(schema)
    for reports in ([], *([report] for report in samples.ALL), samples.ALL):
        text = to_json([sane(report) for report in reports])
        assert text.isascii()
        assert not re.search(r'(?<!\\)\\ud[89a-f]', text)  # half a character
        document = loads(text)
        strict.validate(document)
        assert len(document['bags']) == len(reports)


def test_everything_but_what_is_drawn_is_there():
    bag = loads(to_json([samples.FAILING]))['bags'][0]
    drawn = {'series', 'mechanism', 'module', 'elapsed'}
    assert bag.keys() == {*(field.name for field in fields(BagReport)), 'causes'} - drawn - OF_ARMS
    assert bag['bag'] == 'logs/2026-11-20 Prüfstand 7/läuft.mcap'
    assert bag['rotor']['rejected'] == {'joint missing': 3, 'position not finite': 2}
    assert bag['rotor']['longest_gaps'][0] == {
        'stamp': 1700000001923456789,
        'seconds': 0.0423,
        'turned': 13.2,
    }
    position = bag['topics'][0]['fields'][0]
    assert position['max_error'] == 2e-3
    assert position['budget_used'] == pytest.approx(2e6)
    assert position['worst_stamp'] == samples.START + 2_500_000_000
    assert not position['passed']
    assert [topic['passed'] for topic in bag['topics']] == [False, False]
    # All that the text has, in its order, of which the causes are a part.
    assert bag['findings'] == [finding.text for finding in findings(samples.FAILING)]
    assert bag['causes'] == bag['findings'][:1]


def test_numbers_that_are_none_are_null():
    bag = loads(to_json([samples.NOT_FINITE]))['bags'][0]
    position = bag['topics'][0]['fields'][0]
    assert position['max_error'] is None
    assert position['rms_error'] is None
    assert position['budget_used'] is None
    assert not position['passed']
    assert bag['rotor']['rate'] is None
    assert bag['rotor']['max_speed'] is None


def test_results_are_written_without_their_arrays():
    @dataclass
    class Result:
        ratio: Fraction
        values: np.ndarray
        angle: Estimate
        count: np.int64

    result = Result(Fraction(-58, 3), np.zeros(3), Estimate(2.0, 0.5, math.inf, 9), np.int64(3))
    written = loads(
        strict_json.to_json(Document('gearkin', (), {'found': (result,), 'pins': np.arange(2)}))
    )
    angle = {'value': 2.0, 'standard_uncertainty': 0.5, 'degrees_of_freedom': None}
    angle |= {'expanded_uncertainty': pytest.approx(0.98, abs=1e-3), 'repeats': 9}
    assert written['found'] == [{'ratio': '-58/3', 'angle': angle, 'count': 3}]
    assert written['pins'] == [0, 1]


def test_example_of_the_documentation_follows_the_schema(strict):
    page = (DOCS / 'report.md').read_text('utf-8')
    (example,) = re.findall(r'```json\n(.*?)```', page, re.DOTALL)
    strict.validate(loads(example))
