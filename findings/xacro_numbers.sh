#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# xacro 2.1.1: the property "01" becomes 1 in the name of a joint, and twice the ratio "1/19" is "1/191/19".
#
# Expected: a property is text that is put where its name stands, and is a number only in a calculation. What happens:
# a text that Python's int() or float() takes is a number from then on. So joint_${id} is joint_1 for 01 and
# joint_100000.0 for 1e5, while joint_$(arg id) stays joint_01: two names of one joint, and a parent link that is
# missing. A ratio of 1/19 is no such number: it stays text, and a calculation repeats the text without an error.
# For us: give a ratio as ${1/19}, and an identifier with a letter in it or as an arg; even ${'01'} becomes 1.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check xacro==2.1.1
timeout 60 "$folder/venv/bin/python" - <<'PYTHON'
import xacro


def expanded(properties, text):
    document = xacro.parse(
        f'<robot xmlns:xacro="http://www.ros.org/wiki/xacro">{properties}<joint name="{text}"/></robot>'
    )
    xacro.process_doc(document, mappings={'id': '01'})
    return document.getElementsByTagName('joint')[0].getAttribute('name')


for value, text, expected in (
    ('01', 'joint_${value}', 'joint_1'),
    ('00123', '${value}', '123'),
    ('1e5', 'joint_${value}', 'joint_100000.0'),
    ("${'01'}", 'joint_${value}', 'joint_1'),
    ('1/19', '${value}', '1/19'),
    ('1/19', '${2 * value}', '1/191/19'),
    ('${1/19}', '${2 * value}', '0.10526315789473684'),
    ('-19', '${2 * value}', '-38'),
):
    name = expanded(f'<xacro:property name="value" value="{value}"/>', text)
    print('property', value, 'in', text, 'gives', name)
    assert name == expected
assert expanded('<xacro:arg name="id" default="01"/>', 'joint_$(arg id)') == 'joint_01'
PYTHON
