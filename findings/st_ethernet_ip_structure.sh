#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# st-ethernet-ip 2.7.5 (npm): in a structure of a Logix PLC, a goal of 123456789012 counts is sent as 0, and -5 is 251.
#
# A structure of a PLC has a goal in counts as LINT (64 bits), a speed as REAL, a temperature as SINT and a mode as
# DINT. Expected of writing it: each value at the place that the PLC's template gives. What happens: a single LINT is
# put eight bytes behind its place, where the next members are written over it, so that a drive is sent to 0; as the
# last member it is an error. An array of LINT is right. A SINT, which has a sign, is read without one, and a
# temperature of -5 is an error when it is written; a tag of its own is read and written right in both types. The
# template is given as a PLC sends it (Rockwell's 1756-PM020, "Logix 5000 Controllers Data Access").
# For us: write such a goal by a tag of its own, with its member in the name: Axis.Goal.
#
# Exit code 0: still so. Needs node and npm; installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
npm init --yes > /dev/null
npm install --silent --no-audit --no-fund st-ethernet-ip@2.7.5 > install.log 2>&1 || { cat install.log; exit 1; }
cat > axis.js <<'JS'
const assert = require('assert');
const { Structure, Tag } = require('st-ethernet-ip');
const { Template } = require('st-ethernet-ip/dist/structure');

const LINT = 0xc5, REAL = 0xca, SINT = 0xc2, DINT = 0xc4, SIZE = 24;
const members = [['Goal', LINT, 0], ['Speed', REAL, 8], ['Temperature', SINT, 12], ['Mode', DINT, 16]];

// The members of a template: 16 bits of information, 16 bits of the type and 32 bits of the offset, then the names.
function template() {
  const types = Buffer.alloc(8 * members.length);
  members.forEach(([, type, offset], index) => {
    types.writeUInt16LE(type, 8 * index + 2);
    types.writeUInt32LE(offset, 8 * index + 4);
  });
  const made = new Template();
  Object.assign(made._attributes, { MemberCount: members.length, StructureSize: SIZE, StructureHandle: 0x1234 });
  made._parseReadTemplate(Buffer.concat([types, Buffer.from(`Axis;n\0${members.map(([name]) => `${name}\0`).join('')}`)]));
  return made;
}

const axis = new Structure('Axis', { getTemplateByTag: template });

// What the PLC answers to the reading of the structure.
const answer = Buffer.alloc(4 + SIZE);
answer.writeUInt16LE(0x02a0, 0);
answer.writeUInt16LE(0x1234, 2);
answer.writeBigInt64LE(123456789012n, 4);
answer.writeFloatLE(1.5, 12);
answer.writeInt8(-5, 16);
answer.writeInt32LE(8, 20);
axis.parseReadMessageResponse(answer);
console.log('Read:', axis.value);
assert.deepStrictEqual({ ...axis.value }, { Goal: 123456789012n, Speed: 1.5, Temperature: 251, Mode: 8 });

// What is sent to write the same structure, but for the temperature.
axis.value = { Goal: 123456789012n, Speed: 1.5, Temperature: 5, Mode: 8 };
const sent = axis.generateWriteMessageRequest().subarray(-SIZE);
const written = [sent.readBigInt64LE(0), sent.readFloatLE(8), sent.readInt8(12), sent.readInt32LE(16)];
console.log('Sent:', written);
assert.deepStrictEqual(written, [0n, 1.5, 5, 8]);
assert.throws(() => { axis.value = { Goal: 0n, Speed: 1.5, Temperature: -5, Mode: 8 }; }, RangeError);

const temperature = new Tag('Temperature');
temperature.parseReadMessageResponse(Buffer.from([SINT, 0, 0xfb]));
const goal = new Tag('Axis.Goal', null, LINT);
const single = goal.generateWriteMessageRequest(123456789012n).subarray(-8).readBigInt64LE();
console.log('As tags of their own:', temperature.value, single);
assert.deepStrictEqual([temperature.value, single], [-5, 123456789012n]);
JS
timeout 60 node axis.js
