# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Finding bags by files, directories and globs."""

from pathlib import Path

import pytest
from made_bags import change_metadata, mcap_file, read, split, split_without_metadata
from shipped_bags import BAGS

from gear_kinematics.bag import Bag, BagError
from gear_kinematics.bag.finding import find_bags


@pytest.fixture
def tree(tmp_path, monkeypatch):
    files = {
        'fleet/one': 'metadata.yaml one_0.mcap one_1.mcap',
        'fleet/deep': 'three.mcap four.mcap.lz4 five.bag notes.txt',
        'fleet/deep/er': 'two.db3',
        'killed': 'six_0.mcap six_1.mcap six_10.mcap',
        'logs': 'seven[1].mcap',
        'empty': 'notes.txt',
    }
    for folder, names in files.items():
        (tmp_path / folder).mkdir(parents=True)
        for name in names.split():
            (tmp_path / folder / name).touch()
    monkeypatch.chdir(tmp_path)
    return tmp_path


DEEP = [
    'fleet/deep/er/two.db3',
    'fleet/deep/five.bag',
    'fleet/deep/four.mcap.lz4',
    'fleet/deep/three.mcap',
]


@pytest.mark.parametrize(
    ('patterns', 'found'),
    [
        (['fleet/deep/three.mcap'], ['fleet/deep/three.mcap']),
        (['fleet/deep/notes.txt'], ['fleet/deep/notes.txt']),  # was named, and will be refused
        (['fleet/one'], ['fleet/one']),
        (['fleet/one/one_1.mcap'], ['fleet/one/one_1.mcap']),
        (['fleet/deep'], DEEP),
        (['fleet'], [*DEEP, 'fleet/one']),
        (['killed'], ['killed']),  # one recording, though nobody wrote its metadata
        (['.'], [*DEEP, 'fleet/one', 'killed', 'logs/seven[1].mcap']),
        (['fleet/*'], [*DEEP, 'fleet/one']),
        (['fleet/**'], [*DEEP, 'fleet/one']),
        (
            ['fleet/**/*.mcap'],
            ['fleet/deep/three.mcap', *(f'fleet/one/one_{k}.mcap' for k in '01')],
        ),
        (['logs/seven[1].mcap'], ['logs/seven[1].mcap']),  # as it is, before it is a pattern
        (['fleet/one', 'fleet', './fleet/one'], ['fleet/one', *DEEP]),  # each once, in this order
    ],
)
@pytest.mark.parametrize('absolute', [False, True])
def test_bags_are_found_once_and_in_order(absolute, patterns, found, tree):
    start = f'{tree}/' if absolute else ''
    given = [start + pattern for pattern in patterns]
    assert find_bags(given) == ([Path(start + name) for name in found], {})


@pytest.mark.parametrize('pattern', ['empty', 'empty/*', '**/*.txt', 'nowhere/missing'])
@pytest.mark.usefixtures('tree')
def test_a_pattern_that_nothing_fits_is_named_and_does_not_stop_the_others(pattern):
    bags, faults = find_bags([pattern, 'fleet/one'])
    assert bags == [Path('fleet/one')]
    assert faults == {Path(pattern): f'{pattern}: no bag there'}


@pytest.mark.parametrize('patterns', [['fleet/*'], ['fleet/deep', 'fleet/one']])
@pytest.mark.usefixtures('tree')
def test_an_unreadable_folder_does_not_stop_the_others(patterns, monkeypatch):
    """Tests may run as root, who may read everything."""
    iterdir = Path.iterdir

    def refused(path):
        if path.name == 'deep':
            raise PermissionError(13, 'Permission denied', str(path))
        return iterdir(path)

    monkeypatch.setattr(Path, 'iterdir', refused)
    bags, faults = find_bags(patterns)
    assert bags == [Path('fleet/one')]
    assert faults == {Path('fleet/deep'): 'fleet/deep: Permission denied'}


def test_metadata_stands_for_its_folder():
    folder = BAGS / 'servo_point_to_point'
    assert find_bags([str(folder / 'metadata.yaml')]) == find_bags([str(folder)])
    with Bag(folder / 'metadata.yaml') as given, Bag(folder) as expected:
        assert given.topics == expected.topics


