# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""`gearkin describe`: properties of the mechanism and of its teeth."""

import argparse
from collections.abc import Mapping
from typing import Any

from gear_kinematics import plotting
from gear_kinematics.commands import ExitCode, arguments
from gear_kinematics.commands.reporter import Reporter, add_report_forms
from gear_kinematics.kinematics import Mechanism, loop_closure, vernier
from gear_kinematics.report.document import Cell, Document, Layout, Section, Table, number
from gear_kinematics.shape.angles import arc
from gear_kinematics.shape.teeth import InterferenceError, tooth_pair

_DIGITS = 6
_OF_TEETH = ('working_pressure_angle', 'ring_profile_shift', 'addendum', 'satellite_tip_radius',
             'ring_tip_radius', 'tip_interference_margin', 'contact_ratio')  # fmt: skip
_LENGTHS = ('eccentricity', 'ring_rolling_radius', 'satellite_rolling_radius', 'module',
            'satellite_tip_radius', 'ring_tip_radius')  # fmt: skip
_ANGLES = 'vernier_step', 'working_pressure_angle', 'tip_interference_margin'
_UNITS = {
    **dict.fromkeys(_LENGTHS, 'm'),
    **dict.fromkeys(_ANGLES, 'rad'),
    **dict.fromkeys(('ring_profile_shift', 'addendum'), 'modules'),
}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    arguments.add_mechanism(parser, sizes=True)
    add_report_forms(parser)


def run(options: argparse.Namespace) -> ExitCode:
    reporter = Reporter(options)
    config = arguments.load_config(options)
    described, size = config.mechanism, config.module
    facts = _facts(described, size)
    values = ((name.replace('_', ' '), _cell(name, value)) for name, value in facts.items())
    section = Section(
        '',
        (Table.of_values(Layout.LINES, *values),),
        figure=plotting.outlines(described, size),
        answer=_sentence(facts),
    )
    return reporter.write(
        Document('gearkin describe', (section,), facts), [arguments.config_path(options)]
    )


def _sentence(facts: Mapping[str, Any]) -> str:
    turns = facts['gear_ratio'].removeprefix('-')
    ratio = f'For each turn of the output, the rotor makes {turns} in the opposite direction'
    if facts['interference']:
        return f'{ratio}; {facts["interference"]}.'
    return (
        f'{ratio}; involute teeth mesh with a contact ratio of {number(facts["contact_ratio"])}.'
    )


def _facts(mechanism: Mechanism, module: float) -> dict[str, Any]:
    """Return the properties of the mechanism and of involute teeth with the module, m."""
    zk = mechanism.ring_teeth
    try:
        pair, interference = tooth_pair(mechanism, module), None
    except InterferenceError as error:
        pair, interference = None, str(error)
    return {
        'ring_teeth': zk,
        'satellite_teeth': mechanism.satellite_teeth,
        'eccentricity': mechanism.eccentricity,
        'branches': [branch.name for branch in mechanism.branches],
        'gear_ratio': str(mechanism.gear_ratio),
        'mobility_by_counting': loop_closure.mobility_by_counting(mechanism),
        'mobility_by_rank': loop_closure.mobility_by_rank(mechanism),
        'ring_rolling_radius': mechanism.ring_rolling_radius,
        'satellite_rolling_radius': mechanism.satellite_rolling_radius,
        'oldham_petals': mechanism.oldham_petals,
        'vernier_distinct_positions': vernier.distinct_positions(zk),
        'vernier_step': vernier.step(zk),
        'module': module,
        **{name: getattr(pair, name, None) for name in _OF_TEETH},
        'interference': interference,
    }


def _cell(name: str, value: Any) -> Cell:
    """Format a value for tables: rounded, angles in degrees, minutes and seconds of arc."""
    unit = _UNITS.get(name, '')
    match value:
        case None:
            return Cell('')
        case list():
            return Cell(', '.join(value))
        case float() if unit == 'rad':
            return Cell(arc(value))
        case float():
            return Cell(number(value, _DIGITS), unit=unit)
    return Cell(str(value))
