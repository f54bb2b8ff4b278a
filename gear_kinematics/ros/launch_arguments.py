"""What the arguments of the launch files say of the node that they start."""

import posixpath
from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

from gear_kinematics.state import parameters


class NodeArguments(NamedTuple):
    """What the node gear_state_publisher is started with."""

    config: Path
    """The parameter file."""
    parameters: dict[str, Any]
    """The node's own, with the values that it will have."""


def node_arguments(configurations: Mapping[str, str]) -> NodeArguments:
    """What a launch starts the node with, read before it starts.

    launch only warns of a parameter file that is not there, and a file that has nothing for the
    node leaves it with the default values: both would start another actuator than was asked for.

    Args:
        configurations: of the launch; its arguments `config`, `namespace` and `frame_prefix`, and
            `ros_namespace` where the launch file is included below a namespace.

    Raises:
        parameters.ConfigError: as `parameters.load` does.
    """
    config = Path(configurations['config']).expanduser()
    # An absolute namespace takes the place of the one above it, as it does in launch_ros.
    name = posixpath.join(
        '/', configurations.get('ros_namespace', ''), configurations['namespace'], parameters.NODE
    )
    loaded = parameters.load(config, name)
    if prefix := configurations['frame_prefix']:
        loaded['frame_prefix'] = prefix
    return NodeArguments(config, loaded)
