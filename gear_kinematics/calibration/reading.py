"""Reads the angles of rotor and output from bags and CSV files, in little memory."""

import hashlib
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from gear_kinematics.bag import (
    Bag,
    BagError,
    DamagedBagError,
    ReportProgress,
    TopicMessages,
    in_batches,
    sort_by_topic,
)
from gear_kinematics.bag.roles import find_encoder_topic, find_rotor_topic, missing_encoder
from gear_kinematics.calibration.normal import Array
from gear_kinematics.calibration.recording import (
    Recording,
    RecordingError,
    RotorMotion,
    match,
    spread,
)
from gear_kinematics.kinematics.rotor_turns import LARGEST_ANGLE, split_turns
from gear_kinematics.lost_motion.recorded.csv_files import ENCODERS, Columns, read_columns
from gear_kinematics.state.output_encoder import EncoderSettings
from gear_kinematics.state.rotor_input import InputSettings, RotorInput
from gear_kinematics.wire.batches import JointStates, decode_joint_states
from gear_kinematics.wire.cdr import SECOND


def read_bag(
    path: Path,
    parameters: Mapping[str, Any],
    rotor_topic: str | None = None,
    encoder_topic: str | None = None,
    progress: ReportProgress | None = None,
) -> Recording:
    """Read a bag.

    Args:
        path: of the bag.
        parameters: of the node, as `parameters.load` returns them.
        rotor_topic: of the rotor's states; None finds it by type and name.
        encoder_topic: of the output's encoder; None finds it by type and name.
        progress: called after each batch, with the messages on all topics of the bag.

    Raises:
        BagError: if the bag cannot be read, or lacks a topic.
        RecordingError: if no output angle can be compared.
    """
    rotor_input = RotorInput(InputSettings.from_mapping(parameters))
    settings = EncoderSettings.from_mapping(parameters)
    inputs: list[tuple[Array, ...]] = []
    outputs: list[tuple[Array, ...]] = []
    remarks, lacking = [], ''
    with Bag(path) as bag:
        encoder = find_encoder_topic(bag, encoder_topic)
        if not encoder:
            raise missing_encoder(bag)
        rotor = find_rotor_topic(bag, rotor_topic, parameters['rotor_joint'])
        messages = bag.messages((rotor, encoder))
        try:
            for batch in in_batches(messages, progress=progress, total=bag.message_count):
                columns = {topic: TopicMessages() for topic in (rotor, encoder)}
                sort_by_topic(batch, columns)
                samples = rotor_input.accept_batch(columns[rotor].data, columns[rotor].received)
                inputs.append(
                    (samples.stamp, samples.turns, samples.angle, samples.effort, samples.stretch)
                )
                states = decode_joint_states(columns[encoder].data, settings.output_encoder_joint)
                lacking = lacking or states.lacking
                outputs.append(_measured(states, columns[encoder].received, settings))
        except DamagedBagError as damage:
            remarks.append(f'{damage}; what was before it is used')
    rejected = rotor_input.rejected.items()
    remarks += [f'{rotor}: {count} states {cause}' for cause, count in rejected]
    stamp, turns, angle, effort, stretch = _joined(inputs, 5)
    if not len(stamp):
        why = f': {rotor_input.why_rejected}' if rotor_input.rejected else ''
        raise BagError(f'{path}: no usable rotor states on {rotor}{why}')
    if set_back := np.flatnonzero(np.diff(stamp) < 0).tolist():
        kept = slice(set_back[0] + 1)
        stamp, turns, angle, effort, stretch = (
            column[kept] for column in (stamp, turns, angle, effort, stretch)
        )
        remarks.append('its clock was set back; what was before is used')
    stamps, angles = _joined(outputs, 2)
    if lacking and not len(stamps):
        raise BagError(f'{path}: {encoder}: {lacking}')
    rows = spread(len(stamps))
    stamps, angles = stamps[rows], angles[rows]
    complete = bool(np.isfinite(effort).all())
    motion = RotorMotion(stamp, turns, angle, effort if complete else None, stretch)
    max_gap = round(settings.transmission_error_max_gap * SECOND)
    try:
        before, share, measured = match(motion, (stamps, angles), max_gap)
    except RecordingError as error:
        raise RecordingError(f'{path}: {error}') from error
    if left_out := len(angles) - len(measured):
        remarks.append(f'{left_out} output angles were not compared: no rotor angle around them')
    return Recording(
        path.name,
        _hash(path),
        motion,
        timed=True,
        separate=True,
        before=before,
        share=share,
        measured=measured,
        remarks=tuple(remarks),
    )


