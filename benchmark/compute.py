# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""How long `gearkin compute` takes, against copying messages raw, in the same run.

    python benchmark/compute.py [--messages 100000] [--rounds 5] [--json]

The bag has the rotor topic alone, so that what is written are three messages for each: the rotor
state and two outputs. Both bags are copied, raw and by way of the same storage. The ways take
turns; what is printed is the median over the rounds of the ratio in the same round.
"""

import argparse
import json
import shutil
import tempfile
from collections.abc import Callable
from functools import partial
from pathlib import Path

from rosbags.rosbag2 import Reader, StoragePlugin, Writer
from validation import TYPES, compare, repeated

from gear_kinematics.bag import Bag
from gear_kinematics.bag.writing import BagWriter
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.validation.compute import compute

_ROTOR = '/rotor_state'


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('--messages', type=int, default=100_000, help='of the rotor topic')
    parser.add_argument('--rounds', type=int, default=5)
    parser.add_argument('--json', action='store_true')
    options = parser.parse_args()
    results = {}
    for storage in ('mcap', 'sqlite3'):
        with tempfile.TemporaryDirectory() as folder:
            results[storage] = compare(
                _ways(Path(folder), storage, options.messages), options.rounds
            )
    if options.json:
        print(json.dumps(results, indent=2))
        return
    for storage, (seconds, ratios) in results.items():
        print(f'{storage}, {options.messages} messages: computed in {seconds:.2f} s of CPU')
        for way, ratio in ratios.items():
            print(f'  {1 / ratio:.2f} x the time of {way}')


def _ways(folder: Path, storage: str, count: int) -> dict[str, Callable[[], object]]:
    """Make both bags in a folder, and give what is to be compared; the first is the measure."""
    read, written = Path(folder, 'read'), Path(folder, 'written')
    messages = [message for message in repeated(len(TYPES) * count) if message[0] == _ROTOR]
    with BagWriter(read, storage) as writer:
        writer.add_topic(_ROTOR, TYPES[_ROTOR])
        writer.write_all(messages)
    _compute(storage, read, written)
    ways = {'compute': partial(_compute, storage, read)}
    for name, bag in (('what it writes', written), ('what it reads', read)):
        ways[f'copying {name} with rosbags'] = partial(_copy_with_rosbags, storage, bag)
        ways[f'copying {name} with the same reader and writer'] = partial(_copy, storage, bag)
    target = Path(folder, 'target')
    return {name: partial(_run, way, target) for name, way in ways.items()}


def _run(way: Callable[[Path], None], target: Path) -> None:
    shutil.rmtree(target, ignore_errors=True)
    way(target)


def _compute(storage: str, source: Path, target: Path) -> None:
    with Bag(source) as bag:
        compute(bag, target, {'': NodeParameters.load()}, storage=storage)


def _copy(storage: str, source: Path, target: Path) -> None:
    with Bag(source) as bag, BagWriter(target, storage) as writer:
        for topic in bag.topics:
            writer.copy_topic(bag, topic)
        for batch in bag.batches(bag.topics):
            writer.write_all(batch)


def _copy_with_rosbags(storage: str, source: Path, target: Path) -> None:
    plugin = StoragePlugin[storage.upper()]
    with Reader(source) as reader, Writer(target, version=9, storage_plugin=plugin) as writer:
        connections = {
            connection.id: writer.add_connection(
                connection.topic,
                connection.msgtype,
                msgdef=connection.msgdef.data,
                rihs01=connection.digest,
                offered_qos_profiles=connection.ext.offered_qos_profiles,
            )
            for connection in reader.connections
        }
        for connection, received, data in reader.messages():
            writer.write(connections[connection.id], received, data)


if __name__ == '__main__':
    main()
