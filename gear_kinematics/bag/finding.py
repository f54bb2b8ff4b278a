# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Finds bags by files, directories and globs, and the files of each."""

import glob
import re
from collections.abc import Iterable, Iterator
from pathlib import Path, PurePath
from typing import Any, NamedTuple

from gear_kinematics.bag.codecs import CODECS
from gear_kinematics.bag.errors import BagError, bag_errors, cause
from gear_kinematics.bag.storage import Topic
from gear_kinematics.parameters.yaml_file import Loader, load_yaml, read_yaml

BAG_NAME = re.compile(r'\.(mcap|db3|bag)(\.(zstd|zst|lz4))?$')
_STORAGE_NAME = re.compile(
    r'(?!\._)(?:(?P<counter>\d+)_(?P<prefix>.+)_\d{4}(_\d\d){2}-\d\d(_\d\d){2}|(?P<name>.+?)(_(?P<number>\d+))?)'
    r'\.(?P<kind>mcap|db3)(\.(zstd|zst|lz4))?$'
)
"""Name of a file of a recording; since Lyrical, of a split one, a counter and the date."""
METADATA = 'metadata.yaml'
_TEXTS = '.csv', '.tsv', '.txt', '.dat', '.asc', '.lvm', '.log'
_COMMON = {'.txt', '.dat', '.log'}  # which often are no recordings
POINTER = b'version https://'  # begins a pointer of Git LFS in place of a file
NO_CONTENT = 'only a pointer of Git LFS: fetch the file with git lfs pull'
COMPRESSED = '.gz', '.zst', '.zip', '.bz2', '.xz'  # of compressed texts, behind those of `TABLES`
TABLES = {
    **dict.fromkeys(_TEXTS, 'text'),
    '.parquet': 'parquet',
    '.mat': 'mat',
    '.tdms': 'tdms',
    **dict.fromkeys(('.mf4', '.mdf'), 'mf4'),
    **dict.fromkeys(('.xlsx', '.xlsm'), 'workbook'),
    '.jsonl': 'json',
}
"""Formats of tables by the ends of their names."""


class Found(NamedTuple):
    """The bags that patterns name."""

    bags: list[Path]
    faults: dict[Path, str]
    """Errors, each in one line, by the pattern without a match or the unreadable folder."""


def find_bags(patterns: Iterable[str]) -> Found:
    """Find the bags that files, directories and globs name; a directory can hold many."""
    bags: dict[Path, None] = {}
    faults: dict[Path, str] = {}
    for pattern in patterns:
        path, found = _recording(Path(pattern)), list[Path]()
        known = len(faults)
        try:
            found += _bags_below(path, faults) if path.exists() else _glob(pattern, faults)
        except OSError as error:  # it is about a folder above
            faults[path] = f'{path}: {cause(error)}'
        if not found and len(faults) == known:
            faults[path] = f'{pattern}: no bag there'
        bags |= dict.fromkeys(found)
    return Found(list(bags), faults)


def _recording(path: Path) -> Path:
    """Return the folder of a metadata.yaml, or else the path itself."""
    return path.parent if path.name == METADATA and path.is_file() else path


def is_recording(path: Path) -> bool:
    """Return whether a file has the name of a recording or its metadata."""
    name = path.name
    table = bool(table_format(path)) and path.suffix.lower() not in _COMMON
    return bool(BAG_NAME.search(name)) or table or name == METADATA


def table_format(path: Path) -> str:
    """Return which of `TABLES` a file is by its name; '' if it is no table."""
    *_, inner, last = '', '', *(end.lower() for end in path.suffixes)
    return TABLES.get(inner if last in COMPRESSED and inner in _TEXTS else last, '')


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
        if not path.is_dir() or (path / METADATA).exists():
            yield path
            return
        children = sorted(
            child for child in path.iterdir() if _may_hold(child) and not _leads_astray(child)
        )
    except OSError as error:
        faults[path] = f'{path}: {cause(error)}'
        return
    files = [child for child in children if not child.is_dir()]
    if len(files) > 1 and _in_order(files):
        yield path  # a split recording whose recorder was killed
        children = [child for child in children if child.is_dir()]
    for child in children:
        yield from _bags_below(child, faults)


