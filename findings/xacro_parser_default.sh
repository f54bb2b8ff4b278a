#!/usr/bin/env bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# xacro-parser 0.3.11 (npm): a gear ratio set to 50 is 20, its default, and a brake left out by "False" is there.
#
# By the documentation of xacro, the `default` of a property counts only where the property is not defined yet, and
# "False" is false. Expected, as xacro 2.1.1 gives it: a ratio of 50, which the file of the robot set before that of
# its gear with a default of 20, and no brake where the argument `brake` is "False". What happens: the ratio is 20, and
# the brake is there; "false" is right. ${not brake} of such a property is false as well, so that a part for an arm
# without a brake is lost. ${-7 % 4} is -3, where xacro, which evaluates Python, gives 1. None of this is said by an
# error.
# For us: run xacro itself, and load the URDF that it gives; else write false, and define no property twice.
#
# Exit code 0: still so. Needs node; installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv venv
venv/bin/pip install --quiet --disable-pip-version-check xacro==2.1.1
npm init --yes > /dev/null
npm install --silent --no-audit --no-fund --ignore-scripts xacro-parser@0.3.11 jsdom@26.1.0
cat > arm.xacro <<'XML'
<?xml version="1.0"?>
<robot name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:arg name="brake" default="False"/>
  <xacro:property name="has_brake" value="$(arg brake)"/>
  <xacro:property name="ratio" value="50"/>
  <xacro:property name="ratio" default="20"/>
  <joint name="output" ratio="${ratio}" tooth="${-7 % 4}"/>
  <xacro:if value="$(arg brake)"><joint name="brake"/></xacro:if>
  <xacro:if value="false"><joint name="lower_case"/></xacro:if>
  <xacro:if value="${not has_brake}"><joint name="without_brake"/></xacro:if>
</robot>
XML
cat > read.mjs <<'JS'
import assert from 'node:assert';
import { readFileSync } from 'node:fs';
import { JSDOM } from 'jsdom';

globalThis.DOMParser = new JSDOM('').window.DOMParser;
const { XacroParser } = await import('xacro-parser');

function joints(document) {
  return [...document.getElementsByTagName('joint')].map((joint) => [
    joint.getAttribute('name'), joint.getAttribute('ratio'), joint.getAttribute('tooth')]);
}

const right = joints(new DOMParser().parseFromString(readFileSync(0, 'utf8'), 'text/xml'));
const found = joints(await new XacroParser().parse(readFileSync('arm.xacro', 'utf8')));
console.log('xacro:', right, 'xacro-parser:', found);
assert.deepStrictEqual(right, [['output', '50', '1'], ['without_brake', null, null]]);
assert.deepStrictEqual(found, [['output', '20', '-3'], ['brake', null, null]]);
JS
venv/bin/xacro arm.xacro > arm.urdf
timeout 60 node read.mjs < arm.urdf
