"""Measures one recording, or many in processes of this machine or on a Dask cluster."""

from dataclasses import dataclass, replace
from pathlib import Path

from gear_kinematics.bag import ReportProgress, fleet
from gear_kinematics.bag.errors import unexpected
from gear_kinematics.measurement.columns import Columns
from gear_kinematics.measurement.loops import RampError
from gear_kinematics.measurement.lost_motion import LostMotion, Request, measure
from gear_kinematics.measurement.reading import read
from gear_kinematics.measurement.recording import RecordingError
from gear_kinematics.parameters import NodeParameters


@dataclass(frozen=True, slots=True)
class Task:
    """A recording, and how to measure it."""

    number: int
    """Place among the recordings."""
    path: Path
    name: str
    """In the report."""
    parameters: NodeParameters
    """Parameters of the node."""
    request: Request
    columns: Columns
    rotor_topic: str | None = None
    """Of a bag, as `encoder_topic`; None finds it by type and name."""
    encoder_topic: str | None = None
    debug: bool = False
    """Whether to print tracebacks of unexpected errors to stderr."""


@dataclass(frozen=True, eq=False, slots=True)
class Outcome:
    """What became of a recording: a report or an error."""

    report: LostMotion | None
    error: str = ''


def measure_recording(task: Task, progress: ReportProgress | None = None) -> Outcome:
    """Measure one recording; any error about it is in the outcome."""
    try:
        recording = read(
            task.path,
            task.parameters,
            task.columns,
            task.rotor_topic,
            task.encoder_topic,
            progress,
        )
        recording = replace(recording, name=task.name)
        gear = task.parameters.gear
        return Outcome(measure(recording, gear, task.parameters, task.request))
    except (ValueError, OSError) as error:
        if isinstance(error, (RampError, RecordingError)) and str(task.path) not in str(error):
            return lost(task, str(error))
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
