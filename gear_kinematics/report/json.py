# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""A report as strict JSON."""

import json
import math
from collections.abc import Mapping
from typing import Any

from gear_kinematics.report.document import Document


def to_json(document: Document) -> str:
    """Write the data of a report, behind the command, by which `mark.is_report` recognises it."""
    data = {'made_by': document.title, **document.data}
    # ASCII passes every pipe and every code page.
    return json.dumps(_strict(data), indent=2, allow_nan=False, ensure_ascii=True) + '\n'


def _strict(value: Any) -> Any:
    """Replace what strict JSON cannot express: NaN, infinities and lone surrogates."""
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
