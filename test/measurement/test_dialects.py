# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Tables as benches write them: each is read as without its fault, or refused."""

import argparse
import json
import math
import re
import shlex
from dataclasses import replace
from datetime import UTC, datetime, timedelta
from fractions import Fraction
from functools import cache
from time import process_time

import numpy as np
import pytest
from scipy.integrate import trapezoid

from gear_kinematics.bag import BagError
from gear_kinematics.commands.encoders import add_recordings, say_columns, sources
from gear_kinematics.measurement import dialects
from gear_kinematics.measurement.cells import weight
from gear_kinematics.measurement.columns import Sources
from gear_kinematics.measurement.lost_motion import measure
from gear_kinematics.measurement.reading import read
from gear_kinematics.measurement.recording import RecordingError
from gear_kinematics.measurement.sentences import Observation
from gear_kinematics.measurement.tables import read_rotor, read_table
from gear_kinematics.measurement.texts import plainer

ARCMIN = math.radians(1.0 / 60.0)


@pytest.fixture
def gear(config):
    return replace(config, gear_ratio='-30')


@pytest.fixture
def table(shared_path):
    return lambda name: shared_path(f'data/faults/file_{name}.csv')


def assert_measured(recording, gear):
    """The figures of both reference files, which their README states."""
    measured = measure(recording, gear)
    if recording.encoders is None:
        hysteresis = measured.figures.hysteresis.value
        assert hysteresis == pytest.approx(13.8 * ARCMIN, abs=0.3 * ARCMIN)
    else:
        assert not measured.wrong_ratio
        lost = measured.transmission.lost_motion.value
        assert lost == pytest.approx(18.0 * ARCMIN, abs=0.6 * ARCMIN)


def assert_followed(both):
    """The lost motion of encoders read at once: `measure` takes a hundred times as long."""
    rotor = both.at_measured(both.rotor.turned)
    behind, speed = np.unwrap(both.measured + rotor / 30.0), np.gradient(rotor)
    fast = 0.5 * np.max(np.abs(speed))
    lost = np.median(behind[speed > fast]) - np.median(behind[speed < -fast])
    assert lost == pytest.approx(18.0 * ARCMIN, abs=0.6 * ARCMIN)


@pytest.mark.parametrize(
    ('name', 'given', 'rows'),
    [
        ('0_reference_ramps', {}, None),
        ('comment_lines', {}, None),
        ('decimal_comma', {}, None),
        ('last_line_cut', {}, None),
        ('trailing_separators', {}, None),
        ('units_in_second_row', {}, None),
        ('word_degrees', {'angle': 'angle_degrees', 'torque': 'torque_Nmm'}, None),
        ('motor_side', {}, None),
        ('0_reference_encoders', {}, 1320),
        ('time_in_ms', {}, 1320),
        ('rotor_wraps', {}, 1320),
        ('time_in_iso8601', {}, 1199),
        ('one_row_out_of_order', {}, 1319),
        ('index_in_brackets', {'rotor': 'position[0]', 'output': 'position[1]'}, 1320),
        ('degrees_without_unit', {'unit': 'deg'}, 1320),
    ],
)
def test_files_in_other_dialects(table, gear, name, given, rows):
    recording = read(table(name), gear, Sources(**given))
    assert_measured(recording, gear)
    assert rows in {recording.rows, None}
    on_rotor = [text for text in recording.columns if ' of the rotor [' in text]
    assert len(on_rotor) == 2 * (name == 'motor_side')


def test_times_in_iso_8601(table, gear):
    both = read(table('time_in_iso8601'), gear).both
    # The file has a sample each 40 ms.
    np.testing.assert_allclose(both.seconds, 0.04 * np.arange(len(both.seconds)), atol=1e-6)


# The reference files written otherwise


def in_german(text):
    return text.translate(str.maketrans('.,', ',.'))


DEG, REV = 180.0 / math.pi, 0.5 / math.pi
NAMES = 'time,rotor,output'
NOON = datetime(2026, 11, 26, 11, 59, 40, tzinfo=UTC)
WITH_DEG = 'time_s;rotor_deg;output_deg'


def written(columns, head, form='{:.2f}', mark=','):
    """Rows of columns below a head, separated by a mark; each has a form, or the first has it."""
    forms = form if isinstance(form, (list, tuple)) else [form, *['{:.5f}'] * (len(columns) - 1)]
    forms = [one.format if isinstance(one, str) else one for one in forms]
    rows = zip(*columns, strict=True)
    lines = (mark.join(one(v) for one, v in zip(forms, row, strict=True)) for row in rows)
    return head + '\n' * bool(head) + '\n'.join(lines) + '\n'


def in_counts(*angles):
    return np.round(np.array(angles) * REV * 4096)


def plain(head=NAMES, mark=',', time='{:.2f}', *, unit=1.0, angle=1.0, german=False, code='utf-8'):
    """A row for each moment: its time and the angles of the rotor and the output, in units."""

    def in_bytes(t, r, o):
        content = written([t * unit, r * angle, o * angle], head, time, mark)
        return (in_german(content) if german else content).encode(code)

    return in_bytes


def moment(mark='T', zone='', decimals='.'):
    start = datetime(2026, 11, 26, 9, tzinfo=UTC).replace(tzinfo=None)
    return lambda seconds: (
        (start + timedelta(seconds=seconds)).isoformat(mark, 'microseconds') + zone
    ).replace('.', decimals)


def in_zephyr(t):
    whole = moment()(t)[11:]
    return f'{whole[:-3]},{whole[-3:]}'


def clock(form, hours=0):
    """The time of the day, in a form of strftime; it begins before noon or hours later."""
    return lambda seconds: (NOON + timedelta(hours=hours, seconds=seconds)).strftime(form)


def grouped(mark, decimals='.'):
    marks = str.maketrans(',.', mark + decimals)
    return lambda value: f'{value:,.3f}'.translate(marks)


def split_time(t):
    return np.floor(t) + 1764230000, np.round(t % 1.0 * 1e9)


def moved(t, *rows_and_times):
    t = t.copy()
    for row, time in rows_and_times:
        t[row] = time
    return t


