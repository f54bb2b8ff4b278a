# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The files of a recording, and the contents of its metadata.yaml."""

import re
from itertools import islice
from pathlib import Path, PurePath
from typing import Any, NamedTuple

from gear_kinematics.bag.codecs import CODECS
from gear_kinematics.bag.errors import BagError, bag_errors
from gear_kinematics.bag.topics import Topic
from gear_kinematics.parameters.yaml_file import Loader, load_yaml, read_yaml
from gear_kinematics.wire.nearest import among

BAG_NAME = re.compile(r'\.(mcap|db3|bag)(\.(zstd|zst|lz4))?$')
_STORAGE_NAME = re.compile(r'(_\d+)?\.(mcap|db3)(\.(zstd|zst|lz4))?$')

_MAX_FILES = 50_000
_MAX_NEIGHBOURS = 10_000


class Contents(NamedTuple):
    """The files of a recording, and what is known without opening them."""

    files: list[Path]
    """In the order of recording."""
    topics: dict[str, Topic]
    """Topics by name; empty without metadata.yaml."""
    message_count: int | None
    """None without metadata.yaml."""
    custom: dict[str, str]
    """The recorder's custom_data."""


def find_contents(path: Path) -> Contents:
    """Find the files of a recording, a rosbag2 folder or a file, and read its metadata.

    Raises:
        ValueError: or other exceptions, if this is not a recording.
    """
    if path.is_file():
        return Contents([path], {}, None, {})
    if not path.is_dir():
        raise ValueError(f'no such file or folder{bags_beside(path)}')
    metadata = path / 'metadata.yaml'
    if metadata.exists():
        with bag_errors(metadata):
            return _listed_contents(path, read_yaml(metadata, BagError, _Loader))
    # A recorder that is killed writes no metadata.
    files = [file for file in path.iterdir() if _STORAGE_NAME.search(file.name)]
    if not files:
        raise ValueError('the folder holds neither metadata.yaml nor a .mcap or .db3 file')
    if len({_STORAGE_NAME.sub('', file.name) for file in files}) > 1:
        raise ValueError('several recordings without a metadata.yaml; name one of its files')
    return Contents(sorted(files, key=lambda file: (len(file.name), file.name)), {}, None, {})


def bags_beside(path: Path) -> str:
    """End of a message on a path without a bag: the nearest of those in its folder, and all."""
    try:
        entries = list(islice(path.parent.iterdir(), _MAX_NEIGHBOURS))
        names = [str(entry) for entry in entries if entry != path and _may_hold_bags(entry)]
    except OSError:
        return ''
    return among(str(path), names) if names else ''


def _may_hold_bags(path: Path) -> bool:
    return bool(BAG_NAME.search(path.name)) or (path.is_dir() and not path.name.startswith('.'))


class _Loader(Loader):
    """Reads what recorders write of ten thousand topics or files."""

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
    if information.get('compression_mode', '').lower() == 'message' and (
        information['compression_format'] not in CODECS
    ):
        raise ValueError(f'unsupported compression {information["compression_format"]!r}')
    message_count = int(information['message_count'])
    if not 0 <= message_count < 2**63:
        raise ValueError('the message count is out of range')
    topics: dict[str, Topic] = {}
    for entry in information['topics_with_message_count']:
        topic = _listed_topic(entry['topic_metadata'])
        topics.setdefault(topic.name, topic)
    names = information['relative_file_paths']
    if not names:
        raise ValueError('no files are listed')
    if len(names) > _MAX_FILES:
        raise ValueError(f'more than {_MAX_FILES} files are listed')
    files = [_listed_file(path, name) for name in names]
    if len(set(files)) < len(files):
        raise ValueError('a file is listed more than once')
    custom = information.get('custom_data') or {}
    if not isinstance(custom, dict):
        raise ValueError('custom_data is no mapping')  # noqa: TRY004, about data on disk
    named = {name: text for name, text in custom.items() if isinstance(text, str)}
    return Contents(files, topics, message_count, named)


def _listed_topic(known: Any) -> Topic:
    topic = Topic(
        known['name'],
        known['type'],
        known['serialization_format'],
        type_hash=known.get('type_description_hash', ''),
        qos=known.get('offered_qos_profiles', ''),
    )
    if not all(isinstance(text, str) for text in topic[:-1]):
        raise ValueError('the description of a topic is not text')
    return topic


def _listed_file(path: Path, name: str) -> Path:
    folder = path.absolute()
    file = folder / name
    if '..' in PurePath(name).parts or not file.is_relative_to(folder):
        raise ValueError(f'{name!r} leads outside the folder')
    # Before version 4, names began with that of the folder, which may have been renamed.
    return path / (name if file.exists() else file.name)
