# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Packages that pip installs only with an extra, and the error if one is missing."""

import sys

_EXTRAS = {
    'ros': {'rclpy'},
    'plot': {'matplotlib', 'PIL'},
    'html': {'plotly'},
    'mesh': {'mapbox_earcut'},
    'twin': {'mujoco'},
    'watch': {'tornado'},
    'measure': {'scipy', 'pandas', 'rainflow'},
    'tables': {'pyarrow', 'nptdms', 'asammdf', 'h5py', 'openpyxl'},
    'rosbags': {'rosbags'},
    'cluster': {'distributed'},
}
"""Packages by the extras that install them; setup.py defines the extras."""
_MESSAGES = '_msgs', '_srvs', '_interfaces'  # endings of further packages of the extra `ros`


def remedy(error: ImportError) -> str:
    """Describe in one line what is missing and how to install it."""
    package = (error.name or '').partition('.')[0]
    of_ros = 'ros' if package.endswith(_MESSAGES) else None
    extra = next((extra for extra, of in _EXTRAS.items() if package in of), of_ros)
    if 'librmw_' in str(error):
        wheel = 'ros-jazzy-rclpy[fastrtps]'  # or that of another distribution
        return f"rclpy has no middleware: install it with the extra, as in pip install '{wheel}'"
    if not (isinstance(error, ModuleNotFoundError) and package):
        return ' '.join(str(error).split())
    if not extra:
        another = 'build gear_kinematics with another Python, as by python3 -m colcon build'
        return f'{package} is not installed for {sys.executable}: install it, or {another}'
    instead = 'source a ROS 2 installation, or ' if extra == 'ros' else ''
    return f"{package} is not installed: {instead}pip install 'gear_kinematics[{extra}]'"
