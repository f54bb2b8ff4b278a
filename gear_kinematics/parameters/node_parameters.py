"""The parameters of the node and of `gearkin --config`: meaning, bounds and default values.

The default values are in config/actuator.yaml alone.
"""

import math
import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import yaml

from gear_kinematics.kinematics import Branch, GearRatio
from gear_kinematics.parameters import meshes
from gear_kinematics.parameters.files import ConfigError, given_parameters
from gear_kinematics.parameters.share import share_directory
from gear_kinematics.wire.nearest import nearest

NODE = 'gear_state_publisher'
"""The default name of the node."""

_EVERY_NODE = re.compile(r'use_sim_time|start_type_description_service|qos_overrides\..*')
"""Parameters that every node has and that are ignored here."""


@dataclass(frozen=True, slots=True)
class Parameter:
    """Meaning and bounds of a parameter, whose type is that of its default."""

    description: str
    minimum: float | None = None
    maximum: float | None = None
    step: int = 0
    choices: tuple[str, ...] = ()
    read_only: bool = False
    check: Callable[[Any], object] | None = None
    """Raises ValueError for other faults."""

    def fault(self, name: str, value: object, default: object) -> str | None:
        """Return the fault of a value, or None."""
        if type(value) is not type(default):
            return f'{name} must be of type {type(default).__name__}, not {value!r}'
        if isinstance(value, list) and not all(isinstance(item, str) for item in value):
            return f'{name} must be a list of strings, not {value!r}'
        if (
            isinstance(value, (int, float))
            and self.minimum is not None
            and self.maximum is not None
        ):
            # Written so that NaN is out of range.
            inside = self.minimum <= value <= self.maximum
            if not inside or (self.step and (value - self.minimum) % self.step):
                steps = f' in steps of {self.step}' if self.step else ''
                bounds = f'between {self.minimum} and {self.maximum}{steps}'
                return f'{name} must be {bounds}, not {value!r}'
        return self.other_fault(name, value)

    def other_fault(self, name: str, value: object) -> str | None:
        """Return a fault of a value within the type and the bounds, which ROS checks, or None."""
        if self.choices and value not in self.choices:
            return f'{name} must be one of {", ".join(self.choices)}, not {value!r}'
        if self.check:
            try:
                self.check(value)
            except ValueError as error:
                return f'{name}: {error}'
        return None


PARAMETERS: Mapping[str, Parameter] = {
    'ring_teeth': Parameter('Teeth of the ring gears, zk', 2, 100_000, read_only=True),
    'satellite_teeth': Parameter('Teeth of the satellites, zs', 1, 99_999, read_only=True),
    'eccentricity': Parameter('Eccentricity of the cams, m', 1e-6, 1.0, read_only=True),
    'module': Parameter('Module of the teeth, m; for their shape', 1e-6, 0.1, read_only=True),
    'branches': Parameter('Names of the branches', read_only=True),
    'gear_ratio': Parameter(
        "Exact ratio of a gear that is not ours, such as '-19' or '1457/26'; '': from the teeth",
        read_only=True,
        check=lambda text: text and GearRatio.parse(text),
    ),
    'rotor_joint': Parameter(
        "Joint to look up in rotor_state, or its index if joints have no names; '' takes the "
        'only joint'
    ),
    'rotor_direction': Parameter('1, or -1 if the encoder counts backwards', -1, 1, step=2),
    'rotor_zero': Parameter('Encoder position at rotor angle 0, rad', -1e15, 1e15),
    'rotor_encoder': Parameter(
        'Whether the position wraps once a turn', choices=('multi_turn', 'single_turn')
    ),
    'max_rotor_speed': Parameter('Greatest speed of the rotor, rad/s', 1e-3, 1e6),
    'max_rotor_acceleration': Parameter(
        'Greatest acceleration of the rotor, rad/s²; with the velocities of the messages, it '
        'bounds the turn of a single-turn encoder in a gap',
        1e-3,
        1e9,
    ),
    'input_timeout': Parameter('Time without input that is an ERROR, s', 1e-3, 1e6),
    'output_joint': Parameter('Name of the output shaft in output_state and the URDF'),
    'output_encoder_joint': Parameter(
        "Joint to look up in output_encoder, or its index if joints have no names; '' takes the "
        'only joint'
    ),
    'output_encoder_direction': Parameter(
        '1, or -1 if the encoder at the output counts backwards', -1, 1, step=2
    ),
    'output_encoder_zero': Parameter(
        "Position of the output's encoder at output angle 0, rad", -1e15, 1e15
    ),
    'transmission_error_window': Parameter(
        'Sliding window of the transmission error in diagnostics, s', 0.1, 60.0
    ),
    'transmission_error_limit': Parameter(
        'Peak-to-peak transmission error above which diagnostics report WARN, rad', 1e-9, 10.0
    ),
    'transmission_error_max_gap': Parameter(
        'Gap between rotor states beyond which nothing is interpolated, s', 1e-6, 10.0
    ),
    'transmission_error_travel': Parameter(
        'Travel of the output after a reversal until its direction counts, rad', 1e-9, 10.0
    ),
    'calibration': Parameter(
        "Path of a calibration file, from which corrected_state is computed; '' takes none"
    ),
    'home_angle': Parameter('Output angle that ~/home sets, rad', -1e9, 1e9),
    'frame_prefix': Parameter('Prefix of every frame id and joint name'),
    'markers_rate': Parameter('Highest rate of markers, Hz; 0: none', 0.0, 1000.0, read_only=True),
    'meshes': Parameter(
        'URI of the folder with the meshes of the URDF; auto: the installed ones, if they are of '
        'this mechanism; none: simple shapes',
        read_only=True,
        check=meshes.check,
    ),
    'executor': Parameter(
        'rclpy executor; auto: events if this ROS has it',
        choices=('auto', 'events', 'single_threaded'),
        read_only=True,
    ),
}
BRANCH_PARAMETERS: Mapping[str, Parameter] = {
    'cam_phase': Parameter(
        'Angle of the cam on the rotor, rad', -2.0 * math.pi, 2.0 * math.pi, read_only=True
    ),
    'axial_position': Parameter('Position along the motor axis, m', -10.0, 10.0, read_only=True),
}


