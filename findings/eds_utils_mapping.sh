#!/usr/bin/env bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# eds-utils 0.3.1: a TPDO with two of eight objects mapped has eight in the .dcf that eds2dcf makes of a drive's .eds.
#
# By CiA 301, subindex 0 of 0x1A00 is the number of objects that a TPDO has, not the number of its subindices, and it
# can be written; that of 0x1003 is the number of errors that have occurred. An .eds has a status word and a position
# in a TPDO that can have eight objects, and no error in a list of four. Expected of eds2dcf: a .dcf with the same
# values, and the number of the node. What happens: the TPDO has eight objects, six of which are the object 0 of 0
# bits, and the list has four errors, since the number of subindices is written to each subindex 0, which becomes
# constant. A master that configures the drive by this file asks it to map objects that do not exist. The identifier
# $NODEID+0x180 is right.
# For us: copy the .eds, and write a section DeviceComissioning into it by hand.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check eds-utils==0.3.1 canopen==2.4.1
cd "$folder"
cat > read.py <<'PYTHON'
import subprocess

import canopen

MANUFACTURER = '[ManufacturerObjects]\nSupportedObjects=0\n'


def variable(section, name, kind, access, value):
    return (f'[{section}]\nParameterName={name}\nObjectType=0x7\nDataType={kind}\n'
            f'AccessType={access}\nDefaultValue={value}\nPDOMapping=1\n')


def group(index, name, kind, variables):
    """Return a record or an array of (name, data type, access, value) for each subindex."""
    text = f'[{index}]\nParameterName={name}\nObjectType={kind}\nSubNumber={len(variables)}\n'
    return text + ''.join(variable(f'{index}sub{sub:X}', *values) for sub, values in enumerate(variables))


eds = '[FileInfo]\nFileName=drive.eds\n[DeviceInfo]\nNrOfTXPDO=1\n'
eds += '[MandatoryObjects]\nSupportedObjects=3\n1=0x1000\n2=0x1001\n3=0x1018\n'
eds += variable('1000', 'Device type', '0x7', 'ro', '0x20192') + variable('1001', 'Error register', '0x5', 'ro', '0')
eds += group('1018', 'Identity', '0x9', [('Highest sub-index', '0x5', 'const', '1'), ('Vendor', '0x7', 'ro', '1')])
eds += '[OptionalObjects]\nSupportedObjects=5\n1=0x1003\n2=0x1800\n3=0x1A00\n4=0x6041\n5=0x6064\n'
eds += group('1003', 'Errors', '0x8', [('Number of errors', '0x5', 'rw', '0'),
                                       *((f'Error {number}', '0x7', 'ro', '0') for number in range(1, 5))])
eds += group('1800', 'TPDO 1', '0x9', [('Highest sub-index', '0x5', 'const', '2'),
                                       ('COB-ID', '0x7', 'rw', '$NODEID+0x180'), ('Type', '0x5', 'rw', '1')])
eds += group('1A00', 'TPDO 1 mapping', '0x9', [
    ('Number of objects', '0x5', 'rw', '2'), ('Object 1', '0x7', 'rw', '0x60410010'),
    ('Object 2', '0x7', 'rw', '0x60640020'), *((f'Object {number}', '0x7', 'rw', '0') for number in range(3, 9))])
eds += variable('6041', 'Status word', '0x6', 'ro', '0') + variable('6064', 'Position', '0x4', 'ro', '0')
with open('drive.eds', 'w') as file:
    file.write((eds + MANUFACTURER).replace('\n[', '\n\n[') + '\n')
subprocess.run(['venv/bin/eds2dcf', 'drive.eds', '5', 'elbow', '-o', 'drive.dcf'], check=True)
found = {}
for name in ('drive.eds', 'drive.dcf'):
    objects = canopen.import_od(name, node_id=5)
    number = objects[0x1A00][0]
    found[name] = (number.default, number.access_type, objects[0x1003][0].default, objects[0x1800][1].default)
    print(f'{name}: {number.default} objects ({number.access_type}), {found[name][2]} errors, {found[name][3]:#x}')
assert found == {'drive.eds': (2, 'rw', 0, 0x185), 'drive.dcf': (8, 'const', 4, 0x185)}, found
PYTHON
timeout 60 venv/bin/python read.py
