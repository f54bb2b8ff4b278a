# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Fuzz a harness of this folder, guided by coverage: python fuzz/run.py messages.

Options of libFuzzer follow the harness, such as -max_total_time=300 (s). It starts from the
harness's corpus in test/corpus; what it finds goes to build/fuzz. An input that fails becomes a
test by copying it into the corpus.
"""

import sys
from importlib import import_module
from pathlib import Path

import atheris

ROOT = Path(__file__).resolve().parents[1]

_name, *_options = sys.argv[1:]
_found = ROOT / 'build' / 'fuzz' / _name
_found.mkdir(parents=True, exist_ok=True)
# Where it follows comparisons of arrays, atheris keeps the results of all of them in memory.
_arrays = ['gear_kinematics.wire.batches']
with atheris.instrument_imports(include=['gear_kinematics'], exclude=_arrays):
    _harness = import_module(_name)
_arguments = [
    sys.argv[0],
    '-timeout=10',  # s
    f'-artifact_prefix={_found}-',
    *_options,
    str(_found),
    str(ROOT / 'test' / 'corpus' / _name),
]
atheris.Setup(_arguments, _harness.check)
atheris.Fuzz()