@pytest.mark.parametrize('renamed', [False, True])
def test_files_that_are_listed_by_name_are_read_in_their_order(recorded, tmp_path, renamed):
    """By their numbers, or without them by their starts, which metadata give since version 5."""
    path = split(tmp_path / 'bag', recorded, 'sqlite3')
    names = [f'bag_{number}.db3' for number in range(11)]
    if renamed:
        names = [
            (path / name).rename(path / f'{10 - k:02}.db3').name for k, name in enumerate(names)
        ]
    starts = [recorded[number * 82][1] for number in range(11)]  # split: 900 messages in 11 files
    assert sorted(names) != names
    files = _files_of_metadata(names, starts)[::-1] if renamed else None
    change_metadata(path, relative_file_paths=sorted(names), files=files)
    assert read(path) == recorded


def test_a_recording_whose_metadata_were_not_written_yet_is_read(recorded, tmp_path):
    """As after a loss of power; and as packed by macOS, which adds a file to each."""
    path = split(tmp_path / 'bag', recorded, 'mcap', parts=2)
    (path / 'metadata.yaml').write_bytes(b'')
    for file in [*path.iterdir()]:
        (path / f'._{file.name}').write_bytes(b'\0\5\x16\7')
    assert read(path) == recorded
    (path / 'metadata.yaml').unlink()
    assert read(path) == recorded
    assert find_bags([str(tmp_path)]).bags == [path]
    lone = mcap_file(tmp_path / 'lone.mcap', recorded)
    (tmp_path / '._lone.mcap').write_bytes(b'\0\5\x16\7')
    assert sorted(find_bags([str(tmp_path)]).bags) == [path, lone]


def test_damaged_metadata_are_refused_with_what_to_do(recorded, tmp_path):
    path = split(tmp_path / 'bag', recorded, 'mcap', parts=2)
    (path / 'metadata.yaml').write_text('rosbag2_bagfile_information:\n  version: 9\n')
    with pytest.raises(BagError, match=r'is missing; without metadata\.yaml, the files are read'):
        read(path)


def _files_of_metadata(names, starts) -> list[dict]:
    return [
        {'path': name, 'starting_time': {'nanoseconds_since_epoch': start}}
        for name, start in zip(names, starts, strict=True)
    ]


@pytest.mark.parametrize('back', [4 * 10**9, 400 * 10**9])
def test_files_whose_times_begin_anew_are_read_by_their_numbers(recorded, tmp_path, back):
    """As where a simulation is reset while its time is recorded, in the last file of three."""
    first = [(topic, 10 * received - 10**19, data) for topic, received, data in recorded]
    messages = first[:600] + [
        (topic, received - back, data) for topic, received, data in first[600:]
    ]
    path = split(tmp_path / 'bag', messages, 'mcap', parts=3)
    starts = [messages[k][1] for k in (0, 300, 600)]
    assert sorted(starts) != starts
    files = _files_of_metadata([f'bag_{number}.mcap' for number in range(3)], starts)
    change_metadata(path, files=files)
    assert read(path) == messages


@pytest.mark.parametrize('prefix', ['rosbag2', '3_runs'])
def test_split_files_with_dates_are_in_the_order_of_their_counters(recorded, tmp_path, prefix):
    """As Lyrical names them; the clock was set back in between."""
    path = split_without_metadata(tmp_path / 'bag', recorded, 'mcap')
    for number in range(11):
        date = f'2026_05_23-10_{30 - number}_00'
        (path / f'bag_{number}.mcap').rename(path / f'{number}_{prefix}_{date}.mcap')
    assert find_bags([str(tmp_path)]).bags == [path]
    assert read(path) == recorded
    for number in range(2):  # as --max-bag-files does
        next(path.glob(f'{number}_*')).unlink()
    assert read(path) == recorded[2 * 82 :]


def test_files_of_two_storages_are_two_recordings(recorded, tmp_path):
    path = split_without_metadata(tmp_path / 'bag', recorded, 'mcap')
    (path / 'bag_3.mcap').rename(path / 'bag_3.db3')
    with pytest.raises(BagError, match='several recordings'):
        read(path)
    assert len(find_bags([str(tmp_path)]).bags) == 11
