"""What a validation found out about a bag: plain data, without ROS, bags or numpy.

Stamps are ns, times in s, angles in rad, lengths in m.
"""

import math
from dataclasses import dataclass, field

from gear_kinematics.kinematics import Mechanism
from gear_kinematics.report.document import Verdict


@dataclass(frozen=True, slots=True)
class FieldReport:
    """One field of an output topic, sample by sample against the recomputed one."""

    name: str
    """Such as `position` of output_state, or `orientation` of body_poses."""
    unit: str
    tolerance: float
    """Greatest error that passes, in `unit`."""
    compared: int = 0
    """Samples with a recorded and a recomputed value."""
    non_finite: int = 0
    """Samples whose recorded value is NaN or infinite; they are failures."""
    absent: int = 0
    """Samples that lack the field though the input has it, or the other way round."""
    max_error: float = 0.0
    rms_error: float = 0.0
    worst_stamp: int | None = None
    """Of the sample with `max_error`; None where there is no error at all."""
    worst_rotor_angle: float | None = None
    first_non_finite: int | None = None
    """Stamp of the first sample that is not finite."""
    first_absent: int | None = None
    """Stamp of the first sample that lacks the field."""

    @property
    def budget_used(self) -> float:
        """Share of the tolerance that the greatest error takes."""
        if self.max_error == 0.0:
            return 0.0
        return self.max_error / self.tolerance if self.tolerance else math.inf

    @property
    def passed(self) -> bool:
        """Whether every sample is within the tolerance."""
        return self.max_error <= self.tolerance and not self.non_finite and not self.absent


@dataclass(frozen=True, slots=True)
class TopicReport:
    """One output topic, matched with the input by header stamp."""

    topic: str
    messages: int
    compared: int
    """Messages matched with an input."""
    missing: int
    """Inputs that call for a message that is not there."""
    extra: int
    """Messages that no input calls for."""
    duplicates: int
    """Messages with the stamp of the one before; no failure where the input has them too."""
    out_of_order: int
    """Messages with a stamp before that of the one before, unless the input starts anew there."""
    fields: tuple[FieldReport, ...]
    first_missing: int | None = None
    """Stamp of the first input without a message."""
    first_extra: int | None = None
    """Stamp of the first message without an input."""
    first_out_of_order: int | None = None
    """Stamp of the first message out of order."""
    faults: tuple[str, ...] = ()
    """What else is wrong, each with how often and where first: frame ids, names, layouts."""
    left_out: dict[str, int] = field(default_factory=dict)
    """Inputs without an output and outputs without an input that are the recorder's doing."""

    @property
    def passed(self) -> bool:
        """Whether nothing is missing, too many, out of order or beyond its tolerance."""
        complete = not (self.missing or self.extra or self.out_of_order or self.faults)
        return self.compared > 0 and complete and all(field.passed for field in self.fields)


@dataclass(frozen=True, slots=True)
class Gap:
    """A silence of the rotor topic, or a jump of its position."""

    stamp: int
    """Of the sample after it."""
    seconds: float
    turned: float
    """rad, between the samples before and after it."""


@dataclass(frozen=True, slots=True)
class InputReport:
    """The rotor topic: what was in it, and how healthy it is."""

    topic: str
    joint: str
    messages: int = 0
    valid: int = 0
    rejected: dict[str, int] = field(default_factory=dict)
    """By cause."""
    duplicates: int = 0
    zero_stamps: int = 0
    unnormalised_stamps: int = 0
    """Stamps with a second or more of nanoseconds; they are read as the time that they mean."""
    resets: int = 0
    first_stamp: int | None = None
    rate: float = 0.0
    """Hz, from the median period."""
    duration: float = 0.0
    """s, from the first to the last stamp."""
    gaps: int = 0
    """Silences longer than 5 median periods."""
    jumps: int = 0
    """Gaps in which the rotor could have turned half a turn or more unseen."""
    overspeed: int = 0
    """Steps faster than `max_rotor_speed`."""
    max_speed: float = 0.0
    """rad/s, from position steps."""
    longest_gaps: tuple[Gap, ...] = ()
    """At most ten, the longest first."""
    referenced: bool = True
    """Whether the turns of the encoder were known throughout."""


@dataclass(frozen=True, slots=True)
class Series:
    """A thinned-out record over time for plots; all lists are of the same length."""

    time: list[float]
    """s, since the first sample."""
    rotor_angle: list[float]
    output_angle: list[float]
    """As recorded."""
    angle_error: list[float]
    """Recorded less recomputed output angle; of each interval the worst."""
    position_error: list[float]
    """m, the worst of all bodies and of each interval."""


@dataclass(frozen=True, slots=True)
class BagReport:
    """The whole finding about one bag."""

    bag: str
    verdict: Verdict
    config: str = ''
    """The parameter file that was used."""
    gear_ratio: str = ''
    """Such as `-19` or `-58/3`."""
    error: str | None = None
    """Why the bag is unusable, or what damage cut it short; the rest is of what came before."""
    messages: int = 0
    """On the three topics."""
    rotor: InputReport | None = None
    topics: tuple[TopicReport, ...] = ()
    findings: tuple[str, ...] = ()
    """Sentences: a constant offset, another mechanism, what the input's health means."""
    series: Series | None = None
    mechanism: Mechanism | None = None
    """What the outputs were recomputed for."""
    module: float = 0.0
    """Of its teeth, m, for the drawing."""

    @property
    def passed(self) -> bool:
        """Whether the recorded outputs are what they should be."""
        return self.verdict == Verdict.PASS
