# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Judges a parameter file by recordings of both encoders."""

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from gear_kinematics.kinematics.rotor_turns import TURN
from gear_kinematics.measurement.commissioning.analysis import Commissioning, agrees
from gear_kinematics.measurement.ratio import ENCODER_ERROR
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.report.document import number


@dataclass(frozen=True, slots=True)
class Judgement:
    """A parameter, and what recordings say of it."""

    name: str
    written: str
    """In the file."""
    found: str
    holds: bool | None
    """None: it is left open."""


def judge(result: Commissioning, file: NodeParameters) -> Iterator[Judgement]:
    """Compare the parameters of a file with what recordings determine."""
    if fault := result.longest.unit_fault:
        yield Judgement('unit', 'rad', fault, holds=False)
    ratio, written = file.gear.gear_ratio, str(file.gear.gear_ratio)
    if result.ratio is None:
        yield Judgement('gear_ratio', written, result.fault, None)
        return
    inside = agrees(ratio, result.ratio)
    yield Judgement('gear_ratio', written, result.ratio.plus_minus, inside)
    same = result.ratio.measured.value > 0.0
    right = (file.rotor_direction * file.output_encoder_direction * ratio > 0) == same
    yield Judgement(
        'rotor_direction',
        f'{file.rotor_direction}, output_encoder_direction {file.output_encoder_direction}',
        f'the encoders count in {"the same sense" if same else "opposite senses"}',
        right,
    )
    kind = next((value for value in result.values if value.name == 'rotor_encoder'), None)
    if kind:
        # Positions of any range are used within the turn where the file says single_turn.
        fits = kind.value == file.rotor_encoder or file.single_turn
        yield Judgement(kind.name, file.rotor_encoder, f'{kind.value}: {kind.evidence}', fits)
    if inside and right:
        yield _zero(result, file)
    speed, most = result.longest.greatest_speed, file.max_rotor_speed
    yield Judgement(
        'max_rotor_speed', number(most), f'{number(speed)} rad/s were seen', speed <= most
    )


def _zero(result: Commissioning, file: NodeParameters) -> Judgement:
    """Compare the output angles by both encoders, as the node computes them."""
    last, ratio = result.joints[-1], file.gear.gear_ratio
    by_rotor = file.rotor_direction * (last.turned - file.rotor_zero) / float(ratio)
    measured = file.output_encoder_direction * (last.encoders.measured - file.output_encoder_zero)
    error = measured - by_rotor
    allowed = max(float(np.ptp(error)), ENCODER_ERROR)
    period = math.inf
    if file.single_turn:  # turns of the rotor are unknown at the start
        period = TURN / abs(ratio.numerator)
    elif last.output.wraps:
        period = TURN
    off = math.remainder(float(np.mean(error)), period)
    shown = f'{file.rotor_zero:.6f}, output_encoder_zero {file.output_encoder_zero:.6f}'
    degrees = f'{round(math.degrees(off), 3) + 0.0:.3f}° apart'  # zero has no sign
    if allowed >= period / 2.0 or file.output_encoder_reference == 'absolute':
        return Judgement('rotor_zero', shown, f'{degrees}: nothing is told by that', None)
    right = file.rotor_zero - file.rotor_direction * float(ratio) * off
    found = f'{right:.6f}: both encoders are {degrees}, of which {math.degrees(allowed):.3f}° are '
    found += 'allowed' if abs(off) <= allowed else 'allowed, unless ~/home was called since'
    return Judgement('rotor_zero', shown, found, abs(off) <= allowed)
