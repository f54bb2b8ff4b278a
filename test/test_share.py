"""Installed files are found in every layout in which the package gets installed."""

import importlib.util
import shutil
from pathlib import Path

import pytest

import gear_kinematics.share
from gear_kinematics.share import share_directory

ROOT = Path(__file__).resolve().parents[1]
SOURCE = Path(gear_kinematics.share.__file__)


def share_of(package: Path):
    """Copy the module to a package folder and call it there."""
    package.mkdir(parents=True)
    path = Path(shutil.copy(SOURCE, package))
    spec = importlib.util.spec_from_file_location('share_elsewhere', path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module.share_directory


def put_share(folder: Path) -> Path:
    (folder / 'config').mkdir(parents=True)
    (folder / 'package.xml').touch()
    return folder


def test_running_package_finds_the_files_of_this_tree():
    # The tree itself, or an installation of it.
    for name in ('package.xml', 'config/actuator.yaml'):
        assert (share_directory() / name).read_bytes() == (ROOT / name).read_bytes()


@pytest.mark.parametrize(
    'packages',
    [
        'lib/python3.11/site-packages',
        'lib/python3.12/dist-packages',
        'local/lib/python3.12/dist-packages',
    ],
)
def test_installation_is_found_above_the_package(tmp_path, packages):
    prefix = tmp_path / 'prefix'
    share = put_share(prefix / 'share/gear_kinematics')
    assert share_of(prefix / packages / 'gear_kinematics')() == share


def test_nearest_installation_wins(tmp_path):
    put_share(tmp_path / 'share/gear_kinematics')
    prefix = tmp_path / 'overlay'
    share = put_share(prefix / 'share/gear_kinematics')
    assert share_of(prefix / 'lib/python3.12/site-packages/gear_kinematics')() == share


def test_source_tree_is_found_from_its_package(tmp_path):
    tree = put_share(tmp_path / 'gear_kinematics')
    assert share_of(tree / 'gear_kinematics')() == tree


def test_symlinked_package_finds_its_source_tree(tmp_path):
    # colcon build --symlink-install
    tree = put_share(tmp_path / 'src/gear_kinematics')
    share_of(tree / 'gear_kinematics')
    site = tmp_path / 'install/lib/python3.12/site-packages'
    site.mkdir(parents=True)
    (site / 'gear_kinematics').symlink_to(tree / 'gear_kinematics')
    path = site / 'gear_kinematics/share.py'
    spec = importlib.util.spec_from_file_location('share_linked', path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    assert module.share_directory() == tree


@pytest.mark.parametrize('leftover', ['nothing', 'config', 'package.xml'])
def test_missing_files_are_named(tmp_path, leftover):
    share = tmp_path / 'share/gear_kinematics'
    share.mkdir(parents=True)
    if leftover == 'config':
        (share / 'config').mkdir()
    elif leftover == 'package.xml':
        (share / 'package.xml').touch()
    ask = share_of(tmp_path / 'lib/gear_kinematics')
    with pytest.raises(FileNotFoundError, match='gear_kinematics'):
        ask()
