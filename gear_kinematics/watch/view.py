"""What there is to see at a moment, in the words and numbers that people read."""

import math
import re
import time
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any, Literal

from gear_kinematics.kinematics import Gear
from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.shape.angles import arc
from gear_kinematics.state.diagnostics import ERROR, OK, WARN
from gear_kinematics.watch.drivers import Driver
from gear_kinematics.watch.gear import GearNode, Joint, Status
from gear_kinematics.watch.polled import Latest
from gear_kinematics.watch.recording import Recorded
from gear_kinematics.wire import topics

Tone = Literal['', 'notable', 'bad']
"""As in page.css: a warning, or an error."""

_STALE = 1.0  # s without an output after which its angle is out of date
_SILENT = 3.0  # s without diagnostics, which come every second
_NUMBER = re.compile(r'\d+(\.\d+)?(e[-+]?\d{1,2})?', re.ASCII)
_RPM = 60.0 / TURN  # of 1 rad/s
_LEVELS = {OK: 'healthy', WARN: 'warning', ERROR: 'error'}
_ADVICE = (
    ('no input for', 'Check that the driver is running, and that its topic is remapped.'),
    ('not referenced', 'Move the output to its home angle, then press Home.'),
    ('incompatible QoS', 'Change the quality of service of one of the two.'),
    ('joint missing', 'Set rotor_joint to one of the joints of the driver.'),
    ('rejected', 'The page on diagnostics explains why messages are rejected.'),
    ('lost', 'The middleware has not delivered these messages.'),
    ('not sent', 'Look for a listener that is stuck.'),
    (r'\d drivers', 'Stop all drivers but one.'),
    ('also publishes', 'Stop one of the two nodes, or give each its own namespace.'),
    ('another node is named', 'Stop one of the two nodes, or give each its own namespace.'),
    ('calibration no longer fits', 'Calibrate the gear again.'),
)
"""What to do about a message of diagnostics, as docs/diagnostics.md says in full."""


@dataclass(frozen=True, slots=True)
class Reading:
    """A quantity."""

    name: str
    value: str
    detail: str = ''
    tone: Tone = ''


@dataclass(frozen=True, slots=True)
class Sentence:
    """A status of diagnostics in words."""

    text: str
    tone: Tone = ''


@dataclass(frozen=True, slots=True)
class View:
    """What there is to see."""

    node: str = ''
    """Full name of the node; '' as long as there was none."""
    state: Literal['none', 'connecting', 'connected', 'ended'] = 'none'
    words: str = ''
    """On the state."""
    readings: tuple[Reading, ...] = ()
    sentences: tuple[Sentence, ...] = ()
    drivers: tuple[Driver, ...] = ()
    recording: str = ''
    """On the recording in progress; '' if there is none."""
    failure: str = ''
    """Why the last recording ended by itself, if it did."""
    rotor: float | None = None
    """Angle within the turn, degrees."""
    output: float | None = None
    error: float | None = None
    """Transmission error, seconds of arc."""
    window: float = 0.0
    """Of the transmission error, s."""
    gear: int = 0
    """Raised when the drawing of the gear may have changed."""


def state_of(gear: GearNode | None, others: Sequence[str]) -> dict[str, Any]:
    """Tell which node is watched, and whether it runs."""
    if gear is None:
        words = 'No gear_state_publisher is running. Start it for one of the drivers below.'
        return {'words': words}
    more = f' Also running: {", ".join(others)}; choose with --node.' if others else ''
    if gear.restarts < 0:
        words = f'{gear.name} is not running. Start it for one of the drivers below.'
        return {'node': gear.name, 'words': words + more}
    if not gear.running:
        words = f'{gear.name} has ended. Waiting for it to start again.'
        return {'node': gear.name, 'state': 'ended', 'words': words + more}
    if not gear.known:
        return {'node': gear.name, 'state': 'connecting', 'words': f'Connecting …{more}'}
    return {'node': gear.name, 'state': 'connected', 'words': more.strip()}


def motion_of(gear: GearNode) -> dict[str, Any]:
    """Give the numbers for the drawing and the curve."""
    output = gear.joint(topics.OUTPUT_STATE)
    error = gear.joint(topics.TRANSMISSION_ERROR)
    window = gear.parameters.transmission_error_window if gear.parameters else 0.0
    numbers: dict[str, Any] = {'window': window}
    if output and gear.gear:
        rotor = gear.gear.gear_ratio.rotor_angle(output.position)
        numbers['rotor'] = math.degrees(math.remainder(rotor, TURN))
        numbers['output'] = math.degrees(math.remainder(output.position, TURN))
    if error and error.age < _STALE:
        numbers['error'] = 3600.0 * math.degrees(error.position)
    return numbers


