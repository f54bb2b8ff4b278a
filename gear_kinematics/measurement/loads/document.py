# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The report on the loads of recordings."""

import math
from collections.abc import Iterator, Sequence
from itertools import cycle
from typing import Any, NamedTuple

import numpy as np

from gear_kinematics.bag import ReportProgress
from gear_kinematics.bag.errors import unexpected
from gear_kinematics.fleet.processes import Work
from gear_kinematics.measurement.loads.recorded import (
    ANGLE_BINS,
    Force,
    LoadTask,
    Moment,
    RecordedLoads,
    read_loads,
)
from gear_kinematics.measurement.sentences import Observation, Observed
from gear_kinematics.parameters.arm import labelled
from gear_kinematics.report import document as doc
from gear_kinematics.report.document import number, printable
from gear_kinematics.report.mechanism import MovingMechanism

_LEVELS = 'greatest force', '99.9 % of the forces are below', 'mean force'
_MOST_MOMENTS = 10  # number shown in sentences and as links; the JSON has all
_MOST_UNKNOWN = 0.01  # share of the time: with more of it, a preload cannot be shown to have held
_FRAMES = 1000  # of the moving mechanism
_AROUND = 50  # further frames before and after the beginning of each moment


class LoadReport(NamedTuple):
    """The report on one recording, or why there is none."""

    section: doc.Section | None
    data: dict[str, Any]
    error: str  # one line that names the recording; also damage at which reading ended
    taken: str = ''  # columns that were read from a table


def document(reports: Sequence[LoadReport]) -> doc.Document:
    """Join the reports on recordings."""
    sections = tuple(report.section for report in reports if report.section)
    data = {'schema': 'gear_kinematics/loads', 'version': 1}
    data |= {'recordings': [report.data for report in reports if report.section]}
    return doc.Document('gearkin loads', sections, data)


def report(task: LoadTask, progress: ReportProgress | None = None) -> LoadReport:
    """Report the loads of a recording, and any error about it."""
    try:
        return _report(task, read_loads(task, progress))
    except (ValueError, OSError) as error:
        return _lost(task, str(error))
    except ImportError:
        raise
    except Exception as error:  # noqa: BLE001, the other recordings are worth reporting
        return _lost(task, unexpected(error, debug=task.debug))


def _lost(task: LoadTask, cause: str) -> LoadReport:
    about = labelled(task.parameters.actuator, cause)
    text = cause if str(task.bag) in cause else f'{task.bag}: {about}'
    return LoadReport(None, {}, text)


WORK = Work(report, _lost)  # for `fleet.processes`


def _report(task: LoadTask, loads: RecordedLoads) -> LoadReport:
    preload, verdict = abs(loads.parameters.preload), None
    moments, forces = [*loads.moments()], [*loads.forces(task.cam_rating)]
    source = 'the default parameters' if task.by_default else 'the given parameters'
    answer, loss = _answer(loads, moments, source), loads.slot_loss(task.slot_friction)
    if question := loads.question:
        answer = Observation.IMPLAUSIBLE(answer=answer, question=question)
    unknown, start = loads.unknown
    if gaps := unknown > _MOST_UNKNOWN * loads.time[-1]:
        which = Observation.LOADS_BEGIN_LATE if start < 0.0 else Observation.LOADS_UNKNOWN
        answer = which(answer=answer, seconds=unknown, start=start)
    if preload and (moments or gaps or not question):
        verdict = doc.Verdict.FAIL if moments or gaps else doc.Verdict.PASS
    name, actuator = printable(task.bag.name), task.parameters.actuator
    section = doc.Section(
        f'{name}: {actuator}' if actuator else name,
        (_table(forces),),
        verdict,
        tuple(_findings(answer.sentence, moments, failed=verdict is doc.Verdict.FAIL)),
        tuple(map(str, _remarks(task, loads, loss))),
        doc.Figure((_over_time(loads),), stacked=True),
        _moving(loads, [moment.stamp for moment in moments[:_MOST_MOMENTS]]),
        below=doc.Figure(tuple(_over_angle(forces)), columns=2),
    )
    data = {
        'name': task.bag.name,
        **({'actuator': actuator} if actuator else {}),
        'answer': answer.sentence,
        'verdict': verdict,
        'duration': float(loads.time[-1]),
        'samples': len(loads.time),
        'left_out': loads.left_out,
        'preload': preload or None,
        'needed_preload': loads.needed_preload,
        'moments': [moment._asdict() for moment in moments],
        'forces': {force.name: force._asdict() for force in forces},
        'slot_loss': loss,
    }
    return LoadReport(section, data, loads.damage, loads.taken)


