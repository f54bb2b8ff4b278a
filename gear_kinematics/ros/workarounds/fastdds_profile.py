# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The profile of Fast DDS that the node uses unless there is another one.

By default, Fast DDS 2.14 and 3.2 wake up a thread for every message to every reliable subscriber.
"""

import os
from importlib.metadata import version
from pathlib import Path

from rclpy.utilities import get_rmw_implementation_identifier

from gear_kinematics.share import share_directory

_FASTDDS_2 = 'FASTRTPS', 'fastdds.xml'
_FASTDDS_3 = 'FASTDDS', 'fastdds3.xml'  # with the names of Fast DDS 2, it warns at every start
_FIRST_WITH_FASTDDS_3 = 9  # version of rclpy, that of Kilted
_SKIP = 'SKIP_DEFAULT_XML_FILE'


def use_profile() -> None:
    """Let Fast DDS use a profile of config/, unless somebody has chosen another profile.

    Fast DDS reads the environment when the first participant of a process is created. Without a
    file that is named there, it reads one in the current folder.
    """
    newer = int(version('rclpy').partition('.')[0]) >= _FIRST_WITH_FASTDDS_3
    name, profile = _FASTDDS_3 if newer else _FASTDDS_2
    variables = [f'{each}_DEFAULT_PROFILES_FILE' for each, _ in (_FASTDDS_2, _FASTDDS_3)]
    in_current_folder = Path(f'DEFAULT_{name}_PROFILES.xml')
    chosen = os.environ.keys() & variables or (
        os.environ.get(_SKIP) != '1' and in_current_folder.exists()
    )
    if not chosen and get_rmw_implementation_identifier().startswith('rmw_fastrtps'):
        os.environ[variables[newer]] = str(share_directory() / 'config' / profile)
