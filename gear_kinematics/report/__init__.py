# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""One document for every report, and its renderings."""
