# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The parameters of the node and of `gearkin --config`: types, meanings and bounds.

The default values are in config/actuator.yaml alone.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cache
from operator import attrgetter
from pathlib import Path
from types import MappingProxyType
from typing import Any, Self

from gear_kinematics.kinematics import Branch, Gear, GearRatio, Mechanism, MechanismError
from gear_kinematics.kinematics.loads import Bodies, TorqueSharing
from gear_kinematics.kinematics.preload import Preload, Stiffness
from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.parameters import checks, meshes
from gear_kinematics.parameters.body_parameters import BRANCH_PARAMETERS, LOADS_PARAMETERS
from gear_kinematics.parameters.files import ConfigError, default_values
from gear_kinematics.parameters.parameter import Parameter, declared_in, parameter
from gear_kinematics.share import share_directory
from gear_kinematics.wire.cdr import SECOND

NODE = 'gear_state_publisher'  #: the default name of the node


@dataclass(frozen=True, slots=True, kw_only=True)
class NodeParameters:
    """The parameters of the node, under their names in ROS; `dataclasses.replace` changes some.

    In ROS, `branches` has the names of the branches, and their values have names such as
    `a.cam_phase`. Values in the bounds can still describe no mechanism: see `gear`.
    """

    actuator: str = ''  #: which of `actuators` it is; '' without
    ring_teeth: int = parameter('Teeth of the ring gears, zk', 2, 100_000, read_only=True)
    satellite_teeth: int = parameter('Teeth of the satellites, zs', 1, 99_999, read_only=True)
    eccentricity: float = parameter('Eccentricity of the cams, m', 1e-6, 1.0, read_only=True)
    module: float = parameter('Module of the teeth, m; for their shape', 1e-6, 0.1, read_only=True)
    branches: tuple[Branch, ...] = parameter(
        'Names of the branches', read_only=True, check=checks.names
    )
    gear_ratio: str = parameter(
        "Exact ratio of a gear of another kind, such as '-19' or '1457/26'; '': from the teeth",
        read_only=True,
        check=lambda text: text and GearRatio.parse(text),
    )
    rotor_joint: str = parameter(
        "Joint to look up in rotor_state, or its index if joints have no names; '' takes the "
        'only joint'
    )
    rotor_direction: int = parameter('1, or -1 if the encoder counts backwards', -1, 1, step=2)
    rotor_zero: float = parameter('Encoder position at rotor angle 0, rad', -1e15, 1e15)
    rotor_encoder: str = parameter(
        'Whether the position wraps once a turn', choices=('multi_turn', 'single_turn')
    )
    rotor_encoder_range: float = parameter(
        'Angle after which the position repeats, rad, such as 25.0 for ±12.5 rad; 0: never, or '
        'one turn with single_turn',
        0.0,
        1e9,
        check=checks.encoder_range,
    )
    rotor_effort_factor: float = parameter(
        'Torque of the rotor per unit of the effort in the messages, N·m; not 0',
        *(-1e9, 1e9),
        check=checks.factor,
    )
    max_rotor_speed: float = parameter('Greatest speed of the rotor, rad/s', 1e-3, 1e6)
    max_rotor_acceleration: float = parameter(
        'Greatest acceleration of the rotor, rad/s²; with the velocities of the messages, it '
        'bounds the turn of a single-turn encoder in a gap',
        1e-3,
        1e9,
    )
    unreferenced_outputs: str = parameter(
        "Whether outputs are published while the rotor's turns are not known",
        choices=('publish', 'withhold'),
    )
    input_timeout: float = parameter(
        'Time without input after which diagnostics report ERROR, s', 1e-3, 1e6
    )
    output_joint: str = parameter('Name of the output shaft in output_state and the URDF')
    output_range: tuple[float, ...] = parameter(
        'Least and greatest angle of the output, rad, less than a turn apart: they tell its turn '
        'where the encoder at the output leaves it open; empty: unknown',
        read_only=True,
        items=float,
        check=checks.output_range,
    )
    output_encoder_joint: str = parameter(
        "Joint to look up in output_encoder, or its index if joints have no names; '' takes the "
        'only joint'
    )
    output_encoder_direction: int = parameter(
        '1, or -1 if the encoder at the output counts backwards', -1, 1, step=2
    )
    output_encoder_zero: float = parameter(
        "Position of the output's encoder at output angle 0, rad", -1e15, 1e15
    )
    output_encoder_reference: str = parameter(
        "absolute: the encoder at the output finds the rotor's turns; none: it does not",
        choices=('none', 'absolute'),
    )
    transmission_error_window: float = parameter(
        'Sliding window of the transmission error in diagnostics, s', 0.1, 60.0
    )
    transmission_error_limit: float = parameter(
        'Peak-to-peak transmission error above which diagnostics report WARN, rad', 1e-9, 10.0
    )
    transmission_error_max_gap: float = parameter(
        'Gap between rotor states beyond which nothing is interpolated, s', 1e-6, 10.0
    )
    transmission_error_travel: float = parameter(
        'Travel of the output after a reversal until its direction counts, rad', 1e-9, 10.0
    )
    calibration: str = parameter(
        "Path of a calibration file, from which corrected_state is computed; '' takes none"
    )
    home_angle: float = parameter('Output angle that ~/home sets, rad', -1e9, 1e9)
    home_max_speed: float = parameter(
        'Speed of the output above which ~/home is refused, rad/s', 0.0, 1e6
    )
    home_file: str = parameter(
        'Path of the file that keeps rotor_zero when ~/home or a change sets it, and from which '
        "it is restored at the start; '': none",
        read_only=True,
    )
    preload: float = parameter(
        'Torque T0 by which two branches are braced against each other, N·m at the output; '
        'negative if branch A pushes the output in the negative direction; 0: unknown',
        *(-1e6, 1e6),
        read_only=True,
        least=1e-6,
    )
    branch_stiffness: tuple[float, ...] = parameter(
        'Torsional stiffness of the branches, of both or of each, N·m/rad at the output; 0: rigid',
        read_only=True,
        items=float,
        least=1e-3,
        check=checks.stiffness,
    )
    shaft_stiffness: float = parameter(
        'Stiffness between both arms, N·m/rad; 0: rigid', 0.0, 1e12, read_only=True, least=1e-3
    )
    loads: Bodies  #: in ROS, each of its values is a parameter, such as `loads.rotor_inertia`
    frame_prefix: str = parameter('Prefix of every frame id and joint name')
    markers_rate: float = parameter(
        'Highest rate of markers, Hz; 0: none', 0.0, 1000.0, read_only=True
    )
    meshes: str = parameter(
        'URI of the folder with the meshes of the URDF; auto: the installed ones, if they are of '
        'this mechanism; none: simple shapes',
        read_only=True,
        check=meshes.check,
    )
    executor: str = parameter(
        'rclpy executor; auto: events if this ROS has it',
        choices=('auto', 'events', 'single_threaded'),
        read_only=True,
    )

    actuators: tuple[str, ...] = parameter(
        'Names of the actuators of an arm; empty: one gear', read_only=True, check=checks.names
    )

    @staticmethod
    def load(
        path: Path | None = None,
        node: str = NODE,
        others: Mapping[str, Parameter] = MappingProxyType({}),
        actuator: str = '',
    ) -> 'NodeParameters':
        """Read a node's parameters from a file of ROS as the node would; others have defaults.

        Without a namespace, the node is the only one of its name in the file. It may have `others`
        besides, which are checked. `actuator` selects one of an arm. Raises ConfigError as
        `load_actuators` does, and if it is open which actuator is meant.
        """
        from gear_kinematics.parameters import arm  # noqa: PLC0415, it imports this module

        found = arm.chosen(arm.load_actuators(path, node, others), actuator)
        if len(found) > 1:
            several = f'parameters of more than one actuator: {", ".join(found)}'
            raise ConfigError(f'{path}: {several}; choose one with --actuator')
        return next(iter(found.values()))

    @classmethod
    def of(cls, values: Mapping[str, Any], actuator: str = '') -> Self:
        """Create parameters from valid values by names in ROS; the others have their defaults."""

        def value(name: str) -> Any:
            return values[name] if name in values else default_value(name)

        given = {name: value(name) for name in PARAMETERS if name not in LOADS_PARAMETERS}
        loads = {name.removeprefix('loads.'): value(name) for name in LOADS_PARAMETERS}
        given |= {'loads': Bodies(**loads)} | {name: tuple(given[name]) for name in _LISTS}
        given['branches'] = tuple(
            Branch(name, value(f'{name}.cam_phase'), value(f'{name}.axial_position'))
            for name in given['branches']
        )
        return cls(actuator=actuator, **given)

    def values(self) -> dict[str, Any]:
        """Return the values by their names in ROS, without that of the actuator."""
        values = {name: attrgetter(name)(self) for name in PARAMETERS}
        values['branches'] = [branch.name for branch in self.branches]
        values |= {name: [*values[name]] for name in _LISTS}
        for branch in self.branches:
            values |= {f'{branch.name}.{key}': getattr(branch, key) for key in BRANCH_PARAMETERS}
        return values

    def only_zero_differs(self, other: Self) -> bool:
        """Return whether at most `rotor_zero` differs, as after homing."""
        return replace(self, rotor_zero=other.rotor_zero) == other

    def as_file(self) -> str:
        """Write a parameter file for every node, from which `load` reads the same parameters."""
        from gear_kinematics.parameters import arm  # noqa: PLC0415

        return arm.as_file([self])

    @property
    def output_name(self) -> str:
        """Name of the output shaft's joint in messages and in the URDF.

        The default prefix of an actuator of an arm, `<actuator>_`, is not put before the name.
        """
        default = self.actuator and self.frame_prefix == f'{self.actuator}_'
        return self.output_joint if default else self.frame_prefix + self.output_joint

    @property
    def distinct_encoder_joint(self) -> str:
        """Joint of the encoder at the output; '' if messages of the node itself have that name."""
        joint = self.output_encoder_joint
        return '' if joint == self.output_name else joint

    @property
    def joint_names(self) -> list[str]:
        """Names of all joints in messages and in the URDF, of which `output_name` is the last.

        Raises ValueError if there is no such gear, or a name is refused.
        """
        from gear_kinematics.shape.urdf import joint_names  # noqa: PLC0415, of few programs

        prefix = self.frame_prefix
        return joint_names(self.gear, output_joint=self.output_name, frame_prefix=prefix)

    @property
    def gear(self) -> Gear:
        """The mechanism, or the ratio that is given; raises MechanismError without either."""
        return GearRatio.parse(self.gear_ratio) if self.gear_ratio else self.mechanism

    @property
    def mechanism(self) -> Mechanism:
        """The mechanism; MechanismError if there is none, or `gear_ratio` is of another gear."""
        if self.gear_ratio:
            known = f'gear_ratio is {self.gear_ratio}: only the ratio of this gear is known'
            raise MechanismError([f'{known}, not its bodies'])
        return Mechanism(self.ring_teeth, self.satellite_teeth, self.eccentricity, self.branches)

    @property
    def sharing(self) -> TorqueSharing:
        """How the branches share the torque of the output: equally if `preload` is 0.

        Raises MechanismError without a mechanism, or if a preload lacks two branches or stiffness.
        """
        mechanism, preload = self.mechanism, None
        if self.preload:
            if not (any(self.branch_stiffness) or self.shaft_stiffness):
                needed = 'a preload needs branch_stiffness or shaft_stiffness, N·m/rad'
                raise MechanismError([needed])
            given = *(self.branch_stiffness * 2)[:2], self.shaft_stiffness
            stiffness = Stiffness(*(each or math.inf for each in given))
            preload = Preload.from_torque(stiffness, abs(self.preload))
        return TorqueSharing(mechanism, preload, -1 if self.preload < 0.0 else 1)

    def urdf(self) -> str:
        """Write the URDF; raises ValueError without a mechanism, or if a name is refused."""
        from gear_kinematics.shape.urdf import urdf  # noqa: PLC0415, of few programs

        mechanism, module = self.mechanism, self.module
        return urdf(
            mechanism,
            module=module,
            output_joint=self.output_name,
            frame_prefix=self.frame_prefix,
            meshes=meshes.folder_uri(self.meshes, mechanism, module),
        )

    @property
    def single_turn(self) -> bool:
        """Whether the position of the rotor wraps once a turn."""
        return self.rotor_period == TURN

    @property
    def rotor_period(self) -> float:
        """The angle after which the position of the rotor repeats, rad; 0: never."""
        return self.rotor_encoder_range or TURN * (self.rotor_encoder == 'single_turn')

    @property
    def rotor_limits(self) -> tuple[float, float]:
        """Greatest speed, rad/s, and acceleration, rad/s², of the rotor."""
        return self.max_rotor_speed, self.max_rotor_acceleration

    @property
    def longest_delay_ns(self) -> int:
        """The gap beyond which nothing is interpolated, which bounds the encoders' delay, ns."""
        return round(self.transmission_error_max_gap * SECOND)

    @property
    def absolute(self) -> bool:
        """Whether the encoder at the output finds the turns of the rotor."""
        return self.output_encoder_reference == 'absolute'

    @property
    def longest_silence(self) -> float:
        """Silence after which the driver may have restarted, s, as in diagnostics; 0: never."""
        return self.input_timeout if self.absolute else 0.0


PARAMETERS: Mapping[str, Parameter] = declared_in(NodeParameters) | LOADS_PARAMETERS
"""All parameters but those of the branches, by name."""
_LISTS = [name for name, each in PARAMETERS.items() if each.kind is list and name != 'branches']


@cache
def default_config() -> Path:
    """Return the installed config/actuator.yaml."""
    return share_directory() / 'config' / 'actuator.yaml'


def default_value(name: str) -> Any:
    """Return a parameter's default, from config/actuator.yaml; 0 for a branch that it lacks."""
    return default_values(default_config(), NODE).get(name, 0.0)
