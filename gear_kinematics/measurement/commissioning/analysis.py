# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Parameters of a gear that recordings of both encoders determine, and those they leave open.

The ratio between the encoders is that of the gear, with the opposite sign if one of them counts
backwards.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import islice
from typing import Any, Literal, NamedTuple

import numpy as np

from gear_kinematics.kinematics.gear_ratio import GearRatio, tooth_pairs
from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.measurement.commissioning.joint import Joint
from gear_kinematics.measurement.ratio import RatioEstimate, estimate_ratio, not_followed
from gear_kinematics.measurement.recording import Recording, RecordingError
from gear_kinematics.measurement.sentences import Observation, Observed
from gear_kinematics.measurement.transmission import transmission_figures
from gear_kinematics.measurement.two_encoders import ENCODER_ERROR
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.report.document import number

_FASTER = 2.0  # proposed limit over the greatest recorded speed, which the motor may well exceed
_ONE_TURN = 1.05  # turns beyond which positions are multi-turn: one, and a margin for noise
_DEGREES = 360.0  # range of positions that are in degrees, not rad
_MOST_TEETH, _SHOWN = 200, 10
"""Most teeth of the ring gears in proposed pairs, as pairs have multiples; number of pairs."""


class Channel(NamedTuple):
    """Topic and joint of an encoder; both empty for a table."""

    topic: str
    joint: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Request:
    """What is known about the gear, and what is to be determined."""

    rotor: Channel
    output: Channel
    ratio: GearRatio | None = None  # signed ratio of the gear, to be confirmed
    teeth: tuple[int, int] | None = None  # teeth of ring gear and satellite, with this ratio
    zero_here: float | Literal['START', 'END'] | None = None  # moment of the last recording, s
    file: NodeParameters | None = None  # file to be judged; zeros that agree are kept

    @property
    def limits(self) -> tuple[float, float]:
        """Greatest speed, rad/s, and acceleration, rad/s², of the rotor, given or by default."""
        return (self.file or NodeParameters.load()).rotor_limits


@dataclass(frozen=True, slots=True)
class Value:
    """A parameter of the node, or another quantity that is to be determined."""

    name: str
    value: str | int | float | None  # None if undetermined
    evidence: Observed  # for an undetermined value, what is known and what to do


@dataclass(frozen=True, eq=False, slots=True)
class Commissioning:
    """Result of a commissioning."""

    request: Request
    joints: tuple[Joint, ...]  # one for each recording
    longest: Joint  # recording with the most travel, which determines the ratio
    ratio: RatioEstimate | None  # between the encoders; None if it cannot be estimated
    between: GearRatio | None  # exact ratio between the encoders; None if undetermined
    answer: Observed  # the result
    values: tuple[Value, ...]
    notes: tuple[Observed, ...]  # observations on other subjects than parameters
    questions: tuple[str, ...] = ()  # fields of the rotor's messages that seem wrong

    def changes(self, parameters: NodeParameters) -> dict[str, tuple[Any, Any]]:
        """Return the old and the new value of each parameter that has to change, by name."""
        has = parameters.values() | {'gear_ratio': str(parameters.gear.gear_ratio)}
        pairs = ((v.name, has.get(v.name), v.value) for v in self.values)
        return {name: (old, new) for name, old, new in pairs if new not in (None, old)}


