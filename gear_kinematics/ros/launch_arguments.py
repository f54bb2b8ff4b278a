"""Arguments of the node, from those of the launch files."""

import posixpath
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

from gear_kinematics.parameters import NODE, NodeParameters


class NodeArguments(NamedTuple):
    """Arguments of the node gear_state_publisher."""

    config: Path
    """The parameter file."""
    parameters: NodeParameters
    """The parameters of the node, with the values that it will have."""


def node_arguments(configurations: Mapping[str, str]) -> NodeArguments:
    """Determine the arguments of the node before it is started.

    launch only warns of a missing parameter file, and with a file for other nodes the node has its
    default values: in both cases, the wrong actuator would be started.

    Args:
        configurations: of the launch: `config`, `namespace` and `frame_prefix`, and
            `ros_namespace` if the launch file is included below a namespace.

    Raises:
        ConfigError: as `NodeParameters.load` does.
    """
    config = Path(configurations['config']).expanduser()
    # An absolute namespace replaces the one above it, as in launch_ros.
    name = posixpath.join(
        '/', configurations.get('ros_namespace', ''), configurations['namespace'], NODE
    )
    loaded = NodeParameters.load(config, name)
    if prefix := configurations['frame_prefix']:
        loaded = replace(loaded, frame_prefix=prefix)
    return NodeArguments(config, loaded)