def _answer(loads: RecordedLoads, moments: Sequence[Moment], source: str) -> Observed:
    """Say whose gear it is, whether both branches stayed in mesh, and which preload suffices."""
    seconds, preload = loads.time[-1], abs(loads.parameters.preload)
    known = {
        'ratio': loads.parameters.mechanism.gear_ratio,
        'source': source,
        'time': f'{seconds / 60.0:.1f} min' if seconds >= 100.0 else f'{number(seconds)} s',  # noqa: PLR2004
    }
    if not preload:
        return Observation.NO_PRELOAD(**known, torque=float(np.max(np.abs(loads.torque))))
    known |= {'needed': loads.needed_preload, 'preload': preload}
    if not moments:
        return Observation.IN_MESH(**known)
    total = sum(moment.duration for moment in moments)
    count, start = len(moments), moments[0].start
    return Observation.OUT_OF_MESH(**known, count=count, total=total, start=start)


def _findings(answer: str, moments: Sequence[Moment], *, failed: bool) -> Iterator[doc.Sentence]:
    yield doc.Sentence('error' if failed else 'finding', answer)
    for moment in moments[:_MOST_MOMENTS]:
        found = Observation.BRANCH_OUT_OF_MESH(
            branch=moment.branch,
            duration=moment.duration,
            start=moment.start,
            torque=-moment.least_margin,
        )
        yield doc.Sentence('error', str(found), moment.start)


def _remarks(task: LoadTask, loads: RecordedLoads, loss: float) -> Iterator[Observed]:
    if loads.left_out:
        causes = [f'{cause} {count}' for cause, count in loads.left_out.items()]
        yield Observation.MESSAGES_LEFT_OUT(causes=causes)
    if math.isfinite(task.cam_rating):
        yield Observation.LIFE(rating=task.cam_rating)
    if math.isfinite(loss):
        yield Observation.SLOT_LOSS(friction=task.slot_friction, percent=100.0 * loss)


def _table(forces: Sequence[Force]) -> doc.Table:
    return doc.Table.of_items(
        {
            'force': lambda force: f'{force.name} [{force.unit}]',
            'greatest': lambda force: number(force.greatest),
            '99.9 % below': lambda force: number(force.p99_9),
            'mean': lambda force: number(force.mean),
            'cubic mean': lambda force: _known(force.cubic_mean),
            'L10 [h]': lambda force: _known(force.l10_hours),
        },
        forces,
    )


def _known(value: float) -> str:
    return number(value) if math.isfinite(value) else ''


def _over_time(loads: RecordedLoads) -> doc.Panel:
    if loads.parameters.preload:
        title, values = 'margin to the loss of mesh', loads.margin
    else:
        title, values = 'torque of the output', loads.torque
    line = doc.Line.reduced(title, doc.Pen.FIRST, loads.time, values)
    levels = ((0.0, 'out of mesh below'),) if loads.parameters.preload else ()
    return doc.Panel(title, 'time [s]', f'{title} [N·m]', (line,), levels=levels)


def _over_angle(forces: Sequence[Force]) -> Iterator[doc.Panel]:
    """Draw the forces of teeth and cams over the angle of the rotor, and their spectrum."""
    angle = (np.arange(ANGLE_BINS) + 0.5) * 360.0 / ANGLE_BINS
    drawn = [*zip((force for force in forces if force.unit == 'N'), cycle(doc.PENS))]
    for k, title in enumerate(_LEVELS):
        lines = tuple(
            doc.Line(force.name, pen, angle, np.array(force.by_rotor_angle)[:, k])
            for force, pen in drawn
        )
        yield doc.Panel(title, 'angle of the rotor [°]', 'force [N]', lines)
    spectra = ((force, pen, *np.transpose(force.cycles)) for force, pen in drawn if force.cycles)
    lines = tuple(doc.Line(force.name, pen, x, np.cumsum(y)) for force, pen, x, y in spectra)
    if lines:
        title = 'cycles of at least this range'
        yield doc.Panel('load spectrum', 'range [N]', title, lines, scale='log')


def _moving(loads: RecordedLoads, begins: Sequence[int]) -> MovingMechanism:
    """Show the mechanism over the whole recording, in more detail around the given stamps."""
    last, begun = len(loads.stamp) - 1, np.flatnonzero(np.isin(loads.stamp, begins))
    around = begun[:, np.newaxis] + np.arange(-_AROUND, _AROUND)
    rows = np.append(np.linspace(0, last, _FRAMES), around)
    kept = np.unique(rows.astype(int).clip(0, last))
    parameters, turned = loads.parameters, np.degrees(loads.rotor[kept])
    mechanism = parameters.mechanism
    shares, _ = parameters.sharing.branches(loads.torque[kept])
    torques = np.column_stack(shares)
    return MovingMechanism(
        mechanism,
        parameters.module,
        loads.time[kept],
        turned,
        turned / float(mechanism.gear_ratio),
        int(np.searchsorted(kept, begun[0])) if len(begun) else 0,
        torques / (np.abs(torques).max() or 1.0),  # shares, as the forces are
    )
