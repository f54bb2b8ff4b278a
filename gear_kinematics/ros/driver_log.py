# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The log of the rotor's driver: that it is missing, has stopped, has returned, or is another."""

import math
from collections import Counter, defaultdict
from collections.abc import Callable, Collection, Mapping

from rclpy.node import Node

from gear_kinematics.kinematics import RotorSample
from gear_kinematics.parameters.arm import labelled
from gear_kinematics.ros.graph import Graph
from gear_kinematics.state.rotor_input import RotorInput
from gear_kinematics.state.statuses import Condition, Fact
from gear_kinematics.wire.nearest import among, listed
from gear_kinematics.wire.topics import ROTOR_STATE

_ELSEWHERE = 0.1  # rad, of a rotor that was turned by hand, or counted from another zero
_SEARCH = 3  # s, in which all publishers are found: they announce themselves as often
_HOME = 'home it (gearkin home or ~/home)'
_RESTARTED = f'check whether the drive restarted; then {_HOME}'
_ANOTHER = f'if both run, stop one; if the drive restarted, {_HOME}'


class DriverLog:
    """Logs each change of the driver once."""

    def __init__(
        self,
        node: Node,
        inputs: Mapping[str, RotorInput],
        joints: Callable[[], Collection[str]] = list,
    ) -> None:
        """Take the node that hears the rotors, the inputs by actuator, and the joints it hears."""
        self._joints = joints
        self._own, self._lacking = Counter[str](), Counter[str]()
        """Messages with the joint of each actuator, and the updates since there was none."""
        self._log, self._node, self._inputs = node.get_logger(), node, inputs
        self._topic = node.resolve_topic_name(ROTOR_STATE)
        self._missing = 0  # updates since there was a publisher
        self._said = self._faults()
        self._silent = False  # whether it was logged that the driver is missing or silent
        self._before: dict[str, RotorSample | None] = {}
        """The last samples, if any, of actuators that were silent or have another driver."""
        self._replaced = set[str]()  # those of them that were not silent

    def replaced(self, name: str, last: RotorSample | None) -> None:
        """Compare the next position of an actuator, whose driver is another, with the last."""
        if last and name not in self._before:
            self._before[name] = last
            self._replaced.add(name)

    @property
    def awaited(self) -> bool:
        """Whether an actuator was silent or has another driver, so that `heard` is wanted."""
        return self._silent or bool(self._before)

    def _warn_of_missing(self) -> None:
        """Warn once of each joint of an arm that has been missing for too long beside others."""
        # Joints by actuators, by how they are missing and what is there.
        lacking = defaultdict[tuple[str, str], dict[str, str]](dict)
        for name, each in self._inputs.items():
            own, before = each.received - each.of_others, self._own[name]
            lacks = name and each.of_others and own == before
            self._own[name], self._lacking[name] = own, self._lacking[name] + 1 if lacks else 0
            if self._lacking[name] == max(2, math.ceil(each.parameters.input_timeout)):
                joint, there = each.parameters.rotor_joint, self._joints()
                stopped = 'no more messages of', '; other joints are still heard'
                how = stopped if joint in there else ('no joint', among(joint, there))
                lacking[how][name] = repr(joint)
                self._before[name] = each.last
        for (what, hint), joints in lacking.items():
            text = f'{what} {", ".join(joints.values())} on {self._topic}{hint}'
            self._log.warning(labelled(', '.join(joints), text))

    def _faults(self) -> dict[tuple[str, Condition, float], Fact]:
        """Return how turns were lost, what is wrong or beyond limits, by what identifies each."""
        return {
            (name, fact.condition, fact.values.get('time', 0.0)): fact
            for name, each in self._inputs.items()
            for fact in (
                each.why_lost,
                each.velocity_field.meaning,
                each.plausibility.beyond_limits,
            )
            if fact
        }

    def update(self, publishers: int, silence: float, several: Collection[str] = ()) -> None:
        """Take, once a second, the number of publishers and the time since the last message, s.

        `several` drivers send the joints of some actuators, or of some encoders at the output.
        """
        faults, said = self._faults(), self._said
        mixed = Condition.SEVERAL_DRIVERS()
        faults |= {(name, mixed.condition, 0.0): mixed for name in several}
        names = defaultdict[str, list[str]](list)  # of actuators, by what is new of them
        for key, fact in faults.items():
            if key not in said:
                names[f'{fact}. {fact.advice}'].append(key[0])
        for text, of in names.items():
            self._log.warning(labelled(', '.join(of), text))
        self._said = faults | {key: fact for key, fact in said.items() if not key[2]}
        self._missing = 0 if publishers else self._missing + 1
        if self._silent:
            return
        last = {name: each.last for name, each in self._inputs.items() if each.last}
        timeouts = (each.parameters.input_timeout for each in self._inputs.values())
        if last and silence > max(timeouts):
            self._log.warning(f'{self._topic} has stopped: no input for {silence:.1f} s')
            self._silent = True
            self._before |= last
        elif not last and self._missing > _SEARCH and (others := Graph(self._node).drivers()):
            self._log.warning(
                f'{self._topic} has no publisher; there are: {listed(others)}; choose one with '
                f'-r {ROTOR_STATE}:=<topic>, or with ros2 launch {ROTOR_STATE}:=<topic>'
            )
            self._silent = True
        else:
            self._warn_of_missing()

    def heard(self, samples: Mapping[str, RotorSample]) -> Mapping[str, float]:
        """Take samples by actuator while some are awaited; their first are compared.

        Returns how far rotors are from where they were, rad, if that is far.
        """
        silent, self._silent = self._silent, False
        returned = [name for name in samples if name in self._before]
        elsewhere = dict[str, float]()
        for name, sample in samples.items():
            before = self._before.pop(name, None) or sample
            moved = sample.position.since(before.position)
            if abs(moved) > _ELSEWHERE:
                elsewhere[name] = moved
        if elsewhere:
            self._said |= self._faults()
            turned = 'the rotor is {:.0f}° from where it was'
            at = '; '.join(
                labelled(n, turned.format(math.degrees(a))) for n, a in elsewhere.items()
            )
            how, advice = 'is heard again', _RESTARTED
            if self._replaced & elsewhere.keys():
                how, advice = 'comes from another driver', _ANOTHER
            self._log.warning(f'{self._topic} {how}, but {at}: {advice}')
        elif silent or returned:
            which = '' if silent else ', '.join(returned)
            self._log.info(labelled(which, f'{self._topic} is heard now'))
        self._replaced -= samples.keys()
        return elsewhere
