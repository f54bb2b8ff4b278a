# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""How fast `gearkin validate` is, against other ways to go through the same bag, in the same run.

    python benchmark/validation.py [--messages 300000] [--rounds 5] [--memory 10000000] [--json]

The bag is a shipped recording, repeated with stamps that go on: three topics, interleaved. The
ways take turns, so that what else the machine does befalls all of them; what is printed is the
median over the rounds of the ratio to the validation in the same round. With --memory, a bag of
that many messages is validated by a process of its own, and its peak of resident memory is
printed too (the bag takes 0.1 kB of disk for each message).
"""

import argparse
import json
import multiprocessing
import resource
import statistics
import struct
import tempfile
import time
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path

from mcap.reader import make_reader
from mcap_ros2.decoder import DecoderFactory
from rosbags.highlevel import AnyReader
from rosbags.rosbag2 import Reader

from gear_kinematics.bag import Bag, Message, in_batches
from gear_kinematics.bag.writing import BagWriter
from gear_kinematics.parameters import NodeParameters, default_config
from gear_kinematics.report.document import Verdict
from gear_kinematics.share import share_directory
from gear_kinematics.validation.task import Task
from gear_kinematics.validation.validate_bag import validate_bag
from gear_kinematics.wire.topics import BODY_POSES, OUTPUT_STATE, ROTOR_STATE, TOPICS

_SOURCE = 'servo_point_to_point'
_LENGTH = 7  # s, of which the source takes 6
_SECOND = 1_000_000_000  # ns
TYPES = {f'/{name}': TOPICS[name].type for name in (ROTOR_STATE, OUTPUT_STATE, BODY_POSES)}


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument('--messages', type=int, default=300_000)
    parser.add_argument('--rounds', type=int, default=5)
    parser.add_argument('--memory', type=int, default=0, metavar='MESSAGES')
    parser.add_argument('--json', action='store_true')
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        results = {}
        for storage in ('mcap', 'sqlite3'):
            bag = Path(folder, storage)
            write_repeated(bag, options.messages, storage)
            ways = {way: partial(run, bag) for way, run in _ways(storage).items()}
            seconds, ratios = compare(ways, options.rounds)
            results[storage] = {'validate': seconds, **ratios}
        if options.memory:
            bag = Path(folder, 'large')
            write_repeated(bag, options.memory, 'mcap')
            results['memory'] = _memory(bag)
    if options.json:
        print(json.dumps(results, indent=2))
        return
    for storage in ('mcap', 'sqlite3'):
        seconds = results[storage].pop('validate')
        print(f'{storage}, {options.messages} messages: validated in {seconds:.2f} s of CPU')
        for way, ratio in results[storage].items():
            print(f'  {way}: {ratio:.2f} x the time of the validation')
    if options.memory:
        print(f'{options.memory} messages: peak of resident memory {results["memory"]:.0f} MB')


def write_repeated(path: Path, count: int, storage: str) -> None:
    """Write a bag of `repeated` messages, compressed where the storage has chunks."""
    with BagWriter(path, storage, 'zstd' if storage == 'mcap' else 'none') as writer:
        for topic, message_type in TYPES.items():
            writer.add_topic(topic, message_type)
        for batch in in_batches(repeated(count)):
            writer.write_all(batch)


def repeated(count: int) -> Iterator[Message]:
    """Give a number of messages of the source, repeated with stamps that go on."""
    with Bag(share_directory() / 'bags' / _SOURCE) as bag:
        source = list(bag.messages(TYPES))
    # Whole sets: an input without its outputs would be a failure.
    for number in range(count - count % len(TYPES)):
        repetition, index = divmod(number, len(source))
        topic, received, data = source[index]
        (seconds,) = struct.unpack_from('<i', data, 4)
        later = struct.pack('<i', seconds + _LENGTH * repetition)
        shift = _LENGTH * repetition * _SECOND
        yield topic, received + shift, data[:4] + later + data[8:]


def _ways(storage: str) -> dict[str, Callable[[Path], object]]:
    ways = {
        'validate': _validate,
        'iterating raw messages with rosbags': _iterate,
        'deserialising with rosbags': _deserialise,
    }
    if storage == 'mcap':
        ways['decoding with mcap-ros2-support'] = _decode
    return ways


def _validate(bag: Path) -> None:
    config = default_config()
    task = Task(bag, NodeParameters.load(config), str(config))
    report = validate_bag(task)
    if report.verdict != Verdict.PASS:
        raise RuntimeError(f'the bag does not validate: {report}')


def _iterate(bag: Path) -> None:
    with Reader(bag) as reader:
        for _ in reader.messages():
            pass


def _deserialise(bag: Path) -> None:
    with AnyReader([bag]) as reader:
        for connection, _, data in reader.messages():
            reader.deserialize(data, connection.msgtype)


def _decode(bag: Path) -> None:
    (file,) = bag.glob('*.mcap')
    with file.open('rb') as stream:
        for _ in make_reader(stream, decoder_factories=[DecoderFactory()]).iter_decoded_messages():
            pass


def compare(ways: dict[str, Callable[[], object]], rounds: int) -> tuple[float, dict[str, float]]:
    """Give the time of the first way, s of CPU, and that of each other as a multiple of it."""
    times: dict[str, list[float]] = {way: [] for way in ways}
    for _ in range(rounds):
        for way, run in ways.items():
            start = time.process_time()
            run()
            times[way].append(time.process_time() - start)
    reference = times.pop(next(iter(ways)))
    return statistics.median(reference), {
        way: statistics.median(t / r for t, r in zip(taken, reference, strict=True))
        for way, taken in times.items()
    }


def _memory(bag: Path) -> float:
    """MB, of a process that does nothing but validate."""
    context = multiprocessing.get_context('spawn')
    with context.Pool(1) as pool:
        return pool.apply(_validate_and_measure, (bag,))


def _validate_and_measure(bag: Path) -> float:
    _validate(bag)
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024 / 1e6


if __name__ == '__main__':
    main()
