#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# rod 0.5.0: if one joint of an SDFormat file has a damping but no spring, the arm that is read has no joints at all.
#
# An arm has a shoulder with <dynamics><damping>0.1</damping></dynamics> and an elbow without. Expected: two joints, or
# an error. What happens: joints() is empty, without an error or a warning, and what is saved has three links and no
# joint. The specification of SDFormat 1.10 gives spring_reference and spring_stiffness, which it marks as required, a
# default of 0, and many files have a damping alone; rod drops all joints if a single one lacks them.
# For us: write spring_reference and spring_stiffness into each element dynamics, and count the joints that were read.
#
# Exit code 0: still so. Installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check rod==0.5.0 numpy==2.4.6
cat > "$folder/joints.py" <<'PYTHON'
import rod

JOINT = """<joint name="{}" type="revolute"><parent>{}</parent><child>{}</child>
  <axis><xyz>0 0 1</xyz><limit><lower>-1</lower><upper>1</upper></limit>{}</axis></joint>"""
LINKS = '<link name="base"/><link name="upper"/><link name="fore"/>'
DAMPING = '<dynamics><damping>0.1</damping>{}</dynamics>'
SPRING = '<spring_reference>0</spring_reference><spring_stiffness>0</spring_stiffness>'

for name, dynamics, count in (
    ('no damping', '', 2),
    ('damping', DAMPING.format(''), 0),
    ('damping and spring', DAMPING.format(SPRING), 2),
):
    joints = JOINT.format('shoulder', 'base', 'upper', dynamics) + JOINT.format('elbow', 'upper', 'fore', '')
    text = f'<sdf version="1.10"><model name="arm">{LINKS}{joints}</model></sdf>'
    read = rod.Sdf.load(text)
    model = read.models()[0]
    saved = read.serialize()
    print(name, '- joints', [joint.name for joint in model.joints()], 'saved', saved.count('<joint'))
    assert len(model.links()) == 3 and len(model.joints()) == saved.count('<joint') == count
PYTHON
timeout 90 "$folder/venv/bin/python" "$folder/joints.py" > "$folder/out" 2>&1 || { cat "$folder/out"; exit 1; }
cat "$folder/out"
if grep -iE 'warn|error' "$folder/out"; then exit 1; fi
