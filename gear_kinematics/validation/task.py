"""A bag, and how to validate it."""

from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

from gear_kinematics.correction.calibration_file import Calibration
from gear_kinematics.parameters import NodeParameters


class Tolerances(NamedTuple):
    """Greatest accepted errors."""

    angle: float = 1e-9
    """rad for angles, rad/s for the velocity, N·m for the effort."""
    position: float = 1e-9
    """m."""


_TOLERANCES = Tolerances()


@dataclass(frozen=True, slots=True)
class Task:
    """A bag, and how to validate it."""

    bag: Path
    parameters: NodeParameters
    """Parameters of the node."""
    config: str = ''
    """Their file."""
    tolerances: Tolerances = _TOLERANCES
    allow_offset: bool = False
    """Whether to accept a constant offset of the output angle, as after homing."""
    strict: bool = False
    """Whether to judge all missing and extra messages, even if the recorder may have caused them;
    see `recorder`."""
    rotor_topic: str | None = None
    """None, as for the other topics: found by type and name."""
    output_topic: str | None = None
    poses_topic: str | None = None
    calibration: Calibration | None = None
    """Of the node that was recorded; without it, the corrected output is not judged."""
    calibration_file: str = ''
    """Its file."""
    debug: bool = False
    """Whether to print tracebacks of unexpected errors to stderr."""
