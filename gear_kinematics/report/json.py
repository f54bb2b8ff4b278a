# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""A report as strict JSON."""

import json
import math
from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from typing import Any

import numpy as np

from gear_kinematics.report.document import Document
from gear_kinematics.statistics.uncertainty import Estimate


def to_json(document: Document) -> str:
    """Write the data of a report, behind the command, by which `mark.is_report` recognises it."""
    data = {'made_by': document.title, **document.data}
    # ASCII passes every pipe and every code page.
    return json.dumps(_strict(data), indent=2, allow_nan=False, ensure_ascii=True) + '\n'


def estimated(estimate: Estimate) -> dict[str, Any]:
    """Return a measured quantity as it is in the JSON."""
    return {
        'value': estimate.value,
        'standard_uncertainty': estimate.standard,
        'degrees_of_freedom': estimate.degrees_of_freedom,
        'expanded_uncertainty': estimate.uncertainty,
        'repeats': estimate.repeats,
    }


def _strict(value: Any) -> Any:
    """Express a value in JSON, which has no NaN, infinities and lone surrogates.

    A dataclass becomes an object, without its arrays. What else has a text of its own, such as a
    fraction or a sentence, becomes that text.
    """
    match value:
        case Mapping():
            return {_strict(key): _strict(item) for key, item in value.items()}
        case str():
            return value.encode(errors='backslashreplace').decode()
        case float() if not math.isfinite(value):
            return None
        case float() | int() | None:
            return value
        case np.generic() | np.ndarray():
            return _strict(value.tolist())
        case Estimate():
            return _strict(estimated(value))
    if is_dataclass(value):
        members = {field.name: getattr(value, field.name) for field in fields(value)}
        return _strict({k: v for k, v in members.items() if not isinstance(v, np.ndarray)})
    text: Any = type(value).__str__
    if text is not object.__str__:
        return _strict(text(value))
    return [_strict(item) for item in value]