def commission(recordings: Sequence[Recording], request: Request) -> Commissioning:
    """Determine the parameters of the node for a gear.

    Args:
        recordings: recordings of one gear in the order of time, with the positions of both
            encoders as recorded, neither reversed nor unwrapped.
        request: what else is known.

    Raises:
        RecordingError: if a recording has too few samples, no times, positions in another unit
            than rad, or no sample at `zero_here`.
    """
    joints = tuple(map(Joint.of, recordings))
    longest = max(joints, key=lambda joint: joint.travel)
    ratio, between, evidence = _decided(longest, request.ratio)
    encoders, known = longest.encoders, request.file or NodeParameters.load()
    if between:
        motion = transmission_figures(encoders, between, known.transmission_error_travel)
        if wrong := not_followed(motion.angle, motion.error, between):
            between, evidence = None, wrong
    answer = evidence
    speed = float(np.max(np.abs(encoders.speed(Fraction(1)))))
    both = encoders.rotor.seconds, encoders.seconds
    rotor, output = ((len(times) - 1) / np.ptp(times) for times in both)
    notes = [Observation.SPEED_AND_RATES(speed=speed, rotor=rotor, output=output)]
    named = ('rotor_joint', request.rotor), ('output_encoder_joint', request.output)
    values = [
        Value(name, joint, Observation.JOINT(topic=topic))
        for name, (topic, joint) in named
        if topic and not request.file
    ]
    ranges = [(joint.rotor_range, joint.rotor_wraps) for joint in joints]
    turned = max(float(np.ptp(joint.turned)) for joint in joints)
    values += encoder_kind(ranges, turned, longest.travel)
    if between:
        repeats = longest.rotor_range not in {0.0, TURN}
        what = Observation.RATIO_AND_RANGE if repeats else Observation.GEAR_RATIO
        exact = request.ratio or between
        answer = what(ratio=exact, evidence=evidence, size=longest.rotor_range)
        values += _ratio(between, evidence, request)
        values += _zeros(joints, between, request)
        if delay := motion.delay:
            which = Observation.EARLY if delay.value < 0.0 else Observation.LATE
            late = which(delay=replace(delay, value=abs(delay.value)))
            notes.append(late if delay.clear else Observation.NOT_LATE())
        else:
            values.append(Value('delay', None, Observation.DELAY_OR_HYSTERESIS()))
    elif ratio and ratio.advice and not longest.spoilt:
        seen = Observation.RATIO_SO_FAR(measured=ratio.measured, advice=ratio.advice)
        values.append(Value('ratio', None, seen))
    if speed > known.max_rotor_speed:
        reached = Observation.FASTEST(speed=speed)
        values.append(Value('max_rotor_speed', _FASTER * speed, reached))
    return Commissioning(
        request, joints, longest, ratio, between, answer, tuple(values), tuple(notes)
    )


def _decided(
    longest: Joint, given: GearRatio | None
) -> tuple[RatioEstimate | None, GearRatio | None, Observed]:
    """Return the ratio between the encoders, the exact one, and why it is that or undetermined."""
    encoders = longest.encoders
    try:
        ratio = estimate_ratio(
            longest.turned, encoders.measured, encoders.seconds, encoders.interpolated
        )
    except RecordingError as error:
        return None, None, Observation.NO_RATIO(why=str(error))
    seen = {'measured': ratio.measured, 'degrees': math.degrees(longest.travel)}
    if not (exact := given or ratio.taken):
        candidates, advice = [*ratio.candidates], ratio.advice
        advice = Observation.RECORD_ANEW() if longest.spoilt else advice
        return ratio, None, Observation.OPEN_RATIO(**seen, candidates=candidates, advice=advice)
    for between in (exact, -exact):
        if ratio.fits(between):
            why = Observation.FITS_GIVEN_RATIO if given else Observation.ONLY_FRACTION
            return ratio, GearRatio(between), why(**seen)
    return ratio, None, Observation.GIVEN_RATIO_DISAGREES(**seen, given=exact)


