"""Packages that pip installs only with an extra, and the error if one is missing."""

EXTRAS = {
    'rclpy': 'ros',
    'matplotlib': 'plot',
    'PIL': 'plot',
    'plotly': 'html',
    'distributed': 'dask',
}
"""The extra that installs a package; setup.py defines the extras."""


def remedy(error: ImportError) -> str:
    """Describe in one line what is missing and how to install it."""
    package = (error.name or '').partition('.')[0]
    if not (isinstance(error, ModuleNotFoundError) and package in EXTRAS):
        return ' '.join(str(error).split())
    ros = 'source a ROS 2 installation, or ' if package == 'rclpy' else ''
    return f"{package} is not installed: {ros}pip install 'gear_kinematics[{EXTRAS[package]}]'"
