# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Measurement of a gear from a recording: figures of torque ramps, and the transmission error."""

from dataclasses import dataclass, replace

from gear_kinematics.kinematics import GearRatio
from gear_kinematics.measurement.figures import GearFigures, gear_figures
from gear_kinematics.measurement.loops import RampError, find_ramps
from gear_kinematics.measurement.measured import HYSTERESIS, LOST_MOTION, Measured
from gear_kinematics.measurement.ramp_gate import gated_ramps
from gear_kinematics.measurement.ratio import check_ratio, not_followed
from gear_kinematics.measurement.recording import Recording
from gear_kinematics.measurement.sentences import Observation, Observed
from gear_kinematics.measurement.transmission import TransmissionFigures, transmission_figures
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.report.document import number


@dataclass(frozen=True, eq=False, slots=True)
class LostMotion:
    """The results for one recording."""

    name: str
    recording: Recording
    gear_ratio: GearRatio  #: with which it was read
    figures: GearFigures | None = None  #: None where there are no torque ramps
    measured: bool = False  #: whether an encoder measured the output, otherwise taken as locked
    transmission: TransmissionFigures | None = None
    wrong_ratio: Observed | None = None  #: what contradicts the ratio, if anything

    @property
    def main_figures(self) -> tuple[Measured, ...]:
        """Figures of the summary, to which limits apply; the value is None if unknown."""
        found, motion = self.figures, self.transmission
        moving = found or motion
        lost = moving.lost_motion if moving else None
        top = found.stiffness[-1] if found and found.stiffness else None
        ends = f' {number(top.low)} to {number(top.high)} N·m' if top else ''
        return (
            Measured(HYSTERESIS, 'rad', found.hysteresis if found else None),
            Measured('backlash', 'rad', found.backlash if found else None),
            Measured('friction', 'N·m', found.friction if found else None),
            Measured(LOST_MOTION, 'rad', lost, '' if found else ' on reversals'),
            Measured('stiffness', 'N·m/rad', top.slope if top else None, ends),
            Measured('transmission accuracy', 'rad', motion.forward if motion else None),
        )


def measure(
    recording: Recording, parameters: NodeParameters, rated_torque: float | None = None
) -> LostMotion:
    """Measure torque ramps and the motion of both encoders, as far as a recording has them.

    The default of the rated torque, N·m, is the amplitude of the largest ramps.

    Raises:
        RampError, RecordingError: if nothing can be measured.
    """
    encoders, ratio = recording.encoders, parameters.gear.gear_ratio
    found = wrong = None
    if encoders and not encoders.wound_up(ratio):
        wrong = check_ratio(encoders, ratio)
        found = transmission_figures(encoders, ratio, parameters.transmission_error_travel)
    report = LostMotion(recording.name, recording, ratio, transmission=found, wrong_ratio=wrong)
    if not (loading := recording.loading(ratio)):
        # Without a torque that winds it up, the output goes where the rotor moves it.
        if found and not wrong and (found.forward or found.backward):
            wrong = not_followed(found.angle, found.error, ratio)
        return replace(report, wrong_ratio=wrong)
    loading, new_faults = gated_ramps(loading)
    faults = (*recording.faults, *new_faults)
    try:
        ramps = find_ramps(loading.torque, loading.angle, loading.angle_step.size)
        figures = gear_figures(ramps, rated_torque)
    except RampError as error:
        if not found:
            raise RampError('; '.join(map(str, (error, *faults)))) from error
        no_ramps = Observation.NO_RAMPS(why=str(error))
        return replace(
            report, recording=replace(recording, remarks=(*recording.remarks, no_ramps))
        )
    recording = replace(recording, faults=faults)
    return replace(report, recording=recording, figures=figures, measured=loading.measured)
