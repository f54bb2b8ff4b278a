#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# ingenialink 7.6.3: a flag of a drive that was saved as False is loaded as True, and lost samples are never reported.
#
# A drive has the flag BRAKE_INVERTED, False, and an offset of -5 counts, both in its memory that stays. Expected of
# save_configuration() and then load_configuration() of the same file: both as they were. What happens: the file has
# storage="False", which is read as bool("False"), so that the flag is True after it. check_configuration() refuses the
# drive before, which is as it was when the file was made, and passes it after. No error, also with strict=True.
# The second one: Poller.data says whether samples were lost; of about 500 in half a second, its buffer of ten keeps
# ten. Expected: lost, True. What happens: the mark is removed before it is returned, so that it is always False.
# A drive whose registers are kept in memory takes the place of the one on the network.
# Output: saved False and -5, check: refused; loaded True and -5, check: passed
#         samples of 0.5 s each: 10, lost: False; 10, lost: False
# For us: leave flags out of a configuration and write them one by one; look at the stamps of a poller for gaps.
#
# Exit code 0: still so. Installs the version into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check ingenialink==7.6.3
cd "$folder"
timeout 60 "$folder/venv/bin/python" - 2> log <<'PYTHON' || { cat log; exit 1; }
import time
from pathlib import Path

from ingenialink.ethernet.servo import EthernetServo
from ingenialink.exceptions import ILConfigurationError
from ingenialink.poller import Poller

LABEL = '<Labels><Label lang="en_US">Bench</Label></Labels>'
REGISTERS = [
    ('BRAKE_INVERTED', 'rw', 'NVM_CFG', 'bool', 1),
    ('POSITION_OFFSET', 'rw', 'NVM_CFG', 's32', 1),
    ('ACTUAL_POSITION', 'r', 'NVM_NONE', 's32', 1),
    *((f'DRV_ID_{name}{end}', 'r', 'NVM_NONE', kind, node)
      for name, kind in (('PRODUCT_CODE', 'u32'), ('REVISION_NUMBER', 'u32'), ('SERIAL_NUMBER', 'u32'))
      for end, node in (('_COCO', 0), ('', 1))),
]
REGISTER = ('<Register id="{}" access="{}" address_type="{}" dtype="{}" subnode="{}" address="0x{:04X}" units="-"'
            ' cyclic="CONFIG" desc="-" cat_id="BENCH"/>')
DICTIONARY = f"""<IngeniaDictionary>
<Header><Version>2</Version><DefaultLanguage>en_US</DefaultLanguage></Header>
<Body>
<Device family="Summit" name="Bench" PartNumber="BENCH" ProductCode="0" RevisionNumber="0" firmwareVersion="0.1.0"
        Interface="ETH">
<Categories><Category id="BENCH">{LABEL}</Category></Categories>
<Registers>{''.join(REGISTER.format(*parts, 0x100 + k) for k, parts in enumerate(REGISTERS))}</Registers>
</Device>
<Errors><Error id="0x1" affected_module="Bench" error_type="cyclic">{LABEL}</Error></Errors>
</Body>
</IngeniaDictionary>"""


class Drive(EthernetServo):
    """A drive whose registers are kept in memory."""

    def __init__(self):
        self.memory = {}
        super().__init__('127.0.0.1', 'bench.xdf')

    def _write_raw(self, reg, data):
        self.memory[reg.identifier] = data

    def _read_raw(self, reg):
        return self.memory.get(reg.identifier, bytes(4))


def values(drive):
    return [drive.read(name, 1) for name in ('BRAKE_INVERTED', 'POSITION_OFFSET')]


def check(drive):
    try:
        drive.check_configuration('bench.xcf')
    except ILConfigurationError:
        return 'refused'
    return 'passed'


Path('bench.xdf').write_text(DICTIONARY)
drive = Drive()
drive.write('BRAKE_INVERTED', False, 1)
drive.write('POSITION_OFFSET', -5, 1)
drive.save_configuration('bench.xcf')
saved, before = values(drive), check(drive)
drive.load_configuration('bench.xcf', strict=True)
loaded, after = values(drive), check(drive)

poller = Poller(drive, 1)
poller.configure(0.001, 10)
poller.ch_configure(0, 'ACTUAL_POSITION', 1)
poller.start()
polled = []
for _ in range(2):
    time.sleep(0.5)
    stamps, _, lost = poller.data
    polled.append((len(stamps), lost, stamps[0] < 0.25))
poller.stop()

print('saved {} and {}, check: {};'.format(*saved, before), 'loaded {} and {}, check: {}'.format(*loaded, after))
print('samples of 0.5 s each:', '; '.join(f'{count}, lost: {lost}' for count, lost, _ in polled))
assert 'storage="False"' in Path('bench.xcf').read_text()
assert (saved, before, loaded, after) == ([False, -5], 'refused', [True, -5], 'passed')
assert polled == [(10, False, True), (10, False, False)]
PYTHON
