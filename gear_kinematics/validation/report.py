# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The result of validating a bag, as plain data without ROS, bags or numpy.

Stamps are ns, times s, angles rad, lengths m; a `first_...` is the stamp of the first occurrence.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, Self

from gear_kinematics.kinematics import Mechanism
from gear_kinematics.report.document import Verdict
from gear_kinematics.validation.causes import FindingCause
from gear_kinematics.validation.independent import IndependentReport


@dataclass(frozen=True, slots=True)
class Finding:
    """Something found in a recording; `findings.sentence` puts it into words."""

    cause: FindingCause
    topic: str = ''  #: topic, or topic and field; empty if its values name them
    stamp: int | None = None  #: the moment that it is about
    count: int = 0  #: how many messages or values are concerned
    values: Mapping[str, Any] = field(default_factory=dict)  #: by their names in the sentence
    fails: bool = False  #: whether the bag fails because of it, whatever the other numbers are
    explains: bool = False  #: whether it explains why the bag fails


@dataclass(frozen=True, slots=True)
class FieldReport:
    """Comparison of one field of an output topic with the recomputed one."""

    name: str  #: name, such as `position` of output_state, or `orientation` of body_poses
    unit: str
    tolerance: float  #: greatest accepted error, in `unit`
    compared: int = 0  #: samples with a recorded and a recomputed value
    non_finite: int = 0  #: samples whose recorded value is NaN or infinite, which fail
    absent: int = 0  #: samples with the field in either the input or the output only
    max_error: float = 0.0
    rms_error: float = 0.0
    worst_stamp: int | None = None  #: stamp of the sample with `max_error`; None without any error
    worst_rotor_angle: float | None = None
    first_non_finite: int | None = None
    first_absent: int | None = None

    @property
    def budget_used(self) -> float:
        """Greatest error / tolerance."""
        if self.max_error == 0.0:
            return 0.0
        return self.max_error / self.tolerance if self.tolerance else math.inf

    @property
    def is_beyond(self) -> bool:
        """Whether the greatest error exceeds the tolerance; a NaN does."""
        return not self.max_error <= self.tolerance

    @property
    def passed(self) -> bool:
        """Whether every sample is within the tolerance."""
        return not (self.is_beyond or self.non_finite or self.absent)


@dataclass(frozen=True, slots=True)
class TopicReport:
    """One output topic, matched with the input by header stamp."""

    topic: str
    messages: int
    compared: int  #: messages matched with an input
    missing: int  #: number of inputs without their message
    extra: int  #: messages without an input
    duplicates: int  #: messages with the stamp of the last; no failure if the input has them too
    out_of_order: int  #: with an earlier stamp than the last, unless the input restarts there
    fields: tuple[FieldReport, ...]
    wrong: int = 0  #: compared messages with a field that does not pass
    first_missing: int | None = None
    first_extra: int | None = None
    first_out_of_order: int | None = None
    faults: tuple[Finding, ...] = ()  #: others, such as wrong frame ids or joint names
    left_out: dict[str, int] = field(default_factory=dict)  #: unpaired by the recorder, by cause

    @property
    def passed(self) -> bool:
        """Whether nothing is missing, extra, out of order or beyond its tolerance."""
        complete = not (self.missing or self.extra or self.out_of_order or self.faults)
        return self.compared > 0 and complete and all(field.passed for field in self.fields)


@dataclass(frozen=True, slots=True)
class Gap:
    """A gap between messages of the rotor topic."""

    stamp: int  #: stamp of the sample after the gap
    seconds: float
    turned: float  #: travel between the samples before and after it, rad


