"""Finds the bags that files, directories and globs name."""

import glob
import re
from collections.abc import Iterable, Iterator
from pathlib import Path

from gear_kinematics.bag.errors import BagError
from gear_kinematics.bag.reading import is_bag_file

_BAG_FILE = re.compile(r'\.(mcap|db3|bag)(\.(zstd|zst|lz4))?$')
_NUMBER = re.compile(r'_\d+(?=\.(mcap|db3))')
"""Number of a file of a split recording."""
_METADATA = 'metadata.yaml'
_TABLES = {'.csv', '.tsv'}


def find_bags(patterns: Iterable[str]) -> list[Path]:
    """Find the bags that files, directories and globs name; a directory can hold many.

    Raises:
        BagError: naming a pattern without a match.
    """
    found: list[Path] = []
    for pattern in patterns:
        path = Path(pattern)
        bags = list(_bags_below(path)) if path.exists() else list(_glob(pattern))
        if not bags:
            raise BagError(f'{pattern}: no bag there')
        found += bags
    return list(dict.fromkeys(found))


def is_recording(path: Path) -> bool:
    """Return whether a file is a recording or its metadata, or has the name of one.

    Raises:
        OSError: if it cannot be read.
    """
    if _BAG_FILE.search(path.name) or path.suffix.lower() in _TABLES:
        return True
    return path.name == _METADATA or (path.is_file() and is_bag_file(path))


def _glob(pattern: str) -> Iterator[Path]:
    # Path.glob takes no absolute patterns.
    matches = sorted(map(Path, glob.iglob(pattern, recursive=True)))  # noqa: PTH207
    bags = {bag: None for match in matches if _may_hold(match) for bag in _bags_below(match)}
    # `**` also matches the files inside matched bags.
    return (bag for bag in bags if bag.parent not in bags)


def _bags_below(path: Path) -> Iterator[Path]:
    if not path.is_dir() or (path / _METADATA).exists():
        yield path
        return
    children = sorted(
        child for child in path.iterdir() if _may_hold(child) and not _leads_astray(child)
    )
    files = [child for child in children if not child.is_dir()]
    if len(files) > 1 and len({_NUMBER.sub('', file.name) for file in files}) == 1:
        yield path  # a split recording whose recorder was killed
        children = [child for child in children if child.is_dir()]
    for child in children:
        yield from _bags_below(child)


def _leads_astray(path: Path) -> bool:
    """Whether it is a link to a folder that is not a bag: such links can form cycles."""
    return path.is_symlink() and path.is_dir() and not (path / _METADATA).exists()


def _may_hold(path: Path) -> bool:
    return path.is_dir() or bool(_BAG_FILE.search(path.name))