def _in_order(files: list[Path]) -> list[Path]:
    """Return the files of a split recording in their order; empty if there are several."""
    found = [_STORAGE_NAME.match(file.name) for file in files]
    names = [match and (match['prefix'], match['name'], match['kind']) for match in found]
    numbers = [match and int(match['counter'] or match['number'] or -1) for match in found]
    if None in names or len(set(names)) > 1 or len(set(numbers)) < len(files):
        return []
    return [file for _, file in sorted(zip(numbers, files, strict=True))]


def _leads_astray(path: Path) -> bool:
    """Return whether a path is a link to a folder that is no bag: such links can form cycles."""
    return path.is_symlink() and path.is_dir() and not (path / METADATA).exists()


def _may_hold(path: Path) -> bool:
    name = path.name  # beside each file, archives of macOS have one that begins with ._
    return path.is_dir() or bool(BAG_NAME.search(name) and not name.startswith('._'))


class Contents(NamedTuple):
    """The files of a recording, and what is known without opening them."""

    files: list[Path]  # files in the order of recording
    topics: dict[str, Topic]  # topics by name; empty without metadata.yaml
    message_count: int | None  # number of messages; None without metadata.yaml


def find_contents(path: Path) -> Contents:
    """Find the files of a recording, a folder or a file; any Exception if it is none."""
    path = _recording(path)
    if path.is_file():
        return Contents([path], {}, None)
    if not path.is_dir():
        raise ValueError('no such file or folder')
    metadata = path / METADATA
    empty = metadata.is_file() and not metadata.stat().st_size
    if metadata.exists() and not empty:
        try:
            with bag_errors(metadata):
                return _listed_contents(path, read_yaml(metadata, BagError, _Loader))
        except BagError as error:
            raise BagError(f'{error}; without {METADATA}, the files are read') from error
    # A recorder that was killed has written no metadata, or none yet.
    files = [file for file in path.iterdir() if _STORAGE_NAME.match(file.name)]
    if not files:
        raise ValueError('the folder holds neither metadata.yaml nor a .mcap or .db3 file')
    if not (ordered := _in_order(files)):
        raise ValueError('several recordings without a metadata.yaml; name one of its files')
    return Contents(ordered, {}, None)


class _Loader(Loader):
    """Reads metadata that list ten thousand topics or files."""

    max_bytes = 2**22
    max_events = 400_000
    aliases = True


def parse_yaml(text: str) -> Any:
    """Parse YAML of a bag; raises any exception if it is none, or larger than recorders write."""
    return load_yaml(text, _Loader)


def _listed_contents(path: Path, metadata: Any) -> Contents:
    if not isinstance(metadata, dict):
        raise ValueError('no metadata in it')  # noqa: TRY004, about data on disk
    information = metadata['rosbag2_bagfile_information']
    if (information.get('compression_mode') or '').lower() == 'message' and (
        information['compression_format'] not in CODECS
    ):
        raise ValueError(f'unsupported compression {information["compression_format"]!r}')
    topics: dict[str, Topic] = {}
    for entry in information['topics_with_message_count']:
        topic = Topic.of(entry['topic_metadata'])
        topics.setdefault(topic.name, topic)
    names = information['relative_file_paths']
    if not names:
        raise ValueError('no files are listed')
    listed = information.get('files') or ()
    starts = {file['path']: file['starting_time']['nanoseconds_since_epoch'] for file in listed}
    if starts.keys() >= set(names):  # from version 5 on
        names = sorted(names, key=starts.__getitem__)
    files = [_listed_file(path, name) for name in names]
    # Tools list files by name: _10 before _2. Starts are no order where a clock was reset.
    files = _in_order(files) or files
    if len(set(files)) < len(files):
        raise ValueError('a file is listed more than once')
    message_count = int(information['message_count'])
    if not 0 <= message_count < 2**63:
        raise ValueError('the message count is out of range')
    return Contents(files, topics, message_count)


def _listed_file(path: Path, name: str) -> Path:
    folder = path.absolute()
    file = folder / name
    if '..' in PurePath(name).parts or not file.is_relative_to(folder):
        raise ValueError(f'{name!r} leads outside the folder')
    # Before version 4, names began with that of the folder, which may have been renamed.
    return path / (name if file.exists() else file.name)