@dataclass(frozen=True, slots=True)
class InputReport:
    """Contents and health of the rotor topic."""

    topic: str
    joint: str
    messages: int = 0
    valid: int = 0
    rejected: dict[str, int] = field(default_factory=dict)  #: rejected messages by cause
    of_others: int = 0  #: messages of other joints on a shared topic, neither valid nor rejected
    duplicates: int = 0
    zero_stamps: int = 0
    unnormalised_stamps: int = 0  #: with a second or more of nanoseconds; they are normalised
    resets: int = 0
    first_stamp: int | None = None
    rate: float = 0.0  #: rate from the median period, Hz
    duration: float = 0.0  #: time from the first to the last stamp, s
    gaps: int = 0  #: gaps longer than 5 median periods
    jumps: int = 0  #: gaps in which the rotor could have turned half a turn or more unseen
    jumped: str = ''  #: how turns were lost, such as by the encoder's last jump, in words; or ''
    velocity_is: str = ''  #: what velocities that contradict the positions seem to be; or ''
    beyond_limits: str = ''  #: speed and acceleration beyond their limits, in words; or ''
    outside: str = ''  #: an output angle outside of `output_range`, in words; or ''
    effort_is: str = ''  #: that efforts are too large, or 0 throughout the motion; or ''
    set_back: str = ''  #: the clock's last step back, or that it is of another unit; or ''
    overspeed: int = 0  #: steps faster than `max_rotor_speed`
    max_speed: float = 0.0  #: greatest speed between two positions, rad/s
    longest_gaps: tuple[Gap, ...] = ()  #: the longest gaps, at most ten, longest first
    referenced: bool = True  #: whether the turns of the encoder were known throughout


@dataclass(frozen=True, slots=True)
class Series:
    """A thinned-out record of a topic over time for plots; all lists have the same length."""

    topic: str
    time: list[float]  # time since the first sample of the input, s
    rotor_angle: list[float]
    errors: dict[str, list[float]] = field(default_factory=dict)
    """Worst error of each interval, by the names of the fields: recorded minus expected, or the
    magnitude of a vector."""


@dataclass(frozen=True, slots=True)
class BagReport:
    """The result for one bag."""

    bag: str
    verdict: Verdict
    config: str = ''  #: the parameter file
    actuator: str = ''  #: of an arm; '' of one gear, and of the arm as a whole
    gear_ratio: str = ''  #: gear ratio, such as `-19` or `-58/3`
    error: str | None = None  #: why the bag is unusable, or the damage at which reading ended
    messages: int = 0  #: number of messages on all topics
    rotor: InputReport | None = None
    topics: tuple[TopicReport, ...] = ()
    findings: tuple[Finding, ...] = ()  #: about all; `explain` adds faults of topics and fields
    independent: IndependentReport | None = None  #: by code that the node does not run, if asked
    series: tuple[Series, ...] = ()  #: records of the output topics that have anything to compare
    mechanism: Mechanism | None = None  #: the mechanism for which the outputs were recomputed
    module: float = 0.0  #: module of its teeth, m, for the drawing
    elapsed: float = field(default=0.0, compare=False, repr=False)  #: duration of the check, s
    actuators: 'tuple[BagReport, ...]' = ()  #: of an arm; the verdict is the worst of theirs

    def adding(self, *findings: Finding) -> Self:
        """Return the report with further findings, which may fail it."""
        fails = self.passed and any(finding.fails for finding in findings)
        verdict = Verdict.FAIL if fails else self.verdict
        return replace(self, verdict=verdict, findings=(*self.findings, *findings))

    @property
    def every_topic(self) -> tuple[TopicReport, ...]:
        """The topics of the report and of all its actuators."""
        return (*self.topics, *(topic for each in self.actuators for topic in each.topics))

    @property
    def causes(self) -> list[Finding]:
        """Findings that explain why the bag fails; first those that fail it by themselves."""
        failing = [finding for finding in self.findings if finding.fails]
        return failing + [finding for finding in self.findings if finding.explains]

    def seconds(self, stamp: int) -> float | None:
        """Return the time of a stamp since the input's first stamp, s; None without a stamp."""
        rotors = (each.rotor for each in (self, *self.actuators) if each.rotor)
        first = min((r.first_stamp for r in rotors if r.first_stamp is not None), default=None)
        return None if first is None else (stamp - first) / 1e9

    @property
    def passed(self) -> bool:
        """Whether the recorded outputs agree with the recomputed ones."""
        return self.verdict == Verdict.PASS


def unusable(bag: Path, error: str, config: str = '') -> BagReport:
    """Return the report on a bag that cannot be validated, and why; `config` is its file."""
    return BagReport(str(bag), Verdict.UNUSABLE, config=config, error=error)
