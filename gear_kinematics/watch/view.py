# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The view of a gear at a moment, in the words and numbers that users read."""

import math
import time
from collections.abc import Collection, Iterator
from contextlib import suppress
from dataclasses import dataclass, replace
from typing import Literal

from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.measurement.wording import shown
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.report.document import hertz
from gear_kinematics.shape.angles import arc
from gear_kinematics.state.statuses import ERROR, OK, WARN
from gear_kinematics.watch.drivers import DriverTopic
from gear_kinematics.watch.gear import GearNode, JointValue, Status
from gear_kinematics.wire import topics
from gear_kinematics.wire.nearest import among

Tone = Literal['', 'stale', 'notable', 'bad', 'pass', 'fail', 'unusable']
"""The names are those of the page's classes."""

UNANSWERED = 'The node has not answered yet. It may still do what it was asked for.'
_TONES: dict[str, Tone] = {'no node': 'unusable', 'connecting': 'unusable', 'connected': 'pass'}
_MAX_STATUS_AGE = 3.0  # s; diagnostics come every second
_RPM = 60.0 / TURN  # of 1 rad/s
_LEVELS = {OK: 'healthy', WARN: 'warning', ERROR: 'error'}


@dataclass(frozen=True, slots=True)
class Entry:
    """A quantity, or a status of diagnostics."""

    name: str
    value: str
    detail: str = ''
    tone: Tone = ''


@dataclass(frozen=True, slots=True)
class Guide:
    """Progress of commissioning from the messages of two encoders so far."""

    advice: str  # what to do now
    known: float = 0.0  # share of what a parameter file needs
    entries: tuple[Entry, ...] = ()  # what was heard, parameters with their evidence, what is open


@dataclass(frozen=True, slots=True)
class View:
    """Everything that is shown at a moment."""

    nodes: tuple[Entry, ...] = ()  # all gears of nodes that run, with joint and ratio
    node: str = ''  # label of the gear; '' as long as there was none
    arm: tuple[Entry, ...] = ()  # the output angles of all actuators, if there are several
    revision: int = 0  # which a command repeats that answers this view
    state: str = 'no node'  # or connecting, connected, no output, ended, or fault
    tone: Tone = 'unusable'
    message: str = ''  # on the state, in sentences
    values: tuple[Entry, ...] = ()
    diagnostics: tuple[Entry, ...] = ()
    drivers: tuple[Entry, ...] = ()  # topics of drivers, with joints and rate
    joints: tuple[tuple[str, str], ...] = ()  # topic and name of each joint of a driver
    rotor: float | None = None  # angle, degrees; None while it is unknown or out of date
    output: float | None = None
    margin: float | None = None  # what is left of the preload, as a share of it
    question: str = ''  # to ask before homing; '' where there is nothing to home
    undo: str = ''  # parameters before their last change, to go back to; '' where there is none
    guide: Guide | None = None  # while a gear is commissioned


def view_of(
    gear: GearNode | None, gears: Collection[GearNode] = (), *, looking: bool = False
) -> View:
    """Compose the view of a gear among all that run; while `looking`, some may yet be found."""
    nodes = tuple(map(_choice, gears))
    state, message = _state_of(gear, [gear.name for gear in gears])
    if looking and state == 'no node':
        state, message = 'connecting', 'Looking for nodes.'
    view = View(nodes, state=state, tone=_TONES.get(state, 'fail'), message=message)
    if gear:
        view = replace(view, node=gear.label, revision=gear.revision)
    if not (gear and gear.running):
        return view
    statuses = tuple(status_entry(s, time.monotonic()) for s in gear.statuses.values())
    percent = _number(_diagnostic(gear, 'preload', 'margin (% of the preload)'))
    margin = None if percent is None else percent / 100.0
    values, arm = tuple(values_of(gear)), tuple(_angles(gear, gears))
    view = replace(view, values=values, arm=arm, diagnostics=statuses, margin=margin)
    output, parameters = gear.joint(topics.OUTPUT_STATE), gear.parameters
    if state != 'connected' or not (output and parameters):
        return view
    # Homing forgets the turns of an encoder that repeats.
    earlier = {} if parameters.rotor_period else gear.earlier
    angle, home = _degrees(output.position, 1), _degrees(parameters.home_angle, 1)
    return replace(
        view,
        rotor=math.degrees(parameters.gear.gear_ratio.rotor_angle(output.position)),
        output=math.degrees(output.position),
        question=f'The output is at {angle}. Set it to {home}?',
        undo=', '.join(f'{name} {shown(value)}' for name, value in earlier.items()),
    )


def driver_entry(driver: DriverTopic) -> Entry:
    """Describe the topic of a driver."""
    return Entry(driver.topic, ', '.join(driver.joints), hertz(driver.rate))


def _choice(gear: GearNode) -> Entry:
    """Name a node that runs, with its joint and ratio once they are known."""
    if not (parameters := gear.parameters):
        return Entry(gear.label, '')
    joint = parameters.rotor_joint or 'the only joint'
    return Entry(gear.label, f'{joint}, ratio {parameters.gear.gear_ratio}')


