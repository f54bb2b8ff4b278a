#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# canopen 2.4.1: a DCF that it exports has the old value of each parameter that was changed, and loses negative ones.
#
# A drive of CiA 402 has a home offset (607C) with ParameterValue=100 in its DCF. A program imports the file, changes
# the value to 300, gives the target velocity (60FF) the value -700 and another default, and exports all by export_od().
# Expected: a DCF with 300 and -700. What happens: where the file had a text, that text is written again, so that the
# home offset stays 100, and the default what it was, in an EDS as well. A negative number is written as 0x-2BC, which
# is no number: the import of this library passes over it without a word, and load_configuration() then leaves the
# speed of the drive as it is. Positive values that the file did not have are right.
# For us: set value_raw and default_raw to decimal text, as '-700', together with value and default.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv venv
venv/bin/pip install --quiet --disable-pip-version-check canopen==2.4.1
cat > drive.dcf <<'EDS'
[FileInfo]
FileName=drive.dcf
EDSVersion=4.0
[DeviceInfo]
VendorName=maker
[DeviceComissioning]
NodeID=5
[MandatoryObjects]
SupportedObjects=0
[OptionalObjects]
SupportedObjects=3
1=0x6065
2=0x607C
3=0x60FF
[6065]
ParameterName=Following error window
ObjectType=0x7
DataType=0x0007
AccessType=rw
DefaultValue=2000
[607C]
ParameterName=Home offset
ObjectType=0x7
DataType=0x0004
AccessType=rw
DefaultValue=0
ParameterValue=100
[60FF]
ParameterName=Target velocity
ObjectType=0x7
DataType=0x0004
AccessType=rw
DefaultValue=-10
[ManufacturerObjects]
SupportedObjects=0
EDS
timeout 60 venv/bin/python - <<'PYTHON'
import canopen

WINDOW, OFFSET, SPEED = 0x6065, 0x607C, 0x60FF


def exported(change):
    """Return default and value of the three objects after a change, an export and an import."""
    drive = canopen.import_od('drive.dcf')
    change(drive)
    canopen.export_od(drive, 'changed.dcf', 'dcf')
    with open('changed.dcf') as file:
        print([line.strip() for line in file if line.startswith(('DefaultValue', 'ParameterValue'))])
    again = canopen.import_od('changed.dcf')
    return [(again[index].default, again[index].value) for index in (WINDOW, OFFSET, SPEED)]


def change(drive):
    drive[WINDOW].value, drive[OFFSET].value, drive[SPEED].value = 500, 300, -700
    drive[SPEED].default = -20


def change_text(drive):
    change(drive)
    drive[OFFSET].value_raw, drive[SPEED].value_raw, drive[SPEED].default_raw = '300', '-700', '-20'


assert exported(lambda drive: None) == [(2000, None), (0, 100), (-10, None)]
found = exported(change)
print('default and value of each object', found)
assert found == [(2000, 500), (0, 100), (-10, None)]
assert exported(change_text) == [(2000, 500), (0, 300), (-20, -700)]
PYTHON
