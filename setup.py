# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Package metadata, and what goes into the install space."""

import sys
import xml.etree.ElementTree as ET
from pathlib import Path

from setuptools import find_packages, setup

MANIFEST = ET.parse('package.xml').getroot()  # noqa: S314, the project's own file
PACKAGE = MANIFEST.findtext('name')


def shared(folder: str, pattern: str) -> list[tuple[str, list[str]]]:
    """Send the matching files of a folder to the same folders below the package's share."""
    files: dict[Path, list[str]] = {}
    for path in sorted(Path(folder).rglob(pattern)):
        if path.is_file():
            files.setdefault(path.parent, []).append(path.as_posix())
    return [(f'share/{PACKAGE}/{parent.as_posix()}', paths) for parent, paths in files.items()]


# setup.cfg installs programs to lib/, where `ros2 run` looks for them; bin/ is on the PATH. Wheels
# do not need this, because pip installs the programs to bin/.
ON_PATH = [] if 'bdist_wheel' in sys.argv else [('bin', ['bin/gearkin'])]

# The page of `gearkin watch`, for machines with and without a ROS installation
WATCH = ['tornado>=6.2']
ROSBAGS = ['rosbags>=0.11']
MESH = ['mapbox-earcut']
PANDAS = ['pandas>=2.1']
TABLES = ['scipy>=1.11', 'h5py', 'pyarrow>=14', 'openpyxl>=3.1', 'npTDMS>=1.7', 'asammdf>=7.4']

setup(
    name=PACKAGE,
    version=MANIFEST.findtext('version'),
    description=MANIFEST.findtext('description'),
    maintainer=MANIFEST.findtext('maintainer'),
    maintainer_email=MANIFEST.find('maintainer').get('email'),
    license=MANIFEST.findtext('license'),
    packages=find_packages(exclude=['test', 'test.*']),
    package_data={
        PACKAGE: ['py.typed'],
        f'{PACKAGE}.report': ['*.css', '*.js'],
        f'{PACKAGE}.watch': ['*.css', '*.js'],
    },
    data_files=[
        *ON_PATH,
        ('share/ament_index/resource_index/packages', [f'resource/{PACKAGE}']),
        (f'share/{PACKAGE}', ['package.xml']),
        *shared('config', '*'),
        *shared('launch', '*.launch.py'),
        *shared('bags', '*'),
        *shared('policies', '*.policy.xml'),
        *shared('meshes', '*.stl'),
        *shared('urdf', '*.xacro'),
        *shared('docs', 'report.*'),
        *shared('docs', 'security.md'),
    ],
    python_requires='>=3.11',
    install_requires=[
        'backports.zstd; python_version < "3.14"',
        'lz4',
        'numpy>=1.26',
        'PyYAML',
        'rich',
    ],
    extras_require={
        # For machines without a ROS installation. As a plain requirement, it would install a
        # second ROS beside that of the distribution.
        'ros': [
            'ros-jazzy-rclpy[fastrtps]==7.1.6',
            'ros-jazzy-common-interfaces==5.3.6',
            *ROSBAGS,
            *WATCH,
        ],
        'ros-kilted': [
            'ros-kilted-rclpy[fastrtps]==9.1.2',
            'ros-kilted-common-interfaces==5.5.1',
            *ROSBAGS,
            *WATCH,
        ],
        'watch': WATCH,
        # `gearkin validate --html`; rosdep has no key for it.
        'html': ['plotly>=5.24'],
        # ROS 1 bags and `gearkin compute`; Ubuntu has no package.
        'rosbags': ROSBAGS,
        # `gearkin plot`, `gearkin animate` and `--plot`
        'plot': ['matplotlib>=3.6', 'pillow'],
        # `gearkin lost-motion` and `calibrate`, and the load spectrum of `gearkin loads`
        'measure': ['scipy>=1.11', 'rainflow>=3.1', *PANDAS],
        # Tables that are no text: .parquet, .mat, .xlsx, .tdms, .mf4
        'tables': [*PANDAS, *TABLES],
        # `--scheduler` of `gearkin validate` and `gearkin loads`
        'cluster': ['distributed>=2024.1'],
        # `gearkin urdf --meshes`
        'mesh': MESH,
        # `gearkin mjcf` and gear_simulator, which do with less without it; Ubuntu has no package.
        'twin': ['mujoco>=3.14', *MESH],
        # colcon test looks here to see that the package is tested with pytest.
        'test': ['pytest'],
    },
    entry_points={
        'console_scripts': [
            f'gear_state_publisher = {PACKAGE}.__main__:gear_state_publisher',
            f'gear_simulator = {PACKAGE}.__main__:gear_simulator',
            f'gearkin = {PACKAGE}.__main__:gearkin',
        ]
    },
    zip_safe=False,
)
