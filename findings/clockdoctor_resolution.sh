#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# clockdoctor 0.1.0: its warning of stamps in steps of 10 ms is gone as soon as one message of another topic has no
# header.
#
# A driver sends a joint at 100 Hz with stamps that are cut to 10 ms, where its clock has no finer ones. Expected: the
# flag "coarse_resolution", whatever else is in the recording. What happens: it is there in a recording of this topic
# alone. With one std_msgs/Float64 beside it, the stamps of all topics get into one table of floats, since one has none,
# and are rounded to multiples of 256 ns there: their resolution is then 0.000001 ms, and no flag is left, nor another
# word. The differences of time are wrong by up to 128 ns.
# For us: gearkin keeps stamps as whole numbers; extract one topic for clockdoctor with --topic.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check clockdoctor==0.1.0 numpy==2.4.6 pandas==3.1.1
cd "$folder"
timeout 100 venv/bin/python - <<'PYTHON'
import contextlib
import io
import json
import re
from pathlib import Path

from clockdoctor.analyze import analyze_jsonl

START = 1764328000 * 10**9


def row(topic, number, schema, **data):
    time = START + number * 10**7 + 345_678
    return {'topic': topic, 'schema_name': schema, 'log_time_ns': time, 'publish_time_ns': time, 'data': data}


def flags(rows, name):
    path = Path(name + '_messages.jsonl')
    path.write_text('\n'.join(map(json.dumps, rows)))
    printed = io.StringIO()
    with contextlib.redirect_stdout(printed):
        analyze_jsonl(path, out_dir=name)
    [resolution] = re.findall(r'resolution~([^;]*);', printed.getvalue())
    data = json.loads(Path(name, name + '_timeline_data.json').read_text())
    found = [flag['type'] for flag in data['flags'] if flag['topic'] == '/joint_states']
    print(name, 'resolution', resolution, 'flags of the joint', found)
    return resolution, found


def stamp(number):
    return {'stamp': {'sec': 1764328000 + number // 100, 'nanosec': number % 100 * 10**7}, 'frame_id': ''}


joint = [row('/joint_states', n, 'sensor_msgs/msg/JointState', header=stamp(n)) for n in range(1000)]
assert flags(joint, 'alone') == ('10.0000ms', ['coarse_resolution'])
assert flags([*joint, row('/temperature', 500, 'std_msgs/msg/Float64')], 'beside') == ('0.0000ms', [])
PYTHON
