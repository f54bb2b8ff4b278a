# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Bags of every kind, made by rosbags and the `mcap` package; each maker returns the path."""

import sqlite3
from contextlib import closing
from pathlib import Path

import lz4.frame
import mcap.reader
import mcap.writer
import yaml
from rosbags import rosbag1, rosbag2
from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin
from rosbags.typesys import Stores, get_typestore
from shipped_bags import TYPES

from gear_kinematics.bag import Bag, Message

JAZZY = get_typestore(Stores.ROS2_JAZZY)
_NOETIC = get_typestore(Stores.ROS1_NOETIC)


def read(path: Path, topics=TYPES) -> list[Message]:
    with Bag(path) as bag:
        return list(bag.messages(list(topics)))


def definition_of(kind: str) -> str:
    return JAZZY.generate_msgdef(kind, ros_version=2)[0]


def folder(
    path: Path, messages: list[Message], storage: str = 'mcap', mode: str = 'none', **metadata
) -> Path:
    """Write a folder of rosbag2, and change its metadata."""
    writer = rosbag2.Writer(path, version=9, storage_plugin=StoragePlugin[storage.upper()])
    writer.set_compression(CompressionMode[mode.upper()], CompressionFormat.ZSTD)
    with writer:
        connections = {
            topic: writer.add_connection(topic, kind, typestore=JAZZY)
            for topic, kind in TYPES.items()
        }
        for topic, received, data in messages:
            writer.write(connections[topic], received, data)
    if metadata:
        change_metadata(path, **metadata)
    return path


def change_metadata(path: Path, **changes) -> Path:
    metadata = path / 'metadata.yaml'
    document = yaml.safe_load(metadata.read_text())
    document['rosbag2_bagfile_information'].update(changes)
    metadata.write_text(yaml.safe_dump(document))
    return path


def file_of(path: Path) -> Path:
    """Return the only file of a folder, beside its metadata."""
    (file,) = (p for p in path.iterdir() if p.suffix != '.yaml')
    return file


def single_file(path: Path, messages: list[Message], *form, name: str = '', **forms) -> Path:
    file = file_of(folder(path, messages, *form, **forms))
    return file.rename(path / name) if name else file


def renamed_folder(path: Path, messages: list[Message]) -> Path:
    """Name files as before version 4: with their folder, which has been renamed."""
    names = [f'old_name/{path.name}.mcap']
    return folder(path, messages, version=3, relative_file_paths=names)


def lz4_file(path: Path, messages: list[Message], storage: str) -> Path:
    file = single_file(path, messages, storage)
    packed = file.with_name(f'{file.name}.lz4')
    packed.write_bytes(lz4.frame.compress(file.read_bytes()))
    file.unlink()
    form = {'compression_format': 'lz4', 'compression_mode': 'FILE'}
    return change_metadata(path, **form, relative_file_paths=[packed.name])


def lz4_messages(path: Path, messages: list[Message], storage: str) -> Path:
    packed = [(topic, received, lz4.frame.compress(data)) for topic, received, data in messages]
    form = {'compression_format': 'lz4', 'compression_mode': 'MESSAGE'}
    return folder(path, packed, storage, **form)


def split(
    path: Path, messages: list[Message], storage: str, mode: str = 'none', parts: int = 11
) -> Path:
    """Write files _0 to _10, whose order is not that of their names."""
    path.mkdir()
    size = -(-len(messages) // parts)
    names = []
    for number in range(parts):
        piece = path.parent / f'{path.name}_{number}'
        folder(piece, messages[number * size : (number + 1) * size], storage, mode)
        file = file_of(piece)
        names.append(file.rename(path / file.name).name)
        (piece / 'metadata.yaml').rename(path / 'metadata.yaml')
    return change_metadata(path, relative_file_paths=names, message_count=len(messages))


def split_without_metadata(path: Path, messages: list[Message], storage: str) -> Path:
    split(path, messages, storage)
    (path / 'metadata.yaml').unlink()
    return path


def mcap_file(
    path: Path,
    messages: list[Message],
    *,
    finish: bool = True,
    definition: bool = True,
    shortened: bool = False,
    cut: int | None = None,
    others: tuple[tuple[str, str, str, str, bytes], ...] = (),
    **options,
) -> Path:
    """Write with the mcap package; `others` are topic, type, encoding, syntax and definition."""
    with path.open('wb') as stream:
        writer = mcap.writer.Writer(stream, **{'chunk_size': 20_000, **options})
        writer.start(profile='ros2')
        for topic, kind, encoding, syntax, text in others:
            schema = writer.register_schema(kind, syntax, text)
            channel = writer.register_channel(topic, encoding, schema)
            writer.add_message(channel, messages[0][1], b'\x80\xff other', messages[0][1])
        channels = {}
        for topic, kind in TYPES.items():
            text, syntax = definition_of(kind) if definition else '', 'ros2msg'
            written = kind.replace('/msg/', '/') if shortened else kind
            schema = writer.register_schema(written, syntax if definition else '', text.encode())
            channels[topic] = writer.register_channel(topic, 'cdr', schema)
        for number, (topic, received, data) in enumerate(messages):
            writer.add_message(channels[topic], received, data, received, number)
        writer.finish()
    if cut or not finish:
        path.write_bytes(path.read_bytes()[: cut or record_ends(path)[-1]])
    return path


def record_ends(path: Path) -> list[int]:
    """Find the ends of the records in the data of an mcap, and the start of the first."""
    data, ends = path.read_bytes(), [8]
    while data[ends[-1]] != 15:
        ends.append(ends[-1] + 9 + int.from_bytes(data[ends[-1] + 1 : ends[-1] + 9], 'little'))
    return ends


def chunks(path: Path) -> list[mcap.reader.ChunkIndex]:
    with path.open('rb') as stream:
        return mcap.reader.make_reader(stream).get_summary().chunk_indexes


def ros1_bag(path: Path, messages: list[Message], compression: str | None = None) -> Path:
    writer = rosbag1.Writer(path)
    if compression:
        writer.set_compression(rosbag1.Writer.CompressionFormat[compression])
    with writer:
        connections = {
            topic: writer.add_connection(topic, kind, typestore=_NOETIC)
            for topic, kind in TYPES.items()
        }
        for topic, received, data in messages:
            writer.write(connections[topic], received, JAZZY.cdr_to_ros1(data, TYPES[topic]))
    return path


def database(path: Path, script: str) -> Path:
    """Run a script on a database, which may be new."""
    with closing(sqlite3.connect(path)) as connection:
        connection.executescript(script)
    return path


def edited(path: Path, place: int, data: bytes) -> Path:
    """Replace bytes of a file."""
    content = path.read_bytes()
    path.write_bytes(content[:place] + data + content[place + len(data) :])
    return path
