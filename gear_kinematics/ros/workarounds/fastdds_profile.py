# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The profile of Fast DDS that the node uses unless there is another one.

By default, Fast DDS 2.14 wakes up a thread for every message to every reliable subscriber.
"""

import os
from pathlib import Path

from rclpy.utilities import get_rmw_implementation_identifier

from gear_kinematics.share import share_directory

_FILE = 'FASTRTPS_DEFAULT_PROFILES_FILE'
_OTHER_FILE = 'FASTDDS_DEFAULT_PROFILES_FILE'  # of Fast DDS 3
_IN_CURRENT_FOLDER = 'DEFAULT_FASTRTPS_PROFILES.xml'
_SKIP = 'SKIP_DEFAULT_XML_FILE'


def use_profile() -> None:
    """Let Fast DDS use config/fastdds.xml, unless somebody has chosen another profile.

    Fast DDS reads the environment when the first participant of a process is created. Without a
    file that is named there, it reads one in the current folder.
    """
    chosen = {_FILE, _OTHER_FILE} & os.environ.keys() or (
        os.environ.get(_SKIP) != '1' and Path(_IN_CURRENT_FOLDER).exists()
    )
    if not chosen and get_rmw_implementation_identifier().startswith('rmw_fastrtps'):
        os.environ[_FILE] = str(share_directory() / 'config' / 'fastdds.xml')
