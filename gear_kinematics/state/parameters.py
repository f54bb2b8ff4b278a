"""The parameters of the node and of `gearkin --config`: meaning, bounds and default values.

The default values are in config/actuator.yaml alone.
"""

import math
import re
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

from gear_kinematics.kinematics import Branch, GearRatio
from gear_kinematics.state.share import share_directory
from gear_kinematics.state.yaml_file import Loader, read_yaml
from gear_kinematics.wire.nearest import nearest

NODE = 'gear_state_publisher'
"""The default name of the node."""

_EVERY_NODE = re.compile(r'use_sim_time|start_type_description_service|qos_overrides\..*')
"""Parameters that every node has and that are ignored here."""
_NODE_PATTERN = re.compile(r'(/(\*\*?|[A-Za-z_]\w*))+', re.ASCII)
"""A node's name in a parameter file, as in rcl; `*` is any token, `**` any number of tokens."""


class ConfigError(ValueError):
    """A parameter file that cannot be used; the text names the file and the cause."""


class _OtherNodesError(ConfigError):
    """A parameter file that has parameters, but none of the node."""


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
    'home_angle': Parameter('Output angle that ~/home sets, rad', -1e9, 1e9),
    'frame_prefix': Parameter('Prefix of every frame id and joint name'),
    'markers_rate': Parameter('Highest rate of markers, Hz; 0: none', 0.0, 1000.0, read_only=True),
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
    return _given(default_config(), NODE)


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
    """A fault for each name that is no parameter of a node with these branches."""
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
    return faults


def load(path: Path, node: str = NODE) -> dict[str, Any]:
    """Read a node's parameters from a file as the node would; missing ones have their defaults.

    Args:
        path: a parameter file of ROS: blocks of parameters below names of nodes.
        node: the node's fully qualified name. Without a namespace, it is the only node of that
            name in the file; if the file names none, the one that all its wildcards apply to.

    Raises:
        ConfigError: if it cannot be read, has nothing for the node, leaves open which node is
            meant, or naming every value and every name that is refused.
    """
    given = _given(path, node)
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
    return {name: given.get(name, default) for name, (_, default) in known.items()}


def require_any(paths: Collection[Path], node: str) -> None:
    """Check that parameter files have parameters, and at least one has some for the node.

    ROS silently ignores other files, and the node would run with its default values.

    Args:
        paths: parameter files of ROS, as many as the node is started with.
        node: the node's fully qualified name.

    Raises:
        ConfigError: if a file cannot be read or has no parameters, or none has any for the node.
    """
    useless = []
    for path in paths:
        try:
            _given(path, node)
        except _OtherNodesError as error:
            useless.append(str(error))
    if useless and len(useless) == len(paths):
        raise ConfigError('; '.join(useless))


def _faults(given: Mapping[str, Any], known: Mapping[str, tuple[Parameter, Any]]) -> list[str]:
    checked = (
        parameter.fault(name, given[name], default)
        for name, (parameter, default) in known.items()
        if name in given
    )
    return [fault for fault in checked if fault]


def _given(path: Path, node: str) -> dict[str, Any]:
    """The parameters that a file has for a node, by dotted names.

    All blocks that apply to the node count, in the order in which they begin: a later value of a
    parameter replaces an earlier one, whether its block has a wildcard or not.
    """
    blocks = _read(path)
    if not blocks:
        raise ConfigError(f'{path}: no ros__parameters in it')
    name = f'/{node.lstrip("/")}' if '/' in node else _full_name(path, node, blocks)
    applying = [parameters for pattern, parameters in blocks if _applies(pattern, name)]
    if not applying:
        there = ', '.join(pattern for pattern, _ in blocks)
        raise _OtherNodesError(f'{path}: no parameters of {name} in it, only of {there}')
    given: dict[str, Any] = {}
    for parameters in applying:
        given |= parameters
    return given


def _full_name(path: Path, node: str, blocks: Iterable[tuple[str, object]]) -> str:
    """The fully qualified name of the node of this name in a file."""
    patterns = [
        pattern for pattern, _ in blocks if pattern.rpartition('/')[2] in {node, '*', '**'}
    ]
    # A node that is named takes precedence over wildcards.
    patterns = [pattern for pattern in patterns if '*' not in pattern] or patterns
    for pattern in patterns:
        # A namespace that matches the pattern, with an arbitrary token for `*`.
        namespace = pattern.rpartition('/')[0].replace('/**', '').replace('/*', '/_')
        name = f'{namespace}/{node}'
        if all(_applies(other, name) for other in patterns):
            return name
    if len(patterns) > 1:
        raise ConfigError(
            f'{path}: parameters of more than one node: {", ".join(patterns)}; '
            'choose one with --node'
        )
    return f'/{node}'


def _applies(pattern: str, name: str) -> bool:
    """Whether a block of a parameter file is for a node, as rclpy and rclcpp see it."""
    return re.fullmatch(pattern.replace('/*', r'(/\w+)'), name, re.ASCII) is not None


def _read(path: Path) -> list[tuple[str, dict[str, Any]]]:
    """The blocks of a parameter file: names of nodes, and parameters by dotted names."""
    document = read_yaml(path, ConfigError, _RosLoader)
    blocks: dict[str, dict[str, Any]] = {}
    for name, parameters in _blocks(document):
        blocks.setdefault(name, {}).update(parameters)
    # `node` and `/node` mean the same to rcl, but are two blocks.
    found = [(f'/{name.removeprefix("/")}', parameters) for name, parameters in blocks.items()]
    for name, _ in found:
        if not _NODE_PATTERN.fullmatch(name):
            raise ConfigError(f'{path}: {name} is not a valid node name')
    return found


class _Pairs(tuple[tuple[Any, Any], ...]):
    """A mapping with possibly repeated keys, which ROS merges."""

    __slots__ = ()


class _RosLoader(Loader):
    """Keeps repeated keys, which ROS merges."""


_RosLoader.add_constructor(
    'tag:yaml.org,2002:map',
    lambda loader, node: _Pairs(loader.construct_pairs(node, deep=True)),
)


def _blocks(tree: Any, name: str = '') -> Iterator[tuple[str, dict[str, Any]]]:
    for key, value in tree if isinstance(tree, _Pairs) else ():
        if key != 'ros__parameters':
            yield from _blocks(value, f'{name}/{key}' if name.strip('/') else f'{name}{key}')
        elif isinstance(value, _Pairs):
            yield name, _flatten(value)


def _flatten(tree: _Pairs, prefix: str = '') -> dict[str, Any]:
    flat: dict[str, Any] = {}
    for key, value in tree:
        if isinstance(value, _Pairs):
            flat |= _flatten(value, f'{prefix}{key}.')
        else:
            flat[f'{prefix}{key}'] = value
    return flat
