# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""`gearkin describe`: properties of the mechanism and of its teeth."""

import argparse
from collections.abc import Mapping
from typing import Any, NamedTuple

from gear_kinematics import plotting
from gear_kinematics.commands import ExitCode, arguments
from gear_kinematics.commands.reporter import Reporter, add_report_forms
from gear_kinematics.kinematics import Mechanism, loop_closure, vernier
from gear_kinematics.report.document import Cell, Document, Layout, Section, Table, number
from gear_kinematics.shape.angles import arc
from gear_kinematics.shape.teeth import InterferenceError, tooth_pair

_DIGITS = 6


class _Fact(NamedTuple):
    """A value (None if it does not exist) with its key in JSON and its unit."""

    key: str
    value: Any
    unit: str = ''

    @property
    def cell(self) -> Cell:
        """Format the value for tables: rounded, angles in degrees, minutes and seconds of arc."""
        match self.value:
            case None:
                return Cell('')
            case list():
                return Cell(', '.join(self.value))
            case float() if self.unit == 'rad':
                return Cell(arc(self.value))
            case float():
                return Cell(number(self.value, _DIGITS), unit=self.unit)
        return Cell(str(self.value))


def add_arguments(parser: argparse.ArgumentParser) -> None:
    arguments.add_mechanism(parser, sizes=True)
    add_report_forms(parser)


def run(options: argparse.Namespace) -> ExitCode:
    reporter = Reporter(options)
    config = arguments.load_config(options)
    described, size = config.mechanism, config.module
    facts = [*_facts(described), *_tooth_facts(described, size)]
    values = ((fact.key.replace('_', ' '), fact.cell) for fact in facts)
    data = {fact.key: fact.value for fact in facts}
    section = Section(
        '',
        (Table.of_values(Layout.LINES, *values),),
        figure=plotting.outlines(described, size),
        answer=_sentence(data),
    )
    return reporter.write(
        Document('gearkin describe', (section,), data), [arguments.config_path(options)]
    )


def _sentence(data: Mapping[str, Any]) -> str:
    ratio = f'The rotor turns {data["gear_ratio"]} times as fast as the output'
    if data['interference']:
        return f'{ratio}; {data["interference"]}.'
    return f'{ratio}; involute teeth mesh with a contact ratio of {number(data["contact_ratio"])}.'


def _facts(mechanism: Mechanism) -> list[_Fact]:
    zk = mechanism.ring_teeth
    return [
        _Fact('ring_teeth', zk),
        _Fact('satellite_teeth', mechanism.satellite_teeth),
        _Fact('eccentricity', mechanism.eccentricity, 'm'),
        _Fact('branches', [branch.name for branch in mechanism.branches]),
        _Fact('gear_ratio', str(mechanism.gear_ratio)),
        _Fact('mobility_by_counting', loop_closure.mobility_by_counting(mechanism)),
        _Fact('mobility_by_rank', loop_closure.mobility_by_rank(mechanism)),
        _Fact('ring_rolling_radius', mechanism.ring_rolling_radius, 'm'),
        _Fact('satellite_rolling_radius', mechanism.satellite_rolling_radius, 'm'),
        _Fact('oldham_petals', mechanism.oldham_petals),
        _Fact('vernier_distinct_positions', vernier.distinct_positions(zk)),
        _Fact('vernier_step', vernier.step(zk), 'rad'),
    ]


def _tooth_facts(mechanism: Mechanism, module: float) -> list[_Fact]:
    try:
        pair, interference = tooth_pair(mechanism, module), None
    except InterferenceError as error:
        pair, interference = None, str(error)
    return [
        _Fact('module', module, 'm'),
        _Fact('working_pressure_angle', pair and pair.working_pressure_angle, 'rad'),
        _Fact('ring_profile_shift', pair and pair.ring_profile_shift, 'modules'),
        _Fact('addendum', pair and pair.addendum, 'modules'),
        _Fact('satellite_tip_radius', pair and pair.satellite_tip_radius, 'm'),
        _Fact('ring_tip_radius', pair and pair.ring_tip_radius, 'm'),
        _Fact('tip_interference_margin', pair and pair.tip_interference_margin, 'rad'),
        _Fact('contact_ratio', pair and pair.contact_ratio),
        _Fact('interference', interference),
    ]
