"""The report as JSON, described in docs/report.md and docs/report.schema.json."""

import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from typing import Any

from gear_kinematics.report import wording
from gear_kinematics.validation.report import BagReport, FieldReport, TopicReport

SCHEMA = 'gear_kinematics/report'
VERSION = 1


def to_json(reports: Sequence[BagReport]) -> str:
    """Write the reports."""
    document = {
        'schema': SCHEMA,
        'version': VERSION,
        'verdict': wording.worst_verdict(reports),
        'bags': [_bag(report) for report in reports],
    }
    return dumps(document)


def dumps(document: Any) -> str:
    """Write strict JSON; numbers that it cannot write are null."""
    # ASCII passes every pipe and every code page.
    return json.dumps(_strict(document), indent=2, allow_nan=False, ensure_ascii=True) + '\n'


def _bag(report: BagReport) -> dict[str, Any]:
    content = asdict(report)
    for drawn in ('series', 'mechanism', 'module'):
        del content[drawn]
    content['topics'] = [_topic(topic) for topic in report.topics]
    return content


def _topic(topic: TopicReport) -> dict[str, Any]:
    fields = [_field(field) for field in topic.fields]
    return {**asdict(topic), 'passed': topic.passed, 'fields': fields}


def _field(field: FieldReport) -> dict[str, Any]:
    return {**asdict(field), 'passed': field.passed, 'budget_used': field.budget_used}


def _strict(value: Any) -> Any:
    """Replace what strict JSON has no place for: NaN, infinities and halves of characters."""
    match value:
        case Mapping():
            return {_strict(key): _strict(item) for key, item in value.items()}
        case list() | tuple():
            return [_strict(item) for item in value]
        case str():
            return value.encode(errors='backslashreplace').decode()
        case float() if not math.isfinite(value):
            return None
    return value
