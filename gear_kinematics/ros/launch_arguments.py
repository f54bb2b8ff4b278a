# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Arguments of the node, from those of the launch files."""

import posixpath
import re
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

from gear_kinematics.parameters import NODE, ConfigError, NodeParameters
from gear_kinematics.parameters.arm import load_actuators

_OVERRIDES = 'frame_prefix', 'rotor_joint'  # replace those of the file, unless they are empty


class NodeArguments(NamedTuple):
    """Arguments of the node gear_state_publisher."""

    config: Path  # the parameter file
    actuators: dict[str, NodeParameters]  # parameters of its actuators, with their values
    given: dict[str, Any]  # those that replace values of the file


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
    loaded = load_actuators(config, name)
    given: dict[str, Any] = {
        name: configurations[name] for name in _OVERRIDES if configurations[name]
    }
    if given and '' not in loaded:
        names = ' and '.join(given)
        raise ConfigError(f'{config}: give {names} of an arm in the file, below its actuators')
    actuators = {name: replace(each, **given) for name, each in loaded.items()}
    return NodeArguments(config, actuators, given)


def reads_description_topic(share: Path) -> bool:
    """Return whether a robot_state_publisher has the parameter use_robot_description_topic.

    `share` is its share directory; its package.xml states the version.
    """
    manifest = (share / 'package.xml').read_text('utf-8')
    version = [
        int(number) for number in re.findall(r'<version>(.+)</version>', manifest)[0].split('.')
    ]
    return version >= [3, 5, 3] or [3, 4, 4] <= version < [3, 5]  # Lyrical, and Kilted
