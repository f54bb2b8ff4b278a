"""Lost motion of a recording: figures and the curves behind them."""

from dataclasses import dataclass, replace
from typing import Literal

from gear_kinematics.kinematics import Gear, GearRatio
from gear_kinematics.lost_motion.dynamic import transmission
from gear_kinematics.lost_motion.dynamic.ratio import RatioEstimate, check_ratio
from gear_kinematics.lost_motion.dynamic.transmission import TransmissionFigures
from gear_kinematics.lost_motion.recorded.recording import Loading, Recording
from gear_kinematics.lost_motion.static import hysteresis
from gear_kinematics.lost_motion.static.creep import Creep
from gear_kinematics.lost_motion.static.hysteresis import STIFFNESS_SHARES, Figures, Settings
from gear_kinematics.lost_motion.static.models import Effects, Spring, models_of, settled
from gear_kinematics.lost_motion.static.ramps import RampError, Ramps
from gear_kinematics.lost_motion.static.rate import Rate, rates


@dataclass(frozen=True, eq=False, slots=True)
class HysteresisReport:
    """Figures of torque ramps, by amplitude from small to large."""

    settings: Settings
    rated_by: Literal['given', 'largest ramps', 'least of the recordings']
    """Source of the rated torque."""
    measured: bool
    """Whether an encoder measured the output; if not, figures are inferred from the motor's."""
    figures: tuple[Figures, ...]
    ramps: tuple[Ramps, ...]
    """Curves of the figures."""
    effects: Effects
    """What time does to the recording, and has been taken out."""
    spring: Spring | None
    """The stiffness without friction and creep."""
    creep: Creep | None
    rates: tuple[Rate | None, ...]
    """How fast the torque of the ramps changed; None where their times are not known."""

    @property
    def smallest(self) -> Figures:
        """Figures of the smallest ramps, for hysteresis and friction."""
        return self.figures[0]

    @property
    def leaving(self) -> Figures:
        """Figures of the smallest ramps that leave the backlash, for its size."""
        return next(figures for figures in self.figures if not figures.within)

    @property
    def largest(self) -> Figures:
        """Figures of the largest ramps, for the gear under load."""
        return self.figures[-1]


@dataclass(frozen=True, eq=False, slots=True)
class LostMotionReport:
    """The results for one recording."""

    recording: Recording
    gear_ratio: GearRatio
    """The ratio with which the recording was read."""
    hysteresis: HysteresisReport | None = None
    transmission: TransmissionFigures | None = None
    remarks: tuple[str, ...] = ()
    """Sentences about the recording."""
    fitted: RatioEstimate | None = None
    """The estimate of the ratio, if it comes from the recording."""


def measure(
    recording: Recording,
    gear: Gear,
    rated_torque: float | None = None,
    corners: tuple[float, ...] | None = None,
    fitted: RatioEstimate | None = None,
    delay: float | None = None,
) -> LostMotionReport:
    """Measure lost motion in a recording.

    Args:
        recording: torque ramps, the motion of both encoders, or both.
        gear: the gear whose orders to look for.
        rated_torque: N·m at the output; None: the amplitude of the largest ramps.
        corners: N·m, rising, between ranges of stiffness; None: shares of the rated torque.
        fitted: the estimate of the ratio, if it comes from the recording.
        delay: s, or rows of a file without times, by which the stamps of the output are late;
            None: estimated.

    Raises:
        RampError, MotionError: if nothing can be measured.
    """
    remarks = list(recording.remarks)
    motion = recording.motion
    found = None
    if motion:
        wrong = check_ratio(motion, gear.gear_ratio)
        remarks += [wrong] if wrong else []
        reversals, motion = transmission.separate_delay(motion, delay)
        found = transmission.figures(motion, gear, reversals)
        recording = replace(recording, motion=motion)
    ramps = None
    if recording.loading:
        try:
            ramps = _hysteresis(recording.loading, rated_torque, corners)
        except RampError as error:
            if not found:
                raise
            remarks.append(str(error))
    return LostMotionReport(recording, gear.gear_ratio, ramps, found, tuple(remarks), fitted)


def _hysteresis(
    loading: Loading, rated_torque: float | None, corners: tuple[float, ...] | None
) -> HysteresisReport:
    found = settled(loading)
    ramps = found.ramps
    step = loading.angle_step.size
    hysteresis.check(ramps[-1], step)
    models = models_of(found, step)
    rated = ramps[-1].amplitude if rated_torque is None else rated_torque
    if corners is None:
        corners = tuple(share * rated for share in STIFFNESS_SHARES)
    settings = Settings(rated, corners, step, found.effects.late or 0.0)
    return HysteresisReport(
        settings,
        'largest ramps' if rated_torque is None else 'given',
        loading.measured,
        hysteresis.figures(ramps, settings, models.plays),
        ramps,
        found.effects,
        models.spring,
        found.creeping.creep if found.creeping else None,
        rates(ramps),
    )
