# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Calibration file: the correction of the output of one gear, and the recordings it came from."""

import math
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import asdict, dataclass, is_dataclass
from fractions import Fraction
from pathlib import Path
from types import UnionType
from typing import Any, Self, get_args, get_origin, get_type_hints

import yaml

from gear_kinematics.kinematics import Gear, GearRatio, Mechanism
from gear_kinematics.parameters.yaml_file import Dumper, read_yaml

SCHEMA = 'gear_kinematics/calibration/1'  # identifies calibration files and their version
UNITS = {'angle': 'rad', 'torque': 'N·m', 'speed': 'rad/s', 'time': 's'}
"""The units of all numbers in a file."""
_GREATEST = 1e30  # far above any number of a real gear
_LONGEST_PERIOD = 2**26  # rotor turns; products of two such numbers are exact in float64
WIDEST = 0.1  #: rad: half width of an interval beyond which no gear and encoders deviate


def is_calibration(path: Path) -> bool:
    """Return whether a file is a calibration of any version; OSError if it cannot be read."""
    begin = f'schema: {SCHEMA.rpartition("/")[0]}'.encode()
    with path.open('rb') as file:
        return file.read(len(begin)) == begin


class CalibrationError(ValueError):
    """A calibration that cannot be used; the text names the cause."""


@dataclass(frozen=True, slots=True)
class UsedRecording:
    """A recording from which a calibration was made."""

    name: str  # name of the file
    sha256: str
    samples: int
    duration: float  # duration of the recording, s
    zero: float  # rad: offset of the deviation in this recording, from the zero of its encoder


@dataclass(frozen=True, slots=True)
class Order:
    """A periodic deviation: cos · cos(n φ2) + sin · sin(n φ2)."""

    name: str
    cycles: Fraction  # order n: cycles per turn of the rotor
    cos: float  # cosine coefficient, rad
    sin: float  # sine coefficient, rad


@dataclass(frozen=True, slots=True)
class Stop:
    """A stop operator on the ideal output angle: its coefficient times its state in ±radius."""

    radius: float  # rad, greater than 0
    coefficient: float  # coefficient of the state, rad/rad


@dataclass(frozen=True, slots=True)
class Compliance:
    """Wind-up caused by the output torque M: coefficient · (M - torque)."""

    coefficient: float  # coefficient of the torque, rad/(N·m)
    torque: float  # torque without a wind-up, N·m


@dataclass(frozen=True, slots=True)
class Spans:
    """Ranges of the output that the recordings covered, each as its least and greatest value."""

    speed: tuple[float, float] | None  # range of the speed, rad/s; None if time was not recorded
    torque: tuple[float, float] | None  # range of the torque, N·m; None if no effort was recorded
    angle: tuple[float, float]  # range of the ideal output angle, rad
    time: float  # total duration, s


@dataclass(frozen=True, slots=True)
class Prediction:
    """Quality of the prediction on held-out blocks of the data."""

    rms_before: float  # root mean square error without the correction, rad
    rms_after: float  # root mean square error with the correction, rad
    coverage: float  # share of samples within the 95 % interval


