# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Monitors of a gear's inputs, which report facts; times are of a steady clock, s."""

import math
import time
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from gear_kinematics.correction.error_window import ErrorStatistics
from gear_kinematics.correction.transmission_error import SAMPLES
from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.state.disorder import ALTERNATING, FASTEST
from gear_kinematics.state.losses import Publishers
from gear_kinematics.state.output_encoder import OutputEncoder
from gear_kinematics.state.rotor_input import RotorInput
from gear_kinematics.state.statuses import Condition, Fact, GearReport
from gear_kinematics.state.turn_reference import TurnReference, range_fault
from gear_kinematics.state.wraps import why_unknown
from gear_kinematics.wire.cdr import SECOND
from gear_kinematics.wire.joint_reader import Rejection

_BEYOND_ANY_GEAR = 0.1  # rad
_MOST_REPEATED, _ALL_REPEATED = 0.6, 0.95
"""Shares of repeated stamps that are a fault: where turns depend on stamps, and elsewhere. Half of
them repeat at 2 kHz if they are in ms, which hides no turn."""
_SOON = 0.1  # time, s, after a report until which the next one repeats its rates and comparisons


@dataclass(slots=True)
class DriverFacts:
    """Facts about the drivers on a topic, shared by all actuators."""

    since: float = field(default_factory=time.monotonic)  # from when on messages are awaited
    publishers: int = 0
    lost: int = 0  # messages that are missing between those that came
    losses_known: bool = True  # whether they could be counted since the last report
    number: int | None = None  # that of the latest message, if the middleware gives one


@dataclass(slots=True)
class Connections:
    """Facts about a node's connections with others."""

    rotor: DriverFacts = field(default_factory=DriverFacts)
    encoder: DriverFacts = field(default_factory=DriverFacts)
    unsent: int = 0  # messages that the middleware failed to send
    graph: Sequence[Fact] = ()  # faults at the last check of the ROS graph


class DriverMonitor:
    """Monitors a driver of an actuator."""

    joint = 'rotor_joint'  # parameter that chooses the joint

    def __init__(self) -> None:
        self.last_input: float | None = None  # time of the last message, valid or not
        self.publishers = Publishers()  # of the joint
        self.several = False  # whether several drivers send the joint, at the last report
        self._counted = Counter[str]()  # counts at the last report

    def _growth(self, counts: Mapping[str, int]) -> Counter[str]:
        """Return by how much counts have grown since the last report."""
        grown, self._counted = Counter(counts) - self._counted, Counter(counts)
        return grown  # another input counts from 0

    def _count_drivers(self, driver: DriverFacts, others: int) -> None:
        """Find whether several send the joint; without numbers, none has sent `others` so far."""
        self.publishers.update()
        mixed = self.publishers.several
        if driver.number is None:
            mixed = self.last_input is not None and not others
        self.several = driver.publishers > 1 and mixed

    def _losses(
        self, grown: Counter[str], rejected: Mapping[str, int], driver: DriverFacts
    ) -> Iterator[Fact]:
        """Yield what has grown of the messages that were rejected or lost."""
        if counts := {cause: grown[cause] for cause in rejected if grown[cause]}:
            if Rejection.JOINT_MISSING in counts:
                yield Condition.JOINT_MISSING(counts=counts, parameter=self.joint)
            else:
                yield Condition.REJECTED(counts=counts)
        if lost := grown['lost']:
            yield Condition.LOST(count=lost)
        if not driver.losses_known:
            yield Condition.LOSSES_UNKNOWN()