def _angles(gear: GearNode, gears: Collection[GearNode]) -> Iterator[Entry]:
    """Give the output angle of each actuator of an arm, with its faults.

    The angles are those of the latest message of this gear, and the faults those of all.
    """
    now, arm = time.monotonic(), {each.actuator: each for each in gears if each.name == gear.name}
    for name, parameters in gear.arm.items() if len(gear.arm) > 1 else ():
        if output := gear.joint(topics.OUTPUT_STATE, parameters.output_name):
            tone = _freshness(output, parameters)
            detail = f'{output.age:.1f} s ago' if tone else ''
            statuses = arm[name].statuses.values() if name in arm else ()
            tones = {status_entry(status, now).tone for status in statuses}
            if not tone and (faults := tones - {''}):
                detail, tone = ('error', 'bad') if 'bad' in faults else ('warning', 'notable')
            yield Entry(name, _degrees(output.position, 1), detail, tone)
        else:
            yield Entry(name, 'none', tone='stale')


def _state_of(gear: GearNode | None, running: Collection[str]) -> tuple[str, str]:
    start = 'gearkin init writes a parameter file for a driver.'
    if gear is None:
        return 'no node', f'No gear_state_publisher is running. {start}'
    if not gear.seen:
        hint = among(gear.name, {*running}) if running else f'. {start}'
        return 'no node', f'{gear.name} is not running{hint}'
    if not gear.running:
        return 'ended', f'{gear.name} has ended. Waiting for it to start again.'
    if gear.fault:
        return 'fault', f'Its parameters cannot be used: {gear.fault}'
    if not gear.parameters:
        return 'connecting', ''
    output = gear.joint(topics.OUTPUT_STATE)
    if not output:
        return 'no output', 'There has been no output yet.'
    if _freshness(output, gear.parameters):
        return 'no output', f'The last output was {output.age:.1f} s ago.'
    return 'connected', ''


def values_of(gear: GearNode) -> Iterator[Entry]:
    """Describe the latest values."""
    if not (parameters := gear.parameters):
        return
    if output := gear.joint(topics.OUTPUT_STATE):
        ratio, angle = parameters.gear.gear_ratio, output.position
        tone = _freshness(output, parameters)
        rotor = ratio.rotor_angle(angle)
        yield Entry('output angle', _degrees(angle), f'{angle:z.5f} rad', tone)
        yield Entry('rotor angle', _degrees(rotor), f'{rotor / TURN:z.3f} turns', tone)
        if output.velocity is not None:
            speed = _RPM * output.velocity
            detail = f'rotor {ratio.rotor_angle(speed):z.1f} rpm'
            yield Entry('output speed', f'{speed:z.2f} rpm', detail, tone)
        yield Entry('output rate', hertz(output.rate))
    zero, homed = parameters.rotor_zero, gear.homed_zero
    kept = _diagnostic(gear, 'rotor input', 'home file')
    if lost := homed not in (None, zero):
        kept = f'homed before; the zero is lost: it was {homed:.3f} rad; {kept}'
    yield Entry('zero', f'{zero:.3f} rad', kept, 'notable' if lost else '')
    if left := _diagnostic(gear, 'preload', 'margin (N·m)'):
        least = _diagnostic(gear, 'preload', 'least margin (N·m)')
        detail = f'least {least} N·m in the last second'
        tone = '' if (_number(left) or 0.0) > 0.0 else 'bad'
        yield Entry('preload left', f'{left} N·m', detail, tone)
    if corrected := gear.joint(topics.CORRECTED_STATE):
        interval = gear.joint(topics.CORRECTED_INTERVAL)
        detail = f'± {arc(interval.position)} (95 %)' if interval else ''
        tone = _freshness(corrected, parameters)
        yield Entry('corrected angle', _degrees(corrected.position), detail, tone)
    if error := gear.joint(topics.TRANSMISSION_ERROR):
        peak = _diagnostic(gear, 'transmission error', 'peak to peak (rad)')
        detail = f'peak to peak {peak} rad' if peak else ''
        tone = _freshness(error, parameters)
        yield Entry('transmission error', arc(error.position), detail, tone)


def status_entry(status: Status, now: float) -> Entry:
    """Describe a status of diagnostics at a time, s, with what to do about it."""
    if (age := now - status.at) > _MAX_STATUS_AGE:
        return Entry(status.subject, f'no diagnostics for {age:.1f} s', tone='bad')
    level = _LEVELS.get(status.level, 'unknown level')
    if status.level == OK:
        return Entry(status.subject, level)
    tone: Tone = 'bad' if status.level == ERROR else 'notable'
    advice = status.values.get('advice', '')
    return Entry(status.subject, f'{level}: {status.message}', advice, tone)


def _diagnostic(gear: GearNode, subject: str, key: str) -> str:
    """Look up a value of the diagnostics; '' if it is absent, none or out of date."""
    status = gear.statuses.get(subject)
    known = status and time.monotonic() - status.at <= _MAX_STATUS_AGE
    value = status.values.get(key, '') if status and known else ''
    return '' if value == 'none' else value


def _number(text: str) -> float | None:
    """Read a number that any node may have sent; None if it is none that JSON has."""
    with suppress(ValueError):
        return number if math.isfinite(number := float(text)) else None
    return None


def _freshness(joint: JointValue, parameters: NodeParameters) -> Tone:
    return 'stale' if joint.age > parameters.input_timeout else ''


def _degrees(angle: float, digits: int = 3) -> str:
    return f'{math.degrees(angle):z.{digits}f}°'
