# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""A bag, and how to validate it."""

from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

from gear_kinematics.correction.calibration_file import Calibration
from gear_kinematics.parameters import NodeParameters


class Tolerances(NamedTuple):
    """Greatest accepted errors, one for each quantity."""

    angle: float = 1e-9  #: rad, of angles and orientations
    position: float = 1e-9  #: m
    velocity: float = 1e-9  #: rad/s
    effort: float = 1e-9  #: N·m

    def of(self, unit: str) -> float:
        """Return the tolerance of errors in a unit."""
        return float(getattr(self, QUANTITIES[unit]))


QUANTITIES = {'rad': 'angle', 'm': 'position', 'rad/s': 'velocity', 'N·m': 'effort'}
"""The fields of `Tolerances` by the units of errors."""
_TOLERANCES = Tolerances()


@dataclass(frozen=True, slots=True)
class Task:
    """A bag, and how to validate it."""

    bag: Path
    parameters: NodeParameters  # parameters of the node
    config: str = ''  # their file
    tolerances: Tolerances = _TOLERANCES
    strict: bool = False
    """Whether to judge all missing and extra messages, even if the recorder may have caused them
    (see `recorder`), and to fail a recording with another rotor_zero, as after homing."""
    independent: bool = False  # whether to compare by code that the node does not run, too
    only_joint: bool = True  # whether the only joint on the rotor topic may be the rotor
    rotor_topic: str | None = None  # each topic that is None is found by type and name
    output_topic: str | None = None
    poses_topic: str | None = None
    encoder_topic: str | None = None
    namespace: str | None = None  # that of the node, to choose among several sets of topics
    calibration: Calibration | None = None  # needed to judge the corrected output
    actuators: 'tuple[Task, ...]' = ()  # one for each actuator of an arm; empty for one gear
    debug: bool = False  # whether to print tracebacks of unexpected errors to stderr