def readings_of(gear: GearNode, rotor: Latest | None) -> Iterator[Reading]:
    """Describe the latest values.

    Args:
        gear: the node.
        rotor: the driver's messages, if their topic is known.
    """
    output = gear.joint(topics.OUTPUT_STATE)
    if output and gear.gear:
        yield from _angles(output, gear.gear)
    if rotor:
        age = rotor.age
        timeout = gear.parameters.input_timeout if gear.parameters else 1.0
        tone: Tone = 'bad' if age is None or age > timeout else ''
        detail = 'no message yet' if age is None else f'last message {_duration(age)} ago'
        yield Reading('input', f'{rotor.rate:.0f} Hz', detail, tone)
    corrected = gear.joint(topics.CORRECTED_STATE)
    if corrected:
        interval = gear.joint(topics.CORRECTED_INTERVAL)
        detail = f'± {arc(interval.position)} (95 %)' if interval else ''
        yield Reading('corrected angle', _degrees(corrected.position), detail, _fresh(corrected))
    error = gear.joint(topics.TRANSMISSION_ERROR)
    if error:
        yield Reading('transmission error', arc(error.position), _window(gear), _fresh(error))


def sentences_of(gear: GearNode) -> Iterator[Sentence]:
    """Put the diagnostics of a node into words."""
    if not gear.statuses:
        yield Sentence('No diagnostics yet.')
    for status in gear.statuses.values():
        yield sentence(status, time.monotonic())


def sentence(status: Status, now: float) -> Sentence:
    """Put a status into words, with what to do about it.

    Args:
        status: of the diagnostics.
        now: s, as `status.at`.
    """
    subject = status.subject.capitalize()
    if now - status.at > _SILENT:
        return Sentence(f'{subject}: no diagnostics for {_duration(now - status.at)}.', 'bad')
    level = _LEVELS.get(status.level, 'unknown level')
    if status.level == OK:
        return Sentence(f'{subject}: {level}.')
    advice = [text for pattern, text in _ADVICE if re.search(pattern, status.message)]
    text = ' '.join([f'{subject}: {level}, {status.message}.', *advice[:2]])
    return Sentence(text, 'bad' if status.level == ERROR else 'notable')


def recording_in_words(recorded: Recorded) -> str:
    """Describe a recording in progress."""
    lost = 'losses not counted' if recorded.lost is None else f'{recorded.lost} lost'
    return f'{recorded.path}: {recorded.messages} messages in {recorded.seconds:.1f} s, {lost}'


def _angles(output: Joint, gear: Gear) -> Iterator[Reading]:
    ratio, tone = gear.gear_ratio, _fresh(output)
    rotor = ratio.rotor_angle(output.position)
    yield Reading('output angle', _degrees(output.position), f'{output.position:.5f} rad', tone)
    yield Reading('rotor angle', _degrees(rotor), f'{rotor / TURN:.3f} turns', tone)
    if output.velocity is not None:
        speed = _RPM * output.velocity
        detail = f'rotor {ratio.rotor_angle(speed):.1f} rpm'
        yield Reading('output speed', f'{speed:.2f} rpm', detail, tone)
    if tone:
        yield Reading('last output', f'{_duration(output.age)} ago', '', tone)


def _window(gear: GearNode) -> str:
    """The peak-to-peak value in the window of the diagnostics, and its limit."""
    status = gear.statuses.get('transmission error')
    text = status.values.get('peak to peak (rad)', '') if status else ''
    if not gear.parameters or not _NUMBER.fullmatch(text):
        return ''
    limit = arc(gear.parameters.transmission_error_limit)
    length = gear.parameters.transmission_error_window
    return f'peak to peak {arc(float(text))} in {length:g} s, limit {limit}'


def _fresh(joint: Joint) -> Tone:
    return 'bad' if joint.age > _STALE else ''


def _degrees(angle: float) -> str:
    return f'{math.degrees(angle):.3f}°'


def _duration(seconds: float) -> str:
    seconds = max(seconds, 0.0)
    if seconds < 1.0:
        return f'{1e3 * seconds:.0f} ms'
    return f'{seconds:.1f} s' if seconds < 60.0 else f'{seconds / 60.0:.0f} min'  # noqa: PLR2004
