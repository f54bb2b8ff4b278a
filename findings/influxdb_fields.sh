#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# influxdb-client 1.50.0 (and for npm 1.35.0): positions with a gap become texts, and in npm '1e6' counts become 1.
#
# Expected of a DataFrame's column of 1.5, None and 2.0: numbers in the line protocol. What happens if its dtype is
# object, as after df.where(df.notna(), None) or from a database: position="1.5", a text, which InfluxDB neither
# averages nor plots, and that blocks later numbers of this name; influxdb3-python 0.21.0 does the same. A Point with
# a pandas Timestamp, or with an ISO text, loses all below the microsecond, although its precision is the nanosecond;
# the index of a DataFrame keeps it. In npm intField() takes '1e6' as 1, -1.9 as -2 but 1.9 as 1, and
# 9007199254740993n as ...992; floatField() takes '1,5' as 1; booleanField() takes 'false' as true. Both only refuse
# what does not begin with a number.
# For us: convert with astype(float), Number() and Math.round() first; give stamps as whole numbers, in npm as a text.
#
# Exit code 0: still so. Needs node; installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv venv
venv/bin/pip install --quiet --disable-pip-version-check \
    influxdb-client==1.50.0 influxdb3-python==0.21.0 pandas==3.1.1 numpy==2.4.6
npm install --silent --no-audit --no-fund --ignore-scripts @influxdata/influxdb-client@1.35.0
timeout 60 venv/bin/python - <<'PYTHON'
from importlib import import_module

import numpy as np
import pandas as pd

STAMP = 1795838400000000123
for package in ('influxdb_client.client', 'influxdb_client_3.write_client.client'):
    serializer = import_module(f'{package}.write.dataframe_serializer')
    write_api = import_module(f'{package}.write_api')
    point = import_module(package.split('.')[0]).Point
    lines = {}
    for kind in (float, object):
        column = pd.Series([1.5, np.nan, 2.0]).astype(kind)
        frame = pd.DataFrame({'position': column.where(column.notna(), None)})
        frame.index = pd.to_datetime([STAMP, STAMP + 1, STAMP + 2], utc=True)
        lines[kind] = serializer.data_frame_to_list_of_points(
            frame, write_api.PointSettings(), data_frame_measurement_name='motor'
        )
    stamps = [STAMP, pd.Timestamp(STAMP), '2026-11-28T04:00:00.000000123Z']
    points = [point('motor').field('position', 1.5).time(stamp, 'ns').to_line_protocol() for stamp in stamps]
    print(package, lines, points)
    assert lines[float] == [f'motor position=1.5 {STAMP}', f'motor position=2.0 {STAMP + 2}']
    assert lines[object] == [f'motor position="1.5" {STAMP}', f'motor position="2.0" {STAMP + 2}']
    assert [int(line.split()[-1]) - STAMP for line in points] == [0, -123, -123]
PYTHON
cat > fields.cjs <<'JAVASCRIPT'
const assert = require('node:assert');
const { Point } = require('@influxdata/influxdb-client');

const written = [
  ['intField', '1e6'], ['intField', 1.9], ['intField', -1.9], ['intField', 9007199254740993n],
  ['floatField', '1,5'], ['booleanField', 'false'],
].map(([method, value]) => new Point('motor')[method]('field', value).timestamp('1').toLineProtocol().split(/[= ]/)[2]);
console.log(written);
assert.deepEqual(written, ['1i', '1i', '-2i', '9007199254740992i', '1', 'T']);
JAVASCRIPT
timeout 60 node fields.cjs
