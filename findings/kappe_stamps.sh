#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# kappe 0.25.0: taking log times from the stamps of a recording moves its stamps, and a cut goes by another time.
#
# `update_log_time` is documented to take the log time of each message from the stamp in its header. Expected: log times
# equal to the stamps, and the same stamps as before. What happens: the log times are right, but each stamp is written
# anew from a float of 64 bits, which has steps of 256 ns at this date. A rotor at 100 and 200 ns past the second has
# 0 and 256 ns then, one at 999 999 900 ns has the next second, and 400 and 500 ns become one stamp. An offset of 15 s
# has the same effect. `kappe cut` is documented to compare its seconds with the log time. What happens: it compares
# them with the time of publishing. Of messages that were recorded 50 ms after they were published, the piece from 0
# to 1 s has one that was logged at 1.05 s, and so has the next piece. kappe fetches the definition of TFMessage from
# GitHub before it begins; it is replaced here, since no message of that type is converted.
# For us: round no stamps, as 10**9 * sec + nanosec in integers does not; `gearkin validate` compares them exactly.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check \
    kappe==0.25.0 mcap==1.6.0 mcap-ros2-support==0.6.0 rosbags==0.11.9 numpy==2.4.6
cd "$folder"
timeout 120 venv/bin/python - <<'PYTHON'
from pathlib import Path

import kappe.convert
import numpy as np
from kappe.convert import Converter
from kappe.cut import CutSettings, CutSplits, cutter
from kappe.settings import Settings
from mcap.reader import make_reader
from mcap.writer import Writer
from mcap_ros2.decoder import DecoderFactory
from rosbags.typesys import Stores, get_typestore

KIND = 'sensor_msgs/msg/JointState'
START = 1795838400 * 10**9
store = get_typestore(Stores.ROS2_HUMBLE)
kappe.convert.get_message_definition = lambda kind, *rest: store.generate_msgdef(kind, ros_version=2)[0]


def written(name, times, late=0):
    """A recording of JointStates that are published at their stamps and logged some nanoseconds later."""
    with open(name, 'wb') as file:
        writer = Writer(file)
        writer.start('ros2')
        schema = writer.register_schema(KIND, 'ros2msg', store.generate_msgdef(KIND, ros_version=2)[0].encode())
        channel = writer.register_channel('/rotor', 'cdr', schema)
        for time in times:
            stamp = store.types['builtin_interfaces/msg/Time']((START + time) // 10**9, (START + time) % 10**9)
            header = store.types['std_msgs/msg/Header'](stamp, '')
            state = store.types[KIND](header, ['motor'], np.array([1.0]), np.array([]), np.array([]))
            data = bytes(store.serialize_cdr(state, KIND))
            writer.add_message(channel, START + time + late, data, START + time)
        writer.finish()
    return Path(name)


def read(path):
    """The stamps and log times of a recording, in nanoseconds since the start."""
    with path.open('rb') as file:
        rows = [
            (10**9 * state.header.stamp.sec + state.header.stamp.nanosec - START, message.log_time - START)
            for _, _, message, state in make_reader(file, decoder_factories=[DecoderFactory()]).iter_decoded_messages()
        ]
    return tuple(map(list, zip(*rows)))


def converted(recording, name, **offset):
    """The stamps and log times after `kappe convert` with one offset for all topics."""
    settings = Settings(time_offset={'default': offset}, progress=False, save_metadata=False)
    converter = Converter(settings, recording, Path(name))
    converter.process_file()
    converter.finish()
    return read(Path(name))


times = [0, 100, 200, 300, 400, 500, 999_999_900]
recording = written('stamps.mcap', times)
stamps, log = converted(recording, 'log.mcap', update_log_time=True)
print('Stamps', times, 'are', stamps, 'and log times', log)
assert log == times and stamps == [0, 0, 256, 256, 512, 512, 10**9]
moved, _ = converted(recording, 'moved.mcap', sec=15)
assert [stamp - 15 * 10**9 for stamp in moved] == stamps

late = written('late.mcap', [10**8 * index for index in range(21)], late=5 * 10**7)
second = START // 10**9
splits = [CutSplits(start=second + index, end=second + index + 1, name=str(index)) for index in range(2)]
cutter(late, Path('cut'), CutSettings(splits=splits, progress=False))
pieces = [[round(1e-9 * log, 2) for log in read(Path(f'cut/{index}.mcap'))[1]] for index in range(2)]
print('Logged in the pieces from 0 to 1 s and from 1 to 2 s:', *pieces, sep='\n')
assert pieces[0][-1] == 1.05 and pieces[1][0] == 1.05
PYTHON
