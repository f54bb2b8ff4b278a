# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The report on the loads of recordings."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import cycle
from typing import Any

import numpy as np

from gear_kinematics.measurement.envelope import envelope
from gear_kinematics.measurement.loads.analysis import ANGLE_BINS, Force, LoadHistory
from gear_kinematics.report.document import (
    PENS,
    Document,
    Figure,
    Finding,
    Layout,
    Line,
    Panel,
    Pen,
    Section,
    Table,
    Verdict,
    counted,
    number,
    printable,
)
from gear_kinematics.report.mechanism import MovingMechanism

_MOST_MOMENTS = 10  # in the table and as links; all are in the JSON
_FRAMES = 1000  # of the moving mechanism
_AROUND = 50  # more frames before and after the begin of each moment


def document(histories: Sequence[LoadHistory], cam_rating: float | None = None) -> Document:
    """Return the document on the loads of recordings.

    Args:
        histories: of the recordings.
        cam_rating: C, N, of the bearing of a cam, to compute its life.
    """
    found = [_section(history, cam_rating) for history in histories]
    sections = tuple(found)
    plot = None
    if len(found) == 1:
        (head, forces), (history,) = found[0].tables, histories
        panels = tuple(_of_forces(history))
        more = Section('forces', (forces,), figure=Figure(panels))
        sections = replace(found[0], tables=(head,)), more
        plot = Figure((_over_time(history), *panels), columns=2)
    pairs = zip(histories, found, strict=True)
    recordings = [_data(history, section, cam_rating) for history, section in pairs]
    data = {'schema': 'gear_kinematics/loads', 'version': 1, 'recordings': recordings}
    verdicts = {section.verdict for section in found}
    verdict = next((each for each in (Verdict.FAIL, Verdict.PASS) if each in verdicts), None)
    return Document('gearkin loads', sections, data, verdict, plot=plot)


def answer(history: LoadHistory) -> str:
    """Say whether both branches stayed in mesh, and what preload would have held."""
    time = duration(history.duration)
    if not history.parameters.preload:
        return (
            f'Over {time} the output gave at most {number(history.greatest_torque)} '
            'N·m; without the parameter preload, nothing is known of the mesh.'
        )
    needed = number(history.needed)
    given = number(abs(history.parameters.preload))
    least = f'the least preload that would have held: {needed} N·m (set: {given})'
    if not history.moments:
        return f'In {time} both branches were in mesh; {least}.'
    moments = counted(len(history.moments), 'moment')
    first = f'the first at {history.moments[0].start:.3f} s'
    lost = f'{moments} ({number(history.lost)} s), {first}'
    return f'In {time} both branches were in mesh but for {lost}; {least}.'


def duration(seconds: float) -> str:
    """Write a duration in s or min."""
    return f'{seconds / 60.0:.1f} min' if seconds >= 100.0 else f'{number(seconds)} s'  # noqa: PLR2004


def _section(history: LoadHistory, cam_rating: float | None) -> Section:
    verdict = None
    if history.parameters.preload:
        verdict = Verdict.FAIL if history.moments else Verdict.PASS
    said = answer(history)
    findings = [Finding('error' if history.moments else 'finding', said)]
    if verdict == Verdict.PASS:
        findings.clear()
    for moment in history.moments[:_MOST_MOMENTS]:
        text = (
            f'branch {moment.branch} was out of mesh for {number(moment.duration)} s from '
            f'{moment.start:.3f} s on: {number(-moment.least_margin)} N·m beyond the preload'
        )
        findings.append(Finding('error', text, moment.start))
    return Section(
        printable(history.name),
        (_facts(history), _forces(history, cam_rating)),
        verdict,
        tuple(findings),
        tuple(_remarks(history, cam_rating)),
        Figure((_over_time(history),), stacked=True),
        _moving(history),
        answer=said if verdict == Verdict.PASS else '',
    )


def _facts(history: LoadHistory) -> Table:
    facts = [('duration', duration(history.duration)), ('samples', str(len(history.time)))]
    if preload := abs(history.parameters.preload):
        least = f'{number(history.least_margin)} N·m'
        facts += [('preload', f'{number(preload)} N·m'), ('least margin', least)]
        facts.append(('out of mesh', f'{number(history.lost)} s'))
    facts.append(('greatest torque', f'{number(history.greatest_torque)} N·m'))
    return Table.of_values(Layout.INLINE, *facts)


def _forces(history: LoadHistory, cam_rating: float | None) -> Table:
    def life(force: Force) -> str:
        hours = _life(history, force, cam_rating)
        return f'{number(hours)} h' if hours else ''

    return Table.of_items(
        {
            'force': lambda force: f'{force.name} [{force.unit}]',
            'greatest': lambda force: number(force.greatest),
            '99.9 % below': lambda force: number(force.often),
            'mean': lambda force: number(force.mean),
            'cubic mean': lambda force: number(force.cubic_mean) if history.turns else '',
            'L10': life,
        },
        history.forces,
    )


