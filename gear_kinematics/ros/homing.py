# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The services that home, and the zeros that are kept in the home file."""

from collections.abc import Collection, Mapping, Sequence
from functools import partial
from pathlib import Path

from rclpy.node import Node
from rclpy.parameter import Parameter
from std_srvs.srv import Trigger

from gear_kinematics.parameters import NodeParameters
from gear_kinematics.parameters.arm import full_name, labelled
from gear_kinematics.parameters.files import ConfigError
from gear_kinematics.parameters.home_file import read_home, write_home
from gear_kinematics.ros.actuator import Actuator, RefusedError
from gear_kinematics.state.statuses import Condition


def restored(
    node: Node, path: Path, actuators: Mapping[str, NodeParameters]
) -> Mapping[str, float]:
    """Set the zeros of the home file, if any, and return them by actuator; raises ConfigError."""
    try:
        home = read_home(path, actuators, node.get_fully_qualified_name())
    except ConfigError as error:
        raise ConfigError(f'{error}; to start without it, delete it and home again') from error
    if not home:
        return {}
    zeros, homed = home
    named = {full_name(name, 'rotor_zero'): zero for name, zero in zeros.items()}
    node.set_parameters([Parameter(name, value=zero) for name, zero in named.items()])
    which = ', '.join(f'{name} {zero:.3f} rad' for name, zero in named.items())
    node.get_logger().info(f'{which} restored from {path}, homed {homed}')
    return zeros


class Homing:
    """Sets the zeros of a node on request, and keeps them."""

    def __init__(
        self,
        node: Node,
        path: Path | None,
        actuators: Mapping[str, Actuator],
        kept: Collection[str],
    ) -> None:
        """Open a service for each shaft of an arm, and one for all.

        `path` is that of the home file, if any, and `kept` names the shafts whose zeros it has.
        """
        self._node, self._path, self._actuators, self._set = node, path, actuators, set(kept)
        for name, actuator in actuators.items():
            known = Condition.ZERO_KEPT if name in kept else Condition.ZERO_NOT_SET
            zero_kept = known(path=path) if path else Condition.ZERO_IS_LOST()
            actuator.state.monitor.zero_kept = zero_kept
            if name:
                node.create_service(Trigger, f'~/{name}/home', partial(self._answer, [name]))
        self.answer = partial(self._answer, [*actuators])
        """Homes all shafts or none on a request, and fills in its response."""
        node.create_service(Trigger, '~/home', self.answer)

    def keep(self, names: Collection[str]) -> None:
        """Write the zeros that were set to the home file, after some were set."""
        self._set.update(names)
        if not self._path:
            return
        every = self._actuators.items()
        zeros = {name: each.state.parameters for name, each in every if name in self._set}
        try:
            write_home(self._path, zeros, self._node.get_fully_qualified_name())
            kept = Condition.ZERO_KEPT(path=self._path)
        except OSError as error:  # the zeros hold until the node ends
            kept = Condition.ZERO_NOT_KEPT(path=self._path, why=error.strerror)
        for name in zeros:
            self._actuators[name].state.monitor.zero_kept = kept

    def _answer(
        self, names: Sequence[str], _request: Trigger.Request, response: Trigger.Response
    ) -> Trigger.Response:
        response.success, response.message = self._home(names)
        return response

    def _home(self, names: Sequence[str]) -> tuple[bool, str]:
        """Home all of some shafts or none."""
        found, refused = {}, dict[str, dict[str, list[str]]]()  # names by remedy and fault
        for name in names:
            try:
                found[name] = self._actuators[name].home_zero()
            except RefusedError as error:
                refused.setdefault(error.remedy, {}).setdefault(error.fault, []).append(name)
        if refused:
            none = 'no shaft was homed: ' if len(names) > 1 else ''
            return False, none + '; '.join(
                ', '.join(labelled(', '.join(of), fault) for fault, of in faults.items()) + remedy
                for remedy, faults in refused.items()
            )
        actuators = [self._actuators[name] for name in names]
        angles = [each.rotor_angle for each in actuators]
        result = self._node.set_parameters_atomically(
            [Parameter(full_name(name, 'rotor_zero'), value=found[name][0]) for name in names]
        )
        if not result.successful:
            return False, result.reason
        texts = []
        for name, actuator, rotor_angle in zip(names, actuators, angles, strict=True):
            actuator.state.input.home(rotor_angle)
            zero, moved = found[name]
            kept = f'rotor_zero {zero:.3f} rad, {actuator.state.monitor.zero_kept}'
            texts.append(labelled(name, f'{moved} ({kept})'))
        homed = '; '.join(texts)
        self._node.get_logger().info(homed)
        return True, homed
