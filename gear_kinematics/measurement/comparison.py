"""What several recordings tell together, as a part of a report."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from gear_kinematics.report.document import Section

HYSTERESIS = 'hysteresis'
"""The figure that is judged first, by its name."""


@dataclass(frozen=True, eq=False, slots=True)
class Comparison:
    """Of recordings at a common torque."""

    section: Section
    sentence: str
    """The answer, in one line."""
    data: Mapping[str, Any]
    """For the JSON, without its dataclasses converted."""


def expression(
    option: str, text: str, needed: str = 'one group in parentheses', counts: Sequence[int] = (1,)
) -> re.Pattern[str]:
    """Compile the regular expression of an option.

    Raises:
        ValueError: if it is none, or if the count of its groups is not among `counts`.
    """
    try:
        found = re.compile(text)
    except re.error as error:
        raise ValueError(f'{option} {text}: {error}') from error
    if found.groups not in counts:
        raise ValueError(
            f'{option} {text}: a regular expression needs {needed}, not {found.groups}'
        )
    return found
