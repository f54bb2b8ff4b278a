#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# iolink-utils 0.1.0: by the IODD of a torque sensor, 1.5 N·m are read as 1069547520, and a speed of -5 as 65531.
#
# An IODD tells the type of each value in the process data of an IO-Link device: Float32T for the torque, IntegerT for
# the speed and the angle, which have signs, UIntegerT for a counter. Expected of the decoder that
# createDecoderClass_PDIn() makes of it: 1.5, -5, -3 and 7. What happens: each value becomes an unsigned number of as
# many bits, also a float, whose type was read right as float, and an integer of 12 bits, of which -3 is 4093. IntegerT
# and UIntegerT are the same in the definition that it is made of, so that the sign cannot be found later either.
# Nothing warns. Counters, switches and angles that are not negative are right.
# For us: look into the IODD for IntegerT and Float32T, and convert these values yourself.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check iolink-utils==0.1.0
cd "$folder"
cat > Sensor-Torque-20260101-IODD1.1.xml <<'XML'
<?xml version="1.0" encoding="UTF-8"?>
<IODevice xmlns="http://www.io-link.com/IODD/2010/10" xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance">
  <DocumentInfo version="V1.0" releaseDate="2026-01-01" copyright=""/>
  <ProfileBody>
    <DeviceIdentity vendorId="1" vendorName="" deviceId="1"/>
    <DeviceFunction>
      <Features blockParameter="true" dataStorage="true"/>
      <ProcessDataCollection>
        <ProcessData id="P">
          <ProcessDataIn id="I" bitLength="64">
            <Datatype xsi:type="RecordT" bitLength="64">
              <RecordItem subindex="1" bitOffset="32">
                <SimpleDatatype xsi:type="Float32T"/><Name textId="torque"/>
              </RecordItem>
              <RecordItem subindex="2" bitOffset="16">
                <SimpleDatatype xsi:type="IntegerT" bitLength="16"/><Name textId="speed"/>
              </RecordItem>
              <RecordItem subindex="3" bitOffset="4">
                <SimpleDatatype xsi:type="IntegerT" bitLength="12"/><Name textId="angle"/>
              </RecordItem>
              <RecordItem subindex="4" bitOffset="0">
                <SimpleDatatype xsi:type="UIntegerT" bitLength="4"/><Name textId="counter"/>
              </RecordItem>
            </Datatype>
            <Name textId="data"/>
          </ProcessDataIn>
        </ProcessData>
      </ProcessDataCollection>
    </DeviceFunction>
  </ProfileBody>
  <CommNetworkProfile>
    <TransportLayers>
      <PhysicalLayer bitrate="COM3" minCycleTime="1000" sioSupported="true" mSequenceCapability="43"/>
    </TransportLayers>
  </CommNetworkProfile>
  <ExternalTextCollection><PrimaryLanguage xml:lang="en"/></ExternalTextCollection>
</IODevice>
XML
timeout 60 venv/bin/python - <<'PYTHON'
import struct

from iolink_utils.iodd.iodd import Iodd
from iolink_utils.processDataDecoder.processDataDecoder import createDecoderClass_PDIn

definition = Iodd('Sensor-Torque-20260101-IODD1.1.xml').processDataDefinition
types = {item['name'][0]: item['data']['type'] for item in definition[None]['pdIn']['dataFormat']}
assert types == {'torque': float, 'speed': int, 'angle': int, 'counter': int}
Decoder = createDecoderClass_PDIn(definition)


def read(torque, speed, angle, counter):
    """Send the values as the device does, the highest byte first, and return them as they are decoded."""
    data = Decoder.from_buffer_copy(struct.pack('>fhH', torque, speed, (angle & 0xFFF) << 4 | counter))
    return {name: getattr(data, name) for name in Decoder.field_names}


found = read(1.5, -5, -3, 7)
print(found)
assert found == {'torque': 1069547520, 'speed': 65531, 'angle': 4093, 'counter': 7}
assert read(0.0, 5, 3, 7) == {'torque': 0, 'speed': 5, 'angle': 3, 'counter': 7}
PYTHON
