# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Several recordings: before and after, over positions of the output, over time."""