@dataclass(frozen=True, slots=True, kw_only=True)
class Calibration:
    """Model of the deviation of one gear's real output angle from the ideal one, x = φ2/i.

    The deviation at the rotor angle φ2 and the output torque M is

        constant + Σ orders(φ2) + Σ stops(x) + compliance(M)

    Raises:
        CalibrationError: if a number is out of range.
    """

    made_by: str  # program that wrote the file, and its version
    created: str  # date and time of the calibration, ISO 8601
    recordings: tuple[UsedRecording, ...]
    gear_ratio: Fraction  # signed, exact gear ratio i
    ring_teeth: int | None  # number of teeth zk; None if only the ratio is known
    satellite_teeth: int | None  # number of teeth zs; None if only the ratio is known
    constant: float  # constant part of the deviation, rad
    orders: tuple[Order, ...]
    hysteresis: tuple[Stop, ...]
    compliance: Compliance | None
    covariance: tuple[tuple[float, ...], ...]  # of cos and sin of orders, stops, and compliance
    half_width: float  # half width of the 95 % interval within `spans`, rad
    outside_half_width: float  # half width of the 95 % interval outside `spans`, rad
    spans: Spans
    validation: Prediction

    def __post_init__(self) -> None:
        """Check the numbers beyond their types."""
        spans = self.spans.speed, self.spans.torque, self.spans.angle
        reach = abs(self.constant) + sum(math.hypot(each.cos, each.sin) for each in self.orders)
        reach += sum(stop.radius * abs(stop.coefficient) for stop in self.hysteresis)
        width = self.half_width
        bounds = {
            f'an interval of ± {width:.3g} rad is too wide for a gear; are its numbers in rad?': (
                width <= WIDEST
            ),
            f"an error of {reach:.3g} rad is no gear's; are its numbers in rad?": reach <= math.pi,
            f'the orders must repeat within {_LONGEST_PERIOD} rotor turns': (
                self.period <= _LONGEST_PERIOD
            ),
            'a radius of the hysteresis must be greater than 0': all(
                stop.radius > 0.0 for stop in self.hysteresis
            ),
            'a compliance needs the span of the torque': (
                self.compliance is None or self.spans.torque is not None
            ),
            'a span must not end before it begins': all(
                span[0] <= span[1] for span in spans if span is not None
            ),
            'half_width must be greater than 0 and at most outside_half_width': (
                0.0 < width <= self.outside_half_width
            ),
        }
        if faults := [fault for fault, holds in bounds.items() if not holds]:
            raise CalibrationError('; '.join(faults))

    @classmethod
    def load(cls, path: Path, gear: Gear | None = None) -> Self:
        """Read a file, and check that it belongs to a gear, if one is given.

        Raises:
            CalibrationError: if the file is unusable or of another gear; the text names it.
        """
        document = read_yaml(path, CalibrationError)
        try:
            if not isinstance(document, dict) or document.pop('schema', '') != SCHEMA:
                raise CalibrationError(f'no calibration: its `schema` is not {SCHEMA}')
            if document.pop('units', '') != UNITS:
                raise CalibrationError(f'`units` must be {UNITS}')
            calibration: Self = _read(cls, document, '')
            if gear is not None:
                calibration._check(gear)
        except CalibrationError as error:
            # A value in the message may be as long as the file.
            raise CalibrationError(f'{path}: {error!s:.1000}') from error
        return calibration

    def text(self) -> str:
        """Write the content of the file."""
        fields = asdict(self, dict_factory=_with_ratios_as_texts)
        return yaml.dump(
            {'schema': SCHEMA, 'units': UNITS} | fields,
            Dumper=Dumper,
            sort_keys=False,
            allow_unicode=True,
            default_flow_style=None,  # a line for each order, stop and row of the covariance
            width=math.inf,
        )

    def _check(self, gear: Gear) -> None:
        """Check that this is a calibration of a gear; teeth are compared if both are known."""
        known = gear if isinstance(gear, Mechanism) else None
        its = (known.ring_teeth, known.satellite_teeth) if known else (None, None)
        own = self.ring_teeth, self.satellite_teeth
        differ = None not in {*own, *its} and own != its
        if differ or gear.gear_ratio != self.gear_ratio:
            here, there = _described(self.gear_ratio, *own), _described(gear.gear_ratio, *its)
            raise CalibrationError(f'calibrated for {here}, not for {there}')

    @property
    def period(self) -> int:
        """Rotor turns after which all orders repeat."""
        return math.lcm(*(order.cycles.denominator for order in self.orders))


def _with_ratios_as_texts(items: list[tuple[str, Any]]) -> dict[str, Any]:
    return {name: str(value) if isinstance(value, Fraction) else value for name, value in items}


def _described(ratio: Fraction, ring: int | None, satellite: int | None) -> str:
    teeth = '' if ring is None else f' (ring {ring}, satellite {satellite} teeth)'
    return f'gear ratio {ratio}{teeth}'


def _read(kind: Any, value: Any, where: str) -> Any:
    """Convert a value of a document to a type: a dataclass, a tuple, an optional or a scalar."""
    if isinstance(kind, UnionType):  # with None, which is its last
        return None if value is None else _read(get_args(kind)[0], value, where)
    if is_dataclass(kind):
        return _read_fields(kind, value, where)
    if get_origin(kind) is tuple:
        item, other = get_args(kind)
        if not isinstance(value, list) or (other is not ... and len(value) != 2):  # noqa: PLR2004
            length = 'of any length' if other is ... else 'of 2 numbers'
            raise CalibrationError(f'{where} must be a list {length}, not {value!r}')
        return tuple(_read(item, entry, f'{where}[{k}]') for k, entry in enumerate(value))
    if kind is float and type(value) in {int, float} and abs(value) <= _GREATEST:
        return float(value)
    if kind in {int, str} and type(value) is kind:
        return value
    if kind is Fraction and type(value) in {int, str}:
        with suppress(ValueError):
            return Fraction(GearRatio.parse(str(value)))
    raise CalibrationError(f'{where} must be {_KINDS[kind]}, not {value!r}')


def _read_fields(kind: Any, value: Any, where: str) -> Any:
    if not isinstance(value, Mapping):
        raise CalibrationError(f'{where} must have named values, not {value!r}')
    types, place = get_type_hints(kind), f'{where}.' if where else ''
    if missing := [place + name for name in types if name not in value]:
        raise CalibrationError(f'missing: {", ".join(missing)}')
    if unknown := [f'{place}{name}' for name in value if name not in types]:
        raise CalibrationError(f'unknown: {", ".join(unknown)}')
    return kind(**{name: _read(types[name], value[name], place + name) for name in types})


_KINDS: Mapping[type, str] = {
    float: 'a finite number',
    int: 'an integer',
    str: 'a text',
    Fraction: "an exact ratio such as '-19' or '1457/26'",
}
