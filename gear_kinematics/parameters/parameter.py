# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""A parameter of the node: its type, meaning and bounds, and the check of its values."""

import math
from collections.abc import Callable
from dataclasses import dataclass, field, fields, replace
from fractions import Fraction
from typing import Any, get_origin

_TRUTH = '; quote it, as YAML takes y, n, yes, no, on and off for truth values'


@dataclass(frozen=True, slots=True)
class Parameter:
    """Type, meaning and bounds of a parameter."""

    description: str
    minimum: float | None = None
    maximum: float | None = None
    least: float = 0.0  # least magnitude of a number, or of those in a list, that is not 0
    step: int = 0
    choices: tuple[str, ...] = ()
    read_only: bool = False
    check: Callable[[Any], object] = bool  # additional check, which raises ValueError
    kind: type = float
    items: type = str  # type of the items of a list

    def fault(self, name: str, value: Any) -> str | None:
        """Return the fault of a value, or None."""
        kind = type(value)
        if kind is not self.kind:
            quoted = f'; write {value}.0' if (kind, self.kind) == (int, float) else ''
            if (kind, self.kind) == (bool, str):
                quoted = _TRUTH
            if self.kind is str and kind in {int, float} and math.isfinite(value):
                texts = dict.fromkeys((str(Fraction(str(value))), str(value)))
                quoted = f'; quote it: {" or ".join(map(repr, texts))}'
                quoted += f', and twice after -p: "{name}:={str(value)!r}"'
            if self.kind is list and kind is self.items:
                quoted = f'; write [{value!r}]'
            return f'{name} must be of type {self.kind.__name__}, not {value!r}{quoted}'
        if isinstance(value, list) and not all(isinstance(item, self.items) for item in value):
            what = 'strings' if self.items is str else 'numbers with a decimal point'
            quoted = _TRUTH * any(isinstance(item, bool) for item in value)
            return f'{name} must be a list of {what}, not {value!r}{quoted}'
        if self.minimum is not None and self.maximum is not None:
            inside = self.minimum <= value <= self.maximum  # NaN is not
            if not inside or (self.step and (value - self.minimum) % self.step):
                steps = f' in steps of {self.step}' if self.step else ''
                bounds = f'between {self.minimum} and {self.maximum}{steps}'
                return f'{name} must be {bounds}, not {value!r}'
        if self.choices and value not in self.choices:
            return f'{name} must be one of {", ".join(self.choices)}, not {value!r}'
        numbers = (value if self.kind is list else [value]) if self.least else ()
        if any(0.0 < abs(number) < self.least for number in numbers):
            return f'{name} must be 0, or at least {self.least:g} in magnitude, not {value!r}'
        try:
            self.check(value)
        except ValueError as error:
            return f'{name}: {error}'
        return None


def parameter(*arguments: Any, **named: Any) -> Any:
    """Declare a field of a dataclass as a parameter; the arguments are those of `Parameter`."""
    return field(metadata={'parameter': Parameter(*arguments, **named)})


def declared_in(kind: type) -> dict[str, Parameter]:
    """List the parameters that a dataclass declares, by name, with the types of its fields."""
    return {
        each.name: replace(
            each.metadata['parameter'], kind=list if get_origin(each.type) is tuple else each.type
        )
        for each in fields(kind)
        if 'parameter' in each.metadata
    }
