# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Installed files are found in every layout in which the package gets installed."""

import importlib.util
import shutil
from pathlib import Path

import pytest

import gear_kinematics.share

SOURCE = Path(gear_kinematics.share.__file__)


def share_of(package: Path) -> Path:
    """Call the module as it is in a package folder, into which it is copied if it is missing."""
    path = package / 'share.py'
    if not path.exists():
        package.mkdir(parents=True)
        shutil.copy(SOURCE, path)
    spec = importlib.util.spec_from_file_location('share_elsewhere', path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module.share_directory()


def put_share(folder: Path, parts=('config', 'package.xml')) -> Path:
    folder.mkdir(parents=True)
    if 'config' in parts:
        (folder / 'config').mkdir()
    if 'package.xml' in parts:
        (folder / 'package.xml').touch()
    return folder


@pytest.mark.parametrize(
    ('package', 'share'),
    [
        ('prefix/lib/python3.11/site-packages/gear_kinematics', 'prefix/share/gear_kinematics'),
        ('prefix/lib/python3.12/dist-packages/gear_kinematics', 'prefix/share/gear_kinematics'),
        ('prefix/local/lib/python3/dist-packages/gear_kinematics', 'prefix/share/gear_kinematics'),
        ('gear_kinematics/gear_kinematics', 'gear_kinematics'),  # the source tree
    ],
)
def test_files_are_found_above_the_package_and_the_nearest_win(tmp_path, package, share):
    put_share(tmp_path / 'share/gear_kinematics')
    expected = put_share(tmp_path / share)
    assert share_of(tmp_path / package) == expected


def test_symlinked_package_finds_its_source_tree(tmp_path):
    # colcon build --symlink-install
    tree = put_share(tmp_path / 'src/gear_kinematics')
    share_of(tree / 'gear_kinematics')
    site = tmp_path / 'install/lib/python3.12/site-packages'
    site.mkdir(parents=True)
    (site / 'gear_kinematics').symlink_to(tree / 'gear_kinematics')
    assert share_of(site / 'gear_kinematics') == tree


@pytest.mark.parametrize('parts', [(), ('config',), ('package.xml',)])
def test_missing_files_are_named(tmp_path, parts):
    put_share(tmp_path / 'share/gear_kinematics', parts)
    with pytest.raises(FileNotFoundError, match='gear_kinematics'):
        share_of(tmp_path / 'lib/gear_kinematics')
