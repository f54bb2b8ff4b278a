"""When recordings were made."""

import os
from datetime import UTC, datetime

import pytest
from gear_recordings import Samples, write_csv, write_recording

from gear_kinematics.lost_motion.recorded.times import Times, common_times, named_time, times_of


@pytest.mark.parametrize(
    ('name', 'time'),
    [
        ('2024-07-12__14-07-48__torqueramp__conic 1pre1.csv', (2024, 7, 12, 14, 7, 48)),
        ('rosbag2_2024_07_12-14_07_48', (2024, 7, 12, 14, 7, 48)),
        ('ramps-20240712T140748.csv', (2024, 7, 12, 14, 7, 48)),
        ('0712_1407_conic_1pre1.csv', (2000, 7, 12, 14, 7, 0)),
        ('0229_0001.csv', (2000, 2, 29, 0, 1, 0)),
        ('9999_9999_then_0712_1407.csv', (2000, 7, 12, 14, 7, 0)),
        ('conic_onyx_preload_1_position_1.csv', None),
        ('serial_123456789_0712.csv', None),
        ('1332_1407.csv', None),
    ],
)
def test_time_in_a_name(name, time):
    assert named_time(name) == (time and datetime(*time, tzinfo=UTC).timestamp())


@pytest.mark.parametrize(
    ('column', 'first', 'recorded'),
    [
        ('time', 1.7e9, 1.7e9),
        ('Stamp [ns]', 1.7e18, 1.7e9),
        ('t_ms', 1.7e12, 1.7e9),
        ('time', 12.5, None),
        ('angle', 1.7e9, None),
        ('time', float('nan'), None),
    ],
)
def test_time_of_a_csv(tmp_path, column, first, recorded):
    path = write_csv(tmp_path / 'x.csv', torque=[1.0, 2.0], **{column: [first, first]})
    os.utime(path, (1.6e9, 1.6e9))
    assert times_of(path) == Times(recorded and pytest.approx(recorded), None, 1.6e9)


def test_time_of_a_bag(tmp_path):
    path = write_recording(tmp_path / 'bag', Samples([17 * 10**17, 18 * 10**17], [0.0, 1.0]))
    assert times_of(path).recorded == pytest.approx(1.7e9)


@pytest.mark.parametrize('content', [b'', b'time\n', b'time,angle\n\n', b'\xff\xfe', b'time\nx\n'])
def test_files_without_a_time(tmp_path, content):
    path = tmp_path / 'x.csv'
    path.write_bytes(content)
    assert times_of(path).recorded is None


def test_the_first_source_that_dates_all_recordings_counts():
    both, named = Times(3.0, 30.0, 300.0), Times(None, 10.0, 100.0)
    assert common_times([both, both])[0] == [3.0, 3.0]
    assert common_times([both, named]) == ([30.0, 10.0], 'the times in their names')
    times, source = common_times([both, named, Times(None, None, 200.0)])
    assert times == [300.0, 100.0, 200.0]
    assert 'copying' in source