def encoder_kind(
    found: Sequence[tuple[float, int]], turned: float, travel: float = 0.0
) -> Iterator[Value]:
    """Yield the kind of the rotor's encoder, and its range.

    Args:
        found: what `find_range` returns for each recording.
        turned: the greatest travel of the rotor in one of them, rad.
        travel: that of the output, rad.
    """
    ranges, wraps = {size for size, _ in found if size}, sum(count for _, count in found)
    turns = turned / TURN
    if any(abs(size - _DEGREES) < 0.01 * _DEGREES for size in ranges):
        yield Value('rotor_encoder', None, Observation.DEGREES(wraps=wraps))
    elif len(ranges) > 1:
        differ = ' and '.join(number(each) for each in sorted(ranges))
        yield Value('rotor_encoder_range', None, Observation.RANGES_DIFFER(ranges=differ))
    elif ranges == {TURN}:
        yield Value('rotor_encoder', 'single_turn', Observation.WRAPS_OF_A_TURN(wraps=wraps))
    elif ranges:
        seen = Observation.TURNED_WITH_WRAPS(turns=turns, wraps=wraps)
        yield Value('rotor_encoder', 'multi_turn', seen)
        size = ranges.pop()
        whole = round(size / TURN) if size == TURN * round(size / TURN) else 0
        evidence = Observation.EQUAL_STEPS(wraps=wraps, size=size, turns=whole)
        yield Value('rotor_encoder_range', size, evidence)
    elif turns <= _ONE_TURN and travel > 2.0 * _ONE_TURN * TURN:
        yield Value('rotor_encoder', None, Observation.WRAPS_UNCLEAR())
    elif turns <= _ONE_TURN:
        yield Value('rotor_encoder', None, Observation.TURNED_TOO_LITTLE(turns=turns))
    else:
        yield Value('rotor_encoder', 'multi_turn', Observation.TURNED(turns=turns))


def _ratio(between: GearRatio, evidence: Observed, request: Request) -> Iterator[Value]:
    """Yield the ratio of the gear, and the directions of both encoders."""
    ratio = request.ratio or between
    if request.teeth:
        yield Value('ring_teeth', request.teeth[0], evidence)
        yield Value('satellite_teeth', request.teeth[1], evidence)
    else:
        pairs = tooth_pairs(ratio, ratio, _MOST_TEETH) if ratio < 0 else ()
        teeth = [f'{ring}/{satellite}' for ring, satellite in islice(pairs, _SHOWN)]
        evidence = Observation.TEETH(evidence=evidence, teeth=teeth) if teeth else evidence
        yield Value('gear_ratio', str(ratio), evidence)
    sense = request.file.output_encoder_direction if request.file else 1
    which = (Observation.SAME_SENSE if between > 0 else Observation.OPPOSITE_SENSES)()
    which = which if request.ratio else Observation.SENSE_GIVES_SIGN(sense=which)
    direction = sense if ratio == between else -sense
    yield Value('rotor_direction', direction, which)
    yield Value('output_encoder_direction', sense, Observation.SENSE_KEPT())


def _zeros(joints: Sequence[Joint], between: GearRatio, request: Request) -> Iterator[Value]:
    """Yield zeros with which the output angles of both encoders agree on average."""
    last, ratio, file, moment = joints[-1], float(between), request.file, request.zero_here
    zero = shown = file.output_encoder_zero if file else 0.0
    why, turn = Observation.ZERO_KEPT(), TURN if last.output_wraps else math.inf
    if moment is not None:
        zero = float(last.encoders.measured[last.row_at(moment)])
        shown = math.remainder(zero, turn)
        why = Observation.ZERO_AT(moment=moment, recording=last.recording.name)
    zeros = last.turned - ratio * (last.encoders.measured - zero)
    mean, spread = float(np.mean(zeros)), float(np.ptp(zeros / ratio))
    period, error = abs(ratio) * turn, max(spread, ENCODER_ERROR)
    repeats = max(joint.rotor_range for joint in joints) or (file.rotor_period if file else 0.0)
    if repeats == TURN:
        mean, period = mean % TURN, TURN / between.denominator
    elif repeats:
        mean, period = math.remainder(mean, repeats), repeats
    if file:
        if abs(math.remainder(file.output_encoder_zero - shown, turn)) <= error:
            shown = file.output_encoder_zero
        off = math.remainder(file.rotor_zero - mean, period) / ratio
        if file.absolute or abs(off) <= error:  # an absolute reference finds the zero
            mean = file.rotor_zero
    yield Value('output_encoder_zero', shown, why)
    yield Value('rotor_zero', mean, Observation.ENCODERS_AGREE(spread=spread))
