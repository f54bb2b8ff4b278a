# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""What recordings of both encoders determine of a gear, and what they leave open.

The ratio between the encoders is that of the gear, with the other sign where one of them counts
backwards.
"""

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from gear_kinematics.correction.uncertainty import Estimate
from gear_kinematics.kinematics.gear_ratio import GearRatio
from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.measurement.commissioning.joint import Joint
from gear_kinematics.measurement.commissioning.positions import COUNTED
from gear_kinematics.measurement.ratio import RatioEstimate, estimate_ratio
from gear_kinematics.measurement.recording import Encoders, Recording, RecordingError
from gear_kinematics.measurement.transmission import transmission_figures
from gear_kinematics.measurement.wording import plus_minus
from gear_kinematics.parameters.node_parameters import default_value
from gear_kinematics.report.document import number

_FASTER = 2.0
"""The speed that is allowed / the greatest seen, which is hardly the greatest that there is."""
_MILLI = 1e3


@dataclass(frozen=True, slots=True)
class Channel:
    """Where an encoder is heard; without names in a CSV file."""

    topic: str = ''
    joint: str = ''


@dataclass(frozen=True, slots=True, kw_only=True)
class Request:
    """What is known, and what is asked for."""

    rotor: Channel = Channel()
    output: Channel = Channel()
    ratio: GearRatio | None = None
    """Of the gear, with its sign, to be confirmed."""
    teeth: tuple[int, int] | None = None
    """Of ring gear and satellite, which have this ratio."""
    zero_here: float | Literal['START', 'END'] | None = None
    """When the output is at its angle 0, by the stamps of the last recording, s; None: at 0 of its
    encoder."""


@dataclass(frozen=True, slots=True)
class Value:
    """A parameter of the node that is determined."""

    name: str
    value: str | int | float
    evidence: str
    """In one line."""


@dataclass(frozen=True, slots=True)
class Open:
    """What is not determined."""

    what: str
    known: str
    """A clause."""
    advice: str
    """What to do, as a clause."""


@dataclass(frozen=True, eq=False, slots=True)
class Commissioning:
    """What recordings determine."""

    request: Request
    joints: tuple[Joint, ...]
    """One for each recording."""
    longest: Joint
    """That of most travel, which tells the ratio."""
    ratio: RatioEstimate | None
    """Between the encoders; None where it cannot be estimated."""
    between: GearRatio | None
    """The exact ratio between the encoders; None where it is open."""
    fault: str
    """Why there is no file, in a sentence; else empty."""
    values: tuple[Value, ...]
    open: tuple[Open, ...]
    notes: tuple[str, ...]
    """Sentences on what is no parameter."""
    delay: Estimate | None
    """s, by which the stamps of the output are late."""

    @property
    def travel(self) -> float:
        """Of the output, rad."""
        return self.longest.travel

    @property
    def answer(self) -> str:
        """The result in a sentence."""
        if self.fault or self.ratio is None:
            return self.fault
        given = self.request.ratio
        return f'The gear has the ratio {given or self.between} ({_agreement(self.ratio, given)}).'


def commission(
    recordings: Sequence[tuple[Recording, Encoders]], request: Request
) -> Commissioning:
    """Determine the parameters of the node for a gear.

    Args:
        recordings: of the same gear, in the order of time. The positions of both encoders are as
            they were recorded, neither turned around nor unwrapped.
        request: what else is known.

    Raises:
        RecordingError: if a recording has too few samples, no times, or no sample at `zero_here`.
    """
    joints = tuple(Joint.of(*recording) for recording in recordings)
    longest = max(joints, key=lambda joint: joint.travel)
    encoders = longest.encoders
    ratio, between, delay, fault = None, None, None, longest.unit_fault
    if longest.rotor.turn and longest.output.turn:
        try:
            ratio = estimate_ratio(longest.turned, encoders.measured, encoders.seconds)
        except RecordingError as why:
            fault = fault or f'The ratio is open: {why}.'
        else:
            fault = fault or _doubt(ratio, longest.travel, request.ratio)
    found: list[Value | Open | str] = list(_names(request))
    known = request.ratio or (ratio and ratio.taken)
    if ratio and known and not fault:
        between = GearRatio(abs(known) if ratio.measured.value > 0.0 else -abs(known))
        found += _ratio(ratio, between, request)
        travel = default_value('transmission_error_travel')
        delay = transmission_figures(encoders, between, travel).delay
    elif ratio and ratio.advice:
        found.append(Open('ratio', f'{ratio.plus_minus}{_candidates(ratio)}', ratio.advice))
    found.append(_kind(joints))
    if between:
        single = any(joint.rotor.wraps for joint in joints)
        found += _zeros(joints[-1], between, request.zero_here, single=single)
    found += _motion(longest, delay)
    return Commissioning(
        request,
        joints,
        longest,
        ratio,
        between,
        fault,
        tuple(each for each in found if isinstance(each, Value)),
        tuple(each for each in found if isinstance(each, Open)),
        tuple(each for each in found if isinstance(each, str)),
        delay,
    )


def agrees(given: GearRatio, ratio: RatioEstimate) -> bool:
    """Return whether a ratio may be the measured one, but for its sign."""
    return ratio.fits(given) or ratio.fits(-given)


def _doubt(ratio: RatioEstimate, travel: float, given: GearRatio | None) -> str:
    """Why the exact ratio is not known, in a sentence; else empty."""
    seen = ratio.plus_minus
    if given:
        wrong = f'The given ratio {given} does not agree with the measured {seen}'
        return '' if agrees(given, ratio) else f'{wrong}{_candidates(ratio)}.'
    if ratio.taken:
        return ''
    return (
        f'The ratio is open: {seen} after {number(math.degrees(travel))}° of the output; '
        f'{ratio.advice}, or confirm with --ratio.'
    )


def _candidates(ratio: RatioEstimate) -> str:
    """The simple fractions that fit, and the teeth, as the end of a clause."""
    fitting = f', such as {", ".join(map(str, ratio.candidates))}'
    return fitting + (f', or teeth such as {ratio.teeth}' if ratio.teeth else '')


def _agreement(ratio: RatioEstimate, given: GearRatio | None) -> str:
    """Why the exact ratio is the right one, as a clause."""
    seen = ratio.plus_minus
    return f'given, and agrees with {seen}' if given else f'{seen}, the only simple fraction'


def _names(request: Request) -> Iterator[Value]:
    rotor, output = request.rotor, request.output
    for name, channel in (('rotor_joint', rotor), ('output_encoder_joint', output)):
        if channel.joint:
            yield Value(name, channel.joint, f'a joint of {channel.topic}')


def _ratio(ratio: RatioEstimate, between: GearRatio, request: Request) -> Iterator[Value]:
    given, evidence, same = request.ratio, _agreement(ratio, request.ratio), 1
    if given:
        same = 1 if given == between else -1
        says = f'the encoders turn {"as" if same > 0 else "against"} the sign of the ratio {given}'
    else:
        evidence += f', that of {ratio.teeth} teeth, for example' if ratio.teeth else ''
        says = 'by convention; only a given ratio tells which of both encoders counts backwards'
    if request.teeth:
        yield Value('ring_teeth', request.teeth[0], evidence)
        yield Value('satellite_teeth', request.teeth[1], evidence)
    else:
        yield Value('gear_ratio', str(given or between), evidence)
    yield Value('rotor_direction', same, says)
    yield Value('output_encoder_direction', 1, 'the sense of the encoder is kept')


def _kind(joints: Sequence[Joint]) -> Value | Open:
    """The kind of the rotor's encoder."""
    most = max((joint.rotor for joint in joints), key=lambda rotor: (rotor.wraps, rotor.turns))
    if most.wraps:
        return Value('rotor_encoder', 'single_turn', most.evidence)
    seen = f'the rotor turned {number(most.turns)} turns'
    if most.turns <= COUNTED:
        return Open('rotor_encoder', seen, 'turn the rotor by more than one')
    return Value('rotor_encoder', 'multi_turn', f'{seen} without a wrap')


