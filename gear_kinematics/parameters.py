"""The parameters of the node and of `gearkin --config`: meaning, bounds and default values.

The default values stand in config/actuator.yaml and nowhere else.
"""

import math
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import yaml

from gear_kinematics.kinematics import Branch
from gear_kinematics.share import share_directory

_NODE_NAMES = ('gear_state_publisher', '*', '**')
_EVERY_NODE = ('use_sim_time', 'start_type_description_service')
"""Parameters that every node has, which mean nothing here."""


class ConfigError(ValueError):
    """A parameter file that cannot be used; the text names the file and the cause."""


@dataclass(frozen=True, slots=True)
class Parameter:
    """What a parameter means and which values it takes. Its type is that of its default."""

    description: str
    minimum: float | None = None
    maximum: float | None = None
    step: int = 0
    choices: tuple[str, ...] = ()
    read_only: bool = False

    def fault(self, name: str, value: object, default: object) -> str | None:
        """Say what is wrong with a value, or None."""
        if type(value) is not type(default):
            return f'{name} must be of type {type(default).__name__}, not {value!r}'
        if isinstance(value, list) and not all(isinstance(item, str) for item in value):
            return f'{name} must be a list of strings, not {value!r}'
        if self.choices and value not in self.choices:
            return f'{name} must be one of {", ".join(self.choices)}, not {value!r}'
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
        return None


PARAMETERS: Mapping[str, Parameter] = {
    'ring_teeth': Parameter('Teeth of the ring gears, zk', 2, 100_000, read_only=True),
    'satellite_teeth': Parameter('Teeth of the satellites, zs', 1, 99_999, read_only=True),
    'eccentricity': Parameter('Eccentricity of the cams, m', 1e-6, 1.0, read_only=True),
    'module': Parameter('Module of the teeth, m; no kinematics', 1e-6, 0.1, read_only=True),
    'branches': Parameter('Names of the branches of transmission', read_only=True),
    'rotor_joint': Parameter("Joint to look up in rotor_state; '' takes the only one"),
    'rotor_direction': Parameter('1, or -1 where the encoder counts backwards', -1, 1, step=2),
    'rotor_zero': Parameter('Encoder position at rotor angle 0, rad', -1e15, 1e15),
    'rotor_encoder': Parameter(
        'Whether the position wraps once a turn', choices=('multi_turn', 'single_turn')
    ),
    'max_rotor_speed': Parameter('Fastest that the rotor turns, rad/s', 1e-3, 1e6),
    'max_rotor_acceleration': Parameter(
        'Fastest that the rotor changes its speed, rad/s²; with the velocities of the messages '
        'it bounds what a single-turn encoder can have turned in a gap',
        1e-3,
        1e9,
    ),
    'input_timeout': Parameter('Silence after which diagnostics say ERROR, s', 1e-3, 1e6),
    'output_joint': Parameter('Name of the output shaft in output_state and the URDF'),
    'output_encoder_joint': Parameter("Joint to look up in output_encoder; '' takes the only one"),
    'output_encoder_direction': Parameter(
        '1, or -1 where the encoder at the output counts backwards', -1, 1, step=2
    ),
    'output_encoder_zero': Parameter(
        "Position of the output's encoder at output angle 0, rad", -1e15, 1e15
    ),
    'transmission_error_window': Parameter(
        'The last while, of which diagnostics give the transmission error, s', 0.1, 60.0
    ),
    'transmission_error_limit': Parameter(
        'Transmission error, peak to peak, above which diagnostics say WARN, rad', 1e-9, 10.0
    ),
    'transmission_error_max_gap': Parameter(
        'Time between rotor states, beyond which nothing is interpolated, s', 1e-6, 10.0
    ),
    'transmission_error_travel': Parameter(
        'How far the output moves after a reversal until its direction counts, rad', 1e-9, 10.0
    ),
    'home_angle': Parameter('Output angle that ~/home declares, rad', -1e9, 1e9),
    'frame_prefix': Parameter('Put before every frame id and joint name'),
    'markers_rate': Parameter('Highest rate of markers, Hz; 0: none', 0.0, 1000.0, read_only=True),
    'executor': Parameter(
        'rclpy executor; auto: events where this ROS has it',
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
    return _read(default_config())


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


def load(path: Path) -> dict[str, Any]:
    """Read a parameter file as the node would; what it leaves out has its default value.

    Raises:
        ConfigError: if it cannot be read, or naming every value that is refused.
    """
    given = _read(path)
    known = {name: (parameter, defaults()[name]) for name, parameter in PARAMETERS.items()}
    faults = _faults(given, known)
    branches = given.get('branches', known['branches'][1])
    if not faults:
        of_branches = branch_parameters(branches)
        faults += _faults(given, of_branches)
        known |= of_branches
        faults += [f'{name} is no parameter' for name in given if name not in known]
    if faults:
        raise ConfigError(f'{path}: {"; ".join(faults)}')
    return {name: given.get(name, default) for name, (_, default) in known.items()}


def _faults(given: Mapping[str, Any], known: Mapping[str, tuple[Parameter, Any]]) -> list[str]:
    checked = (
        parameter.fault(name, given[name], default)
        for name, (parameter, default) in known.items()
        if name in given
    )
    return [fault for fault in checked if fault]


def _read(path: Path) -> dict[str, Any]:
    """The ros__parameters that the file has for the node, flattened to dotted names."""
    try:
        document = yaml.load(path.read_text(encoding='utf-8'), _RosLoader)  # noqa: S506, it is safe
    except OSError as error:
        raise ConfigError(f'{path}: {error.strerror}') from error
    except UnicodeDecodeError as error:
        raise ConfigError(f'{path}: {error}') from error
    except (yaml.YAMLError, ValueError, RecursionError) as error:
        raise ConfigError(f'{path}: not YAML: {" ".join(str(error).split())}') from error
    found = _parameters_of_node(document)
    if not found:
        raise ConfigError(f'{path}: no ros__parameters of gear_state_publisher in it')
    return {
        name: value
        for name, value in found.items()
        if name not in _EVERY_NODE and not name.startswith('qos_overrides.')
    }


class _RosLoader(yaml.SafeLoader):
    """Reads as ROS does: 15e-4 is a number, and aliases, which could go on and on, are refused."""

    def compose_node(self, parent: yaml.Node | None, index: int) -> yaml.Node | None:
        """Compose the next node."""
        if self.check_event(yaml.AliasEvent):
            problem = 'aliases are not supported'
            raise yaml.composer.ComposerError(None, None, problem, self.get_mark())
        return super().compose_node(parent, index)


_RosLoader.add_implicit_resolver(
    'tag:yaml.org,2002:float',
    re.compile(r'[-+]?([0-9]+\.?[0-9]*|\.[0-9]+)[eE][-+]?[0-9]+$'),
    list('-+.0123456789'),
)


def _parameters_of_node(tree: Any, name: str = '') -> dict[str, Any]:
    """Those below the node's name or a wildcard, in whatever namespace."""
    found: dict[str, Any] = {}
    for key, value in tree.items() if isinstance(tree, dict) else ():
        if key == 'ros__parameters':
            if isinstance(value, dict) and name.rpartition('/')[2] in _NODE_NAMES:
                found |= _flatten(value)
        else:
            found |= _parameters_of_node(value, str(key))
    return found


def _flatten(tree: Mapping[Any, Any], prefix: str = '') -> dict[str, Any]:
    flat: dict[str, Any] = {}
    for key, value in tree.items():
        if isinstance(value, dict):
            flat |= _flatten(value, f'{prefix}{key}.')
        else:
            flat[f'{prefix}{key}'] = value
    return flat
