# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Everything that diagnostics can say, each with its level, message and advice.

Messages and advice are formatted with the values of a `Fact`: counts by cause, other facts, and
numbers in SI units; the names of others end with their unit.
"""

from collections.abc import Iterable, Mapping, Sequence
from enum import Enum
from typing import Any, NamedTuple, Self

from gear_kinematics.statistics.uncertainty import Estimate

OK, WARN, ERROR = 0, 1, 2  # levels of diagnostic_msgs/DiagnosticStatus

_DRIVER = 'Check that the driver is running, and that its topic is remapped.'
_HOME_IT = 'then home it (gearkin home or ~/home)'
_HOME = f'Move the output to its home angle, {_HOME_IT}.'
_CLOCKS = 'Check that both drivers run and send often, and that their clocks agree.'
_RANGE = 'Check output_range, gear_ratio and the zeros of both encoders.'
_VELOCITY = 'Let the driver send rad/s of the rotor, or no velocities.'
_LIMIT = 'Let the driver send rad, stamped in s and ns, or set the limit to that of the motor.'
_QOS = 'Change the quality of service of one of the two.'
_TWO_NODES = 'Stop one of the two nodes, or give each its own namespace.'

_VELOCITIES = 'the velocities contradict the positions: they seem to be {meaning}'
_AT = 'the output, at {angle_deg:.2f}°, '
_ENDS = 'output_range, {low_deg:.2f}° to {high_deg:.2f}°'
_MARGIN = '{used_deg:.3g}° of {margin_deg:.3g}° margin'
_BOTH = '{encoder_deg:.2f}° by the encoder, {rotor_deg:.2f}° by the rotor'
_EFFORT = (
    'efforts of up to {effort:.4g} N·m at the rotor are more than {whose} ({bearable:.3g} N·m): '
    'set rotor_effort_factor (N·m per unit) if the messages have another unit, such as mA'
)
_TWO_MOTIONS = (
    'the positions alternate between two motions, as if two drivers sent this joint, or 0 for '
    'failed readings'
)
_TOO_SELDOM = (
    '{rate:g} Hz is too slow to count turns at a max_rotor_speed of {limit:.4g} rad/s: lower it '
    'to {speed:.3g} rad/s or less, or let the driver read and send at {least:.0f} Hz or '
    'more{other}'
)
_PEAK_TO_PEAK = 'peak to peak {angle:.3g} rad'


class Condition(Enum):
    """A condition of a gear, its drivers or its connections: level, message and advice."""

    # The rotor's driver
    NO_INPUT = ERROR, 'no input for {age:.1f} s', _DRIVER
    OTHERS_ALONE = (
        ERROR,
        "no input for {age:.1f} s, but {count} messages without the joint '{joint}'",
        'Check that the driver still reads that motor and names it as rotor_joint does.',
    )
    JUMPED = (
        ERROR,
        "the rotor's encoder jumped by {angle:.4g} rad at {time:.3f} s",
        'Check whether the drive restarted or repeats readings; if they wrap, set rotor_encoder.',
    )
    WRAPS = ERROR, 'the positions wrap every {angle:.4g} rad: set {setting}', _HOME
    TOO_SELDOM = ERROR, _TOO_SELDOM, _HOME
    GAP = (
        ERROR,
        'a gap of {gap:.3f} s could hide a turn of the rotor',
        'Let the driver send without gaps, or lower max_rotor_speed to what the motor reaches.',
    )
    TURNED_TOO_FAR = (
        ERROR,
        'the rotor turned by more than max_rotor_speed allows within {gap:.3f} s',
        "Check whether the drive restarted and how it stamps, or raise that limit to the motor's.",
    )
    ELSEWHERE = (
        WARN,
        'a driver came, and the rotor is {angle_deg:.0f}° from where it was',
        f'Check whether the drive restarted; {_HOME_IT}.',
    )
    REJECTED = (
        WARN,
        'rejected: {counts}',
        'docs/diagnostics.md explains why messages are rejected.',
    )
    TAKEN_BACK = (
        WARN,
        'single positions were wrong: {count}, the last by about {angle:.3g} rad at {time:.3f} s',
        'Check the encoder and its cable, and whether a second driver sends this joint.',
    )
    JOINT_MISSING = (
        WARN,
        'rejected: {counts}',
        'Set {parameter} to one of the joints of the driver.',
    )
    LOST = WARN, 'lost {count}', 'Check the network, and whether the computer is too busy.'
    LOSSES_UNKNOWN = OK, 'losses unknown', ''
    VELOCITIES_ARE = WARN, _VELOCITIES, _VELOCITY
    VELOCITIES_UNKNOWN = WARN, _VELOCITIES + ', {factor:.3g} times the slope', _VELOCITY
    POSITIONS_ARE = WARN, _VELOCITIES, 'Let the driver send positions of the rotor in rad.'
    VELOCITIES_LATE = (
        WARN,
        'the velocities are about {delay:.2g} s late',
        'Let the driver filter them less, or send them with the position of the same time.',
    )
    POSITIONS_LATE = (
        WARN,
        'the positions are about {delay:.2g} s behind the velocities',
        'Let the driver filter the positions less, or send measured velocities of the same time.',
    )
    POSITIONS_STAND = (
        WARN,
        'the velocities contradict the positions, which do not change',
        'Check the encoder, its cable, and which velocities the driver sends.',
    )
    CLOCKS_ALTERNATE = (
        WARN,
        'the stamps went back by more than 1 s {count} times, as from two clocks in turn',
        'Stop all drivers but one: steps of the positions are not found meanwhile.',
    )
    CLOCK_SET_BACK = (
        OK,
        'the clock was set back by at least {size:.3g} s just after {time:.3f} s',
        '',
    )
    # The following are said of recordings only.
    TWO_MOTIONS = OK, _TWO_MOTIONS, ''
    VELOCITIES_WERE = OK, 'until {time:.3f} s, {doubt}', ''
    EFFORT_TOO_LARGE = OK, _EFFORT, ''
    EFFORT_IS_ZERO = OK, 'the effort is 0 throughout the motion, and is taken as absent', ''
    UNSTAMPED = OK, '{messages} without a stamp: outputs have the time of reception', ''
    UNREFERENCED_AT_END = OK, 'the turns of the rotor are not known at the end', ''
    BEYOND_LIMITS = WARN, '{which}', '{advice}'
    BEYOND_SPEED = WARN, '{speed:.4g} rad/s exceed max_rotor_speed', _LIMIT
    BEYOND_ACCELERATION = WARN, '{acceleration:.4g} rad/s² exceed max_rotor_acceleration', _LIMIT
    BEYOND_PRECISION = (
        WARN,
        'the positions are numbers of single precision, in steps of {angle:.3g} rad so far from 0',
        'Let the driver count turns in double precision, or restart it in time.',
    )
    ZERO_STAMPS = (
        WARN,
        'zero stamps {count}',
        'Let the driver stamp its messages: without stamps, turns may be miscounted.',
    )
    REPEATED_STAMPS = (
        WARN,
        'repeated stamps {count}',
        'Let the driver stamp each message: gaps do not show, and turns may be miscounted.',
    )
    STAMPS_TOO_FAST = (
        WARN,
        'the stamps run {factor:.0f} times as fast as the clock',
        'Let the driver stamp in s and ns: until then, speeds, gaps and jumps are misjudged.',
    )
    SEVERAL_DRIVERS = (
        WARN,
        'several drivers send this joint',
        'Stop all but one, such as a joint_state_publisher, or give them different topics.',
    )
    # The rotor's turns, and the encoder at the output that can tell them
    NOT_REFERENCED = ERROR, 'not referenced', _HOME
    NOT_FOUND = ERROR, 'not referenced: {why}', '{why.advice} Or: ' + _HOME
    NO_SAMPLES = ERROR, 'no {count} samples of output_encoder in a row', _CLOCKS
    UNEXPLAINED = (
        ERROR,
        _MARGIN,
        'Check gear_ratio, the directions and zeros of both encoders, and the gear.',
    )
    AMBIGUOUS = (
        ERROR,
        _MARGIN,
        'Stop the output; or calibrate the gear, or lower transmission_error_limit.',
    )
    OUTSIDE = ERROR, _AT + 'is outside of ' + _ENDS, _RANGE
    AT_EITHER_END = ERROR, _AT + 'may be at either end of ' + _ENDS, _RANGE
    DISAGREES = (
        ERROR,
        'output_encoder disagrees: ' + _BOTH,
        f'Check the directions of both encoders, and for slips; {_HOME_IT}, or restart the node.',
    )
    NOT_CHECKED = OK, 'reference not checked', ''
    WERE_UNKNOWN = WARN, 'turns unknown for {count} inputs', 'Do not use the outputs of that time.'
    HOMED = OK, 'homed', ''
    EXACT_TURNS = OK, 'turns of a single-turn encoder, exact', ''
    EXACT_PERIODS = OK, 'periods of the encoder, exact', ''
    MEASURED = OK, 'output encoder, ± {uncertainty_deg:.2g}°', ''
    # Where the zero is kept
    ZERO_KEPT = OK, 'kept in {path}', ''
    ZERO_NOT_KEPT = OK, 'lost at restart: {path}: {why}', ''
    ZERO_NOT_SET = OK, 'not homed yet', ''
    ZERO_IS_LOST = OK, 'lost at restart: set home_file', ''
    # The transmission error
    NO_ENCODER = WARN, 'no output_encoder for {age:.1f} s', _DRIVER
    NOT_COMPARED = WARN, 'no rotor angle of the same time', _CLOCKS
    UNREFERENCED = WARN, 'none while the turns of the rotor are unknown', _HOME
    CLOCKS_APART = (
        WARN,
        'the newest stamps of rotor_state and output_encoder are at least {apart:.2g} s apart',
        'First check that both drivers stamp by one clock: angles of different times disagree.',
    )
    TOO_LARGE = (
        WARN,
        _PEAK_TO_PEAK,
        'Check the gear and its encoders, or raise transmission_error_limit.',
    )
    BEYOND_ANY_GEAR = (
        WARN,
        _PEAK_TO_PEAK,
        f'Check gear_ratio, and the directions and zeros of both encoders; {_HOME_IT}.',
    )
    SLIPPED = (
        WARN,
        'the output has slipped by {angle_deg:.2f}° against the rotor, at {time:.3f} s',
        f'Check the couplings, and the directions and zeros of both encoders; {_HOME_IT}.',
    )
    FITS_NO_LONGER = WARN, 'calibration no longer fits', 'Calibrate the gear again.'
    DIRECTION_NOT_CHECKED = OK, 'direction not checked', ''
    # The preload
    MARGIN_UNKNOWN = OK, 'unknown: no {lacking} in rotor_state', ''
    OUT_OF_MESH = (
        WARN,
        'a branch was out of mesh for {share:.1f} % of the time',
        'Raise the preload (gearkin preload) or lower the torque of the output.',
    )
    # The ROS graph
    DRIVER_QOS = ERROR, 'incompatible QoS on {topic}: {policy} (driver {node})', _QOS
    LISTENER_QOS = WARN, 'incompatible QoS on {topic}: {policy} (listener {node})', _QOS
    UNSENT = WARN, 'not sent {count}', 'Look for a listener that is stuck.'
    ALSO_PUBLISHES = WARN, '{node} also publishes {topics}', _TWO_NODES
    SAME_NAME = (
        WARN,
        # Fast DDS lists a node that was killed for as long.
        'another node is named {node}, or one of that name was killed in the last 20 s',
        _TWO_NODES,
    )

    def __init__(self, level: int, message: str, advice: str) -> None:
        self.level, self.message, self.advice = level, message, advice

    def __call__(self, **values: Any) -> 'Fact':
        """Return the fact that the condition holds, with its values."""
        return Fact(self, values)


class Fact(NamedTuple):
    """A condition that holds, with its values; as text it is the message."""

    condition: Condition
    values: Mapping[str, Any]

    def __str__(self) -> str:
        values = {name: _listed(value) for name, value in self.values.items()}
        return self.condition.message.format(**values)

    @property
    def advice(self) -> str:
        """What to do about it, in sentences; '' if it is no fault."""
        return self.condition.advice.format(**self.values)


def _listed(value: Any) -> Any:
    """List several things, or counts by cause; leave other values as they are."""
    if isinstance(value, Mapping):
        value = [f'{cause} {count}' for cause, count in value.items()]
    return ', '.join(map(str, value)) if isinstance(value, list) else value


class GearReport(NamedTuple):
    """Facts on one subject in the time since the last report."""

    facts: Sequence[Fact]  # the gravest first
    values: Mapping[str, Any]  # counts, numbers in the unit of their name, facts; None for none

    @classmethod
    def of(cls, facts: Iterable[Fact], values: Mapping[str, Any]) -> Self:
        """Sort facts by level; those of the same level stay in their order."""
        return cls(sorted(facts, key=lambda fact: -fact.condition.level), values)

    @property
    def level(self) -> int:
        """The level of the gravest fact."""
        return self.facts[0].condition.level if self.facts else OK

    @property
    def message(self) -> str:
        """All facts."""
        return '; '.join(map(str, self.facts)) or 'ok'

    @property
    def texts(self) -> dict[str, str]:
        """The values as text, with `advice` where there are faults."""
        texts = {name: _text(name, value) for name, value in self.values.items()}
        if self.level:
            advice = (fact.advice for fact in self.facts if fact.condition.level)
            texts['advice'] = ' '.join(dict.fromkeys(advice))
        return texts


_FORMATS = {'Hz': '.1f', '%': '.1f', 'N·m': '.4g'}  # by the first word of the unit
_OWN_FORMATS = {'age of last input (s)': '.3f', 'rotor zero (rad)': '.9g'}


def _text(name: str, value: Any) -> str:
    if value is None:
        return 'none'
    if isinstance(value, bool):
        return str(value).lower() if name == 'referenced' else 'yes' if value else 'no'
    if isinstance(value, Estimate):
        spread = value.uncertainty
        return f'{value.value:.6g}' + ('' if spread is None else f' ± {spread:.2g}')
    if isinstance(value, float):
        unit = name.rpartition('(')[2].rstrip(')').partition(' ')[0]
        return format(value, _OWN_FORMATS.get(name) or _FORMATS.get(unit, '.6g'))
    return str(value)
