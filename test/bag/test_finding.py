"""Finding bags by files, directories and globs."""

import re

import pytest

from gear_kinematics.bag import BagError
from gear_kinematics.bag.finding import find_bags


@pytest.fixture
def tree(tmp_path, monkeypatch):
    for name in (
        'fleet/one/metadata.yaml',
        'fleet/one/one_0.mcap',
        'fleet/one/one_1.mcap',
        'fleet/deep/er/two.db3',
        'fleet/deep/three.mcap',
        'fleet/deep/four.mcap.lz4',
        'fleet/deep/five.bag',
        'fleet/deep/notes.txt',
        'killed/six_0.mcap',
        'killed/six_1.mcap',
        'killed/six_10.mcap',
        'logs/seven[1].mcap',
        'empty/notes.txt',
    ):
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.touch()
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
        (['fleet/one/'], ['fleet/one']),
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
        (['fleet/d*/*.db3', 'fleet/**/two.db3'], None),
        (['logs/seven[1].mcap'], ['logs/seven[1].mcap']),  # as it is, before it is a pattern
        (['fleet/one', 'fleet', './fleet/one'], ['fleet/one', *DEEP]),  # each once, in this order
    ],
)
@pytest.mark.parametrize('absolute', [False, True])
def test_bags_are_found_once_and_in_order(absolute, patterns, found, tree):
    start = f'{tree}/' if absolute else ''
    given = [start + pattern for pattern in patterns]
    if found is None:
        with pytest.raises(BagError, match=f'^{re.escape(given[0])}: no bag there$'):
            find_bags(given)
        return
    assert [str(path) for path in find_bags(given)] == [start + name for name in found]


@pytest.mark.parametrize('pattern', ['missing', 'missing.mcap', 'empty', 'empty/*', '**/*.txt'])
@pytest.mark.usefixtures('tree')
def test_a_pattern_that_nothing_fits_is_named(pattern):
    with pytest.raises(BagError, match=f'^{re.escape(pattern)}: no bag there$'):
        find_bags(['fleet', pattern])