def _zeros(
    last: Joint, between: GearRatio, zero_here: float | str | None, *, single: bool
) -> Iterator[Value]:
    """Find the zeros with which the output angles of both encoders agree on average."""
    zero, why = 0.0, 'the zero of the encoder is kept'
    if zero_here is not None:
        zero = float(last.encoders.measured[last.row_at(zero_here)])
        moment = zero_here if isinstance(zero_here, str) else f'{zero_here:.13g} s'
        why = f'the output angle is 0 at {moment} of {last.recording.name}'
    shown = math.remainder(zero, TURN) if last.output.wraps else zero
    yield Value('output_encoder_zero', shown, why)
    rotor = last.zeros(between) + float(between) * zero
    mean, spread = float(np.mean(rotor)), float(np.ptp(rotor)) / abs(float(between))
    evidence = f'both encoders then agree on average, within {number(math.degrees(spread))}°'
    evidence += ', but for whole turns' if single else '; check it after a power cycle'
    yield Value('rotor_zero', mean % TURN if single else mean, evidence)


def _motion(joint: Joint, delay: Estimate | None) -> Iterator[Value | Open | str]:
    """Delay, rates and speeds."""
    if not delay:
        advice = 'turn the output there and back three times or more, at different speeds'
        yield Open('delay between the encoders', 'it is not told from hysteresis', advice)
    elif (late := plus_minus(delay, _MILLI)) != '0 ± 0':
        yield f'The stamps of the output are late by {late} ms.'
    both = joint.encoders.rotor.seconds, joint.encoders.seconds
    rotor, output = (f'{(len(times) - 1) / np.ptp(times):.4g} Hz' for times in both)
    yield f'Rates: {rotor} of the rotor, {output} of the output.'
    speed, allowed = joint.greatest_speed, default_value('max_rotor_speed')
    seen = f'the rotor turned at up to {number(speed)} rad/s'
    if speed > allowed:
        evidence = f'{seen}, of which {number(_FASTER)} times as much is allowed'
        yield Value('max_rotor_speed', _FASTER * speed, evidence)
    else:
        yield f'{seen.capitalize()}: the default of max_rotor_speed, {number(allowed)}, holds.'
