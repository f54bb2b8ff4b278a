# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The node's diagnostics of its inputs, without ROS."""

import math
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import NamedTuple, Self

from gear_kinematics.correction.error_window import ErrorStatistics
from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.state.output_encoder import OutputEncoder
from gear_kinematics.state.output_range import range_fault
from gear_kinematics.state.rotor_input import RotorInput
from gear_kinematics.state.turn_reference import SAMPLES, TurnReference
from gear_kinematics.statistics.uncertainty import Estimate
from gear_kinematics.wire.cdr import SECOND

OK, WARN, ERROR = 0, 1, 2
"""Levels of diagnostic_msgs/DiagnosticStatus."""

_NO_INPUT = 'Check that the driver is running, and that its topic is remapped.'
_NOT_REFERENCED = 'Move the output to its home angle, then call ~/home.'
_WAS_UNREFERENCED = 'Do not use the outputs of that time.'
_JUMPED = 'Check whether the drive restarted, and the encoder and its cable.'
_VELOCITY = 'Let the driver send rad/s of the rotor, or no velocities.'
_BEYOND = 'Raise the limit to what the motor can do, or check that positions are in rad.'
_UNSTAMPED = 'Let the driver stamp its messages: without stamps, turns may be miscounted.'
_UNEXPLAINED = 'Check gear_ratio, the directions and zeros of both encoders, and the gear.'
_AMBIGUOUS = 'Stop the output; or calibrate the gear, or lower transmission_error_limit.'
_DISAGREES = 'Check whether an encoder has slipped; then call ~/home, or restart the node.'
_OUTSIDE = 'Check output_range, gear_ratio and the zeros of both encoders.'
_NOT_COMPARED = 'Check that both drivers run and send often, and that their clocks agree.'
_SLIPPED = 'Check the couplings and the zeros of both encoders; then call ~/home.'
_BEYOND_ANY_GEAR = 0.1  # rad
_TOO_LARGE = 'Check the gear and its encoders, or raise transmission_error_limit.'

_SOON = 0.1
"""Time, s, after a report until which the next one repeats its rates and comparisons."""


class Fault(str):
    """The message of a fault, with what to do about it."""

    __slots__ = ('advice',)
    advice: str

    def __new__(cls, message: str, advice: str) -> Self:
        """Create a fault with its advice, which is a sentence."""
        fault = super().__new__(cls, message)
        fault.advice = advice
        return fault


class StatusReport(NamedTuple):
    """One status: level, message, and values by name."""

    level: int
    message: str
    values: dict[str, str]
    """Where there are faults, `advice` is what to do about them."""


class GraphFaults(NamedTuple):
    """Faults in the connections with other nodes."""

    errors: Sequence[Fault] = ()
    warnings: Sequence[Fault] = ()


@dataclass(slots=True, kw_only=True)
class DriverMonitor:
    """Monitors a driver; times are of a steady clock, s."""

    drivers: int = 0
    """Publishers on its topic."""
    lost: int = 0
    """Inputs that are missing between those that came."""
    losses_known: bool = True
    """Whether they could be counted since the last report."""
    last_input: float | None = None
    """Time of the last message, valid or not."""
    _counted: Counter[str] = field(default_factory=Counter)
    """The counts at the last report, by names."""
    _rejected: Counter[str] = field(default_factory=Counter)

    def _newly(self, name: str, count: int) -> int:
        """Return by how much a count has grown since the last report."""
        before, self._counted[name] = self._counted[name], count
        return max(count - before, 0)  # another input counts from 0

    def _new_faults(self, rejected: Counter[str]) -> list[Fault]:
        """Return the faults of messages that were rejected or lost since the last report."""
        newly_rejected, self._rejected = rejected - self._rejected, Counter(rejected)
        faults = [_rejections(newly_rejected)] if newly_rejected else []
        if newly_lost := self._newly('lost', self.lost):
            advice = 'Check the network, and whether the computer is too busy.'
            faults.append(Fault(f'lost {newly_lost}', advice))
        return faults

    def _report(
        self,
        errors: Sequence[Fault],
        warnings: Sequence[Fault],
        values: dict[str, str],
        notes: Sequence[str] = (),
    ) -> StatusReport:
        """Report on faults, or that there are none; notes do not raise the level."""
        level = ERROR if errors else WARN if warnings else OK
        if faults := (*errors, *warnings):
            values['advice'] = ' '.join(dict.fromkeys(fault.advice for fault in faults))
        messages: list[str] = [*faults]
        if not self.losses_known:
            messages.append('losses unknown')
            values['lost messages'] = 'unknown'
        messages += notes
        return StatusReport(level, '; '.join(messages) or 'ok', values)


