# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Arguments of the node, from those of the launch files."""

import posixpath
import sys
from collections.abc import Iterable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

from gear_kinematics.parameters import NODE, NodeParameters
from gear_kinematics.wire.nearest import among
from gear_kinematics.wire.topics import ROTOR_STATE

NODE_ARGUMENTS = 'config', 'namespace', 'frame_prefix', 'rotor_joint', ROTOR_STATE
"""Names of the launch arguments of gear_state_publisher.launch.py."""
_OVERRIDES = 'frame_prefix', 'rotor_joint'  # replace those of the file, unless they are empty
_OF_LAUNCH = (
    'launch-prefix', 'launch-prefix-filter', 'emulate_tty', 'sigterm_timeout', 'sigkill_timeout'
)  # fmt: skip


class NodeArguments(NamedTuple):
    """Arguments of the node gear_state_publisher."""

    config: Path
    """The parameter file."""
    parameters: NodeParameters
    """The parameters of the node, with the values that it will have."""
    given: dict[str, Any]
    """Those that replace values of the file."""


def node_arguments(configurations: Mapping[str, str]) -> NodeArguments:
    """Determine the arguments of the node from the configurations of a launch; raises ConfigError.

    launch only warns of a missing parameter file, and with a file for other nodes the node has its
    default values: in both cases, the wrong actuator would be started.
    """
    config = Path(configurations['config']).expanduser()
    # An absolute namespace replaces the one above it, as in launch_ros.
    name = posixpath.join(
        '/', configurations.get('ros_namespace', ''), configurations['namespace'], NODE
    )
    loaded = NodeParameters.load(config, name)
    given: dict[str, Any] = {
        name: configurations[name] for name in _OVERRIDES if configurations[name]
    }
    return NodeArguments(config, replace(loaded, **given), given)


def refuse_unknown(file: str, context_arguments: Iterable[str], *known: str) -> None:
    """Refuse arguments that neither `NODE_ARGUMENTS` nor a launch file itself knows.

    launch ignores those that nobody declares. Those on the command line, `name:=value`, are of the
    file that is launched, not of one that it includes.
    """
    if Path(file).name not in {Path(word).name for word in sys.argv}:
        return
    there = *NODE_ARGUMENTS, *known
    for name in (argument.partition(':=')[0] for argument in context_arguments):
        if name not in {*there, *_OF_LAUNCH}:
            raise ValueError(f'unknown launch argument `{name}`{among(name, there)}')
