# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""What a recording tells of a gear: the figures of torque ramps, and the transmission error.

`measure` works on a recording that was read, `measure_recording` on a file, so that many can be
measured in processes of this machine or on a Dask cluster.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import NamedTuple

from gear_kinematics.bag import ReportProgress, fleet
from gear_kinematics.bag.errors import unexpected
from gear_kinematics.correction.uncertainty import Estimate
from gear_kinematics.kinematics import Gear, GearRatio
from gear_kinematics.measurement.csv_files import Sources
from gear_kinematics.measurement.figures import (
    GearFigures,
    Settings,
    gear_figures,
    settings_for,
)
from gear_kinematics.measurement.loops import RampError, Ramps, find_ramps
from gear_kinematics.measurement.measured import HYSTERESIS, Measured
from gear_kinematics.measurement.ratio import check_ratio
from gear_kinematics.measurement.reading import read
from gear_kinematics.measurement.recording import Recording
from gear_kinematics.measurement.transmission import TransmissionFigures, transmission_figures
from gear_kinematics.measurement.wording import arc_minutes
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.report.document import number


@dataclass(frozen=True, eq=False, slots=True)
class LostMotion:
    """The results for one recording."""

    name: str
    recording: Recording
    gear_ratio: GearRatio
    """With which it was read."""
    figures: GearFigures | None = None
    """None where there are no torque ramps."""
    measured: bool = False
    """Whether an encoder measured the output under torque; if not, it is taken to be locked."""
    transmission: TransmissionFigures | None = None
    remarks: tuple[str, ...] = ()
    """Sentences about what was found."""
    wrong_ratio: str = ''
    """What is wrong with the ratio, in a sentence; empty if nothing shows."""

    @property
    def main_figures(self) -> tuple[Measured, ...]:
        """The figures of a summary, to which limits apply; without a value where unknown."""
        found, motion = self.figures, self.transmission
        stiffness = found.stiffness[-1].both if found and found.stiffness else None
        moving = found or motion
        return (
            Measured(HYSTERESIS, 'rad', found.hysteresis if found else None),
            Measured('backlash', 'rad', found.backlash if found else None),
            Measured('lost motion', 'rad', moving.lost_motion if moving else None),
            Measured('stiffness', 'N·m/rad', stiffness),
            Measured('transmission accuracy', 'rad', motion.forward if motion else None),
        )

    def at(self, settings: Settings) -> 'LostMotion':
        """The figures of the ramps at other reference values; the step of the encoder stays."""
        if not (found := self.figures):
            return self
        settings = replace(settings, angle_step=found.settings.angle_step)
        ramps = [own.ramps for own in found.by_amplitude]
        return replace(self, figures=gear_figures(ramps, settings))


@dataclass(frozen=True, slots=True)
class Request:
    """How to measure a recording."""

    rated_torque: float | None = None
    """N·m; None: the amplitude of the largest ramps."""
    corners: tuple[float, ...] | None = None
    """N·m, rising, between ranges of stiffness; None: shares of the rated torque."""
    delay: float | None = None
    """s or rows, by which the output's encoder is late; None: estimated."""


def measure(
    recording: Recording, gear: Gear, parameters: NodeParameters, request: Request
) -> LostMotion:
    """Measure a recording.

    Args:
        recording: torque ramps, the motion of both encoders, or both.
        gear: whose ratio and orders to take.
        parameters: of the node, for `transmission_error_travel`.
        request: see there.

    Raises:
        RampError, RecordingError: if nothing can be measured.
    """
    encoders, remarks = recording.encoders, recording.sentences
    found, wrong = None, ''
    if encoders:
        wrong = check_ratio(encoders, gear.gear_ratio)
        travel = parameters.transmission_error_travel
        found = transmission_figures(encoders, gear, travel, request.delay)
    report = LostMotion(
        recording.name, recording, gear.gear_ratio, transmission=found, wrong_ratio=wrong
    )
    if loading := recording.loading(gear.gear_ratio):
        try:
            ramps = find_ramps(loading.torque, loading.angle, loading.time)
            step = loading.angle_step.size
            settings = settings_for(ramps, step, request.rated_torque, request.corners)
            figures = gear_figures(ramps, settings)
            remarks += time_remarks(ramps, figures.friction, step)
            report = replace(report, figures=figures, measured=loading.measured)
        except RampError as error:
            if not found:
                raise
            remarks.append(f'{error}.')
    return replace(report, remarks=tuple(remarks))


def time_remarks(
    ramps: Sequence[Ramps], friction: Estimate | None, angle_step: float
) -> Iterator[str]:
    """Say what changes with time, with its size; it is not taken out of the figures.

    The friction, N·m, is that of the smallest ramps, as creep adds to that of large ones.
    """
    if drift := max(ramps, key=lambda ramps: len(ramps.loops)).drift():
        moved, span = drift
        yield f'The zero drifts by {arc_minutes(moved)} arcmin in {number(span)} s, evenly.'
    if friction and (further := ramps[-1].creep(friction.value, angle_step)):
        yield (
            f'After the torque has turned back, the angle goes on by {arc_minutes(further)} '
            'arcmin while friction holds the gear: it creeps, or the encoder is late. This is '
            'part of the hysteresis.'
        )


# Many recordings


@dataclass(frozen=True, slots=True)
class Task:
    """A recording, and how to measure it."""

    number: int
    """Place among the recordings."""
    path: Path
    name: str
    """In the report."""
    parameters: NodeParameters
    request: Request
    sources: Sources
    debug: bool = False
    """Whether to print tracebacks of unexpected errors to stderr."""


class Outcome(NamedTuple):
    """What became of a recording: a report or an error."""

    report: LostMotion | None
    error: str = ''


def measure_recording(task: Task, progress: ReportProgress | None = None) -> Outcome:
    """Measure one recording; any error about it is in the outcome."""
    try:
        recording = read(task.path, task.parameters, task.sources, progress)
        recording = replace(recording, name=task.name)
        return Outcome(measure(recording, task.parameters.gear, task.parameters, task.request))
    except (ValueError, OSError) as error:
        cause = str(error)
        return Outcome(None, cause) if str(task.path) in cause else _failed(task, cause)
    except Exception as error:  # noqa: BLE001, the other recordings are worth reporting
        return _failed(task, unexpected(error, debug=task.debug))


def _failed(task: Task, cause: str) -> Outcome:
    return Outcome(None, f'{task.path}: {cause}')


def _absolute(task: Task) -> Task:
    return replace(task, path=task.path.absolute())


WORK = fleet.Work(measure_recording, _failed, _absolute)
"""For `fleet.on_this_machine` and `fleet.on_cluster`."""