@dataclass(slots=True, kw_only=True)
class InputMonitor(DriverMonitor):
    """Monitors the rotor input."""

    started: float
    published: int = 0
    unsent: int = 0
    """Messages that the middleware failed to send."""
    unreferenced: int = 0
    """Valid inputs while the turns were not known."""
    zero_kept: str = ''
    """Where `rotor_zero` is kept until the next start, or why it is not."""
    graph: GraphFaults = field(default_factory=GraphFaults)
    """Faults at the last check of the ROS graph."""
    _reported: float = 0.0
    _rate: float = 0.0
    _received: int = 0

    def report(
        self, rotor_input: RotorInput, now: float, reference: TurnReference | None = None
    ) -> StatusReport:
        """Report on an input in the time since the last report, until now."""
        elapsed = now - max(self._reported, self.started)
        count = rotor_input.received - rotor_input.of_others
        received = max(0, count - self._received)  # at first, others may count as rejected
        newly_unreferenced = self._newly('unreferenced', self.unreferenced)
        shared = self._newly('of others', rotor_input.of_others) > 0
        unstamped = self._newly('zero stamps', rotor_input.zero_stamps)
        if elapsed > _SOON:
            self._rate = received / elapsed
            self._reported, self._received = now, count

        age = now - (self.started if self.last_input is None else self.last_input)
        overdue = age > rotor_input.parameters.input_timeout
        errors: list[Fault] = []
        if overdue:
            errors.append(Fault(f'no input for {age:.1f} s', _NO_INPUT))
        if not rotor_input.referenced:
            if rotor_input.plausibility.jumped:
                errors.append(Fault(rotor_input.plausibility.jumped, _JUMPED))
            errors.append(_not_referenced(reference))
        elif reference and reference.disagreement:
            errors.append(Fault(reference.disagreement, _DISAGREES))
        elif outside := _outside(rotor_input):
            errors.append(Fault(outside, _OUTSIDE))
        errors += self.graph.errors
        warnings = self._new_faults(rotor_input.rejected)
        if rotor_input.velocity_field.meaning:
            warnings.append(Fault(rotor_input.velocity_field.meaning, _VELOCITY))
        if rotor_input.plausibility.beyond_limits:
            warnings.append(Fault(rotor_input.plausibility.beyond_limits, _BEYOND))
        if rotor_input.parameters.rotor_period and unstamped:
            warnings.append(Fault(f'zero stamps {unstamped}', _UNSTAMPED))
        if newly_unsent := self._newly('unsent', self.unsent):
            advice = 'Look for a listener that is stuck.'
            warnings.append(Fault(f'not sent {newly_unsent}', advice))
        if newly_unreferenced and rotor_input.referenced:
            text = f'turns unknown for {newly_unreferenced} inputs'
            warnings.append(Fault(text, _WAS_UNREFERENCED))
        if self.drivers > 1 and not shared:  # the topic is not shared with drivers of other joints
            warnings.append(Fault(f'{self.drivers} drivers', 'Stop all drivers but one.'))
        warnings += self.graph.warnings
        values = {
            'rate (Hz)': f'{self._rate:.1f}',
            'received': str(rotor_input.received),
            'published': str(self.published),
            'of others': str(rotor_input.of_others),
            **_by_cause('rejected', rotor_input.rejected),
            'lost messages': str(self.lost),
            'not sent': str(self.unsent),
            'not referenced': str(self.unreferenced),
            'drivers': str(self.drivers),
            'duplicate stamps': str(rotor_input.duplicates),
            'zero stamps': str(rotor_input.zero_stamps),
            'unnormalised stamps': str(rotor_input.unnormalised_stamps),
            'clock resets': str(rotor_input.resets),
            'age of last input (s)': 'none' if self.last_input is None else f'{age:.3f}',
            'referenced': str(rotor_input.referenced).lower(),
            'rotor zero (rad)': f'{TURN * rotor_input.zero.turns + rotor_input.zero.angle:.9g}',
            'home file': self.zero_kept,
        }
        notes: list[str] = []
        if reference:
            values['reference'] = rotor_input.origin if rotor_input.referenced else 'none'
            values['reference checked'] = 'yes' if reference.checked else 'no'
            unchecked = rotor_input.referenced and reference.decision and not reference.checked
            if unchecked and not reference.disagreement:
                notes.append('reference not checked')
        return self._report(errors, warnings, values, notes)