def _measured(
    states: JointStates, times: Sequence[int], settings: EncoderSettings
) -> tuple[Array, Array]:
    """Stamps and output angles of messages of the encoder, and their times of reception, ns."""
    angle = settings.output_angle(states.values[:, 0])
    usable = ~states.malformed & states.present[:, 0] & (np.abs(angle) <= LARGEST_ANGLE)
    received = np.asarray(times, np.int64)
    stamp = np.where(states.stamp == 0, received, states.stamp)
    return stamp[usable], angle[usable]


def _joined(batches: list[tuple[Array, ...]], count: int) -> tuple[Array, ...]:
    """Columns of all batches; frees those of the batches one by one."""
    columns = list(map(list, zip(*batches, strict=True))) or [[np.zeros(0)] for _ in range(count)]
    batches.clear()
    return tuple(np.concatenate(columns.pop(0)) for _ in range(count))


def read_csv(path: Path, columns: Columns, ratio: float) -> Recording:
    """Read a CSV file, in which all angles of a row were sampled at one time.

    Args:
        path: of the file.
        columns: the columns to read.
        ratio: of the gear, for a torque at the output.

    Raises:
        CsvError: if it cannot be read, or has no such columns.
        RecordingError: if it has no usable rows.
    """
    table = read_columns(path, columns, ENCODERS)
    usable = np.ones(len(table.values), bool)
    for column in table.values.T:
        usable &= np.abs(column) <= LARGEST_ANGLE  # NaN compares false
    remarks, stretch = [], None
    if left_out := int(np.count_nonzero(~usable)):
        remarks.append(f'{left_out} rows were left out: not finite, or too large')
        stretch = np.cumsum(~usable)[usable]  # the motion in them is unknown
    data = {role: column[usable] for role, column in zip(table.found, table.values.T, strict=True)}
    time_column = table.found.get('time')
    del table, usable  # an hour has to fit into memory
    turns, angle = split_turns(data.pop('rotor'))
    count = len(turns)
    if not count:
        raise RecordingError(f'{path}: no usable rows')
    stamp = np.arange(count)
    if time_column:
        time = data.pop('time')
        stamp = np.round((time - time[0]) * SECOND).astype(np.int64)
        if np.any(np.diff(stamp) < 0):
            raise RecordingError(f'{path}: the time in {time_column} runs backwards')
    effort = data.pop('torque', None)
    if effort is not None and not columns.on_rotor:
        effort = effort / ratio
    rows = spread(count)
    return Recording(
        path.name,
        _hash(path),
        RotorMotion(stamp, turns, angle, effort, stretch),
        timed=time_column is not None,
        separate=False,
        before=rows,
        share=np.zeros(len(rows)),
        measured=data['output'][rows],
        remarks=tuple(remarks),
    )


def _hash(path: Path) -> str:
    """SHA-256 of a file, or of the files in a folder one after the other, by name."""
    total = hashlib.sha256()
    files: Iterable[Path] = [path]
    if path.is_dir():
        files = sorted(file for file in path.rglob('*') if file.is_file())
    for file in files:
        with file.open('rb') as content:
            while part := content.read(2**20):
                total.update(part)
    return total.hexdigest()
