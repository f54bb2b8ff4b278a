#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# pyads 3.6.0: in a structure of TwinCAT 3 a position of 1.5 after a BOOL is read as 0.0, without an error.
#
# Expected: the alignment of TwinCAT 3, 8 bytes, or an error, as the structure has 24 bytes and its definition says 15.
# What happens: dict_from_bytes() takes each field right after the one before, and leaves the bytes over, so that the
# LREAL is read from its padding. It is right for a structure with the attribute 'pack_mode' := '1' in the PLC only.
# In dt_to_filetime() the part of a second is lost: 12:00:00.123456 comes back as 12:00:00.
# For us: ask the length that the PLC gives for a symbol, and compare it with size_of_structure().
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check pyads==3.6.0
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import ctypes
import datetime

import pyads
from pyads import filetimes

definition = (('ready', pyads.PLCTYPE_BOOL, 1), ('position', pyads.PLCTYPE_LREAL, 1), ('limits', pyads.PLCTYPE_INT, 3))


class InThePlc(ctypes.Structure):
    _fields_ = [('ready', ctypes.c_bool), ('position', ctypes.c_double), ('limits', ctypes.c_int16 * 3)]


read = pyads.dict_from_bytes(bytearray(InThePlc(True, 1.5, (1, -2, 3))), definition)
print('bytes', ctypes.sizeof(InThePlc), 'defined', pyads.size_of_structure(definition), read)
assert (ctypes.sizeof(InThePlc), pyads.size_of_structure(definition)) == (24, 15)
assert read['position'] == 0.0 and list(read['limits']) == [0, 0, -2048]
moment = datetime.datetime(2026, 1, 1, 12, 0, 0, 123456)
returned = filetimes.filetime_to_dt(filetimes.dt_to_filetime(moment))
print(moment, returned)
assert returned.replace(tzinfo=None) == datetime.datetime(2026, 1, 1, 12)
PYTHON