def _life(history: LoadHistory, force: Force, cam_rating: float | None) -> float | None:
    """L10 of a cam's bearing, h."""
    if not (cam_rating and history.turns and force.name.startswith('cam')):
        return None
    return history.life(cam_rating, force)


def _remarks(history: LoadHistory, cam_rating: float | None) -> Iterator[str]:
    if history.left_out:
        causes = ', '.join(f'{cause} {count}' for cause, count in history.left_out.items())
        yield f'Messages left out: {causes}.'
    if cam_rating:
        yield (
            f'L10 by ISO 281 for ball bearings of C = {number(cam_rating)} N, at the speed '
            'and the cubic mean load of this recording; without lubrication and contamination '
            'factors.'
        )
    if history.slot_loss is not None:
        yield (
            f'At μ = {history.slot_friction:g}, friction of the slots takes '
            f'{100.0 * history.slot_loss:.1f} % of the work of the output, if each couple acts as '
            'two forces at a distance of twice the rolling radius of the satellite.'
        )


def _over_time(history: LoadHistory) -> Panel:
    time, label = history.time, 'time [s]'
    if not history.parameters.preload:
        line = Line('torque', Pen.FIRST, *envelope(time, history.torque))
        return Panel('torque of the output', label, 'torque [N·m]', (line,))
    line = Line('margin', Pen.FIRST, *envelope(time, history.margin))
    level = (0.0, 'out of mesh below')
    return Panel('margin to the loss of mesh', label, 'margin [N·m]', (line,), levels=(level,))


def _of_forces(history: LoadHistory) -> Iterator[Panel]:
    """Draw the greatest forces over the angle of the rotor, and the load spectrum."""
    angle = (np.arange(ANGLE_BINS) + 0.5) * 360.0 / ANGLE_BINS
    pens = dict(zip((force.name for force in history.forces), cycle(PENS)))
    for unit, title in (('N', 'greatest force'), ('N·m', 'greatest couple')):
        lines = tuple(
            Line(force.name, pens[force.name], angle, force.by_angle)
            for force in history.forces
            if force.unit == unit
        )
        yield Panel(title, 'angle of the rotor [°]', f'{title} [{unit}]', lines)
    lines = tuple(
        Line(
            force.name,
            pens[force.name],
            np.array([size for size, _ in force.cycles]),
            np.cumsum([count for _, count in force.cycles]),
        )
        for force in history.forces
        if force.cycles
    )
    if lines:
        title = 'cycles of at least this range'
        yield Panel('load spectrum', 'range [N]', title, lines, scale='log')


def _moving(history: LoadHistory) -> MovingMechanism:
    count = len(history.time)
    rows = {*np.linspace(0, count - 1, _FRAMES).astype(int).tolist()}
    for moment in history.moments[:_MOST_MOMENTS]:
        rows.update(range(max(moment.sample - _AROUND, 0), min(moment.sample + _AROUND, count)))
    kept = np.array(sorted(rows))
    first = history.moments[0].sample if history.moments else 0
    parameters = history.parameters
    mechanism, shares = parameters.mechanism, parameters.sharing.branches(history.torque[kept], np)
    return MovingMechanism(
        mechanism,
        parameters.module,
        history.time[kept],
        np.degrees(history.rotor[kept]),
        np.degrees(history.rotor[kept]) / float(mechanism.gear_ratio),
        int(np.searchsorted(kept, first)),
        np.column_stack([torque for torque, _ in shares]) / mechanism.satellite_rolling_radius,
    )


def _data(history: LoadHistory, section: Section, cam_rating: float | None) -> dict[str, Any]:
    preload = abs(history.parameters.preload)
    return {
        'name': history.name,
        'answer': answer(history),
        'verdict': section.verdict,
        'duration': history.duration,
        'samples': len(history.time),
        'left_out': history.left_out,
        'preload': preload or None,
        'needed_preload': history.needed if preload else None,
        'least_margin': history.least_margin if preload else None,
        'out_of_mesh': history.lost if preload else None,
        'moments': [moment._asdict() for moment in history.moments],
        'greatest_torque': history.greatest_torque,
        'slot_loss': history.slot_loss,
        'forces': {
            force.name: {
                'unit': force.unit,
                'greatest': force.greatest,
                'p99_9': force.often,
                'mean': force.mean,
                'cubic_mean': None if math.isnan(force.cubic_mean) else force.cubic_mean,
                'l10_hours': _life(history, force, cam_rating),
                'by_rotor_angle': [None if math.isnan(x) else x for x in force.by_angle.tolist()],
                'cycles': [{'range': size, 'count': count} for size, count in force.cycles],
            }
            for force in history.forces
        },
    }