class InputMonitor(DriverMonitor):
    """Monitors the rotor input."""

    def __init__(self, rotor_input: RotorInput, encoder: OutputEncoder) -> None:
        """Monitor an input and the encoder at the output, which may find its turns."""
        super().__init__()
        self._input, self._encoder = rotor_input, encoder
        self.unreferenced = 0  # valid inputs while the turns were not known
        self.withheld = 0  # those of them without outputs
        self.moved = 0.0  # rad, from where the rotor was when its driver was heard last
        self.zero_kept: Fact | None = None  # where `rotor_zero` is kept, or why it is not
        self._reported, self._rate, self._received = 0.0, 0.0, 0
        self._stamp = 0  # ns, the last one at the last report
        self._paces = 0.0, 0.0  # by how many times the clock's time stamps rose in two reports

    def report(self, now: float, connections: Connections) -> GearReport:
        """Report on the time since the last report, until now."""
        rotor_input, driver = self._input, connections.rotor
        elapsed = now - max(self._reported, driver.since)
        count = rotor_input.received - rotor_input.of_others
        received = max(0, count - self._received)  # at first, others may count as rejected
        if elapsed > _SOON:
            self._count_drivers(driver, rotor_input.of_others)
            self._rate = received / elapsed
            self._reported, self._received = now, count
            stamp = rotor_input.last.stamp if rotor_input.last else 0
            pace = (stamp - self._stamp) / SECOND / elapsed if self._stamp else 0.0
            self._paces = self._paces[1], pace
            self._stamp = stamp
        age = now - (driver.since if self.last_input is None else self.last_input)
        referenced = rotor_input.referenced
        values = {
            'rate (Hz)': self._rate,
            'received': rotor_input.received,
            'published': count - rotor_input.rejected.total() - self.withheld,
            'of others': rotor_input.of_others,
            **_by_cause('rejected', rotor_input.rejected),
            'lost messages': driver.lost if driver.losses_known else 'unknown',
            'not sent': connections.unsent,
            'not referenced': self.unreferenced,
            'drivers': driver.publishers,
            'duplicate stamps': rotor_input.duplicates,
            'zero stamps': rotor_input.zero_stamps,
            'unnormalised stamps': rotor_input.unnormalised_stamps,
            'clock resets': rotor_input.resets,
            'age of last input (s)': None if self.last_input is None else age,
            'referenced': referenced,
            'rotor zero (rad)': TURN * rotor_input.zero.turns + rotor_input.zero.angle,
            'home file': self.zero_kept or '',
        }
        if reference := self._encoder.reference:
            values['reference'] = rotor_input.origin if referenced else None
            values['reference checked'] = reference.checked
        return GearReport.of(self._facts(age, connections), values)

    def _facts(self, age: float, connections: Connections) -> Iterator[Fact]:
        driver, rotor_input = connections.rotor, self._input
        plausibility, reference = rotor_input.plausibility, self._encoder.reference
        counts = {
            'lost': driver.lost,
            'of others': rotor_input.of_others,
            'zero stamps': rotor_input.zero_stamps,
            'repeated stamps': rotor_input.duplicates,
            'close resets': rotor_input.disorder.close_resets,
            'received': rotor_input.received - rotor_input.of_others,
            'unsent': connections.unsent,
            'unreferenced': self.unreferenced,
            'taken back': plausibility.alternation.taken_back,
        }
        grown = self._growth({**rotor_input.rejected, **counts})
        if age > rotor_input.parameters.input_timeout:
            joint, others = rotor_input.parameters.rotor_joint, grown['of others']
            lacking = Condition.OTHERS_ALONE(age=age, count=others, joint=joint)
            yield lacking if others else Condition.NO_INPUT(age=age)
        if not rotor_input.referenced:
            turns, reset = rotor_input.turns, rotor_input.disorder.step
            lost = rotor_input.why_lost if turns.lost else why_unknown(turns)
            if lost := lost or (reset if rotor_input.resets else None):
                yield lost
            yield _not_referenced(reference, self._encoder.clocks_apart)
        elif wrong := (reference and reference.disagreement) or _outside(rotor_input):
            yield wrong
            if reference and (apart := self._encoder.clocks_apart):
                yield apart
        if self.moved:  # said once
            yield Condition.ELSEWHERE(angle_deg=math.degrees(self.moved))
            self.moved = 0.0
        yield from self._losses(grown, rotor_input.rejected, driver)
        wrong = plausibility.alternation.wrong(grown['taken back'])
        for doubt in (wrong, rotor_input.velocity_field.meaning, plausibility.beyond_limits):
            if doubt:
                yield doubt
        if rotor_input.parameters.rotor_period and grown['zero stamps']:
            yield Condition.ZERO_STAMPS(count=grown['zero stamps'])
        most = _MOST_REPEATED if rotor_input.parameters.rotor_period else _ALL_REPEATED
        if grown['repeated stamps'] > most * grown['received']:
            yield Condition.REPEATED_STAMPS(count=grown['repeated stamps'])
        if min(self._paces) > FASTEST:  # one alone is a clock that was set
            yield Condition.STAMPS_TOO_FAST(factor=self._paces[1])
        if grown['close resets'] >= ALTERNATING:
            yield Condition.CLOCKS_ALTERNATE(count=grown['close resets'])
        if grown['unsent']:
            yield Condition.UNSENT(count=grown['unsent'])
        if grown['unreferenced'] and rotor_input.referenced:
            yield Condition.WERE_UNKNOWN(count=grown['unreferenced'])
        if self.several:
            yield Condition.SEVERAL_DRIVERS()
        yield from connections.graph
        if (
            rotor_input.referenced
            and reference
            and reference.decision
            and not (reference.checked or reference.disagreement)
        ):
            yield Condition.NOT_CHECKED()


