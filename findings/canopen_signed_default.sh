#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# canopen 2.4.1: the hexadecimal default of a signed object in an EDS is read as an unsigned number.
#
# A drive of CiA 402 has Min position range limit (607B:01), a signed number of 32 bits, with LowLimit and DefaultValue
# 0x80000000, as EDS files of drives have it. The limit is read as -2147483648, the default as 2147483648. A LocalNode
# made from the file, such as a simulated drive, then cannot answer: it aborts the upload of its own default.
# For us: a simulated drive needs its defaults set as `od[0x607B][1].default -= 2**32`.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check canopen==2.4.1
cd "$folder"
cat > drive.eds <<'EDS'
[DeviceInfo]
VendorName=bench
[OptionalObjects]
SupportedObjects=1
1=0x607B
[607B]
ParameterName=Position range limit
ObjectType=0x8
SubNumber=2
[607Bsub0]
ParameterName=Highest sub-index
ObjectType=0x7
DataType=0x0005
AccessType=ro
DefaultValue=1
[607Bsub1]
ParameterName=Min position range limit
ObjectType=0x7
DataType=0x0004
AccessType=rw
LowLimit=0x80000000
HighLimit=0x7FFFFFFF
DefaultValue=0x80000000
EDS
timeout 60 venv/bin/python - 2> log <<'PYTHON'
import canopen

entry = canopen.import_od('drive.eds')[0x607B][1]
print('limit', entry.min, 'default', entry.default)
assert (entry.min, entry.default) == (-(2**31), 2**31)
host, drive = canopen.Network(), canopen.Network()
for network in (host, drive):
    network.connect(interface='virtual', channel='bench')
drive.add_node(canopen.LocalNode(2, canopen.import_od('drive.eds')))
limit = host.add_node(canopen.RemoteNode(2, canopen.import_od('drive.eds'))).sdo[0x607B][1]
try:
    limit.raw
except canopen.SdoAbortedError as error:
    print('upload:', error)
else:
    raise AssertionError('it is answered')
limit.raw = -(2**31)
assert limit.raw == -(2**31)
for network in (host, drive):
    network.disconnect()
PYTHON
grep -m 1 'does not fit' log
