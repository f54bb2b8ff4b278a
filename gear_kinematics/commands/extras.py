# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Packages that pip installs only with an extra, and the error if one is missing."""

EXTRAS = {
    'rclpy': 'ros',
    'matplotlib': 'plot',
    'PIL': 'plot',
    'plotly': 'html',
    'distributed': 'dask',
    'imageio_ffmpeg': 'video',
    'shtab': 'completion',
    'mapbox_earcut': 'mesh',
    'tornado': 'watch',
    'scipy': 'measure',
    'rosbags': 'rosbags',
}
"""The extra that installs a package; setup.py defines the extras."""
_MESSAGES = '_msgs', '_srvs', '_interfaces'
"""Ends of the names of further packages of the extra `ros`."""
_INSTEAD = {
    'ros': 'source a ROS 2 installation, or ',
    'video': 'install it with the system, or ',
}
"""What does as well."""
_NAMES = {'imageio_ffmpeg': 'ffmpeg'}


def remedy(error: ImportError) -> str:
    """Describe in one line what is missing and how to install it."""
    package = (error.name or '').partition('.')[0]
    extra = EXTRAS.get(package) or ('ros' if package.endswith(_MESSAGES) else None)
    if not (isinstance(error, ModuleNotFoundError) and extra):
        return ' '.join(str(error).split())
    name, instead = _NAMES.get(package, package), _INSTEAD.get(extra, '')
    return f"{name} is not installed: {instead}pip install 'gear_kinematics[{extra}]'"