class EncoderMonitor(DriverMonitor):
    """Monitors the encoder at the output, and the transmission error."""

    joint = 'output_encoder_joint'

    def __init__(self, rotor: RotorInput, encoder: OutputEncoder) -> None:
        super().__init__()
        self._rotor, self._encoder = rotor, encoder
        self._reported, self._compared = -math.inf, 0

    def report(self, now: float, driver: DriverFacts) -> GearReport | None:
        """Report on the time since the last report, until now; None before the first message."""
        if self.last_input is None:
            return None
        encoder, parameters = self._encoder, self._encoder.parameters
        age = now - self.last_input
        matched = encoder.comparison.matched
        soon = now - self._reported < _SOON
        compared, silent = soon or matched != self._compared, age > parameters.input_timeout
        if not soon:
            self._reported, self._compared = now, matched
            self._count_drivers(driver, encoder.of_others)
        counts = {'lost': driver.lost, 'of others': encoder.of_others}
        grown = self._growth({**encoder.rejected, **counts})
        facts = [Condition.SEVERAL_DRIVERS()] * self.several
        if silent:
            facts.append(Condition.NO_ENCODER(age=age))
        elif not compared:
            known = self._rotor.referenced or parameters.absolute
            facts.append(Condition.NOT_COMPARED() if known else Condition.UNREFERENCED())
        # Without new samples, the statistics are out of date.
        error = encoder.window.statistics() if compared and not silent else ErrorStatistics()
        found = error.reversals
        if error.peak_to_peak and error.peak_to_peak > parameters.transmission_error_limit:
            far = max(error.peak_to_peak, abs(error.mean or 0.0)) > _BEYOND_ANY_GEAR
            which = Condition.BEYOND_ANY_GEAR if far else Condition.TOO_LARGE
            facts.append(which(angle=error.peak_to_peak))
        if slip := encoder.slip_watch.slip:
            moved, when = math.degrees(slip.angle), slip.stamp / SECOND
            facts.append(Condition.SLIPPED(angle_deg=moved, time=when))
        values = {
            'received': encoder.received,
            'of others': encoder.of_others,
            'compared': matched,
            'direction checked': encoder.direction_checked,
            **_by_cause('rejected', encoder.rejected),
            **_by_cause('not compared', encoder.comparison.unmatched),
            'lost messages': driver.lost if driver.losses_known else 'unknown',
            'age of last input (s)': age,
            'samples': error.samples,
            'mean (rad)': error.mean,
            'peak to peak (rad)': error.peak_to_peak,
            'lost motion (rad)': found and found.lost_motion,
            'delay of output_encoder (s)': found and found.delay,
        }
        if fit := error.calibration:
            if not fit.fits:
                facts.append(Condition.FITS_NO_LONGER())
            explained = None if fit.explained is None else 100.0 * fit.explained
            values['explained by the calibration (%)'] = explained
            values['outside the interval (%)'] = 100.0 * fit.outside
        if facts and (apart := encoder.clocks_apart):
            facts.insert(0, apart)
        facts += self._losses(grown, encoder.rejected, driver)
        faulty = any(fact.condition.level for fact in facts)
        if compared and not (faulty or encoder.direction_checked):
            facts.append(Condition.DIRECTION_NOT_CHECKED())
        return GearReport.of(facts, values)


def _outside(rotor_input: RotorInput) -> Fact | None:
    """Return how the output angle, by the present zero, contradicts `output_range`, if it does."""
    parameters, rotor = rotor_input.parameters, rotor_input.turns
    if not rotor.position:
        return None
    angle = rotor.relative_to(rotor_input.zero, parameters.rotor_direction)
    turns, rest = parameters.gear.gear_ratio.output_angle(*angle, math)
    return range_fault(parameters, TURN * turns + rest, parameters.transmission_error_limit)


def _not_referenced(reference: TurnReference | None, apart: Fact | None) -> Fact:
    """Return why the turns are not known."""
    if not reference:
        return Condition.NOT_REFERENCED()
    decision = reference.decision
    if decision and decision.unambiguous:
        # But slower motion has excluded these turns, or the motion could explain a jump.
        margin = min(decision.margin, reference.jump_margin)
        decision = reference.refuted or decision._replace(margin=margin)
    if not decision:
        why = Condition.NO_SAMPLES(count=SAMPLES)
    elif found := apart or decision.outside:
        why = found
    else:
        known = decision.budget < decision.margin
        which = Condition.UNEXPLAINED if known else Condition.AMBIGUOUS
        used, margin = (math.degrees(angle) for angle in (decision.used, decision.margin))
        why = which(used_deg=used, margin_deg=margin)
    return Condition.NOT_FOUND(why=why)


def _by_cause(what: str, counts: Counter[str]) -> dict[str, int]:
    return {f'{what}: {cause}': count for cause, count in sorted(counts.items())}