def default_config() -> Path:
    """The installed config/actuator.yaml."""
    return share_directory() / 'config' / 'actuator.yaml'


@cache
def defaults() -> Mapping[str, Any]:
    """Every parameter's default value by its full name, from config/actuator.yaml."""
    return given_parameters(default_config(), NODE)


def branch_parameters(branches: Iterable[str]) -> dict[str, tuple[Parameter, Any]]:
    """The parameters of the named branches by full name, each with its default value."""
    return {
        f'{branch}.{field}': (
            parameter,
            defaults().get(f'{branch}.{field}', getattr(Branch(branch), field)),
        )
        for branch in branches
        for field, parameter in BRANCH_PARAMETERS.items()
    }


def unknown_parameters(names: Iterable[str], branches: Iterable[str]) -> list[str]:
    """A fault for each name that is no parameter of a node with these branches.

    After the faults, if any, comes the list of the parameters that there are.
    """
    known = [*PARAMETERS, *branch_parameters(branches)]
    faults = []
    for name in names:
        if name in known or _EVERY_NODE.fullmatch(name):
            continue
        branch, _, field = name.rpartition('.')
        if branch and field in BRANCH_PARAMETERS:
            hint = f'; `{branch}` is not in `branches`'
        else:
            hint = nearest(name, known)
        faults.append(f'unknown parameter `{name}`{hint}')
    if faults:
        faults.append(f'there are: {", ".join(known)}')
    return faults


def load(path: Path, node: str = NODE) -> dict[str, Any]:
    """Read a node's parameters from a file as the node would; missing ones have their defaults.

    A relative path of a calibration is relative to the file.

    Args:
        path: a parameter file of ROS: blocks of parameters below names of nodes.
        node: the node's fully qualified name. Without a namespace, it is the only node of that
            name in the file; if the file names none, the one that all its wildcards apply to.

    Raises:
        ConfigError: if it cannot be read, has nothing for the node, leaves open which node is
            meant, or naming every value and every name that is refused.
    """
    given = given_parameters(path, node)
    known = {name: (parameter, defaults()[name]) for name, parameter in PARAMETERS.items()}
    faults = _faults(given, known)
    branches = given.get('branches', known['branches'][1])
    if not faults:
        of_branches = branch_parameters(branches)
        faults += _faults(given, of_branches)
        known |= of_branches
        faults += unknown_parameters(given, branches)
    if faults:
        raise ConfigError(f'{path}: {"; ".join(faults)}')
    if calibration := given.get('calibration'):
        given['calibration'] = str(path.parent / calibration)
    return {name: given.get(name, default) for name, (_, default) in known.items()}


def as_file(parameters: Mapping[str, Any]) -> str:
    """Write a parameter file for every node, from which `load` reads the same parameters."""
    return yaml.safe_dump({'/**': {'ros__parameters': dict(parameters)}}, sort_keys=False)


def _faults(given: Mapping[str, Any], known: Mapping[str, tuple[Parameter, Any]]) -> list[str]:
    checked = (
        parameter.fault(name, given[name], default)
        for name, (parameter, default) in known.items()
        if name in given
    )
    return [fault for fault in checked if fault]
