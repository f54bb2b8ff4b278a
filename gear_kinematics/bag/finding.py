# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Finds the bags that files, directories and globs name."""

import glob
import re
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import NamedTuple

from gear_kinematics.bag.contents import BAG_NAME, bags_beside
from gear_kinematics.bag.errors import BagError, cause
from gear_kinematics.bag.reading import is_bag_file

_NUMBER = re.compile(r'_\d+(?=\.(mcap|db3))')
"""Number of a file of a split recording."""
_METADATA = 'metadata.yaml'
_TABLES = {'.csv', '.tsv'}


class Found(NamedTuple):
    """What patterns name."""

    bags: list[Path]
    faults: dict[Path, str]
    """Causes, in one line that names it, by the pattern without a match or the unreadable
    folder."""


def find_bags(patterns: Iterable[str], *, least: int = 1) -> Found:
    """Find the bags that files, directories and globs name; a directory can hold many.

    Raises:
        BagError: naming each pattern without a match, if there are fewer bags than `least`.
    """
    bags: dict[Path, None] = {}
    faults: dict[Path, str] = {}
    for pattern in patterns:
        path, found = Path(pattern), list[Path]()
        known = len(faults)
        try:
            found += _bags_below(path, faults) if path.exists() else _glob(pattern, faults)
        except OSError as error:  # of a folder above
            faults[path] = f'{path}: {cause(error)}'
        if not found and len(faults) == known:
            hint = '' if path.exists() or glob.has_magic(pattern) else bags_beside(path)
            faults[path] = f'{pattern}: no bag there{hint}'
        bags |= dict.fromkeys(found)
    if len(bags) < least:
        raise BagError('; '.join(faults.values()))
    return Found(list(bags), faults)


def is_recording(path: Path) -> bool:
    """Return whether a file is a recording or its metadata, or has the name of one.

    Raises:
        OSError: if it cannot be read.
    """
    if BAG_NAME.search(path.name) or path.suffix.lower() in _TABLES:
        return True
    return path.name == _METADATA or (path.is_file() and is_bag_file(path))


def _glob(pattern: str, faults: dict[Path, str]) -> Iterator[Path]:
    # Path.glob takes no absolute patterns.
    matches = sorted(map(Path, glob.iglob(pattern, recursive=True)))  # noqa: PTH207
    bags = {
        bag: None for match in matches if _may_hold(match) for bag in _bags_below(match, faults)
    }
    # `**` also matches the files inside matched bags.
    return (bag for bag in bags if bag.parent not in bags)


def _bags_below(path: Path, faults: dict[Path, str]) -> Iterator[Path]:
    """Yield the bags; a folder that cannot be read is a fault, and does not stop the others."""
    try:
        if not path.is_dir() or (path / _METADATA).exists():
            yield path
            return
        children = sorted(
            child for child in path.iterdir() if _may_hold(child) and not _leads_astray(child)
        )
    except OSError as error:
        faults[path] = f'{path}: {cause(error)}'
        return
    files = [child for child in children if not child.is_dir()]
    if len(files) > 1 and len({_NUMBER.sub('', file.name) for file in files}) == 1:
        yield path  # a split recording whose recorder was killed
        children = [child for child in children if child.is_dir()]
    for child in children:
        yield from _bags_below(child, faults)


def _leads_astray(path: Path) -> bool:
    """Whether it is a link to a folder that is not a bag: such links can form cycles."""
    return path.is_symlink() and path.is_dir() and not (path / _METADATA).exists()


def _may_hold(path: Path) -> bool:
    return path.is_dir() or bool(BAG_NAME.search(path.name))
