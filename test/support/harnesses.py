# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The harnesses of the fuzzer, which are no modules of a package."""

from functools import cache
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path


@cache
def harness(name):
    """Load one by its name."""
    path = Path(__file__).resolve().parents[2] / 'fuzz' / f'{name}.py'
    spec = spec_from_file_location(f'fuzz_{name}', path)
    module = module_from_spec(spec)
    spec.loader.exec_module(module)
    return module
