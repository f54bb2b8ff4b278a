# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Messages as bytes: CDR to numbers and back, one message at a time or in batches."""
