"""Measures one recording, or many in processes of this machine or on a Dask cluster."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from gear_kinematics.bag import ReportProgress, fleet
from gear_kinematics.bag.errors import unexpected
from gear_kinematics.kinematics import Gear, gear_from_mapping
from gear_kinematics.lost_motion.dynamic.ratio import fit_ratio
from gear_kinematics.lost_motion.recorded.bags import read_bag
from gear_kinematics.lost_motion.recorded.csv_files import Columns, is_csv, read_csv
from gear_kinematics.lost_motion.recorded.motion import MotionError
from gear_kinematics.lost_motion.recorded.recording import Recording
from gear_kinematics.lost_motion.recorded.times import Times, times_of
from gear_kinematics.lost_motion.report import LostMotionReport, measure
from gear_kinematics.lost_motion.static.ramps import RampError


@dataclass(frozen=True, slots=True)
class Task:
    """A recording, and how to measure it."""

    number: int
    """Place among the recordings."""
    path: Path
    name: str
    """In the report."""
    parameters: Mapping[str, Any]
    """Parameters of the node, as `parameters.load` returns them."""
    columns: Columns = field(default_factory=Columns)
    """Of a CSV."""
    rotor_topic: str | None = None
    """Of a bag, as `encoder_topic`; None finds it by type and name."""
    encoder_topic: str | None = None
    counts: int | None = None
    """Steps per turn of the encoder of the rotor, or of the angle column."""
    output_counts: int | None = None
    rated_torque: float | None = None
    """N·m."""
    corners: tuple[float, ...] | None = None
    """N·m, rising, between ranges of stiffness."""
    fit_ratio: bool = False
    """Whether to estimate the gear ratio."""
    delay: float | None = None
    """s or rows, of the output's encoder; None: estimated."""
    debug: bool = False
    """Whether to print tracebacks of unexpected errors to stderr."""


@dataclass(frozen=True, eq=False, slots=True)
class Outcome:
    """What became of a recording: a report or an error."""

    report: LostMotionReport | None
    error: str = ''
    times: Times | None = None


def measure_recording(task: Task, progress: ReportProgress | None = None) -> Outcome:
    """Measure one recording; any error about it is in the outcome."""
    try:
        return Outcome(_measured(task, progress), times=times_of(task.path))
    except (RampError, MotionError) as error:
        return lost(task, str(error))
    except (ValueError, OSError) as error:
        return Outcome(None, str(error))
    except Exception as error:  # noqa: BLE001, the other recordings are worth reporting
        return lost(task, unexpected(error, debug=task.debug))


def lost(task: Task, cause: str) -> Outcome:
    """Return the outcome of a recording that could not be measured."""
    return Outcome(None, f'{task.path}: {cause}')


def _absolute(task: Task) -> Task:
    return replace(task, path=task.path.absolute())


WORK = fleet.Work(measure_recording, lost, _absolute)
"""For `fleet.on_this_machine` and `fleet.on_cluster`."""


def _measured(task: Task, progress: ReportProgress | None) -> LostMotionReport:
    gear, fitted = gear_from_mapping(task.parameters), None
    recording = _read(task, gear, progress)
    if task.fit_ratio:
        if not recording.motion:
            raise MotionError('--fit-ratio needs the angles of rotor and output')
        fitted = fit_ratio(recording.motion, gear.gear_ratio)
        if fitted.ratio != gear.gear_ratio:
            gear = fitted.ratio
            changed = {**task.parameters, 'gear_ratio': str(gear)}
            recording = _read(replace(task, parameters=changed), gear, progress)
    recording = replace(recording, name=task.name)
    return measure(recording, gear, task.rated_torque, task.corners, fitted, task.delay)


def _read(task: Task, gear: Gear, progress: ReportProgress | None) -> Recording:
    if is_csv(task.path):
        travel = task.parameters['transmission_error_travel']
        return read_csv(task.path, gear, task.columns, travel, task.counts, task.output_counts)
    return read_bag(
        task.path,
        task.parameters,
        task.rotor_topic,
        task.encoder_topic,
        task.counts,
        task.output_counts,
        progress,
    )
