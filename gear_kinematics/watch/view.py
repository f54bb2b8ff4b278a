# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""What there is to see at a moment, in the words and numbers that people read."""

import math
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any, Literal, NamedTuple

from gear_kinematics.kinematics import Gear
from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.shape.angles import arc, arc_seconds
from gear_kinematics.state.diagnostics import ERROR, OK, WARN
from gear_kinematics.watch.drivers import Driver
from gear_kinematics.watch.gear import GearNode, Joint, Status
from gear_kinematics.watch.polled import Latest
from gear_kinematics.wire import topics

State = Literal['no node', 'connecting', 'connected', 'no input', 'no output', 'ended', 'fault']
Tone = Literal['', 'stale', 'notable', 'bad']
"""Out of date, a warning, or an error; the names are those of the page's classes."""

_TONES = {'no node': 'unusable', 'connecting': 'unusable', 'connected': 'pass'}  # or fail
_MAX_OUTPUT_AGE = 1.0  # s, after which it is out of date
_MAX_STATUS_AGE = 3.0  # s; diagnostics come every second
_RPM = 60.0 / TURN  # of 1 rad/s
_LEVELS = {OK: 'healthy', WARN: 'warning', ERROR: 'error'}


class Curve(NamedTuple):
    """The latest value of a curve; None while there is none."""

    unit: str
    value: float | None


@dataclass(frozen=True, slots=True)
class Entry:
    """A quantity, or a status of diagnostics."""

    name: str
    value: str
    detail: str = ''
    tone: Tone = ''
    curve: Curve | None = None


@dataclass(frozen=True, slots=True)
class Commission:
    """What two encoders have told of a gear so far."""

    heard: str
    advice: str  # what to do now
    known: float = 0.0  # share of what a parameter file needs
    entries: tuple[Entry, ...] = ()  # parameters with their evidence, and what is open


class Answer(NamedTuple):
    """What came of a command."""

    text: str
    done: bool
    command: str = ''
    """To copy into a terminal."""

    def __str__(self) -> str:
        return f'{self.text} {self.command}'.strip()


@dataclass(frozen=True, slots=True)
class View:
    """What there is to see."""

    node: str = ''  # full name of the node; '' as long as there was none
    state: State = 'no node'
    tone: str = _TONES['no node']  # pass, fail or unusable
    duration: str = ''  # of the state, where it matters
    message: str = ''  # on the state, in sentences
    values: tuple[Entry, ...] = ()
    diagnostics: tuple[Entry, ...] = ()
    drivers: tuple[Driver, ...] = ()
    recording: str = ''  # on the recording in progress, if there is one
    failure: str = ''  # why the last recording ended by itself, if it did
    rotor: float | None = None  # angle within the turn, degrees
    output: float | None = None
    question: str = ''  # to ask before homing; '' where there is nothing to home
    undo: str = ''  # parameters before their last change, to go back to; '' where there is none
    gear: int = 0  # raised when the drawing of the gear may have changed
    commission: Commission | None = None  # while a gear is commissioned


def view_of(gear: GearNode, rotor: Latest | None, others: Sequence[str]) -> View:
    """Show a node; the arguments are those of `state_of`."""
    return View(
        values=tuple(values_of(gear, rotor)),
        diagnostics=tuple(status_entry(s, time.monotonic()) for s in gear.statuses.values()),
        **state_of(gear, rotor, others),
        **_angles(gear),
        **_homing(gear),
    )


def state_of(gear: GearNode | None, rotor: Latest | None, others: Sequence[str]) -> dict[str, Any]:
    """Tell whether the node that was found or asked for runs, and has input.

    `rotor` are the driver's messages, if their topic is known; `others` are further nodes.
    """
    state, duration, message = _state_of(gear, rotor)
    if others:
        message = f'{message} Also running: {", ".join(others)}; choose with --node.'.strip()
    shown = {'node': gear.name if gear else '', 'state': state, 'tone': _TONES.get(state, 'fail')}
    return {**shown, 'duration': duration, 'message': message}


def _state_of(gear: GearNode | None, rotor: Latest | None) -> tuple[State, str, str]:
    start = 'Start it for one of the drivers.'
    if gear is None:
        return 'no node', '', f'No gear_state_publisher is running. {start}'
    if gear.restarts < 0:
        return 'no node', '', f'{gear.name} is not running. {start}'
    if not gear.running:
        return 'ended', '', f'{gear.name} has ended. Waiting for it to start again.'
    if gear.fault:
        return 'fault', '', f'Its parameters cannot be used: {gear.fault}'
    if not gear.parameters or not gear.known:
        return 'connecting', '', ''
    if rotor and (rotor.age is None or rotor.age > gear.parameters.input_timeout):
        return 'no input', '' if rotor.age is None else _duration(rotor.age), ''
    output = gear.joint(topics.OUTPUT_STATE)
    if output and _freshness(output):  # the topic of a driver that has ended is gone
        return 'no output' if rotor else 'no input', _duration(output.age), ''
    if not (output or rotor):
        return 'no input', '', ''
    return 'connected', '', ''


def _angles(gear: GearNode) -> dict[str, Any]:
    """Give the angles of the drawing, within the turn."""
    output = gear.joint(topics.OUTPUT_STATE)
    if not (output and gear.gear):
        return {}
    rotor = gear.gear.gear_ratio.rotor_angle(output.position)
    return {
        name: math.degrees(math.remainder(angle, TURN))
        for name, angle in (('rotor', rotor), ('output', output.position))
    }


