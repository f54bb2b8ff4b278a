#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# cantools 45.1.0: by the C code that it generates, no current of a motor is in its range if its factor is negative.
#
# A .dbc gives a current from -100 A to 100 A with a factor of -0.01, as the motor is mounted the other way round, and
# an angle from -355.35 to 300 degrees with a factor of -0.01 and an offset of 300. Expected of the functions
# ..._is_in_range() of generate_c_source, which take raw values: true for 50 A, false for 101 A. What happens: the
# limits are divided by the factor one by one and not exchanged, so that a value must be at least 10000 and at most
# -10000: not one of all 65536 raw values is in range. A program that sends or takes only values in range loses all. A
# torque with the factor 0.01 is right, and so are ..._is_in_phys_range() and the range check of Python, in which the
# same fault was mended in 2023 (pull request 637).
# Output: raw values in range of 65536: current 0, angle 0, torque 20001
#         50 A: raw -5000, in range 0, in physical range 1; Python: sent as -5000, and 101 A is refused
# For us: use ..._is_in_phys_range() before the encoding, or keep the factors positive.
#
# Exit code 0: still so. Needs a C compiler, cc; installs the version into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
python3 -m venv "$folder/venv"
"$folder/venv/bin/pip" install --quiet --disable-pip-version-check cantools==45.1.0
cd "$folder"
cat > bench.dbc <<'DBC'
VERSION ""
NS_ :
BS_:
BU_: Drive Host
BO_ 256 Motor: 6 Drive
 SG_ Current : 0|16@1- (-0.01,0) [-100|100] "A" Host
 SG_ Angle : 16|16@1+ (-0.01,300) [-355.35|300] "deg" Host
 SG_ Torque : 32|16@1- (0.01,0) [-100|100] "Nm" Host
DBC
venv/bin/cantools generate_c_source bench.dbc > /dev/null
cat > count.c <<'C'
#include <stdio.h>
#include "bench.h"

int main(void)
{
    int current = 0, angle = 0, torque = 0;
    for (long raw = 0; raw < 65536; raw++) {
        current += bench_motor_current_is_in_range((int16_t)(raw - 32768));
        angle += bench_motor_angle_is_in_range((uint16_t)raw);
        torque += bench_motor_torque_is_in_range((int16_t)(raw - 32768));
    }
    printf("raw values in range of 65536: current %d, angle %d, torque %d\n", current, angle, torque);
    int16_t raw = bench_motor_current_encode(50.0);
    printf("50 A: raw %d, in range %d, in physical range %d; ", raw, bench_motor_current_is_in_range(raw),
           bench_motor_current_is_in_phys_range(50.0));
    return 0;
}
C
cc -o count count.c bench.c -lm
./count > seen
timeout 60 venv/bin/python - >> seen <<'PYTHON'
import cantools

message = cantools.database.load_file('bench.dbc').get_message_by_name('Motor')
values = {'Current': 50, 'Angle': 10, 'Torque': 5}
raw = int.from_bytes(message.encode(values)[:2], 'little', signed=True)
try:
    message.encode(values | {'Current': 101})
    answer = 'sent'
except cantools.database.EncodeError:
    answer = 'refused'
print(f'Python: sent as {raw}, and 101 A is {answer}')
PYTHON
cat seen
diff seen - <<'TEXT'
raw values in range of 65536: current 0, angle 0, torque 20001
50 A: raw -5000, in range 0, in physical range 1; Python: sent as -5000, and 101 A is refused
TEXT
