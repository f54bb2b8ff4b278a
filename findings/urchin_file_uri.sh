#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# urchin 0.0.30: a mesh at a `file://` address in a URDF is an error.
#
# The address is passed to trimesh as if it was a path; RViz, Drake, Pinocchio, PyBullet and yourdfpy read it.
# A path relative to the URDF is read.
# Seen: "string is not a file: `file:///...`", of a file that exists.
# For us: the addresses that `gearkin urdf --meshes` writes have to be made relative for urchin.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check urchin==0.0.30
cd "$folder"
"$folder/venv/bin/python" - <<'PYTHON'
from pathlib import Path

import trimesh
import urchin

URDF = """<robot name="box"><link name="base"><visual><geometry>
<mesh filename="{}"/></geometry></visual></link></robot>"""
mesh = Path('box.stl').resolve()
trimesh.creation.box().export(mesh)
Path('relative.urdf').write_text(URDF.format('box.stl'))
assert len(urchin.URDF.load('relative.urdf').visual_trimesh_fk()) == 1
Path('address.urdf').write_text(URDF.format(mesh.as_uri()))
try:
    urchin.URDF.load('address.urdf')
except ValueError as error:
    print(error)
    assert 'string is not a file' in str(error)
else:
    raise AssertionError('it is read')
PYTHON