def _homing(gear: GearNode) -> dict[str, Any]:
    if not (gear.running and gear.known and gear.parameters):
        return {}
    output, home = gear.joint(topics.OUTPUT_STATE), math.degrees(gear.parameters.home_angle)
    where = 'Set the output'
    if output and not _freshness(output):
        where = f'The output is at {_degrees(output.position, 1)}. Set it'
    earlier = ', '.join(f'{name} {shown(value)}' for name, value in gear.earlier.items())
    # Homing forgets the turns of a single-turn encoder.
    undo = '' if gear.parameters.single_turn else earlier
    return {'question': f'{where} to {home:.1f}°?', 'undo': undo}


def shown(value: str | float) -> str:
    """Write the value of a parameter."""
    return f'{value:.6g}' if isinstance(value, float) else str(value) or "''"


def values_of(gear: GearNode, rotor: Latest | None) -> Iterator[Entry]:
    """Describe the latest values; `rotor` are the driver's messages, if their topic is known."""
    output = gear.joint(topics.OUTPUT_STATE)
    if output and gear.gear:
        yield from _motion(output, gear.gear)
    if gear.parameters:
        yield _zero(gear, gear.parameters.rotor_zero)
    if rotor:
        age = rotor.age
        timeout = gear.parameters.input_timeout if gear.parameters else 1.0
        detail = 'no message yet' if age is None else f'last message {_duration(age)} ago'
        tone: Tone = 'bad' if age is None or age > timeout else ''
        yield Entry('input', f'{rotor.rate:.0f} Hz', detail, tone)
    if corrected := gear.joint(topics.CORRECTED_STATE):
        interval = gear.joint(topics.CORRECTED_INTERVAL)
        detail = f'± {arc(interval.position)} (95 %)' if interval else ''
        angle = _degrees(corrected.position)
        yield Entry('corrected angle', angle, detail, _freshness(corrected))
    if error := gear.joint(topics.TRANSMISSION_ERROR):
        tone, detail = _freshness(error), _peak_to_peak(gear)
        curve = _curve('″', arc_seconds(error.position), tone)
        yield Entry('transmission error', arc(error.position), detail, tone, curve)


def status_entry(status: Status, now: float) -> Entry:
    """Describe a status of diagnostics at a time, s, with what to do about it."""
    if (age := now - status.at) > _MAX_STATUS_AGE:
        return Entry(status.subject, f'no diagnostics for {_duration(age)}', tone='bad')
    level = _LEVELS.get(status.level, 'unknown level')
    if status.level == OK:
        return Entry(status.subject, level)
    tone: Tone = 'bad' if status.level == ERROR else 'notable'
    advice = status.values.get('advice', '')
    return Entry(status.subject, f'{level}: {status.message}', advice, tone)


def _motion(output: Joint, gear: Gear) -> Iterator[Entry]:
    ratio, tone, angle = gear.gear_ratio, _freshness(output), output.position
    rotor, curve = ratio.rotor_angle(angle), _curve('°', math.degrees(angle), tone)
    yield Entry('output angle', _degrees(angle), f'{angle:.5f} rad', tone, curve)
    yield Entry('rotor angle', _degrees(rotor), f'{rotor / TURN:.3f} turns', tone)
    if output.velocity is not None:
        speed = _RPM * output.velocity
        detail = f'rotor {ratio.rotor_angle(speed):.1f} rpm'
        yield Entry('output speed', f'{speed:.2f} rpm', detail, tone, _curve(' rpm', speed, tone))


def _zero(gear: GearNode, zero: float) -> Entry:
    status = gear.statuses.get('rotor input')
    kept = status.values.get('home file', '') if status else ''
    if gear.homed_zero in (None, zero):
        return Entry('zero', f'{zero:.3f} rad', kept)
    lost = f'homed before; the zero is lost: it was {gear.homed_zero:.3f} rad; {kept}'
    return Entry('zero', f'{zero:.3f} rad', lost, 'notable')


def _curve(unit: str, value: float, tone: Tone) -> Curve:
    return Curve(unit, value if math.isfinite(value) and not tone else None)


def _peak_to_peak(gear: GearNode) -> str:
    """The peak-to-peak value in the window of the diagnostics, and its limit."""
    status = gear.statuses.get('transmission error')
    try:
        value = float(status.values['peak to peak (rad)']) if status else math.nan
    except (KeyError, ValueError):  # as 'none'
        return ''
    if not gear.parameters or not abs(value) <= TURN:
        return ''
    limit = arc(gear.parameters.transmission_error_limit)
    length = gear.parameters.transmission_error_window
    return f'peak to peak {arc(value)} in {length:g} s, limit {limit}'


def _freshness(joint: Joint) -> Tone:
    return 'stale' if joint.age > _MAX_OUTPUT_AGE else ''


def _degrees(angle: float, digits: int = 3) -> str:
    return f'{round(math.degrees(angle), digits) + 0.0:.{digits}f}°'  # no -0.0


def _duration(seconds: float) -> str:
    seconds = max(seconds, 0.0)
    if seconds < 1.0:
        return f'{1e3 * seconds:.0f} ms'
    return f'{seconds:.1f} s' if seconds < 60.0 else f'{seconds / 60.0:.0f} min'  # noqa: PLR2004
