# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Prove twenty simulated gears anew, and write what comes back into docs/twin.md.

python docs/twin_table.py
"""

import sys
from pathlib import Path

sys.path.append(str(Path(__file__).parents[1] / 'test' / 'support'))

from proved_twins import all_proved, filled

PAGE = Path(__file__).with_name('twin.md')

if __name__ == '__main__':
    PAGE.write_text(filled(PAGE.read_text('utf-8'), all_proved()), encoding='utf-8')