@dataclass(slots=True, kw_only=True)
class EncoderMonitor(DriverMonitor):
    """Monitors the encoder at the output, and the transmission error."""

    _reported: float = -math.inf
    _compared: int = 0

    def report(
        self, encoder: OutputEncoder, parameters: NodeParameters, now: float
    ) -> StatusReport | None:
        """Report on an encoder in the time since the last report, until now.

        Return None until the encoder has sent a message. `parameters` have the limits.
        """
        if self.last_input is None:
            return None
        age = now - self.last_input
        matched = encoder.comparison.matched
        soon = now - self._reported < _SOON
        compared, silent = soon or matched != self._compared, age > parameters.input_timeout
        if not soon:
            self._reported, self._compared = now, matched

        warnings = []
        if silent:
            warnings.append(Fault(f'no output_encoder for {age:.1f} s', _NO_INPUT))
        elif not compared:
            warnings.append(Fault('no rotor angle of the same time', _NOT_COMPARED))
        warnings += self._new_faults(encoder.rejected)
        # Without new samples, the statistics are out of date.
        error = encoder.window.statistics() if compared and not silent else ErrorStatistics()
        found = error.reversals
        if (
            error.peak_to_peak is not None
            and error.peak_to_peak > parameters.transmission_error_limit
        ):
            far = max(error.peak_to_peak, abs(error.mean or 0.0)) > _BEYOND_ANY_GEAR
            advice = _NOT_REFERENCED if far else _TOO_LARGE
            warnings.append(Fault(f'peak to peak {error.peak_to_peak:.3g} rad', advice))
        if slip := encoder.slip_watch.slip:
            moved, when = math.degrees(slip.angle), slip.stamp / SECOND
            text = f'the output has slipped by {moved:.2f}° against the rotor, at {when:.3f} s'
            warnings.append(Fault(text, _SLIPPED))
        values = {
            'received': str(encoder.received),
            'compared': str(matched),
            'direction checked': 'yes' if encoder.direction_checked else 'no',
            **_by_cause('rejected', encoder.rejected),
            **_by_cause('not compared', encoder.comparison.unmatched),
            'lost messages': str(self.lost),
            'age of last input (s)': f'{age:.3f}',
            'samples': str(error.samples),
            'mean (rad)': _number(error.mean),
            'peak to peak (rad)': _number(error.peak_to_peak),
            'lost motion (rad)': _estimate(found.lost_motion if found else None),
            'delay of output_encoder (s)': _estimate(found.delay if found else None),
        }
        if fit := error.calibration:
            if not fit.fits:
                warnings.append(Fault('calibration no longer fits', 'Calibrate the gear again.'))
            values['explained by the calibration (%)'] = _percent(fit.explained)
            values['outside the interval (%)'] = _percent(fit.outside)
        unchecked = compared and not (warnings or encoder.direction_checked)
        return self._report([], warnings, values, ['direction not checked'] * unchecked)


def _outside(rotor_input: RotorInput) -> str:
    """Say how the last output angle contradicts `output_range`; '' if it does not."""
    parameters, last = rotor_input.parameters, rotor_input.last
    if not last:
        return ''
    turns, rest = parameters.gear.gear_ratio.output_angle(*last.position, math)
    return range_fault(parameters, TURN * turns + rest, parameters.transmission_error_limit)


def _not_referenced(reference: TurnReference | None) -> Fault:
    """Explain why the turns are not known."""
    if not reference:
        return Fault('not referenced', _NOT_REFERENCED)
    if not (decision := reference.decision):
        cause, advice = f'no {SAMPLES} samples of output_encoder in a row', _NOT_COMPARED
    elif decision.outside:
        cause, advice = decision.outside, _OUTSIDE
    else:
        used, margin = (f'{math.degrees(x):.3g}°' for x in (decision.used, decision.margin))
        cause = f'{used} of {margin} margin'
        advice = _UNEXPLAINED if decision.budget < decision.margin else _AMBIGUOUS
    return Fault(f'not referenced: {cause}', f'{advice} Or: {_NOT_REFERENCED}')


def _rejections(counts: Counter[str]) -> Fault:
    causes = ', '.join(f'{cause} {count}' for cause, count in counts.items())
    advice = 'docs/diagnostics.md explains why messages are rejected.'
    if 'joint missing' in counts:
        advice = 'Set rotor_joint to one of the joints of the driver.'
    return Fault(f'rejected: {causes}', advice)


def _by_cause(what: str, counts: Counter[str]) -> dict[str, str]:
    return {f'{what}: {cause}': str(count) for cause, count in sorted(counts.items())}


def _estimate(estimate: Estimate | None) -> str:
    if estimate is None:
        return 'none'
    spread = estimate.uncertainty
    return _number(estimate.value) + (f' ± {spread:.2g}' if spread is not None else '')


def _number(value: float | None) -> str:
    return 'none' if value is None else f'{value:.6g}'


def _percent(share: float | None) -> str:
    return 'none' if share is None else f'{100.0 * share:.1f}'