ENCODERS = {
    'semicolons': plain('time;rotor;output', ';'),
    'spaces': plain('time  rotor output', '   '),
    'names in a comment': plain('# time, rotor, output', ' '),
    'names of two words': plain('Time (s)   Rotor angle (rad)   Output angle (rad)', ' '),
    'UTF-8 with BOM': plain(code='utf-8-sig'),
    'UTF-16': plain(code='utf-16'),
    'UTF-16 without BOM': plain(code='utf-16-le'),
    'UTF-16 of big endian': plain(code='utf-16-be'),
    'cp1252': plain('Prüfling 3\ntime,rotor [°],output [°]', angle=DEG, code='cp1252'),
    'CR LF': lambda t, r, o: written([t, r, o], NAMES).replace('\n', '\r\n'),
    'the newest row first': lambda t, r, o: written([t[::-1], r[::-1], o[::-1]], NAMES),
    'each row three times': lambda t, r, o: written(
        [np.repeat(one, 3) for one in (t, r, o)], NAMES),
    'readings held over four rows': lambda t, r, o: written(
        [0.01 * np.arange(4 * len(t)), np.repeat(r, 4), np.repeat(o, 4)], NAMES),
    'the output held over four rows': lambda t, r, o: written(
        [f := 0.01 * np.arange(4 * len(t)), np.interp(f, t, r), np.repeat(o, 4)], NAMES),
    'the output held over four rows, without times': lambda t, r, o: written(
        [np.interp(0.01 * np.arange(4 * len(t)), t, r), np.repeat(o, 4)], 'rotor,output'),
    'rows by the angle of the output': lambda t, r, o: written(
        [column[np.argsort(o)] for column in (t, r, o)], NAMES),
    'the newest date first': lambda t, r, o: written(
        [t[::-1], r[::-1], o[::-1]], 'Zeitstempel,rotor,output', moment()),
    'a colon before milliseconds': plain(time=lambda v: ':'.join(moment(' ')(v).rsplit('.', 1))),
    'zeros after a crash': lambda t, r, o: (
        written([t, r, o], 'Date/Time,rotor,output') + 900 * '\0'),
    'decimal comma and spaces': plain('time rotor output', ' ', german=True),
    'decimal comma in quotes': lambda t, r, o: written(
        [t, r, o], NAMES, 3 * [lambda v: f'"{v:.5f}"'.replace('.', ',')]),
    'thousands by comma, in quotes': lambda t, r, o: written(
        [t, r * DEG, o * DEG], WITH_DEG.replace(';', ','), 3 * [lambda v: f'"{v:,.3f}"']),
    'thousands by comma, and decimals below 1000': lambda t, r, o: written(
        [t, r * 1e3, o], 'time,rotor [mrad],output [rad]',
        ('{:.2f}', lambda v: f'"{v:,.0f}"' if abs(v) >= 999.5 else f'{v:.1f}', '{:.5f}')),
    'thousands by point': lambda t, r, o: written(
        [t, r * DEG, o * DEG], WITH_DEG, 3 * [grouped('.', ',')], ';'),
    'thousands by space': lambda t, r, o: written(
        [t, r * DEG, o * DEG], WITH_DEG, 3 * [grouped('\u202f', ',')], ';'),
    'thousands as in Switzerland': lambda t, r, o: written(
        [t, r * DEG, o * DEG], WITH_DEG, ['{:.2f}', grouped('\u2019'), grouped("'")], ';'),
    'turns beside the angle within them': lambda t, r, o: written(
        [t, np.floor(r * REV), r * DEG % 360.0, o * DEG],
        'time,motor_turns,motor_angle_deg,output_deg', ('{:.2f}', '{:.0f}', '{:.5f}', '{:.5f}')),
    'units in cells': lambda t, r, o: written(
        [t, r * DEG, o * DEG], NAMES, ('{:.2f} s', '{:.4f} °', '{:.4f}deg')),
    'numbers and arrays of Python': lambda t, r, o: 'time,name,position\n' + ''.join(
        f'np.float64({at:.2f}),"[\'m1\', \'out\']","array(\'d\', [{rotor:.5f}, {out:.5f}])"\n'
        for at, rotor, out in zip(t, r, o, strict=True)),
    'a row of sums': lambda t, r, o: written([t, r, o], NAMES) + f'{sum(t)},{sum(r)},{sum(o)}\n',
    'rows of the sums and the means': lambda t, r, o: written([t, r, o], NAMES) + written(
        np.transpose([[sum(one), np.mean(one)] for one in (t, r, o)]), '', '{:.5f}'),
    'rows of ranges and of root mean squares': lambda t, r, o: written(
        [t, r, o], NAMES) + written(
        np.transpose([[np.ptp(k), np.hypot(np.mean(k), np.std(k))] for k in (t, r, o)]), ''),
    'seconds of the day': plain('time_of_day,rotor,output', time=lambda v: f'{v + 32400.0:.2f}'),
    'Serial Studio': plain('RX Date/Time,rotor,output',
        time=lambda v: moment(' ')(v)[:-3].replace('-', '/').replace('.', '::')),
    'a log of TwinCAT': plain(time=moment('-')),
    'a zone behind a space': plain(time=moment(' ', ' +0100')),
    'CoolTerm': lambda t, r, o: '2026-11-26 08:59:59.960 rotor,output\n' + ''.join(
        f'{moment(" ")(at)[:-3]} {rotor:.5f},{out:.5f}\n'
        for at, rotor, out in zip(t, r, o, strict=True)),
    'sep=': plain('sep=;\ntime;rotor;output', ';', german=True),
    'meta lines': plain(f'Bench 3\nRate,100,Hz\n\ndevice,SN,fw\nA,17,2.1\n{NAMES}'),
    'stamps of Tera Term, and a footer': lambda t, r, o: (
        written([t, t, r, o], '[26 Nov 2026 9:59:40.000] time,rotor,output', (
            lambda v: f'[{moment()(v)[:-3]}]', ' {:.2f}', '{:.5f}', '{:.5f}')).replace('],', ']')
        + 'Min,-99,-9\nMax,99,9\n'),
    'old stamps of Tera Term': lambda t, r, o: written(
        [t, r, o], '[Thu Nov 26 09:59:39.000 2026] rotor,output', (
            lambda v: f'[Thu Nov 26 {moment()(v)[11:-3]} 2026]', '{:.5f}', '{:.5f}'
        )).replace('],', '] '),
    'stamps of the Arduino IDE alone': lambda t, r, o: written(
        [t, r, o], '09:59:40.000 -> rotor,output', (
            lambda v: f'{moment()(v)[11:-3]} ->', '{:.5f}', '{:.5f}')).replace('>,', '> '),
    'the log of Python': lambda t, r, o: written(
        [t, r, o], '2026-11-26 09:59:40,000 - b2.arm - INFO - rotor,output', (
            lambda v: f'{moment(" ", decimals=",")(v)[:-3]} - b2.arm - INFO -', '{:.5f}', '{:.5f}')
        ).replace('-,', '- '),
    'the log of Python, with a label before each number': lambda t, r, o: written(
        [t, r, o], '', (
            lambda v: f'{moment(" ", decimals=",")(v)[:-3]} DEBUG: rotor:', '{:.5f}',
            ' output: {:.5f}')).replace('rotor:,', 'rotor: '),
    'the log of ROS': lambda t, r, o: written(
        [t, r, o], '[INFO] [1790000000.000000000] [bench]: rotor;output', (
            lambda v: f'[INFO] [{v + 1.79e9:.9f}] [bench]:', '{:.5f}', '{:.5f}'), ';'
        ).replace(':;', ': '),
    'the log of ESP-IDF': lambda t, r, o: written(
        [t, r, o], 'I (300) bench: rotor,output', (
            lambda v: f'I ({300 + 1e3 * v:.0f}) bench:', '{:.5f}', '{:.5f}')
        ).replace(':,', ': '),
    'the log of Zephyr': lambda t, r, o: written(
        [t, r, o], '[00:00:00.000,000] <inf> bench: rotor,output', (
            lambda v: f'[{in_zephyr(v)}] <inf> bench:', '{:.5f}', '{:.5f}')).replace(':,', ': '),
    'the log of Zephyr in colours, with labels': lambda t, r, o: written(
        [t, r, o], '*** Booting Zephyr OS ***', (
            lambda v: f'[{in_zephyr(v)}] \x1b[0m<inf> bench: ', 'motor={:.5f}',
            'output={:.5f}\x1b[0m'), ' '),
    'the log of spdlog': lambda t, r, o: written(
        [t, r, o], '[2026-11-26 09:59:40.000] [bench] [info] rotor;output', (
            lambda v: f'[{moment(" ")(v)[:-3]}] [bench] [info]', '{:.5f}', '{:.5f}'), ';'
        ).replace('];', '] '),
    'the journal of systemd': lambda t, r, o: written(
        [t, r, o], 'Nov 26 09:59:40.000000 pi4 bench[812]: rotor,output', (
            lambda v: f'Nov 26 {moment()(v)[11:]} pi4 bench[812]:', '{:.5f}', '{:.5f}')
        ).replace(':,', ': '),
    'the journal of systemd, with labels and other lines': lambda t, r, o: written(
        [t, r, o], '-- Journal begins at Thu 2026-11-26 09:00:00 CET. --', (
            lambda v: f'{moment()(v)}+0100 pi4 bench[812]: temperature: 31\n'
            f'{moment()(v)}+0100 pi4 bench[812]: state=on', 'motor={:.5f}', 'output={:.5f}'), ' '),
    'levels alone': lambda t, r, o: written(
        [t, r, o], '[INFO] t,rotor,output', ('[INFO] {:.2f}', '{:.5f}', '{:.5f}')),
    'levels alone, with labels and decimal commas': lambda t, r, o: in_german(written(
        [t, r, o], '', ('[INFO] t={:.2f};', 'motor={:.5f};', 'output={:.5f}; state: 3a'), ' ')),
    'Teleplot': lambda t, r, o: written(
        [t * 1e3, r * DEG, t * 1e3, o * DEG], '', (
            '>motor:{:.0f}', '{:.5f}§deg|g\nready\n>output', '{:.0f}', '{:.5f}§deg|g'), ':'),
    'Portuguese': plain(
        'Tempo (s);Ângulo do motor (graus);Posição da saída (graus)', ';', angle=DEG, german=True),
    'labels in a column of notes': lambda t, r, o: written(
        [t, r, o], f'{NAMES},note', ('{:.2f}', '{:.5f}', '{:.5f},a: 1 b: 2')),
    'labels in a column of notes behind a date and a state': lambda t, r, o: written([t, r, o, t],
        f'{NAMES},state,note', (moment(), '{:.5f}', '{:.5f}', lambda v: (
            f'{"rest" if v < 9.0 else "run"},a: 1 b: 2'))),
    'labels behind the time of the day': lambda t, r, o: written([t, r, o], 'start', (
        clock('%H:%M:%S,%f'), 'motor={:.5f}', 'output={:.5f}'), ' '),
    'a label before each number': lambda t, r, o: written(
        [t * 1e3, r, o], '', ('t_ms:{:.0f}', 'motor: {:.5f}', 'output={:.5f}'), '\t'),
    'labels behind stamps of the Arduino IDE': lambda t, r, o: written(
        [t, r, o], '', (lambda v: f'{moment()(v)[11:-3]} -> motor:0', '{:.5f}', '{:.5f}')
        ).replace('motor:0,', 'motor:').replace(',', ',output:'),
    'milliseconds in a column of their own': lambda t, r, o: written(
        [t, t, r, o], 'Number,Date&Time,ms,Motor angle,Output angle\nNO.,Time,ms,rad,rad', (
            lambda v: f'7,{moment(" ")(v)[:19]}', lambda v: moment()(v)[20:23],
            '{:.5f}', '{:.5f}')),
    'tv_sec and tv_usec, below the least values': lambda t, r, o: written(
        [*split_time(t), r, o], 'tv_sec,tv_nsec,rotor,output\nMin,0,-219.1,-9.2',
        2 * ['{:.0f}'] + 2 * ['{:.5f}']),
    'comments and names again in the body': lambda t, r, o: (
        written([t[:600], r[:600], o[:600]], f'// bench\n{NAMES}') + f'# paused\n\n{NAMES}\n'
        + written([t[600:], r[600:], o[600:]], '')),
    'units in a row': plain(
        'Unit 7,x\nTime,MotorPosition,LoadPosition\n[ms],°,(deg)', angle=DEG, unit=1e3),
    'empty and repeated names': lambda t, r, o: written(
        [t, r, t, o, t, t], ',rotor,time,output,note,note', '{:.5f}'),
    'trailing separators in rows alone': lambda t, r, o: written(
        [t, r, o], NAMES, ('{:.2f}', '{:.5f}', '{:.5f},')),
    'a word between German numbers, without times': lambda t, r, o: in_german(written(
        [r, t, o], 'Motor [rad];Modus;Abtrieb [rad]', ('{:.7f}', lambda _: 'an', '{:.7f}'), ';')),
    'commas in names behind spaces': lambda t, r, o: written(
        [t / 60.0, r * DEG, o * DEG], '"Timestamp, min", "Rotor, deg", "Output, deg"',
        3 * ['{:.7f}'], ', '),
    'a comma before units': plain('Time, ms, Rotor, deg, Output, deg', angle=DEG, unit=1e3),
    'a form of times as unit': plain('Time (HH:MM:SS.fff),rotor,output', time=clock('%X.%f')),
    'a joint with a state': plain('/joint_states/t,/motor/state/position,/joint/state/position'),
    'CamelCase': plain('TimeMs,MotorAngleDeg,OutputAngleDeg', angle=DEG, unit=1e3),
    'time in µs': plain(unit=1e6),
    'ms of the day': lambda t, r, o: written(
        [t * 1e3 + 3e7, r * DEG, o * DEG], 'ms_today;motor_pos_deg;output_pos_deg', mark=';'),
    'ms with jitter': lambda t, r, o: written([t * 1e3 + 0.1 * np.sin(9.0 * t), r, o], NAMES),
    'ms since 1970': lambda t, r, o: written([t * 1e3 + 1764230000e3, r, o], NAMES),
    'rostopic echo -p': lambda t, r, o: written(
        [np.round(t * 1e9).astype(int) + 1764230000 * 10**9, r, o],
        '%time,field.rotor_position,field.output_position', '{}'),
    'ISO 8601 with a zone': plain('pi_time,rotor,output', time=moment(zone='+01:00')),
    'dates with a decimal comma': plain('time;rotor;output', ';', time=moment(' '), german=True),
    'dates of the month first, in the afternoon': plain(
        time=clock('%m/%d/%Y %-I:%M:%S.%f %p', hours=2)),
    '12 hours, over noon': plain(time=clock('%I:%M:%S.%f %p')),
    'minutes and seconds': plain(time=lambda v: moment(' ')(v)[14:]),
    'dates of two digits': plain(
        'time;rotor;output', ';', time=clock('%d,%m,%y %H:%M:%S.%f'), german=True),
    'days of a workbook': lambda t, r, o: written([46352.4 + t / 86400.0, r, o], NAMES, '{:.11f}'),
    'index of pandas': lambda t, r, o: written(
        [t, r * 1e6, o * REV * 1e3], ',rotor_urad,output_mrev', moment(' ')),
    'tuples of bagpy, and a short row': lambda t, r, o: (
        'Time,header.seq,name,position,velocity\n' + ''.join(
        f'{at:.6f},7,"(\'m1\', \'out\')","({rotor:.5f}, {out:.5f})",()\n' + '1,7\n' * (k == 9)
        for k, (at, rotor, out) in enumerate(zip(t + 1.79e9, r, o, strict=True)))),
    'arrays of numpy, and feedback': lambda t, r, o: written(
        [t, r * DEG, o * DEG], 't,MotorPosFb(deg),LoadPos/ave (deg)',
        ('{:.2f}', '[{:.5f}]', '{:.5f}')),
    'time of the day': plain(time=lambda v: moment(' ')(v)[11:]),
    'seconds and nanoseconds': lambda t, r, o: written(
        [*split_time(t), r, o], 'header.stamp.sec,header.stamp.nanosec,rotor,output',
        ('{:.0f}', '{:.0f}', '{:.5f}', '{:.5f}')),
    'ros2 topic echo with velocity and effort': lambda t, r, o: written([*split_time(t), r, o], '',
        ('{:.0f}', '{:.0f},base,motor,joint', '{:.5f}', '{:.5f},0.1,0.2,0.0,0.0')),
    'a row for each value': lambda t, r, o: 'elapsed time,receive time,topic,value\n' + ''.join(
        f'{at:.2f},{at + 1764230000:.2f},/{topic}.position[0],{value:.5f}\n'
        for topic, values in (('rotor_state', r), ('output_encoder', o))
        for at, value in zip(t, values, strict=True)),
    'never in one row': lambda t, r, o: '__time,/output/position,/x,/rotor/position\n' + ''.join(
        f'{at:.4f},,,{rotor:.5f}\n{at + 5e-4:.4f},{out:.5f},,\n{at + 6e-4:.4f},,1,\n'
        for at, rotor, out in zip(t, r, o, strict=True)),
    'gaps filled with the values before': lambda t, r, o: '__time,/rotor/pos,/output/pos\n'
        + ''.join(f'{at:.4f},{rotor:.5f},{before:.5f}\n{at + 5e-4:.4f},{rotor:.5f},{out:.5f}\n'
        for at, rotor, before, out in zip(t, r, np.append(np.nan, o[:-1]), o, strict=True)),
    'TwinCAT with commas': lambda t, r, o: written([t * 1e3, r * DEG, t * 1e3, o * DEG],
        'Name,Scope\nFile,a.csv\n\nName,Motor.Pos,Name,Output.Pos\nSymbolComment,,SymbolComment,'
        '\nSampleTime[ms],40,SampleTime[ms],40\nUnit,° (Degree),Unit,° (Degree)\n',
        4 * ['{:.4f}']) + 'EOF\n',
    'TwinCAT, whose channels share their times': lambda t, r, o: written(
        [t * 1e3, t, r * DEG, t * 1e3, o * DEG],
        'Name,Scope\nFile,a.csv\n\nName,Mode,Motor.Pos,Name,Output.Pos\nData-Type,INT16,REAL64,'
        'Data-Type,REAL64\nSampleTime[ms],40,40,SampleTime[ms],40\nUnit,(None),° (Degree),Unit,'
        '° (Degree)\nUnit Offset,0,0,Unit Offset,0\n', 5 * ['{:.4f}']),
    'TwinCAT, whose channels all have the same times': lambda t, r, o: written(
        [t * 1e3, r * DEG, o * DEG],
        'Name\tScope\nFile\ta.csv\n\nName\tMotor.Pos\tOutput.Pos\nSampleTime[ms]\t40\t40\nUnit\t'
        '° (Degree)\t° (Degree)\nUnit Offset\t0\t0\n', 3 * ['{:.4f}'], '\t'),
    'wraps at 180°': lambda t, r, o: written(
        [t, (r * DEG + 180.0) % 360.0 - 180.0, (o * DEG) % 360.0], WITH_DEG.replace(';', ',')),
    'wraps at one turn': lambda t, r, o: written(
        [t, r * REV % 1.0, o * REV], 'time,rotor_rev,output_rev', 3 * ['{:.7f}']),
    'names above names': lambda t, r, o: written(
        [t, r * DEG, r, o * DEG], ',Motor,,Load\nt (s),Angle (deg),Speed (rad/s),Angle (deg)',
        '{:.5f}'),
    'the same names above names': lambda t, r, o: written(
        [t, r * DEG, r, o * DEG, o], 'PC,Motor,Motor,Load,Load\nt (s),'
        'Angle (deg),Speed (rad/s),Angle (deg),Speed (rad/s)', '{:.5f}'),
    'LabVIEW': plain('"A 5" shaft\nChannels\t2\nY_Unit_Label\tdeg\tdeg\t\n***End***\n'
        'X_Value\tMotor angle\tOutput angle\tComment', '\t', angle=DEG),
    'LabVIEW, with times of each channel': lambda t, r, o: written(
        [t, r * DEG, t, o * DEG], 'Channels\t2\t\t\t\nY_Unit_Label\tdeg\t\tdeg\n***End***\n'
        'X_Value\tMotor angle\tX_Value\tOutput angle\tComment', '{:.5f}', '\t'),
    'LabVIEW, without times': lambda t, r, o: written(
        [0 * t, r, o], 'X_Value\tMotor angle [rad]\tOutput angle [rad]\tComment',
        (lambda _: '', '{:.5f}', '{:.5f}'), '\t'),
    'times in ns beside those in s': lambda t, r, o: written(
        [t, 1e9 * t, r, o], 'time_s,time_ns,rotor,output',
        ('{:.2f}', '{:.0f}', '{:.5f}', '{:.5f}')),
    'dates in a column of seconds': lambda t, r, o: written(
        [t, r, o], 'time_s,rotor,output', (moment(), '{:.5f}', '{:.5f}')),
    'whole seconds, one of them missing, and their µs': lambda t, r, o: written(
        [np.where(t == t[7], np.nan, t // 1), 1e6 * (t % 1.0), r, o], 'sec,usec,rotor,output',
        ('{:.0f}', '{:.0f}', '{:.5f}', '{:.5f}')),
    'FAMOS, with Grad below the names': plain(
        'Zeit;Motorwinkel;Abtriebswinkel\ns;Grad;Grad', ';', '{:.5f}', angle=DEG, german=True),
    'French, with the day and the time in two columns': lambda t, r, o: written(
        [t, r * DEG, o * DEG], 'Date;Heure;Position moteur (deg);Position sortie (deg)',
        (lambda s: f'26/11/2026;{moment()(s)[11:]}', '{:.5f}', '{:.5f}'), ';'),
    'rosbag_to_csv, with an empty stamp': lambda t, r, o: written(
        [1e9 * t, t // 1, 1e9 * (t % 1.0), r, o], 'rosbagTimestamp,stamp,secs,nsecs,rotor,output',
        ('{:.0f},', '{:.0f}', '{:.0f}', '{:.5f}', '{:.5f}')),
    'Tektronix, with labels above its names': plain(
        'Model,MSO44\nHorizontal Units,s,,\n\nLabels,Motor angle,Output angle\nTIME,CH1,CH2'),
    'LabVIEW, with an interval in place of times': lambda t, r, o: written(
        [t, r, o], '\nSamples\t1320\t1320\nX_Dimension\tTime\tTime\nX0\t0.0\t0.0\n'
        'Delta_X\t0.040\t0.040\n***End***\nX_Value\tMotor angle\tOutput angle\tComment',
        (lambda _: '', '{:.5f}', '{:.5f}'), '\t'),
    'names behind a word, as their units are': plain(
        'Units;ms;deg;deg\ntime;rotor;output', ';', angle=DEG, unit=1e3),
    'units above names': plain('ms,deg,deg\ntime,rotor,output', angle=DEG, unit=1e3),
    'meta lines of three cells above names with units': plain(
        'bench,3,x\nTime (s),Rotor (deg),Output (deg)', angle=DEG),
    'a unit that is a machine': lambda t, r, o: 'unit,time,signal,value\n' + ''.join(
        f'B7,{at:.2f},rotor,{rotor:.5f}\nB7,{at:.2f},output,{out:.5f}\n'
        for at, rotor, out in zip(t, r, o, strict=True)),
    'an index called key, and a value of something else': lambda t, r, o: written(
        [range(len(t)), t, r, o, t], 'key,time,rotor,output,value',
        ('{:.0f}', '{:.2f}', '{:.5f}', '{:.5f}', '{:.1f}')),
    'a label, and a value of something else': lambda t, r, o: 'time,label,rotor,output,value\n'
    + ''.join(f'{at:.2f},{"up" if rotor > 0.0 else "down"},{rotor:.5f},{out:.5f},3\n'
              for at, rotor, out in zip(t, r, o, strict=True)),
    'a row for each value, with its unit': lambda t, r, o: 'Time,Signal,Value,Unit\n' + ''.join(
        f'{at:.2f},Motor angle,{rotor * REV:.7f},rev\n{at:.2f},Output angle,{out * DEG:.5f},deg\n'
        for at, rotor, out in zip(t, r, o, strict=True)),
    'texts among the values': lambda t, r, o: 'time,topic,value\n' + ''.join(
        f'{at:.2f},rotor,{rotor:.5f}\n{at:.2f},output,{out:.5f}\n{at:.2f},state,idle\n'
        for at, rotor, out in zip(t, r, o, strict=True)),
    'no stamps, of Foxglove': lambda t, r, o: (
        'elapsed time,receive time,header.stamp,topic,value\n' + ''.join(
        f'{at:.2f},{at + 1764230000:.2f},,/{topic}.data,{value:.5f}\n'
        for topic, values in (('MAIN.rotor', r), ('MAIN.output', o))
        for at, value in zip(t, values, strict=True))),
    'stamps of a few topics, of Foxglove': lambda t, r, o: 'header.stamp,topic,value\n' + ''.join(
        f'{at + 1764230000:.2f},/rotor,{rotor:.5f}\n{at + 1764230000:.2f},/output,{out:.5f}\n'
        f',/a/temperature,{at:.2f}\n,/b/temperature,{at:.2f}\n,/c/temperature,{at:.2f}\n'
        for at, rotor, out in zip(t, r, o, strict=True)),
    'slices and units of Foxglove': lambda t, r, o: 'timestamp,message path,value\n' + ''.join(
        f'{at + 1764230000:.2f},/{topic}.position[:]{{0}}@degrees,{DEG * value:.5f}\n'
        for topic, values in (('rotor', r), ('output', o))
        for at, value in zip(t, values, strict=True)),
    'JSON of a topic that others share': lambda t, r, o: (
        '_log_time_ns,_publish_time_ns,header.stamp,header.frame_id,name,position,effort\n'
        + ''.join(
            f'1,1,{round(at * 1e3)}000000,,"[""m1"", ""out""]","[{rotor:.5f}, {out:.5f}]",[]\n'
            f'1,1,{round(at * 1e3)}000001,,"[""finger""]",[0.5],[]\n'
            for at, rotor, out in zip(t + 1.79e9, r, o, strict=True))),
    'the output at every other moment of the rotor, and later': lambda t, r, o: (
        'time,rotor,output\n' + ''.join(
            f'{at:.2f},{rotor:.5f},{out:.5f}\n{at + 0.01:.2f},{ahead:.5f},\n'
            f'{at + 0.02:.2f},{0.5 * rotor + 0.5 * after:.5f},\n'
            for at, rotor, out, ahead, after in zip(
                t, r, o, 0.75 * r + 0.25 * np.append(r[1:], r[-1]), np.append(r[1:], r[-1]),
                strict=True))),
    'slices by the name of a joint': lambda t, r, o: 'receive time,topic,value\n' + ''.join(
        f'{at + 1764230000:.2f},/joint_states.position[:]{{name=="{joint}"}},{value:.5f}\n'
        for joint, values in (('motor', r), ('output', o))
        for at, value in zip(t, values, strict=True)),
    'InfluxDB': lambda t, r, o: '#default,_result,,,,\n,result,table,_time,_value,_field\n'
        + ''.join(f',,{table},{moment()(at)}Z,{value:.5f},{name}\n'
        for table, (name, values) in enumerate((('rotor', r), ('output', o)))
        for at, value in zip(t, values, strict=True)),
    'hours of MATLAB': plain(time='{:.7f} hr', unit=1.0 / 3600.0),
    'durations of polars': plain(time='PT{:.2f}S'),
    'durations of Python': plain(time=lambda v: f'"1 day, {timedelta(seconds=v)}"'),
    'serial dates of MATLAB': lambda t, r, o: written([740312.4 + t / 86400.0, r, o], NAMES,
                                                      ('{:.10f}', '{:.5f}', '{:.5f}')),
    'a trend of Rockwell': lambda t, r, o: written(
        [t, r, o], 'Trend,3\nHeader:,Date,Time,Msg.Motor [rad],Payload.Output [rad]',
        (lambda v: f'Data,11/26/2026,{moment(" ", decimals=";")(v)[11:-3]}', '{:.5f}', '{:.5f}')),
    'a date in place of a time': plain('Date,rotor,output', time=moment(' ')),
    'a whole day beside times of each side': lambda t, r, o: written(
        [t[:-1], r[:-1], t[1:], o[1:]], 'Date,motor_time,motor_pos,output_time,output_pos',
        ('26.11.2026,{:.2f}', *3 * ['{:.5f}'])),
    'fractional seconds of Keithley': lambda t, r, o: written(
        [t, t % 1.0, r, o], 'Date,Fractional Seconds,rotor,output',
        (lambda v: moment(' ')(v)[:19], '{:.6f}', '{:.5f}', '{:.5f}')),
    'names of columns above the name of the index': plain(
        'joint,motor,output\nquantity,position,position\ntime,,'),
    'exponents of Fortran': lambda t, r, o: written(
        [t, r, o], NAMES, lambda v: f'{v:.6E}'.replace('E', 'D')),
    'dates with names of months': plain(time=clock('%d-Nov-%Y %H:%M:%S.%f')),
    'Simulink, with times of each signal': lambda t, r, o: written(
        [t, r * DEG, t, o * DEG], 'time,motor angle,time,output angle\n'
        ',Units: deg,,Units: deg\n,Interp: linear,,Interp: linear', 2 * ['{:.16f}', '{:.5f}']),
    'INCA': plain('sampleCount\t1320\ntime\tMotorPos\\ETKC:1\tOutputPos\\ETKC:1\n'
        's\tdeg\tdeg\nf8\tf8\tf8', '\t', angle=DEG),
    'no units of angles above': plain(
        '# rev 3 at 25 degrees Celsius\n# heat in deg. C\n# two degrees-of-freedom\n'
        '# angles in rad, arm at 30 deg\n# 3 turns at 2 revolutions per minute\n'
        f'# pace in degrees per second\n{NAMES}'),
    'over midnight': plain(time=lambda v: moment(' ')(v + 15 * 3600 - 20)[11:]),
    'whole seconds': plain('time_s,rotor,output', time='{:.0f}'),
    'minutes': lambda t, r, o: written(
        [t / 60.0, r, o], 'time_min,rotor_rad,output_rad', 3 * ['{:.7f}']),
    'hours and minutes beside seconds': lambda t, r, o: written(
        [0 * t + 14, 0 * t + 7, t, r, r - 1, o],
        'hour,minute,second,motor position,motor position (min),output position', '{:.5f}'),
    'hours, and angles in German': lambda t, r, o: written(
        [t / 3600.0, r * DEG, o * DEG], 'Zeit [h];Winkel Motor [Grad];abtriebswinkel_grad',
        3 * ['{:.8f}'], ';'),
    'CODESYS': lambda t, r, o: '[key]; [value]\nName; App.Trace\nComment; "2; 5; 7\n' + ''.join(
        f'{k}.Variable; GVL.{name}\n{k}.Size; 8\n{k}.Data; \n'
        + ''.join(f'; {1e3 * at:.0f}; {v:.9g}\n' for at, v in zip(t, values, strict=True))
        for k, (name, values) in enumerate({'motorPos': r, 'oil': t, 'outputPos': o}.items())),
    'German': plain('Zeit [s];Winkel Antrieb [°];Winkel Abtrieb [°]', ';', angle=DEG, german=True),
    'catman': plain('T0 = 1\t\t\nZeit  1 - Standardmessrate [s]\tWinkel Motor [°]\t'
        'Winkel Abtrieb [°]\nAbtastrate: 25 Hz\t\t', '\t', angle=DEG, german=True),
    'psql': lambda t, r, o: written(
        [t, r, o], ' time  | rotor | output \n-------+-------+--------', mark=' | ')
        + '(1320 rows)\n',
    'French': plain('Temps [s];Angle moteur [°];Angle sortie [°]', ';', angle=DEG, german=True),
    'Italian': plain('Tempo [s];Angolo motore [°];Angolo uscita [°]', ';', angle=DEG),
    'words in one': plain('Uhrzeit [s];Motorwinkel [°];Abtriebswinkel [°]', ';', angle=DEG),
    'multiples in names': lambda t, r, o: written(
        [t, r * DEG * 100, o * DEG * 10], 'time,rotor_deg_x100,output_ddeg', 3 * ['{:.4f}']),
    'hexadecimal counts': lambda t, r, o: written(
        [t, *in_counts(r - r.min()).astype(int), o], 'time,rotor_counts,output_rad',
        ('{:.2f}', '{:06X}', '{:.5f}')),
    'hexadecimal counts, said': lambda t, r, o: written(
        [t, *in_counts(r - r.min()).astype(int), o], 'time,rotor_counts,output_rad',
        ('{:.2f}', '0x{:x}', '{:.5f}')),
    'hexadecimal numbers alone': lambda t, r, o: written(
        [t, *(1e3 * DEG * (np.array([r, o]) + 1e3)).astype(int)], 'time,rotor_mdeg,output_mdeg',
        ('{:.2f}', '0x{:08X}', '0x{:08X}')),
    'counts of as many digits, in arrays': lambda t, r, o: written(
        [t, *in_counts(r) + 500_000, o], 'time,rotor_counts,output_rad',
        ('{:.2f}', '[{:.0f}]', '{:.5f}')),
    'ISO dates in the afternoon': plain(time=clock('%Y-%m-%d %I:%M:%S.%f %p')),
    'TwinCAT with full timestamps': lambda t, r, o: written([column for one in (r, o)
         for column in (np.round(1e7 * t).astype(int) + 134_090_000_000_000_000, one * DEG)],
        'Name,Scope\nFile,a.csv\n\nName,Motor.Pos,Name,Output.Pos\nSampleTime[ms],40,'
        'SampleTime[ms],40\nUnit,deg,Unit,deg\n', 2 * ['{}', '{:.4f}']),
    'descriptions below units': plain(
        'Time,Input angle,Output angle\ns,deg,deg\nsample time,encoder 1,encoder 2', angle=DEG),
    'Siemens': lambda t, r, o: written([t, t * 1e3, r * DEG, o * DEG],
        'Time stamp\tRelative time\tMotor position\tLoad position\n\tms\t°\t°',
        clock('%d.%m.%Y %H:%M:%S.%f'), '\t'),
    'channels': plain('Time [s],CH1: Motor angle [deg],CH2: Output angle [deg]', angle=DEG),
    'motor and gear, as measured': plain(
        'time,/dynamic_joint_states/gear_motor/pos,gear_pos_meas'),
    'shafts': plain('time,motor_shaft_pos,output_shaft_pos'),
    'rotations': lambda t, r, o: written(
        [t, r * REV, o * REV], 'Timestamp,/Motor/PositionRotations,/Output/PositionRotations',
        3 * ['{:.7f}']),
    'rotation as a unit': lambda t, r, o: written(
        [t, r * REV, o * REV], 'Time,MotorPosition(Rotation),LoadPosition(Rotation)',
        3 * ['{:.7f}']),
    'times and temperatures in French and English': lambda t, r, o: written(
        [t, r, o, 40.0 + np.sin(t)], 'Temps;Angle moteur;Angle sortie;motor_temps', '{:.5f}', ';'),
    'negative numbers in brackets': lambda t, r, o: written(
        [t, r, o], NAMES, ('{:.2f}', *2 * [lambda v: f'({-v:.5f})' if v < 0 else f'{v:.5f}'])),
    'negative numbers in brackets, in German': lambda t, r, o: in_german(
        ENCODERS['negative numbers in brackets'](t, r, o).replace(',', ';')),
    'states of both sides': lambda t, r, o: written([t, t > 20.0, r, t > 30.0, np.sin(t), o],
        'time,motor_state,motor_pos,output,load,load_pos', '{:.5f}'),
    'units of other quantities': lambda t, r, o: written([40.0 + np.sin(t), t, r, r, o, o, t],
        'T,t,motor [°C],motor_pos,load [N],load_pos,output [V]', '{:.5f}'),
    'a word beside time': plain('robot_time,motor_ang,gearbox_ang'),
    'Chinese': lambda t, r, o: written(
        [t, r * DEG, o * DEG], '时间\uff08s\uff09,电机角度\uff08°\uff09,输出角度\uff08°\uff09'),
    'Chinese of Windows': plain('时间戳,电机编码器(deg),输出轴角度(deg)', angle=DEG, code='gbk'),
    'units in Chinese': plain('时间(毫秒),电机角度(度),输出角度(度)', angle=DEG, unit=1e3),
    'Korean of Windows': plain('시간(s),모터 각도(deg),출력축각도(deg)', angle=DEG, code='cp949'),
    'traditional Chinese': plain('時間,馬達位置(deg),輸出軸角度(deg)', angle=DEG, code='big5'),
    'Japanese of Windows': plain('時間,モータ位置[deg],出力軸角度[deg]', angle=DEG, code='cp932'),
    'Spanish, with line breaks': plain(
        '"Banco ""A"""\nTiempo;"Posición\r\nmotor\n[deg]";Posición salida [°]', ';', angle=DEG),
    'a row for each joint': lambda t, r, o: 'sec,nanosec,id,joint_name,position_deg\n' + ''.join(
        f'{at // 1:.0f},{at % 1 * 1e9:.0f},{k},{name},{value * DEG:.5f}\n'
        for at, *values in zip(t + 1.79e9, r, o, strict=True)
        for k, name, value in zip((11, 12), ('motor', 'output'), values, strict=True))
        + '-,-,11,motor,-\n',
    'counts of 16 bits': lambda t, r, o: written(
        [t, *in_counts(r) % 65536, o], 'time,rotor_counts,output_rad',
        ('{:.2f}', '{:.0f}', '{:.5f}')),
    'AdvantageScope': lambda t, r, o: 'Timestamp,Key,Value\n' + ''.join(
        f'{at:.2f},/Motor/Position,{rotor:.5f}\n{at:.2f},/Output/Position,{out:.5f}\n'
        for at, rotor, out in zip(t, r, o, strict=True)),
    'day first, over midnight': plain(time=clock('%d/%m/%Y %X.%f', hours=-492)),
    'times of a system': plain('unix_ms,rotor,output', unit=1e3),
    'R': plain('"time" "rotor" "output"', ' ', time=lambda v: f'"{v / 0.04 + 1.0:.0f}" {v:.2f}'),
    'days of pandas': plain(',rotor,output', time=lambda v: f'0 days 00:00:{v:09.6f}'),
    'times of each side': lambda t, r, o: written(
        [t[:-1], r[:-1], t[1:], o[1:]], 'motor_time,motor_pos,output_time,output_pos', '{:.5f}'),
    'times of each side in units of their own': lambda t, r, o: written(
        [t[:-1] * 1e3, r[:-1], t[1:], o[1:]], 'motor_time_ms,motor_pos,load_time_s,load_pos',
        '{:.5f}'),
    'ticks of .NET': lambda t, r, o: written(
        [np.round(t * 1e7).astype(int) + 639_157_824_000_000_000, r, o], NAMES, '{}'),
    'ticks of Windows': lambda t, r, o: written(
        [np.round(t * 1e7).astype(int) + 134_090_000_000_000_000, r, o], NAMES, '{}'),
    'ticks of 100 ns': lambda t, r, o: written(
        [np.round(t * 1e7).astype(int), r, o], 'Time [100ns],rotor,output', '{}'),
    'dates with spaces': plain(time=clock('%d Nov %Y %H:%M:%S.%f')),
    'a row from the future of one side': lambda t, r, o: written(
        [moved(t, (200, 40.0)), r, t, o], 'motor_time,motor_pos,output_time,output_pos', '{:.5f}'),
    'a repeated time': lambda t, r, o: written(
        [*np.pad([t, r], [(0, 0), (0, 1)], constant_values=np.nan),
         *np.pad([t, o], [(0, 0), (1, 0)], constant_values=np.nan)],
        'time,rotor,time.1,output', '{:.5f}').replace('nan', ''),
    'times of each side in short, with units': lambda t, r, o: written(
        [1e3 * t[1:], t[:-1], r[1:], o[:-1]], 't_m [ms],t_o [s],motor_pos,output_pos', '{:.5f}'),
    'times of each side in short': lambda t, r, o: written(
        [t[:-1], t[1:], r[:-1], o[1:]], 't_m,t_o,motor_pos,output_pos', '{:.5f}'),
    'temperatures of both sides': lambda t, r, o: written(
        [t, t / 2 + np.sin(t), r, t / 3 + np.sin(t), o], 'time,t_motor,motor_pos,t_output,out_pos',
        '{:.5f}'),
    'X of each side': lambda t, r, o: written(
        [t[1:], r[1:], t[:-1], o[:-1]], 'X,Motor [rad],X,Load [rad]', '{:.5f}'),
    'times of each side in groups': lambda t, r, o: written(
        [t[1:], r[1:], t[:-1], o[:-1]], 'Motor,,Load,\nTime (s),Angle (rad),Time (s),Angle (rad)',
        '{:.5f}'),
    'two rates, of catman': lambda t, r, o: written(
        [np.repeat(t, 2)[:-1] + 0.02 * (np.arange(2 * len(t) - 1) % 2),
         DEG * np.interp(np.arange(2 * len(t) - 1), 2.0 * np.arange(len(t)), r),
         np.append(t, np.nan + t[1:]), DEG * np.append(o, np.nan + o[1:])],
        'Zeit  1 - Schnelle Messrate [s];Winkel Motor [°];'
        'Zeit  2 - Standardmessrate [s];Winkel Abtrieb [°]', '{:.5f}', ';').replace('nan', ''),
    'a clock that begins again, twice': lambda t, r, o: written([t % 20.0, r, o], NAMES),
    'a row from the future': lambda t, r, o: written([moved(t, (200, 40.0)), r, o], NAMES),
    'rows from past and future': lambda t, r, o: written(
        [moved(t, (200, 40.0), (201, 40.0), (700, 1.0)), r, o], NAMES),
}  # fmt: skip
READ_IN_TURN = {'never in one row', 'gaps filled with the values before'}
RAMPS = {
    'a name that stays': lambda t, a, q: written(
        [t, t, a, q], 'time,name,angle,torque', ('{:.2f}', lambda _: 'Run A', '{:.6f}', '{:.6f}')),
    'labels of a footer in a column that is not read': lambda t, a, q: written(
        [range(len(t)), a, q], 'No.,angle [rad],torque [Nm]',
        (lambda k: f'"1,{k:03}"' if k % 3 else 'FF', '{:.6f}', '{:.5f}'))
        + f'MIN,{min(a)},{min(q)}\nMAX,{max(a)},{max(q)}\nAVG,{np.mean(a)},{np.mean(q)}\n',
    'N·cm': lambda t, a, q: written(
        [t, a * DEG, q * 100], 't,Angle [°],Torque', ['{:.2f}', '{:.6f}', '{:.5f} N·cm']),
    'dN·m': lambda t, a, q: written([t, a * 1e3, q * 10], 't,angle_millirad,torque_dNm', '{:.6f}'),
    'gf·cm': lambda t, a, q: written(
        [t, a * 1e6, q / 9.80665e-5], 't,angle [microrad],torque [gf.cm]', '{:.6f}'),
    'in-ozf': lambda t, a, q: written([t, a, q / 0.00706155], 't,angle,torque [in-ozf]', '{:.6f}'),
    'kg·cm': lambda t, a, q: written([t, a * DEG, q / 0.0980665], 't,angle_deg,torque_kgcm'),
    'lb-in': lambda t, a, q: written([t, a * DEG, q / 0.112985], 't,angle_deg,load [lb-in]'),
    'lbs': lambda t, a, q: written([t, a * DEG, q / 0.112985], 't,angle_deg,Torque (in-lbs)'),
    'oz-in behind a name': lambda t, a, q: written(
        [t, a * DEG / 0.9, q / 0.00706155], 't,angle_gon,torque_oz-in', 3 * ['{:.6f}']),
    'N·cm behind a name': lambda t, a, q: written(
        [t, a * DEG, q * 100], 'Time (s),Angular Position (deg),Torque N cm', 3 * ['{:.6f}']),
    'a torsion tester': lambda t, a, q: written(
        [a * DEG, q, t], 'Rotation (deg),Rotary Torque (N·m),Time (s)', 3 * ['{:.6f}']),
    'Drehwinkel and Moment': lambda t, a, q: in_german(written(
        [t, a * DEG, q], 'Zeit;Drehwinkel [°];Moment [Nm]', mark=';')),
    'torques in and out': lambda t, a, q: written(
        [t, a * DEG, q / -30, q * 1e3], 't,angle_deg,torque_in_Nm,torque_out_MilliNm', '{:.6f}'),
    'a symbol of torque, and kN·mm': lambda t, a, q: written(
        [t, a * 60 * DEG, q], 'time,phi [arc-min],Drehmoment M [kNmm]', 3 * ['{:.6f}']),
    'a torsion tester of MTS': lambda t, a, q: written(
        [t, a * DEG, 1e-3 * q, q / 0.112985, 1e-7 * q], 'Test: 20in-lb-return\n\n\n'
        'Time ,Torsional Angle ,Torsional Epsilon 3550 Torsion ,Torsional Torque ,Axial Epsilon\n'
        'sec,°,°,in·lbf,in', 5 * ['{:.6f}']),
    'a middle dot of Japanese': lambda t, a, q: written(
        [t, a * DEG, q * 1e3], '時間(s),ねじれ角(deg),トルク(mN・m)', 3 * ['{:.6f}']),
    'symbols alone': lambda t, a, q: written([t, a * DEG, q], 't,φ [°],M [Nm]', 3 * ['{:.6f}']),
    'N.m': lambda t, a, q: written([t, a * DEG, q], 't,angle [deg.],torque [N.m]'),
    'the motor in other units': lambda t, a, q: written(
        [t, a * -30 * DEG, q / -30 * 1e3], 'time,MotorPosition (deg),MotorTorque (mNm)'),
    'torques in two units': lambda t, a, q: written(
        [t, a, 20.0 * q, q, q], 'time,angle,Torque [%],Torque [Nm],motor [A]', 5 * ['{:.6f}']),
    'torques of motor and output': lambda t, a, q: written(
        [t, a, 0.01 * t, q], 'time,angle,motor_torque,output_torque', 4 * ['{:.6f}']),
    'units of which few are known': lambda t, a, q: written(
        [t, a * DEG, q / 0.00706155, t, t, t, t, t],
        'Time,Angle,Torque,Temp,U,I,P,n\ns,deg,ozf·in,°C,V,A,W,rpm', 8 * ['{:.6f}']),
    'Verdrehwinkel': lambda _, a, q: written(
        [q, a / ARCMIN], "Drehmoment [Nm];Verdrehwinkel [']", 2 * ['{:.6f}'], ';'),
    'a row of units in German': lambda t, a, q: in_german(written(
        [t, q, a * DEG], 'Zeit;Drehmoment;Winkel\ns;Nm;Grad', 3 * ['{:.6f}'], ';')),
    'what is desired and actual, abbreviated': lambda t, a, q: written(
        [t, 2.0 * q, 2.0 * a, q, a], 't,torDes,posDes,torAct,posAct', 5 * ['{:.6f}']),
    'τ and φ': lambda t, a, q: written([t, a, q], 't,φ,τ', 3 * ['{:.6f}']),
    'units in columns of their own': lambda t, a, q: written(
        [t, a * DEG, q * 1e3], 'Time,Angle,Units,Torque,Units',
        ('{:.2f}', '{:.6f},deg', '{:.3f},mNm')),
    'units behind other signs': lambda t, a, q: written(
        [t, a * DEG, q * 1e3], 'time=s,angle<deg>,扭矩（mNm）', 3 * ['{:.6f}']),
    'a symbol by DIN 1313': lambda t, a, q: written(
        [t, a * DEG, q], 't / s;φ / °;M / Nm', 3 * ['{:.6f}'], ';'),
    'moteus': lambda t, a, q: written(
        [t, a * REV, q, t], '# revolutions\n#time,position,torque,q_current', 4 * ['{:.9f}']),
    'time in ms': lambda t, a, q: written([t * 1e3, a, q], 'time,angle,torque', 3 * ['{:.6f}']),
    'torque at other times': lambda t, a, q: '__time,/angle,/torque\n' + ''.join(
        f'{at:.4f},{angle:.6f},\n{at + 1e-3:.4f},,{torque:.4f}\n'
        for at, angle, torque in zip(t, a, q, strict=True)),
}  # fmt: skip


@pytest.fixture(scope='module')
def reference(shared_path):
    @cache
    def columns(name):
        path = shared_path(f'data/faults/file_0_reference_{name}.csv')
        found = np.genfromtxt(path, delimiter=',', skip_header=1).T
        found.setflags(write=False)
        return found

    return columns


def saved(folder, content):
    path = folder / 'r.csv'
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    return path


@pytest.mark.parametrize('dialect', [*ENCODERS, *RAMPS])
def test_every_dialect_is_read(tmp_path, gear, reference, dialect):
    kind, dialects = ('ramps', RAMPS) if dialect in RAMPS else ('encoders', ENCODERS)
    path = saved(tmp_path, dialects[dialect](*reference(kind)))
    recording = read(path, gear, Sources(rotor_counts=4096 if 'counts' in dialect else None))
    if dialect in READ_IN_TURN:
        assert_measured(recording, gear)
    if kind == 'ramps':
        _, *true = reference(kind)
        for found, values in zip(
            (recording.locked.angle, recording.locked.torque), true, strict=True
        ):
            np.testing.assert_allclose(np.ptp(found), np.ptp(values), rtol=1e-3)
            shares = (0.2, 0.8)
            turned = np.quantile(found - found[0], shares)
            np.testing.assert_allclose(turned, np.quantile(values - values[0], shares), rtol=1e-2)
        # The area of the loops, to which angle and torque of each row contribute together.
        (a, q), locked = true, recording.locked
        area = (locked.angle[1:] @ np.diff(locked.torque)) / (a[1:] @ np.diff(q))
        assert area == pytest.approx(1.0, rel=0.02)
    if kind == 'encoders':
        both, (_, *angles) = recording.encoders, reference(kind)
        for found, true in zip((both.rotor.turned, both.measured), angles, strict=True):
            assert np.ptp(found) == pytest.approx(np.ptp(true), rel=1e-3)
        assert np.ptp(both.rotor.segment) == 0
        if dialect not in READ_IN_TURN:
            assert_followed(both)
        # All but the rows that are out of order or none, of which there are at most 3.
        assert 1317 <= recording.rows <= 1320
        duration = 0.0 if 'without times' in dialect else 52.76
        assert recording.encoders.duration == pytest.approx(duration, abs=1.1)


def test_a_long_cell_that_begins_as_a_number_is_judged_at_once():
    """In a time that rises with its square, it would take hours."""
    assert weight(500_000 * '1' + 'x', '.') == 0.0


@pytest.mark.parametrize('readings', [2, 7, 8, 10])
@pytest.mark.parametrize('form', ['{:.5f}', '{:.3f}'])
def test_means_of_counts_are_no_thousands(tmp_path, gear, reference, readings, form):
    t, r, o = reference('encoders')
    counts = np.round((r - r.min()) * REV * 20 * readings) / readings + 1.0
    assert 500.0 < counts.max() < 1000.0
    form = '{:.2f}', form, '{:.5f}'
    path = saved(tmp_path, written([t, counts, o], 'time,rotor_counts,output_rad', form))
    turned = read(path, gear, Sources(rotor_counts=20)).both.rotor.turned
    np.testing.assert_allclose(turned - turned[-1], r - r[-1], atol=1.01 * math.pi / 20.0)


def test_counts_that_a_driver_reads_without_their_sign_are_negative(tmp_path, gear, reference):
    # Dynamixel SDK 4.1.0 gives positions modulo 2^32.
    t, r, o = reference('encoders')
    (counts,) = in_counts(r - np.median(r))
    right, both = (
        read(
            saved(tmp_path, written([t, one, o], 'time,rotor_counts,output_rad')),
            gear, Sources(rotor_counts=4096),
        ).both
        for one in (counts, counts % 2**32)
    )  # fmt: skip
    assert np.ptp(np.sign(counts)) == 2.0
    np.testing.assert_allclose(both.rotor.turned, right.rotor.turned, rtol=0.0, atol=1e-8)
    np.testing.assert_array_equal(both.rotor.turns, right.rotor.turns)


@pytest.mark.parametrize(
    ('written_as', 'cause'),
    [
        (lambda t, r, o: written([10 * t, r * DEG, o * DEG], NAMES),
         'output differs from rotor by more than gears do in rad, as in degrees'),
        (lambda t, r, o: written([10 * t, r * DEG % 360.0, o * DEG], NAMES), 'turns of 360'),
        (lambda t, r, o: written([t, r * REV % 1.0, o * REV], NAMES), r'turns \(209 wraps at 1'),
        (lambda t, r, o: written([t, np.round(r * 1e4), o], NAMES), 'such as counts'),
        (lambda t, r, o: written([t, r * DEG, o], 'time,rotor_0.1deg,output'),
         'the unit 0.1deg is not known'),
        (lambda t, r, o: written([t, np.round(r * 1e4), o * DEG], 'time,rotor,output [deg]'),
         'such as counts: give its unit as in --rotor-column .rotor .counts.'),
        (lambda t, r, o: written([t, r, o], 'time,rotor [mil],output'), 'unit mil is not known'),
        (lambda t, r, o: written(
            [t, r * 1e3, o], 'time;rotor_counts;output_rad',
            ('{:.2f}', lambda v: f'{v:,.0f}'.replace(',', '.'), '{:.5f}'), ';'),
         'rotor_counts has three decimals or none, as if points divided'),
        (lambda t, r, o: written(
            [t * 1e3, r, o], 'time_ms;rotor_rad;output_rad',
            (lambda v: f'{v:,.0f}'.replace(',', '.'), '{:.5f}', '{:.5f}'), ';'),
         'time_ms has three decimals or none, as if points divided'),
        (lambda t, r, o: written(
            [t, r * 1e3 + 9e5, o], 'time,rotor_counts,output_rad  # three decimals',
            ('{:.2f}', lambda v: f'"{v / 1e3:.3f}"'.replace('.', ','), '{:.5f}')),
         'rotor_counts has three digits behind each comma'),
        (lambda t, r, o: written([t + 95_930.0 + 40.0 * (t >= 30.0), r, o], NAMES),
         'the times in time are hours, minutes and seconds'),
        (lambda t, r, o: written([25.0 * t, 10.0 * r, 10.0 * o], NAMES),
         r'times in time: steps of 1 do not tell'),
        (lambda t, r, o: written([t, r, o * DEG], 'time,rotor [rad],output'),
         r'output differs from rotor \[rad\] .* as in --output-column .output .deg'),
        (lambda t, r, o: written([t, r * DEG, o], 'time,rotor,output [rad]'), 'speeds of'),
        *((lambda t, r, o, step=step: written([25.0 * step * t, 1e-2 * r, 1e-2 * o], NAMES,
                                   ('{:.4f}', '{:.7f}', '{:.7f}')),
          f'steps of {step} do not tell') for step in (0.2, 0.9993)),
        (lambda t, r, o: written([40 + t, r, o], 'temps,rotor_rad,output_rad'),
         "temps: steps of 0.04 do not tell their unit: .* --time-column 'temps .ms.'"),
        (lambda t, r, o: written([t, r, o], 'time,input,output'), 'neither an angle and'),
        (lambda t, _, o: written([t, 1e-3 * o, o], 'time,angle,torque%'), 'neither an angle and'),
        (lambda t, _, o: written([t, 1e-3 * o, o], 'time,angle,torque [mA]'),
         r'torque \[mA\] is in ma: convert it to one of N·m, '),
        (lambda t, r, o: written([t, r, o], 'Horizontal Units,s,\nVertical Units,V,V\n'
                                 'Labels,Motor position,Output position\nTIME,CH1,CH2'),
         'Motor position is in v: convert it to one of rad'),
        (lambda t, _, o: written([t, 1e-3 * o, o], 'time,angle,torque_raw'), 'torque_raw is raw'),
        (lambda t, r, o: written([t, r * REV, o * REV], 'time,motor raw,output raw', '{:.5f}'),
         'motor raw is raw: give its unit with --angle-unit'),
        (lambda t, r, o: written([t, r * REV, o * DEG], 'time,motor (raw),output [deg]', '{:.5f}'),
         'raw: give its unit as in --rotor-column .motor .raw. .rev'),
        (lambda t, r, o: written([t, r, o], f'# angles in degrees, bench 3\n{NAMES}'),
         'rotor has no unit, and a line above the names says deg: give its unit'),
        (lambda t, r, o: written([t, r, o], f'# angles are in 0.1 deg\n{NAMES}'),
         'rotor has no unit, and a line above the names says deg: give its unit'),
        (lambda t, _, o: written([t, 1e-3 * o, o], 'time,angle,torque [MN·m]'), 'is not known'),
        (lambda t, _, o: written([t, 1e-3 * o, o], '# torque in lbf-in\ntime,angle,torque'),
         'torque has no unit, and a line above the names says lb·in: .*--torque-column'),
        (lambda t, r, o: written(
            [t, r, o], NAMES,
            ('{:.2f}', lambda v: f'{v:.3f} or so' if abs(v) > 5 else '7', '{:.5f}')),
         'no usable rows: none has numbers such as -12.5 in all of rotor, output'),
        (lambda t, r, o: written([t, r, o], NAMES, (
            '{:.2f}', lambda v: f'{v:.3f} rad' if v < -5 else f'{v * 1e3:.0f} mrad', '{:.5f}')),
         'no usable rows: none has numbers such as -12.5 in all of rotor, output'),
        (lambda t, r, o: written(
            [t, r, o], 'time,rotor_rad,output', ('{:.2f}', '{:.4f} deg', '{:.5f}')),
         'rotor_rad is in rad by its name, and in deg by its cells'),
        (lambda t, r, o: written([t, r, o], NAMES, '26.11.2026 {:.0f}'),
         'the times in time: no numbers nor ISO 8601'),
        (lambda t, r, o: written([t, r, o], NAMES, '2026-13-26 09:{:05.2f}'),
         'the times in time: no numbers nor ISO 8601'),
        (lambda t, r, o: written([25 * t, r / 3, o / 3], 'T,rotor,output'),
         'the times in T: steps of 1 do not tell their unit: .* --time-column .T .ms'),
        (lambda t, *_: written([1e18 + 25 * t, t / 400, t / 400], NAMES),
         r'steps of \d+ do not tell their unit'),
        (lambda t, r, o: written([0 * t, r, o], NAMES), 'the times in time: they stand still'),
        (lambda t, r, o: written([t, r, o], NAMES, '{:.0f}. Nov'), 'no numbers nor ISO 8601'),
        *((lambda t, r, o, a=a, b=b: written([a * t, r, b * t, o],
           'motor_time,motor_rad,output_time,output_rad', '{:.5f}'), 'as in another unit: convert')
          for a, b in [(1.0, 1e3), (1e3, 1.0), (1.0, 1e6), (1e9, 1.0)]),
        (lambda t, r, o: written([t, r, o], NAMES).translate(str.maketrans('.', ',')),
         'rows of 6 cells are below 3 names: .*: write a name for each cell, and decimal points'),
        (lambda t, r, o: written([t, r, o], 'time rotor angle output angle', mark=' '),
         'rows of 3 cells are below 5 names'),
        (lambda t, _, o: written([t, 0.4 * np.sin(t), o], 'time,angle,torque'),
         'turns by 45.8° under torque'),
        (lambda t, _, o: written([t, 1e-3 * o, np.round(1e3 * o)], 'time,angle,torque'),
         'torque has whole numbers: give its unit as in --torque-column .torque .Nmm'),
        (lambda t, r, o: (written([t, r, o], 'time,rotor_rad,output_rad')
                          + written([t, o, r], 'time,output_rad,rotor_rad')),
         'output_rad goes on below as rotor_rad: divide the file there'),
        (lambda t, r, o: (written([t, r, o], 'time,rotor_rad,output_rad')
                          + written([t, r * DEG, o], 'time,rotor_deg,output_rad')),
         'rotor_rad goes on below as rotor_deg'),
        (lambda t, r, o: (written([t, r, o], 'time,rotor,output\ns,rad,rad')
                          + written([t, r * DEG, o * DEG], 'time,rotor,output\ns,deg,deg')),
         'output goes on below as deg'),
        (lambda t, r, o: written([t, r, t + 1.79e9, o], 'motor_time,motor_pos,output_time,output',
                                 '{:.5f}'), 'times of the rotor and of the output are never'),
        (lambda t, _, o: written([t, np.round(8 * o * REV), o], 't,shadow,Iq',
                                 ('{:.2f}', '{:.0f}', '{:.4f}')),
         'by --angle-column, --torque-column'),  # no current is proposed as an angle
        (lambda t, r, o: written([t, r, 1.5 * r, o], 'time,motor1_pos,motor2_pos,output_pos',
                                 '{:.5f}'), r'--rotor-column motor\d_pos --output-column output_'),
        *((lambda t, r, o, name=name: written([t, r, o], f'time,{name}1,{name}2', '{:.5f}'),
           f'--rotor-column {name}1 --output-column {name}2') for name in ('axis', 'J')),
        (lambda t, r, o: ''.join(
            written([t[:99], r[:99], o[:99]],
                    f'X_Dimension\tTime\tTime\nDelta_X\t{interval}\t{interval}\n***End***\n'
                    'X_Value\tMotor angle\tOutput angle\tComment',
                    (lambda _: '', '{:.5f}', '{:.5f}'), '\t') for interval in ('0.04', '0.04')),
         r'several segments, with unknown pauses: save it with times \(X values\)'),
        (lambda t, r, o: 'time,position\n' + ''.join(
            f'{at:.2f},"[{rotor:.5f}{f", {out:.5f}" if at > 45.0 else ""}]"\n'
            for at, rotor, out in zip(t, r, o, strict=True)),
         'neither an angle and a torque nor a rotor and an output'),
        ('{"t": 0.0, "rotor": 1.5}\n{"t": 0.1, "rotor": 1.6}\n', 'lines of JSON: name it .jsonl'),
        (' (1764230000.000000) can0 141#A100000000000000\n', 'a log of CAN frames: decode'),
        (lambda t, r, o: written([t, r, t, o], 'motor_time,motor_pos,output_time_ms,output_pos'),
         'are not in the same unit: give both units in the names'),
        (lambda t, r, o: written([t, r, o], 'time [100ns],rotor,output', 'x{:.2f}'),
         r'time \[100ns\]: no numbers nor ISO 8601; give another with --time-column$'),
        (lambda t, r, o: written([t, r, t, o], 't_m,motor_pos,t_o,output_pos',
                                 ['{:.2f}', '{:.5f}', lambda _: '', '{:.5f}']),
         'the times in t_o: no numbers'),
        ('date Thu Nov 26 09:12:33 2026\nbase hex\n', 'a log of CAN frames: decode'),
        ('  can0  00000141   [8]  A1 00 00 00 00 00 00 00\n', 'a log of CAN frames: decode'),
        (' (1764230000.000000)  can0  141   [2]  A1 00\n', 'a log of CAN frames: decode'),
        ('# Created by Octave 9.2.0, Thu Nov 26\n# name: rotor\n# type: matrix\n 0\n 1\n 2\n',
         'a text of Octave: save the variables with the option -v7'),
        ('header:\n  stamp:\n    sec: 0\nposition:\n- 1.5\n---\n',
         'the YAML of ros2 topic echo: add --csv to it'),
        ('t,angle [deg],force [N]\n0,1,2\n1,2,3\n', 'with their units, by --angle-column'),
        (lambda t, r, o: written([t, r, o], 'time,force_N,angle_rad'),
         'with their units, by --angle-column'),
        ('time,angle_grad,torque\n0,1,2\n',
         "known; known: rad, .*counts: give it as in --angle-column 'angle_grad .rad.'"),
        ('time,angle,torque\ns,mil,Nm\n0,1,2\n', 'the unit mil is not known'),
        ('rotor,output\n1.5,20\n359.5,30.5\n', 'rotor has turns of 360'),
        ('Data1,torque\n0,2\n', 'Data1 does not say that it is an angle: .* --angle-unit'),
        (lambda t, r, o: written([1e3 * t, r, o], 'time_s,rotor,output', '{:.0f}'),
         r"times in time_s are 40 s apart, as if they were ms: .* --time-column 'time_s \[ms"),
        (lambda t, r, o: written([1e6 * t, r, o], 'time_ms,rotor,output', '{:.0f}'),
         r"times in time_ms are 40 s apart, as if they were us: .* --time-column 'time_ms \[us"),
        (lambda t, r, o: written([1e9 * t, r, o], 'time_ms,rotor,output', '{:.0f}'),
         r"times in time_ms are 40000 s apart, as if they were ns: .* 'time_ms \[ns"),
        (plain('time_us,rotor_deg,output_deg', time='{:.5f}', angle=DEG),  # as of unball/Firmware
         r"times in time_us are 4e-08 s apart, in .* turn by 1\.44 rad: .* 'time_us \[s\]'"),
        (plain('time_ns,rotor,output', unit=1e3),
         r"times in time_ns are 4e-08 s apart, in .* turn by 1\.44 rad: .* 'time_ns \[ms\]'"),
        (plain('time_us,rotor_rad,output_rad', unit=0.0), 'times in time_us: they stand still'),
        (plain('time_ticks,rotor,output', unit=8e3),  # of 125 µs each
         r"time_ticks: steps of 320 do not tell their unit: .* 'time_ticks \["),
        (lambda t, r, o: written([t, *in_counts(r, o), in_counts(r)[0] / 4096 * 360],
                                 'time,mot_ang,ank_ang,mot_ang_deg', ('{:.2f}', *3 * ['{:.7f}'])),
         'for example: .* --output-column .?ank_ang'),
        ('time;rotor;output\nsec;U;U\n0;0;0\n', 'rotor: the unit u is not known'),
        ('time;angle;torque\ns;deg;mV/V\n0;0;1\n', 'torque is in mv/v: convert it'),
        ('time,angle (deg),torque (mV/V)\n0,0,1\n1,2,3\n', 'with their units, by --angle-column'),
        (lambda t, r, o: written([t, r * 7, o], 'time,motor_phase_rad,output_rad'),
         'with their units, by --angle-column'),
        (lambda t, r, o: 'time,signal,value,unit\n' + ''.join(
            f'{at:.2f},motor,{rotor:.5f},{"rad" if at < 9.0 else "deg"}\n'
            f'{at:.2f},output,{out:.5f},rad\n' for at, rotor, out in zip(t, r, o, strict=True)),
         'motor: the unit radanddeg is not known'),
        *((f'time,angle,{name}\n0,0,2\n1,0.001,3\n',
           f'{name} does not say that it is a torque: .* --torque-column .{name} .N·m')
          for name in ('load', 'Iq')),
        ('arm_moves_freely', r'the output turns by 100° under torque: .* \(--on-rotor\)'),
        ('degrees_without_unit',
         'speeds of .* as in degrees or beside times in another unit: .* --angle-unit'),
        (lambda t, r, o: written([t, r / 300, o / 300], 'time_us,rotor,output', '{:.6f}'),
         r"times in time_us are 4e-08 s apart: .* 'time_us \[s\]'"),
        (lambda t, r, o: written(
            [t, np.floor(r * REV), o], 'time_s,rotor_turns,output_rad', '{:.6f}'),
         'rotor_turns has whole turns alone: add the angle within the turn'),
        *((lambda t, r, o, names=names, scales=scales: written(
            [t, r * scales[0], o * scales[1]], f'time,{names}', '{:.6f}'),
           f'{lone} has no unit, and that of the other angle is {unit}: .* .{lone} .{unit}.')
          for names, lone, unit, scales in (
              ('rotor_deg,output', 'output', 'deg', (180.0 / math.pi, 1.0)),
              ('rotor,output_deg', 'rotor', 'deg', (1.0, 180.0 / math.pi)),
              ('rotor,output_rev', 'rotor', 'rev', (1.0, 1.0 / math.tau)),
          )),
        ('vesc_tool', 'not say .* an angle: .* --angle-unit'),
        (lambda t, r, o: written([t, (r + 0.05 * np.sin(r)) * REV, o * REV], NAMES, '{:.7f}'),
         'repeats with each turn of the rotor if that is in turns: .* --angle-unit rev'),
    ],
)  # fmt: skip
def test_what_speaks_against_a_unit_is_said(tmp_path, gear, reference, table, written_as, cause):
    given = (
        {'rotor': 'tachometer', 'output': 'encoder_position'} if written_as == 'vesc_tool' else {}
    )
    if isinstance(written_as, str):
        path = saved(tmp_path, written_as) if '\n' in written_as else table(written_as)
        if angle := re.search(r'angle_\w*|Data1', written_as):
            given = {'angle': angle[0]}
        if torque := re.search(r'load$|Iq', written_as, re.MULTILINE):
            given = {'angle': 'angle', 'torque': torque[0]}
    else:
        path = saved(tmp_path, written_as(*reference('encoders')))
    counts = 4096 if 'three decimals' in cause else None
    with pytest.raises(RecordingError, match=cause) as caught:
        read(path, gear, Sources(**given, rotor_counts=counts))
    assert '\n' not in str(caught.value)


def test_the_revolutions_of_moteus_are_assumed_unless_the_numbers_are_counts(
    tmp_path, gear, reference
):
    t, a, q = reference('ramps')
    names, forms = 'time,position,torque,q_current', 4 * ['{:.9f}']
    recording = read(saved(tmp_path, written([t, a * REV, q, q], names, forms)), gear)
    assert 'angle at the output [rev, assumed] from position' in recording.columns
    path = saved(tmp_path, written([t, np.round(65536 * a * REV), q, q], names, forms))
    with pytest.raises(RecordingError, match='position has whole numbers, such as counts'):
        read(path, gear)


@pytest.mark.parametrize('unit', ['', 'rad', 'deg'])
def test_assumed_units_are_said_first_of_all(tmp_path, gear, reference, unit, capsys):
    """An error of the rotor's encoder shows turns or degrees, and nothing speaks against rad."""
    t, r, o = reference('encoders')
    size = DEG if unit == 'deg' else 1.0
    columns = t, (r + 0.05 * np.sin(r)) * size, o * size
    path = saved(tmp_path, written(columns, NAMES, '{:.7f}'))
    recording = read(path, gear, Sources(unit=unit or None))
    assumed = Observation.UNITS_ASSUMED(units=['rad for rotor', 'rad for output'])
    assert recording.remarks == ((assumed,) if not unit else ())
    say_columns(recording, argparse.Namespace(quiet=False))
    _, *said = capsys.readouterr().err.splitlines()
    assert said == ([f'r.csv: {assumed}'] if not unit else [])


def test_an_error_that_is_sampled_as_if_once_a_turn_does_not_speak_against_rad(tmp_path, gear):
    """Three waves in a turn, in a motion that moves on by as much as one wave, and one revolution.

    3 m = τ (m - 1) for a motion by m in each sample: both waves have the same values.
    """
    even = np.arange(600.0) * math.tau / (math.tau - 3.0)
    rotor = np.concatenate([even, even[-2::-1]])
    output = -rotor / 30.0 + 0.002 * np.sin(3.0 * rotor)
    columns = np.arange(len(rotor)) / 50.0, rotor, output
    recording = read(saved(tmp_path, written(columns, NAMES)), gear)
    np.testing.assert_allclose(recording.both.measured, output, atol=1e-5)


@pytest.mark.parametrize('name', ['Bremsmoment', 'torquemeter_2'])
def test_compound_words_say_that_they_are_torques(tmp_path, gear, reference, name):
    path = saved(tmp_path, written(reference('ramps'), f'time,angle,{name}', '{:.5f}'))
    recording = read(path, gear, Sources(angle='angle', torque=name))
    assert f'torque at the output [N·m, assumed] from {name}' in recording.columns


UNTOLD = {
    'counts': lambda t, r, o: written([t, *in_counts(r, o)], 'time,motor_inc,load_inc'),
    'counts without unit': lambda t, r, o: written([t, *in_counts(r, o)],
        'time,motor_present_position,load_present_position', ('{:.2f}', '{:.0f}', '{:.0f}')),
    'counts of numbered servos': lambda t, r, o: written([t * 1e3, *in_counts(r, o)],
        'Time(ms),[ID:001] Present Position,[ID:002] Present Position', 3 * ['{:.0f}']),
    'counts as raw readings': lambda t, r, o: written(
        [t, *in_counts(r, o)], 'time,motor_raw,output_raw'),
    'degrees': plain(angle=DEG),
    'turns of a drive beside degrees': lambda t, r, o: written(
        [t * 1e3, r * REV, o * DEG], 'Time (ms),PL.FB (Rev),FB2.P (deg)', 3 * ['{:.5f}']),
    'turns beside degrees, in a row of units': lambda t, r, o: written(
        [t, r * REV, o * DEG], 'Time,FB1,FB2\ns,rev,deg', 3 * ['{:.5f}']),
    'degrees at which the output differs': plain(angle=DEG, unit=10.0),
    'angles of unknown sides': plain('t,pos_a,pos_b', angle=DEG),
    'no names': plain(''),
    'a title, but no names': plain('Bench 3, of 2026', mark=';'),
    'paths with an s behind a slash': lambda t, r, o: written([t, r * DEG, o * DEG],
        'Zeit,/spine/enc_degrees,/shoulder/pos_degrees', '{:.5f}'),
    'names of joints in ros2 topic echo': lambda t, r, o: written([*split_time(t), r, o], '',
        ('{:.0f}', '{:.0f},,hip_motor,hip_joint', '{:.5f}', '{:.5f},0.1,0.2')),
    'degrees beside what is wanted and words': lambda t, r, o: written([t, t, 57.4 * r, r * DEG,
        57.4 * o, o * DEG], 't,mode,hip_pos_ref,hip_pos_sens,knee_pos_ref,knee_pos_sens',
        ('{:.2f}', lambda _: 't', *4 * ['{:.5f}'])),
    'an acceleration beside': lambda t, r, o: written(
        [t, r, o, 30.0 * r, r], 't,theta_m,theta_l,theta_m_ddot,theta_command', '{:.5f}'),
    'revolutions': lambda t, r, o: written([t, r * REV % 1.0, o * REV % 1.0], NAMES),
    'a unit of one encoder alone': lambda t, r, o: written(
        [t, *in_counts(r), o * DEG], 'time,rotor,output [deg]'),
    'counts at steps that may be s or ms': lambda t, r, o: written(
        [25.0 * t, *in_counts(r, o)], 'time,rotor_inc,output_inc'),
    'unknown word': plain('time,motor_pos_x,output_pos_x'),
    'times': lambda t, r, o: written([25 * t, r / 3, o / 3], NAMES),
    'both motors': plain('time,motor1_pos,motor2_pos'),
    'sides alone': plain('time,input,output'),
    'rad before a word': plain('time,front_rad_raw,rear_rad_raw'),
    'degrees beside notes that are no numbers': lambda t, r, o: written(
        [t, t, r * DEG, o * DEG], 'time,encoder_setup,encoder_1,encoder_2', (
            '{:.2f}', lambda v: '3' if v < 20.0 else '1-2', '{:.5f}', '{:.5f}')),
    'accumulated angles beside raw ones': lambda t, r, o: written(  # adamhaze8/Cycloidal_Actuator
        [r * DEG % 360.0, 9.0 * o * DEG % 360.0, r * DEG, 9.0 * o * DEG, o * DEG, t],
        'Motor_Raw,MT6_Raw,Motor_Accum,MT6_Accum,Output_Accum,Progress_Perc', '{:.3f}'),
    'constraints, which are no strains': plain('t,motor_constraint_pos,output_constraint_pos'),
    'Chinese, by angles alone': plain('时间,输入端转角,输出端转角'),
    'turns in French': plain('temps;codeur moteur (tr);codeur sortie (tr)', ';', angle=REV),
    'a unit of a maker': lambda t, r, o: written([t * 1e3, *in_counts(r, o)],
        'Time [ms];Position actual value [qc];Load position [qc]', 3 * ['{:.0f}'], ';'),
    'a torque beside': lambda t, r, o: written(
        [t, r, o, t], 'time,POSITION,ABS_POSITION,TORQUE', '{:.5f}'),
    'Russian of Windows': plain('время;Угол двигателя, °;Угол выхода, °', ';', german=True,
        angle=DEG, code='cp1251'),
    'sides alone, of two joints': lambda t, r, o: written(
        [t, r, o, r / 2, o / 2], 'time,j1_motor,j1_link,j2_motor,j2_link', '{:.5f}'),
    'no locked output': lambda t, r, o: written(
        [t, r, o, np.sin(t)], 'time,M1_position_rad,J1_position_rad,torque_Nm', '{:.5f}'),
}  # fmt: skip
UNTOLD_RAMPS = {
    'two torques': lambda t, a, q: written(
        [t, a * DEG, q, q], 'time,angle_deg,torque_raw_Nm,torque_filtered_Nm', 4 * ['{:.6f}']),
    'a row for each of three': lambda t, a, q: 'time,motor,position_deg,torque\n' + ''.join(
        f'{at:.2f},{k},{(k == 2) * angle * DEG:.6f},{torque:.6f}\n'
        for at, angle, torque in zip(t, a, q, strict=True) for k in (1, 2, 3)),
    'a torque in whole numbers': lambda t, a, q: written([t, a, np.round(q * 1e3)],
        'time,angle,torque', ('{:.2f}', '{:.6f}', '{:.0f}')),
    'a sensor of three axes': lambda t, a, q: written([t, 0 * q + 1.0, 0 * q, q, a * DEG],
        'Time (s),Tx (Nm),Ty (Nm),Tz (Nm),Encoder (deg)', 5 * ['{:.6f}']),
    'travel in arc seconds, by the unit alone': lambda t, a, q: written(
        [t, a * DEG * 3600.0, q], 't,arcsec,torque', 3 * ['{:.6f}']),
    'units of rotation': lambda t, a, q: written(
        [t, a * DEG, q], '"Time","Rotation","Axial Torque"\n"(s)","(Degrees)","(N-m)"',
        3 * ['"{:.6f}"']),
    'a unit in a line above names': lambda t, a, q: written([range(len(t)), t, q, a * DEG],
        'Units: Nm\nSample Number,Time (s),Tracking Value (Nm),Angle [º]', 4 * ['{:.6f}']),
    'moments of a hexapod': lambda t, a, q: written([t, 0 * q, q, a * DEG],
        't,M_x [Nm],M_z [Nm],angle [deg]', 4 * ['{:.6f}']),
    'a torque by its unit alone': lambda t, a, q: written(
        [t, q / 0.00706155, a * DEG], 'Time (Sec),Tracking (in-oz),Angle (deg)', 3 * ['{:.6f}']),
    'a unit that is a word': lambda t, a, q: written(
        [t, a, q], 'time,angle_grad,torque', 3 * ['{:.6f}']),
}  # fmt: skip


def followed(error):
    """The sources that the command line at the end of an error gives."""
    words = shlex.split(str(error).split('for example: ')[1])
    assert words[:2] == ['gearkin', 'lost-motion']
    parser = argparse.ArgumentParser()
    parser.set_defaults(command_line='')
    add_recordings(parser, 'angle', 'torque', 'rotor', 'output')
    return sources(parser.parse_args(words[2:]))


@pytest.mark.parametrize('untold', [*UNTOLD, *UNTOLD_RAMPS])
def test_every_refusal_ends_with_a_command_line_that_works(tmp_path, gear, reference, untold):
    ramps = untold in UNTOLD_RAMPS
    content = (UNTOLD | UNTOLD_RAMPS)[untold](*reference('ramps' if ramps else 'encoders'))
    path = saved(tmp_path, content)
    for as_recorded in (False, True):
        given = Sources(as_recorded=as_recorded)
        if as_recorded and untold == 'counts':
            assert read(path, gear, given, both=True).encoders
            continue
        with pytest.raises(
            RecordingError, match=f'for example: gearkin lost-motion {path}'
        ) as told:
            read(path, gear, given, both=as_recorded and not ramps)
        recording = read(path, gear, followed(told.value))
        assert (recording.locked is not None) == ramps
    if untold in {'two torques', 'a sensor of three axes', 'moments of a hexapod'}:
        assert_measured(recording, gear)
    elif any(word in untold for word in ('counts', 'degrees', 'both motors', 'accumulated')):
        assert_followed(recording.both)


def test_advice_heeds_names_where_an_output_wraps_and_seems_faster(tmp_path, gear, reference):
    t, r, o = reference('encoders')
    columns = t, r * REV, 10.0 * o * DEG % 360.0
    path = saved(tmp_path, written(columns, 'time,input_rev,output_deg'))
    with pytest.raises(RecordingError) as told:
        read(path, gear)
    given = followed(told.value)
    assert (given.rotor, given.output) == ('input_rev', 'output_deg')


def test_advice_repeats_the_options_that_were_given(tmp_path, gear, reference):
    path = saved(tmp_path, UNTOLD['counts'](*reference('encoders')))
    line = f'gearkin calibrate {path} --ratio -30 --rotor-counts 4096'
    with pytest.raises(RecordingError, match=f'for example: {line} --output-counts 4096$'):
        read(path, gear, Sources(rotor_counts=4096, command=line))


@pytest.mark.parametrize('given', ["--torque-column 'load 5'", "'--torque-column=load 5'"])
def test_advice_replaces_the_options_that_it_corrects(tmp_path, gear, reference, given):
    t, a, q = reference('ramps')
    head = 'time_s,angle_rad,load 5'
    path = saved(
        tmp_path, written([t, a, np.round(q * 1e3)], head, ('{:.2f}', '{:.6f}', '{:.0f}'))
    )
    line = f'gearkin lost-motion {path} {given} --quiet'
    with pytest.raises(RecordingError) as told:
        read(path, gear, Sources(torque='load 5', command=line))
    words = shlex.split(str(told.value).split('for example: ')[1])
    assert words[3:] == ['--quiet', '--torque-column', 'load 5 [Nmm]']


@pytest.mark.parametrize(
    ('name', 'unit'),
    [
        ('enc {}', []),
        ('odrv{}.axis0.pos_vel_mapper.pos_rel', []),
        ('Data{}', ['--angle-unit', 'rad']),
        ('FB{} [cnt]', ['--rotor-counts', '4096', '--output-counts', '4096']),
        ('FB{} [qc]', ['--rotor-counts', '4096', '--output-counts', '4096']),
    ],
)
@pytest.mark.parametrize('as_recorded', [False, True])
def test_the_command_line_of_the_advice_works(tmp_path, gear, reference, name, unit, as_recorded):
    time, rotor, output = reference('encoders')
    names = ','.join(['t', name.format(1), 'temp', name.format(2)])
    content = written([time, rotor, 30.0 * time, output], names, '{:.5f}')
    path = saved(tmp_path, content)
    with pytest.raises(RecordingError, match=r'among the columns t \(0.00000\), .*1') as caught:
        read(path, gear, Sources(as_recorded=as_recorded))
    text, command = str(caught.value).split('for example: ')
    assert (' in place of ' in text and '4096' in text) == ('4096' in unit)
    words = shlex.split(command)
    assert words[:3] == ['gearkin', 'lost-motion', str(path)]
    assert words[7:] == unit
    both = read(path, gear, followed(caught.value)).both
    if unit[1:] == ['rad']:
        assert np.ptp(both.measured) == pytest.approx(np.ptp(output), rel=1e-3)


def test_seconds_and_their_fractions_are_one_time(tmp_path, gear, reference):
    t, r, o = reference('encoders')
    form = '{:.0f}', '{:.0f}', '{:.5f}', '{:.5f}'
    columns = t // 1, 1e6 * (t % 1.0), r, o
    recording = read(
        saved(tmp_path, written(columns, 'secs,usecs,rotor_rad,output_rad', form)), gear
    )
    assert recording.remarks == ()
    np.testing.assert_allclose(recording.both.seconds, t, atol=1e-6)


def test_the_seconds_of_each_encoder_have_their_own_fractions(tmp_path, gear, reference):
    t, r, o = reference('encoders')
    kinds = [*split_time(t[:-1]), r[:-1], *split_time(t[1:]), o[1:]]
    head = ','.join(
        f'{one}_stamp_sec,{one}_stamp_nanosec,{one}_pos' for one in ('motor', 'output')
    )
    content = written(kinds, head, 2 * ['{:.0f}', '{:.0f}', '{:.5f}'])
    both = read(saved(tmp_path, content), gear).both
    assert (both.duration, both.before[0]) == (pytest.approx(52.72, abs=0.05), 1)
    assert_followed(both)


@pytest.mark.parametrize('whole', ['motor', 'output'])
def test_one_encoder_has_fractions_of_seconds_and_the_other_decimals(
    tmp_path, gear, reference, whole
):
    t, r, o = reference('encoders')
    names, columns, forms = [], [], []
    for side, times, angle in (('motor', t[:-1], r[:-1]), ('output', t[1:], o[1:])):
        parts = split_time(times) if side == whole else [1764230000 + times]
        units = ['sec', 'nanosec'] if side == whole else ['s']
        names += [*(f'{side}_stamp_{unit}' for unit in units), f'{side}_pos']
        columns += [*parts, angle]
        forms += [*len(parts) * ['{:.0f}' if side == whole else '{:.2f}'], '{:.5f}']
    both = read(saved(tmp_path, written(columns, ','.join(names), forms)), gear).both
    assert both.duration == pytest.approx(52.72, abs=0.05)
    assert_followed(both)


def test_names_can_be_given_with_units(tmp_path, gear, reference):
    time, rotor, output = reference('encoders')
    path = saved(tmp_path, written([1e3 * time, DEG * rotor, output], 'a,b,c\n25 Hz,,'))
    given = Sources(time='a [ms]', rotor='b [deg]', output='c [rad]')
    recording = read(path, gear, given)
    assert recording.columns == (
        'time [ms] from a', 'rotor [deg] from b', 'output [rad] from c', '1320 of 1320 rows',
    )  # fmt: skip
    assert not measure(recording, gear).wrong_ratio


def test_an_angle_that_is_given_as_one_of_a_side_is_that_of_this_side(tmp_path, gear, reference):
    time, angle, torque = reference('ramps')
    columns = [time, angle, torque, -30.0 * angle]
    path = saved(tmp_path, written(columns, 'time,angle,torque,enc', '{:.6f}'))
    for given in (Sources(rotor='enc'), Sources(output='angle')):
        recording = read(path, gear, given)
        assert_measured(recording, gear)
        assert measure(recording, gear).measured == (given.output is not None)


@pytest.mark.parametrize('line', ['np.array(1.5' + 4000 * ", a='f'", '[' + 4000 * '1:11'])
def test_what_is_around_numbers_is_found_in_long_lines_at_once(line):
    """Patterns that begin anew at each comma take 100 times as long."""
    text, began = 10 * f'{line}\n', process_time()
    assert plainer(text, ',')[0](text) == text
    assert process_time() - began < 1.0


def test_lines_of_two_axes_with_the_same_labels_are_not_mixed(tmp_path, gear, reference):
    t, r, o = reference('encoders')
    text = written(
        [t, r, t, o],
        '',
        ('[motor] t={:.2f}', 'pos={:.5f}\n[joint]', 't={:.2f}', 'pos={:.5f}'),
        ' ',
    )
    with pytest.raises(RecordingError, match="labels begin with 'joint' and 'motor': save those"):
        read(saved(tmp_path, text), gear)


def test_a_torque_of_the_clamp_has_the_other_sign(tmp_path, gear, reference):
    """Springs give way: where the angle falls, the sensor measures the reaction."""
    t, a, q = reference('ramps')
    head = 'time_s,angle_rad,torque_Nm'
    recording = read(saved(tmp_path, written([t, a, 3.0 - q], head, 3 * ['{:.7f}'])), gear)
    assert recording.remarks == (Observation.OPPOSED(),)
    recording = read(saved(tmp_path, written([t, a, -q], head, 3 * ['{:.7f}'])), gear)
    assert_measured(recording, gear)


@pytest.mark.parametrize('timed', [False, True])
def test_weights_under_which_an_angle_is_read_twice_are_not_held(tmp_path, gear, timed):
    torque = np.repeat(np.round(8.0 * np.sin(np.linspace(0.0, 9.0, 60)), 3), 2)
    angle = torque / 3790.0 + 1e-5 * (np.arange(len(torque)) % 2)
    columns, names = [angle, torque], 'angle_rad,torque_Nm'
    if timed:
        columns, names = [np.arange(len(torque)), *columns], f'time_s,{names}'
    recording = read(saved(tmp_path, written(columns, names, '{:.6f}')), gear)
    assert recording.remarks == ()
    np.testing.assert_allclose(recording.locked.torque, torque)


def test_loads_take_columns_that_say_no_side_for_those_of_the_rotor(tmp_path, gear, reference):
    time, rotor, _ = reference('encoders')
    for names in ('time,position,effort', 'time,motor_pos,torque', 'time,angle,motor_torque'):
        path = saved(tmp_path, written([time, rotor, np.sin(time)], names, '{:.5f}'))
        _, angle, torque, _ = read_rotor(path, Sources(), gear.gear.gear_ratio)
        np.testing.assert_allclose(angle, rotor, atol=1e-5)
        np.testing.assert_allclose(torque, np.sin(time), atol=1e-5)

    path = saved(tmp_path, written([rotor, np.sin(time)], 'position,effort', '{:.5f}'))
    with pytest.raises(RecordingError, match=r'--time-column and --torque-column$'):
        read_rotor(path, Sources(), gear.gear.gear_ratio)
    path = saved(tmp_path, written([time, rotor, rotor], 'time_us,position,effort', '{:.5f}'))
    with pytest.raises(RecordingError, match=r"the shaft would turn by .* 'time_us \[s\]'"):
        read_rotor(path, Sources(), gear.gear.gear_ratio)


def test_rows_are_those_of_the_output_where_encoders_share_none(tmp_path, gear, reference):
    t, r, o = reference('encoders')
    content = 'time [s],motor [rad],output [rad]\n' + ''.join(
        (f'{at:.4f},{rotor:.5f},\n' if k % 5 == 0 else '') + f'{at + 5e-4:.4f},,{out:.5f}\n'
        for k, (at, rotor, out) in enumerate(zip(t, r, o, strict=True))
    )
    path = saved(tmp_path, content)
    recording = read_table(path, Sources(), gear.gear.gear_ratio)
    assert recording.columns[-1] == '1320 of 1320 rows'


# Other formats


def parquet(path, time, rotor, output):
    pa = pytest.importorskip('pyarrow')
    import pyarrow.parquet as pq  # noqa: PLC0415

    state = [[*pair] for pair in zip(rotor, output, strict=True)]
    pq.write_table(pa.table({'timestamp': time.astype('f4'), 'observation.state': state}), path)
    return Sources(rotor='observation.state[0]', output='observation.state[1]', unit='rad')


def structs(path, time, rotor, output):
    pa = pytest.importorskip('pyarrow')
    import pyarrow.parquet as pq  # noqa: PLC0415

    sides = [[{'pos': one, 'vel': 0.0} for one in values] for values in (rotor, output)]
    images = [{'bytes': b'\x89PNG\xff', 'path': None}] * len(time)  # as LeRobot has them
    columns = {'time': time, 'motor': sides[0], 'output': sides[1], 'observation.image': images}
    pq.write_table(pa.table(columns), path)
    return Sources()


def long_table(path, time, rotor, output):
    pytest.importorskip('pyarrow')
    pd = pytest.importorskip('pandas')
    series = {'/rotor/position': rotor, '/state': np.zeros(len(time)), '/output/position': output}
    rows = ((t, key, value[k]) for k, t in enumerate(time) for key, value in series.items())
    pd.DataFrame(rows, columns=['time', 'topic', 'value']).to_parquet(path)
    return Sources()


def joint_states(path, time, rotor, output):
    """Joints change their places, as where two drivers share a topic."""
    pytest.importorskip('pyarrow')
    pd = pytest.importorskip('pandas')
    order = [slice(None), slice(None, None, -1)]
    pairs = zip(rotor, output, strict=True)
    rows = {'stamp_ns': np.round(1e9 * time).astype('i8'),
            'name': [['m1', 'out'][order[k % 2]] for k in range(len(time))],
            'position': [[*pair][order[k % 2]] for k, pair in enumerate(pairs)]}  # fmt: skip
    pd.DataFrame(rows).to_parquet(path)
    return Sources()


def asammdf_export(path, time, rotor, output):
    """As asammdf 8 exports two groups with a master each."""
    pytest.importorskip('scipy.io').savemat(path, {
        'DGM0_timestamps': time[1:], 'DG0_MotorAngle': rotor[1:],
        'DGM1_timestamps': time[:-1], 'DG1_OutputAngle': output[:-1]})  # fmt: skip
    return Sources(unit='rad')


def fields_with_times(path, time, rotor, output):
    pytest.importorskip('scipy.io').savemat(path, {
        'motor': {'t': time[1:], 'angle': rotor[1:]},
        'output': {'t': time[:-1], 'angle': output[:-1]}})  # fmt: skip
    return Sources()


def parquet_of_times(path, time, rotor, output):
    pytest.importorskip('pyarrow')
    pd = pytest.importorskip('pandas')
    index = pd.to_datetime(1.79e9 + time, unit='s')
    pd.DataFrame({'rotor': rotor, 'output': output}, index=index).to_parquet(path)
    return Sources()


def timeseries(path, time, rotor, output):
    """As structures of MATLAB, of which the second is sampled a moment later."""
    io = pytest.importorskip('scipy.io')
    io.savemat(path, {'motor': {'Time': time[:-1], 'Data': rotor[:-1]},
                      'output': {'Time': time[1:], 'Data': output[1:]}})  # fmt: skip
    return Sources()


def scope(path, time, rotor, output):
    """As a scope of Simulink has it, a structure with time."""
    io = pytest.importorskip('scipy.io')
    signals = [('Motor angle [rad]', rotor), ('Output angle [rad]', output)]
    signals = np.array([{'values': values, 'label': label} for label, values in signals])
    io.savemat(path, {'Scope': {'time': time, 'signals': signals, 'blockName': 'm/Scope'}})
    return Sources()


def scope_without_labels(path, time, rotor, output):
    io = pytest.importorskip('scipy.io')
    signals = np.array([{'values': values, 'label': ''} for values in (rotor, output)])
    io.savemat(path, {'Scope': {'time': time, 'signals': signals}})
    return Sources(rotor='signals[0].values', output='signals[1].values', unit='rad')


def control_desk(path, time, rotor, output):
    """As dSPACE has it, with a unit, and two signals of the same name."""
    io = pytest.importorskip('scipy.io')
    names = zip(('Out1', 'Motor angle', 'Out1'), (time, DEG * rotor, output), strict=True)
    signals = [{'Name': name, 'Data': values, 'Unit': 'deg'} for name, values in names]
    io.savemat(path, {'r': {'X': {'Name': '', 'Data': time}, 'Y': np.array(signals)}})
    return Sources(time='X.Data', output='Y[2].Data [rad]')


def ascii_mat(path, time, rotor, output):
    np.savetxt(path, np.stack([time, rotor, output]).T)
    return Sources(time='1', rotor='2', output='3', unit='rad')


def mat(path, time, rotor, output):
    io = pytest.importorskip('scipy.io')
    io.savemat(path, {'run': {'time': time, 'rotor_deg': DEG * rotor, 'output': {'rad': output}}})
    return Sources(output='output.rad')


def hdf5(path, time, rotor, output):
    """As MATLAB 7.3 has it, with a signal in each row, as Simulink does."""
    with pytest.importorskip('h5py').File(path, 'w', userblock_size=512) as file:
        file['run/time'], file['run/name'] = time[None, :], np.zeros((4, 1), 'u2')
        file['run/angle'] = np.stack([rotor, output]).T
        file['run/name'].attrs['MATLAB_class'] = np.bytes_('char')
    with path.open('r+b') as file:
        file.write(b'MATLAB 7.3 MAT-file'.ljust(124) + b'\0\2IM')
    return Sources(rotor='angle[0]', output='angle[1]')


def text(path, time, rotor, output):
    pd = pytest.importorskip('pandas')
    pd.DataFrame({'time': time, 'rotor': rotor, 'output': output}).to_csv(path, index=False)
    return Sources()


def json_lines(path, time, rotor, output):
    """As `mcap cat --json` writes them."""
    messages = (
        {'log_time': t, 'data': {'name': ['m1', 'out'], 'position': pair, 'effort': []}}
        for t, *pair in zip(time, rotor, output, strict=True)
    )
    path.write_text('\n'.join(map(json.dumps, messages)) + '\n\n')
    return Sources()


def workbook(path, time, rotor, output):
    pytest.importorskip('openpyxl')
    pd = pytest.importorskip('pandas')
    rows = zip(time, DEG * rotor, output, strict=True)
    head = [('Bench 3', None, None), ('Time', 'Rotor\nangle', 'Output'), ('s', '°', 'rad')]
    pd.DataFrame([*head, *rows]).to_excel(path, header=False, index=False)
    return Sources()


def covered_workbook(path, *columns):
    pytest.importorskip('openpyxl')
    pd = pytest.importorskip('pandas')
    with pd.ExcelWriter(path) as book:
        pd.DataFrame({'Bench': [7], 'Gear': ['A 5']}).to_excel(book, sheet_name='Info')
        return workbook(book, *columns)


def tdms(path, time, rotor, output):
    nptdms = pytest.importorskip('nptdms')
    with nptdms.TdmsWriter(path) as writer:
        for group, values in (('Rotor', rotor), ('Output', output)):
            known = {'wf_increment': float(time[1]), 'unit_string': 'Degrees'}
            channel = nptdms.ChannelObject(group, 'Angle', DEG * values, properties=known)
            writer.write_segment([channel])
    return Sources()


def tdms_with_wrong_increments(path, time, rotor, output):
    nptdms = pytest.importorskip('nptdms')
    columns = {'Time': time, 'Rotor [rad]': rotor, 'Output [rad]': output}
    with nptdms.TdmsWriter(path) as writer:
        for one in columns.items():
            channel = nptdms.ChannelObject('Log', *one, properties={'wf_increment': 1.0})
            writer.write_segment([channel])
    return Sources()


def tdms_with_dates(path, time, rotor, output):
    nptdms = pytest.importorskip('nptdms')
    dates = np.datetime64('2026-11-26') + np.round(1e6 * time).astype('timedelta64[us]')
    columns = {'Time': dates, 'Rotor [rad]': rotor, 'Output [rad]': output}
    with nptdms.TdmsWriter(path) as writer:
        writer.write_segment([nptdms.ChannelObject('Log', *one) for one in columns.items()])
    return Sources()


def mf4(path, time, rotor, output):
    """One in a hundred readings of each encoder is wrong, and marked as invalid."""
    asammdf = pytest.importorskip('asammdf')
    file = asammdf.MDF()
    invalid = np.arange(len(time)) % 100 == 3
    for name, values, late in (('RotorAngle', rotor, 0.0), ('OutputAngle', output, 1e-5)):
        angles = DEG * np.where(invalid, 99.0, values)
        signal = asammdf.Signal(
            angles, time + late, name=name, unit='deg', invalidation_bits=invalid
        )
        file.append([signal])
    file.append([asammdf.Signal(9.0 * time, time, name='Time', unit='s')])
    file.save(path)
    return Sources()


FORMATS = {'parquet': parquet, 'mat': mat, '7.3.mat': hdf5, 'tdms': tdms, 'mf4': mf4}
FORMATS |= {'index.parquet': parquet_of_times, 'scope.mat': scope, 'ascii.mat': ascii_mat}
FORMATS |= {'dates.tdms': tdms_with_dates, 'times.tdms': tdms_with_wrong_increments}
FORMATS |= {'timeseries.mat': timeseries, 'groups.mat': asammdf_export}
FORMATS |= {'fields.mat': fields_with_times, 'structs.parquet': structs}
FORMATS |= {'long.parquet': long_table, 'joints.parquet': joint_states}
FORMATS |= {'unnamed.mat': scope_without_labels, 'dspace.mat': control_desk}
FORMATS |= {
    'jsonl': json_lines,
    'xlsx': workbook,
    'cover.xlsx': covered_workbook,
    **dict.fromkeys(('csv.gz', 'tsv.zst', 'TXT.zip', 'log'), text),
}


@pytest.mark.parametrize('name', FORMATS)
def test_other_formats(tmp_path, gear, reference, name):
    path = tmp_path / f'r.{name}'
    given = FORMATS[name](path, *reference('encoders'))
    recording = read(path, gear, given)
    assert recording.encoders.timed
    assert recording.encoders.duration == pytest.approx(52.76, abs=0.05)
    assert_followed(recording.both)
    path.write_bytes(b'nothing at all')
    with pytest.raises(RecordingError, match=f'{re.escape(name)}: '):
        read(path, gear, given)
    path.write_bytes(b'version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 9\n')
    with pytest.raises(RecordingError, match='only a pointer of Git LFS'):
        read(path, gear, given)


def old_workbook(path, *_):
    pytest.importorskip('openpyxl')  # which needs no other library to refuse it
    path.write_bytes(bytes.fromhex('d0cf11e0a1b11ae1') + bytes(600))


def sheets(path, *_):
    pytest.importorskip('openpyxl')
    pd = pytest.importorskip('pandas')
    with pd.ExcelWriter(path) as book:
        for sheet, values in ('Info', ['bench 3', 'x']), ('Run 1', [0, 1]), ('Run 2', [0, 1]):
            frame = pd.DataFrame({'rotor': values, 'output': values})
            frame.to_excel(book, sheet_name=sheet, index=False)


def daqmx(path, _, angle, torque):
    nptdms = pytest.importorskip('nptdms')
    channels = [
        nptdms.ChannelObject('Bench', name, values, properties={'NI_UnitDescription': unit})
        for name, values, unit in (('Angle', DEG * angle, 'Deg'), ('Torque', torque, 'Volts'))
    ]
    with nptdms.TdmsWriter(path) as writer:
        writer.write_segment(channels)


def twice(path, time, rotor, output):
    pa, pq = pytest.importorskip('pyarrow'), pytest.importorskip('pyarrow.parquet')
    columns = ['time', 'rotor', 'rotor', 'output']
    pq.write_table(pa.table([time, rotor, rotor, output], names=columns), path)


def saved_mat(columns):
    return lambda path, *data: pytest.importorskip('scipy.io').savemat(path, columns(*data))


NO_NUMBERS = 'no columns of numbers: save the vectors of a time'
TABLE = np.array([[0xDD000000], [2], [1], [1], [1], [1]], np.uint32)  # the reference to one


@pytest.mark.parametrize(('name', 'write', 'cause'), [
    ('r.xlsx', old_workbook, r'cannot be read as \.xlsx: File is not a zip'),
    ('r.xlsx', sheets, 'sheets with numbers: Run 1, Run 2: save one as CSV'),
    ('r.tdms', daqmx, 'Torque is in volts: convert it to one of N·m'),
    ('r.mat', saved_mat(lambda *_: {'name': 'bench 3'}), NO_NUMBERS),
    ('r.mat', saved_mat(lambda *_: {'T': TABLE}), NO_NUMBERS),
    ('r.mat', saved_mat(lambda t, r, o: {'tout': t[1:], 'rotor': r, 'output': o}),
     'columns of 1319 and 1320 rows, without times of each'),
    ('r.parquet', twice, "more than one column 'rotor'"),
    ('r.ods', lambda path, *_: path.write_bytes(b'PK\x03\x04'),
     r'bags are .mcap.* tables .csv.*\.parquet.* as \.csv\.gz, \.csv\.zst, \.csv\.zip'),
])  # fmt: skip
def test_other_files_are_refused_with_what_to_do(tmp_path, gear, reference, name, write, cause):
    write(tmp_path / name, *reference('encoders'))
    with pytest.raises(BagError if name == 'r.ods' else RecordingError, match=cause):
        read(tmp_path / name, gear)


def test_series_that_take_turns_are_all_read_in_part(tmp_path, gear, reference, monkeypatch):
    monkeypatch.setattr(dialects, '_MOST_ROWS', 1500)
    t, r, o = reference('encoders')
    content = 'time,rotor_rad,output_rad\n' + ''.join(
        f'{at:.4f},{rotor:.5f},\n{at + 5e-4:.4f},,{out:.5f}\n'
        for at, rotor, out in zip(t, r, o, strict=True)
    )
    recording = read_table(saved(tmp_path, content), Sources(), gear.gear.gear_ratio)
    assert recording.remarks == (Observation.ROWS_THINNED(every=3),)
    np.testing.assert_allclose(recording.both.rotor.turned, r[::3], rtol=1e-14)
    np.testing.assert_allclose(recording.both.measured, o[1::3][:-1], rtol=1e-14)


def test_a_sum_below_a_table_of_which_rows_are_left_out_is_no_sample(
    tmp_path, gear, reference, monkeypatch
):
    """One row in two is read, so that the sum is twice that of these rows, and a little more."""
    monkeypatch.setattr(dialects, '_MOST_ROWS', 1000)
    t, *angles = (each[160:1160] for each in reference('encoders'))
    # A motion of both signs has a small sum.
    columns = [t, *(each - each.mean() + 0.01 * np.ptp(each) for each in angles)]
    content = written(columns, NAMES) + ','.join(str(sum(each)) for each in columns) + '\n'
    recording = read_table(saved(tmp_path, content), Sources(unit='rad'), gear.gear.gear_ratio)
    assert recording.remarks[0] == Observation.ROWS_THINNED(every=2)
    assert recording.remarks[1:] == (Observation.ROWS_LEFT_OUT(rows=1),)
    np.testing.assert_allclose(recording.both.measured, columns[2][::2], atol=1e-5)


def test_a_last_row_of_sums_that_is_in_reach_is_no_sample(tmp_path, gear):
    """The steps from place to place are as large as that to the sums."""
    rotor = np.repeat([0.0, 40.0, -39.0, 38.5, -38.0], 12) / 12.0
    columns = 0.01 * np.arange(len(rotor)), rotor, -rotor / 19.0
    content = written(columns, NAMES) + ','.join(str(sum(each)) for each in columns) + '\n'
    recording = read_table(saved(tmp_path, content), Sources(), gear.gear.gear_ratio)
    assert recording.rows == len(rotor)
    assert Observation.ROWS_LEFT_OUT(rows=1) in recording.remarks


@pytest.mark.parametrize(('head', 'output'), [
    ('rotor_rad,output_rad', [*np.radians(np.arange(0.0, 361.0, 10.0)), 0.0]),
    ('rotor_rad,output_rad', np.round(9.0 * np.sin(np.arange(0.0, 401.0) * math.pi / 50.0))),
    ('time_s,rotor_rad,output_rad', [*np.linspace(-1.0, 1.0, 401), 0.0, 0.0, 0.0]),
])  # fmt: skip
def test_a_motion_that_returns_at_once_has_all_its_rows(tmp_path, head, output):
    """Its last step is larger than all others, or the sum of its rows 0 as the last one."""
    columns = 0.1 * np.arange(len(output)), 19.0 * np.asarray(output), output
    path = saved(tmp_path, written(columns[-head.count(',') - 1 :], head, '{:.5f}'))
    recording = read_table(path, Sources(), Fraction(19))
    assert (recording.rows, recording.remarks) == (len(output), ())


@pytest.mark.parametrize('end', ['greatest', 'mean'])
def test_a_motion_that_ends_at_its_greatest_or_mean_angles_has_all_its_rows(
    tmp_path, gear, reference, end
):
    t, r, o = reference('encoders')
    ahead = -o  # turns the same way
    last = 1 + int(np.argmax(r) if end == 'greatest' else np.argmin(np.abs(r[100:] - r.mean())))
    last += 100 * (end == 'mean')
    content = written([t[:last], r[:last], ahead[:last]], NAMES)
    recording = read_table(saved(tmp_path, content), Sources(unit='rad'), gear.gear.gear_ratio)
    assert (recording.rows, recording.remarks) == (last, ())


@pytest.mark.parametrize('other', ['time,output_time', 'time1,time2', 'time_a,time_b'])
@pytest.mark.parametrize(('late', 'asked'), [(0.5, True), (0.004, False), (1.79e9, False)])
def test_two_times_that_are_apart_and_may_be_of_one_encoder_each_are_asked_for(
    tmp_path, gear, reference, late, asked, other
):
    """Taken for the times of both, either would be an error by the way within half a second."""
    t, r, o = reference('encoders')
    usual, other = other.split(',')
    names = f'{usual},motor_pos [rad],{other},output_pos [rad]'
    path = saved(tmp_path, written([t, r, t + late, o], names, '{:.5f}'))
    if asked:
        with pytest.raises(RecordingError, match=rf'{usual} and {other} may be .* of one') as told:
            read(path, gear)
        both = read(path, gear, followed(told.value)).encoders
        # The output's readings are half a second later than those of the same row.
        assert both.before[0] == 12
    recording = read_table(path, Sources(time=usual if asked else ''), gear.gear.gear_ratio)
    assert recording.columns[0] == f'time [s] from {usual}'


@pytest.mark.parametrize(
    'names',
    [
        'rotor,output,t,t.1',
        'rotor,time1,output,time2',
        'time_a,time_b,rotor,output',
        'tm,rotor,to,output',
    ],
)
def test_two_times_are_asked_for_wherever_they_stand(tmp_path, gear, reference, names):
    t, r, o = reference('encoders')
    times = iter([t, t + 0.5])
    angles = {'rotor': r, 'output': o}
    columns = [angles[k] if k in angles else next(times) for k in names.split(',')]
    path = saved(tmp_path, written(columns, names, '{:.5f}'))
    with pytest.raises(RecordingError, match=r'may be the times of one encoder each') as told:
        read(path, gear)
    assert read(path, gear, followed(told.value)).both.before[0] == 12


@pytest.mark.parametrize(('name', 'unit', 'start'), [
    ('Ticks', 1e7, 638_700_000_000_000_000),  # of .NET, 100 ns since the year 1
    ('clock value 2', 1e3, 0),
])  # fmt: skip
def test_a_column_that_rises_where_no_times_are_found_is_proposed(
    tmp_path, gear, reference, name, unit, start
):
    t, r, o = reference('encoders')
    times = start + np.round(t * unit).astype(int)
    path = saved(tmp_path, written([times, r, o], f'{name},rotor,output', '{}'))
    said = read(path, gear).columns[0]
    given = shlex.split(said.partition('perhaps ')[2].rstrip(')'))
    assert given == [f'--time-column={name}']
    found = read(path, gear, Sources(time=name)).both
    assert (found.timed, found.duration) == (True, pytest.approx(52.76, rel=1e-3))


@pytest.mark.parametrize('form', [
    '[default]Bench/{}/Position',  # Ignition
    'ns=4;s=Cell 3.Bench.{}.Position',  # OPC UA
    '/0:Objects/4:Cell/4:{}/4:ActPos',
    'Channel1.Device1.{}.Position',  # KEPServerEX
    'ns=2;s=|var|PLC.Application.GVL.r{}Pos',  # CODESYS
])  # fmt: skip
def test_tags_of_a_plc_are_known_by_what_differs_in_them(tmp_path, gear, reference, form):
    """What all begin with says nothing; whether they are in degrees or counts is asked for."""
    t, r, o = reference('encoders')
    names = [form.format(one) for one in ('Motor', 'Output')]
    content = written([t, r * DEG, o * DEG], ','.join(['Timestamp', *names]), '{:.5f}')
    path = saved(tmp_path, content)
    with pytest.raises(RecordingError, match=r'give its unit with --angle-unit'):
        read(path, gear)
    recording = read(path, gear, Sources(unit='deg'))
    assert [text.partition(' from ')[2] for text in recording.columns[1:3]] == names
    np.testing.assert_allclose(np.ptp(recording.both.measured), np.ptp(o), rtol=1e-3)


@pytest.mark.parametrize('other', ['error', 'target'])
def test_commands_are_not_known_by_what_differs_in_them(tmp_path, gear, reference, other):
    t, r, o = reference('encoders')
    head = f'time,target/motor/position,target/output/position,{other}/x'
    path = saved(tmp_path, written([t, r, o, 0.1 * r], head, '{:.5f}'))
    with pytest.raises(RecordingError, match='neither an angle'):
        read(path, gear)


@pytest.mark.parametrize('form', [
    'Temperature.{}', 'Bench/velocity/{}', 'Drehzahl.{}', 'torque/{}', 'PLC.Soll.{}.Position',
    'error/{}/position', 'model.{}.position',
])  # fmt: skip
def test_tags_of_other_quantities_are_no_angles(tmp_path, gear, reference, form):
    t, r, o = reference('encoders')
    head = ','.join(['time', *(form.format(one) for one in ('motor', 'output'))])
    path = saved(tmp_path, written([t, r, o], head, '{:.5f}'))
    with pytest.raises(RecordingError, match='neither an angle'):
        read(path, gear, Sources(unit='rad'))


@pytest.mark.parametrize('sign', ['{:.5f}-', '\u2013{:.5f}', '<{:.5f}', '- {:.5f}', '{:.5e}-'])
def test_numbers_with_unknown_marks_are_no_gaps(tmp_path, gear, reference, sign):
    """Taken for gaps, the rotor would have the rows above 0 alone, and the output the others."""

    def signed(value):
        return sign.format(-value) if value < 0.0 else f'{value:.5f}'

    path = saved(tmp_path, written(reference('encoders'), NAMES, ('{:.2f}', signed, signed)))
    with pytest.raises(RecordingError, match=r'rotor has cells such as .*, which are no numbers'):
        read(path, gear)


def test_a_point_alone_is_a_gap(tmp_path, gear, reference):
    """As statistics programs such as SAS write it."""
    t, r, o = reference('encoders')
    output = [f'{value:.5f}' if k % 20 else '.' for k, value in enumerate(o)]
    path = saved(tmp_path, written([t, r, output], NAMES, ('{:.2f}', '{:.5f}', '{}')))
    assert read(path, gear).rows == np.count_nonzero(np.arange(len(t)) % 20)


@pytest.mark.parametrize('first', ['row', 'cycle'])
def test_numbers_of_rows_and_repeats_are_not_proposed_as_times(tmp_path, gear, reference, first):
    t, r, o = reference('encoders')
    numbers = np.arange(len(t)) if first == 'row' else np.sin(t).round(3)
    path = saved(tmp_path, written([numbers, r, o], f'{first},rotor,output', '{}'))
    assert read(path, gear).columns[0] == 'no times'


def test_times_that_may_be_of_the_torque_alone_are_named(tmp_path, gear, reference):
    t, a, q = reference('ramps')
    path = saved(tmp_path, written([t, a, t + 0.5, q], 'time,angle,time.1,torque', '{:.5f}'))
    with pytest.raises(RecordingError, match=r'time and time\.1 may be the times of one column'):
        read(path, gear)


def test_the_given_times_of_the_output_are_not_those_of_the_rotor(tmp_path, gear, reference):
    t, r, o = reference('encoders')
    path = saved(tmp_path, written([t[1:], o[1:], t[:-1], r[:-1]], 't_o,output,t_m,rotor'))
    assert_measured(read(path, gear, Sources(output_time='t_o')), gear)


@pytest.mark.parametrize('names', ['x,rotor,output', 'T,rotor,output', 'time,angle,torque'])
def test_times_of_the_output_alone_are_refused(tmp_path, gear, reference, names):
    """Numbers called T are no times if they fall, as temperatures do."""
    t, r, o = reference('encoders')
    path = saved(tmp_path, written([-t, r, o, t], f'{names},t_o', '{:.5f}'))
    with pytest.raises(
        RecordingError, match='--output-time-column needs both encoders, and --time-co'
    ):
        read(path, gear, Sources(output_time='t_o'))


def test_rows_with_a_torque_of_their_own_are_no_filled_gaps(tmp_path, gear):
    """Ideal encoders whose counts of rotor and output never change in the same row."""
    count, time = math.tau / 4096, np.arange(20_000) * 1e-3
    rotor = count * (100.0 * np.minimum(time, 20.0 - time) + 0.37)
    output = count * np.round(0.1 * rotor / count + 0.26)
    torque = np.random.default_rng(1).normal(2.0, 0.05, len(time))
    columns = [time, count * np.round(rotor / count), output, torque]
    path = saved(tmp_path, written(columns, 'time,rotor,output,torque', '{:.6f}'))
    given = replace(gear, gear_ratio='10')
    assert len(read(path, given).encoders.rotor.stamp) == len(time)


@pytest.mark.parametrize('slow', [1, 2])
def test_a_slow_sensor_of_torque_or_angle_adds_no_hysteresis(tmp_path, gear, reference, slow):
    columns = [*reference('ramps')]
    _, angle, torque = columns
    columns[slow] = np.repeat(columns[slow][::4], 4)
    path = saved(tmp_path, written(columns, 'time,angle,torque', 3 * ['{:.6f}']))
    locked = read(path, gear).locked
    # If each row had a reading, it would be 0.82 or 1.16 times as large.
    area = trapezoid(locked.angle, locked.torque)
    assert area == pytest.approx(trapezoid(angle, torque), rel=0.03)


def test_an_axis_that_is_moved_in_steps_is_read_in_each_row(tmp_path, gear):
    """Its encoder repeats each reading, and the other scatters around an angle that stands."""
    time, rotor = 0.01 * np.arange(1000), 0.2 * np.repeat(np.arange(100), 10)
    output = rotor / -30.0 + np.random.default_rng(1).normal(0.0, 2e-3, 1000)
    path = saved(tmp_path, written([time, rotor, output], NAMES))
    assert len(read(path, gear).encoders.rotor.stamp) == 1000


def test_a_table_without_names_that_begins_with_whole_numbers_has_no_joints(
    tmp_path, gear, reference
):
    t, r, o = reference('encoders')
    path = saved(tmp_path, written([0 * t, 0 * t, t, r, o], '', 2 * ['{:.0f}'] + 3 * ['{:.5f}']))
    given = Sources(time='3', rotor='4', output='5', unit='rad')
    assert_measured(read(path, gear, given), gear)


def test_an_index_without_a_name_is_proposed_for_the_times(tmp_path, gear, reference):
    t, r, o = reference('encoders')
    path = saved(tmp_path, written([t, r, o], ',rotor,output'))
    with pytest.raises(RecordingError, match=r'--time-column 1$') as caught:
        read(path, gear, Sources(needs_times=True))
    assert read(path, gear, followed(caught.value)).encoders.timed


@pytest.mark.parametrize('columns', [2, 3])
def test_the_first_column_without_a_name_that_rises_is_no_encoder(
    tmp_path, gear, reference, columns
):
    path = saved(tmp_path, written(reference('encoders')[:columns], '', '{:.6f}'))
    with pytest.raises(RecordingError, match='neither an angle') as told:
        read(path, gear)
    if columns == 2:
        assert 'for example' not in str(told.value)
    else:
        assert (followed(told.value).rotor, followed(told.value).output) == ('2', '3')


@pytest.mark.parametrize(('kind', 'names'), [
    ('encoders', 't,pressure_2,pressure_1'), ('encoders', 't,Range,Exchange'),
    ('encoders', 't,Drehzahl [°],Schleppfehler [°]'),
    ('encoders', '时间,目标角度[deg],指令位置[deg]'),
    ('encoders', 't,Shear Strain (deg),Axial Strain (deg)'),
    ('encoders', 't,motor_pos_rad,output_pos_mm'), ('encoders', 't,qy,qx'),
    ('encoders', 't,motor [rad s^-1],output [rad·s⁻¹]'), ('encoders', 't,motor rad s-1,output'),
    ('ramps', 'time,actual_q_0,momentum_0'), ('ramps', 'time,Efficiency (kgf/W),Torque (N·m)'),
])  # fmt: skip
def test_only_angles_and_torques_are_proposed(tmp_path, gear, reference, kind, names):
    path = saved(tmp_path, written(reference(kind), names, '{:.6f}'))
    with pytest.raises(RecordingError, match='by --angle-column, --torque-column'):
        read(path, gear)


@pytest.mark.parametrize('form', ['{}_motor_pos,{}_output_pos', 'motor_pos[{}],joint_pos[{}]'])
def test_encoders_of_one_joint_are_proposed_together(tmp_path, gear, reference, form):
    t, r, o = reference('encoders')
    names = [form.format(side, side) for side in ('1', '2')]
    path = saved(tmp_path, written([t, r, o, r / 2, o / 2], ','.join(['time', *names]), '{:.5f}'))
    with pytest.raises(RecordingError) as told:
        read(path, gear)
    given = followed(told.value)
    assert f'{given.rotor},{given.output}' in names


def test_motors_with_the_same_letter_are_no_joint(tmp_path, gear, reference):
    t, r, o = reference('encoders')
    columns = t, r * REV, np.round(o * REV, 3), o
    names = 'time [s],c1 position [rev],c2 position [rev],a3 position [rad]'
    path = saved(tmp_path, written(columns, names, '{:.5f}'))
    with pytest.raises(RecordingError, match='name them with their units') as told:
        read(path, gear)
    given = followed(told.value)
    assert (given.rotor, given.output) == ('c1 position [rev]', 'a3 position [rad]')


def test_numbers_that_touch_are_no_gaps(tmp_path, gear, reference):
    t, r, o = reference('encoders')
    assert r.min() * DEG < -1e4  # of twelve characters
    rows = [
        f'{at:10.3f}{rotor * DEG:12.5f}{out * DEG:12.5f}'
        for at, rotor, out in zip(t, r, o, strict=True)
    ]
    path = saved(tmp_path, '\n'.join(['      time   rotor_deg  output_deg', *rows]) + '\n')
    with pytest.raises(RecordingError, match=r'time has cells such as .*, which are no numbers'):
        read(path, gear)


def test_temperatures_are_no_times(tmp_path, gear, reference):
    t, r, o = reference('encoders')
    for others in ('motor_pos,output_pos,time,temps', 'motor_pos,output_pos,x,temps'):
        content = written([r, o, t, 40.0 + np.round(t / 9.0)], others, '{:.5f}')
        recording = read(saved(tmp_path, content), gear)
        assert recording.encoders.timed == ('time' in others)
    with pytest.raises(RecordingError, match=r'steps of 0\.04 do not tell their unit'):
        read(saved(tmp_path, written([40 + t, r, o], 'temps,rotor,output')), gear)


def test_whole_seconds_are_believed_where_the_rotor_would_be_too_fast_in_ms(
    tmp_path, gear, reference
):
    t, r, o = reference('encoders')
    path = saved(tmp_path, written([50 * t, 10 * r, 10 * o], 'time_s,rotor,output', '{:.0f}'))
    recording = read_table(path, Sources(unit='rad'), gear.gear.gear_ratio)
    assert recording.encoders.duration == pytest.approx(50 * 52.76, rel=1e-3)


@pytest.mark.parametrize('head', ['time_ns', 'time_us', 'time [min]'])
def test_times_of_rows_that_are_seconds_apart_are_believed(tmp_path, gear, reference, head):
    t, r, o = reference('encoders')
    size = {'time_ns': 125e9, 'time_us': 125e6}.get(head, 25.0)  # 5 s and 1 min
    content = written([size * t, r / 50, o / 50], f'{head},rotor,output', '{:.0f}')
    seconds = read(saved(tmp_path, content), gear).both.seconds
    assert np.median(np.diff(seconds)) == pytest.approx(60.0 if 'min' in head else 5.0)


def test_a_rotor_that_stands_where_its_turn_ends_is_not_fast(tmp_path, gear, reference):
    _, r, o = reference('encoders')
    rest = 1e-4 * np.random.default_rng(3).choice([-1.0, 1.0], 20_000)
    r = np.concatenate([rest, r - r[0]]) % math.tau
    columns = 0.1 * np.arange(len(r)), r, np.concatenate([np.full(len(rest), o[0]), o])
    content = written(columns, 'time_ms,rotor_rad,output_rad', '{:.1f}')
    assert read(saved(tmp_path, content), gear).encoders.timed


def test_counts_without_a_unit_say_nothing_of_the_times(tmp_path, gear, reference):
    t, r, o = reference('encoders')
    columns = 1e3 * t / 40, np.round(2**20 * r * REV), np.round(2**20 * o * REV)
    content = written(columns, 'time_ms,motor_pos,output_pos', ['{:.1f}', '{:.0f}', '{:.0f}'])
    with pytest.raises(RecordingError, match='motor_pos has whole numbers, such as counts'):
        read(saved(tmp_path, content), gear)


def test_a_placeholder_for_counts_says_nothing_of_times_in_seconds(tmp_path, gear, reference):
    t, r, o = reference('encoders')
    columns = t / 40, np.round(2**20 * r * REV), np.round(2**20 * o * REV)
    content = written(columns, 'time_s,motor_inc,output_inc', ['{:.6f}', '{:.0f}', '{:.0f}'])
    with pytest.raises(RecordingError, match=r'--rotor-counts 4096 --output-counts 4096$'):
        read(saved(tmp_path, content), gear)


@pytest.mark.parametrize(('unit', 'scale'), [('deg', DEG / 40), ('rad', 3.0)])
def test_the_unit_of_the_other_angle_is_proposed(tmp_path, gear, reference, unit, scale):
    t, r, o = reference('encoders')
    path = saved(tmp_path, written([t, r * scale, o * scale], 't,a,b', 3 * ['{:.5f}']))
    with pytest.raises(RecordingError, match='b does not say that it is an angle') as told:
        read(path, gear, Sources(rotor=f'a [{unit}]', output='b'))
    assert followed(told.value).output == f'b [{unit}]'


def test_times_beside_fast_degrees_without_a_unit_are_believed(tmp_path, gear, reference):
    t, r, o = reference('encoders')
    columns = 1e3 * t / 20, r * DEG, o * DEG  # 720 rad/s
    path = saved(tmp_path, written(columns, 'time_ms,rotor,output', '{:.1f}'))
    with pytest.raises(RecordingError, match=r'rotor has speeds of .* as in degrees'):
        read(path, gear)


def test_slow_ramps_of_torque_may_have_whole_seconds(tmp_path, gear, reference):
    t, a, q = reference('ramps')
    columns = 10.0 * np.arange(len(t)), a * DEG, q
    content = written(columns, 'time_s,angle_deg,torque', ['{:.0f}', '{:.6f}', '{:.4f}'])
    assert read(saved(tmp_path, content), gear).locked


def test_durations_are_no_times(tmp_path, gear, reference):
    t, r, o = reference('encoders')
    fixed = 0.04 * (t > 0.0)
    changed = fixed + 0.001 * (t > 20.0)
    varied = 0.04 + 1e-3 * np.sin(t)
    for duration in (fixed + 0.04, varied, -t, t + math.nan, t % 3.0, fixed, changed):
        content = written([duration, r, o], 'loop_time,rotor,output', 3 * ['{:.5f}'])
        assert not read(saved(tmp_path, content), gear).encoders.timed
    content = written([(t + 1764230000) * (t > 0.0), r, o], 'loop_time,rotor,output')
    assert read(saved(tmp_path, content), gear).encoders.timed


def test_a_sample_that_is_missing_at_a_reversal_is_no_slip(tmp_path, gear, reference):
    columns = reference('encoders')
    kept = np.arange(columns.shape[1]) % 9 != 2
    path = saved(tmp_path, written(columns[:, kept], NAMES, ('{:.2f}', '{:.6f}', '{:.6f}')))
    assert read(path, gear).faults == ()
