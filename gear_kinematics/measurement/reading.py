# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""The reader of recordings, which makes a `Recording` of a bag or a table."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from gear_kinematics.bag import BagError, DamagedBagError, ReportProgress, TopicMessages
from gear_kinematics.bag.roles import find_encoder_topic, find_rotor_topic, missing_encoder
from gear_kinematics.kinematics.rotor_turns import LARGEST_ANGLE
from gear_kinematics.measurement.columns import Sources
from gear_kinematics.measurement.encoder_step import step_of
from gear_kinematics.measurement.formats import is_table, open_bag
from gear_kinematics.measurement.gate import gated
from gear_kinematics.measurement.recording import (
    MOST_MESSAGES,
    Array,
    Encoders,
    Recording,
    RecordingError,
    RotorMotion,
    locked_shaft,
    match,
)
from gear_kinematics.measurement.sentences import Observation, Observed
from gear_kinematics.measurement.series import held_readings
from gear_kinematics.measurement.stamps import RestoredClock
from gear_kinematics.measurement.tables import read_table
from gear_kinematics.parameters import NodeParameters
from gear_kinematics.state.gear_state import GearState
from gear_kinematics.state.output_encoder import measured_angle
from gear_kinematics.wire.batches import JointStates, decode_joint_states
from gear_kinematics.wire.cdr import SECOND
from gear_kinematics.wire.joint_reader import CLOCK_RESET
from gear_kinematics.wire.topics import OUTPUT_ENCODER

_MOST_REPEATED = 0.75  # share of the stamps; a recording that was merged with itself has half
_MOST_STATES = 1_800_000  # half an hour at 1 kHz; a state takes up to 200 bytes when measured


def read(
    path: Path,
    parameters: NodeParameters,
    sources: Sources | None = None,
    progress: ReportProgress | None = None,
    *,
    both: bool = False,
) -> Recording:
    """Read a table or a bag, and leave out readings that contradict each other.

    `progress` is called after each batch of a bag, with the number of messages on all its topics.

    Raises:
        BagError, RecordingError: if it cannot be read, contains nothing to measure, or lacks one
            of `both` encoders.
    """
    sources = sources or Sources()
    if is_table(path):
        ratio, period = parameters.gear.gear_ratio, parameters.rotor_period
        recording = read_table(path, sources, ratio, period, both=both)
    else:
        recording = _read_bag(path, parameters, sources, progress, both=both)
    return gated(recording)


def _read_bag(
    path: Path,
    parameters: NodeParameters,
    sources: Sources,
    progress: ReportProgress | None,
    *,
    both: bool,
) -> Recording:
    damage, heard = None, TopicMessages()
    with open_bag(path) as bag:
        rotor = find_rotor_topic(bag, sources.rotor_topic, parameters.rotor_joint)
        joint = parameters.distinct_encoder_joint
        encoder = find_encoder_topic(bag, rotor, sources.encoder_topic, joint)
        if both and not encoder:
            raise RecordingError(f'{path}: {missing_encoder(bag)}')
        states = States(rotor, encoder, parameters, _MOST_STATES)
        topics = [topic for topic in (rotor, encoder) if topic]
        try:
            for found in bag.by_topic(topics, progress):
                states.add(found[rotor], found[encoder] if encoder else None)
                if sources.as_recorded and len(heard.data) < MOST_MESSAGES:
                    heard.data += found[rotor].data
                    heard.received += found[rotor].received
        except DamagedBagError as error:
            damage = str(error)
    recording = states.recording(path, sources, damage)
    return replace(recording, rotor_messages=heard) if heard.data else recording


def as_recorded(rotor_joint: str, output_joint: str) -> NodeParameters:
    """Return the parameters to take positions as they are: no limit rules out their wraps."""
    return replace(
        NodeParameters.load(),
        rotor_joint=rotor_joint,
        output_encoder_joint=output_joint,
        max_rotor_speed=1e6,
        max_rotor_acceleration=1e9,
    )


class States:
    """States of the rotor and of the output's encoder, collected batch by batch."""

    def __init__(
        self, rotor: str, encoder: str | None, parameters: NodeParameters, most: int
    ) -> None:
        """Keep at most `most` states of both topics; of more, one in two, four, ..."""
        self._rotor, self._encoder, self._parameters = rotor, encoder, parameters
        self._gear = GearState(parameters)
        self._inputs, self._outputs = _Columns(most // (2 if encoder else 1)), _Columns(most // 2)
        self._lacking = ''
        self._clock = RestoredClock()
        self._output_clock = RestoredClock(self._clock.steps)

    def add(self, rotor: TopicMessages, encoder: TopicMessages | None) -> None:
        """Add the next messages of both topics."""
        data, later = self._clock.restored(rotor)
        new = self._gear.input.accept_batch(data, rotor.received)
        segment = new.segment + later[new.row]
        self._inputs.add((new.stamp, new.turns, new.angle, new.effort, segment))
        if encoder:
            data, _ = self._output_clock.restored(encoder)
            states = decode_joint_states(data, self._parameters.output_encoder_joint)
            self._lacking = self._lacking or states.missing_joint
            self._outputs.add(_measured(states, encoder.received, self._parameters))

    def recording(self, path: Path, sources: Sources, damage: str | None = None) -> Recording:
        """Return the states so far as a recording; `damage` is what ended the reading.

        Raises:
            BagError, RecordingError: if there is nothing to measure.
        """
        rotor, encoder, parameters = self._rotor, self._encoder, self._parameters
        rejected = self._gear.input.rejected
        remarks = [
            Observation.REJECTED(topic=rotor, count=count, cause=cause)
            for cause, count in rejected.items()
        ]
        for topic, read in ((rotor, self._inputs), (encoder, self._outputs)):
            if read.every > 1:
                remarks.append(Observation.STATES_THINNED(topic=topic, every=read.every))
        if (wraps := self._gear.input.plausibility.wraps.fact) and not sources.as_recorded:
            raise RecordingError(f'{path}: {wraps}')
        columns = self._inputs.joined()
        rows = len(columns[0]) if columns else 0
        if not rows:
            why = f': {self._gear.input.why_rejected}' if rejected else ''
            raise BagError(f'{path}: no usable rotor states on {rotor}{why}')
        stamp, turns, angle, effort, segment = _in_order(columns, rotor, remarks)
        clock, has_effort = self._clock.steps, np.isfinite(effort).any()
        motion = RotorMotion(stamp, turns, angle, effort, segment)
        described = [f'rotor {rotor}, joint {parameters.rotor_joint!r}, rad']
        encoders = locked = None
        if encoder:
            measured = self._outputs.joined()
            if self._lacking and not len(measured[0]):
                raise BagError(f'{path}: {encoder}: {self._lacking}')
            stamps, angles = _in_order(measured, encoder, remarks)
            none = f'{path}: no output angle was measured between two rotor states'
            if not len(stamps):
                raise RecordingError(none)
            for topic, times in ((rotor, stamp), (encoder, stamps)):
                repeated = int(np.count_nonzero(np.diff(times) == 0))
                if repeated > _MOST_REPEATED * len(times):
                    found = Observation.STAMPS_REPEAT(count=repeated, total=len(times))
                    raise RecordingError(f'{path}: {topic}: {found}: record their nanoseconds')
            both = {'rotor': motion.turned, 'output': np.unwrap(angles)}
            beside = {
                'rotor': np.interp(stamp, stamps, both['output']),
                'output': np.interp(stamps, stamp, both['rotor']),
            }
            held = held_readings(both, beside, remarks)
            new, kept = (held.get(role, slice(None)) for role in both)
            motion = RotorMotion(*(each[new] for each in motion))
            encoders = _compared(motion, stamps[kept], angles[kept], parameters, sources)
            if not len(encoders.measured):
                raise RecordingError(none)
            described.append(f'output {encoder}, rad')
        elif not has_effort:
            raise BagError(f'{path}: {rotor} has no effort, and no {OUTPUT_ENCODER} is there')
        else:
            ratio, known = parameters.gear.gear_ratio, np.isfinite(effort)
            step = step_of(sources.rotor_counts, motion.turned)
            torque, turned = float(ratio) * effort[known], motion.turned[known]
            locked = locked_shaft(torque, turned, step, ratio, stamp[known], measured=False)
            if locked.not_locked:
                encoder = f'where it turns, an {OUTPUT_ENCODER} is needed'
                raise RecordingError(f'{path}: {locked.not_locked}; {encoder}')
        if has_effort:
            described.append(f'torque: effort of {rotor} times the ratio, N·m')
        return Recording(
            path, path.name, tuple(described), rows, encoders, locked,
            tuple(remarks), damage,
            tuple(Observation.SET_BACK_AT(size=s.size / SECOND, stamp=s.stamp) for s in clock),
        )  # fmt: skip


def _measured(
    states: JointStates, received: Sequence[int], parameters: NodeParameters
) -> tuple[Array, Array]:
    """Stamps and output angles of messages; the time of reception replaces a zero stamp."""
    angle = measured_angle(parameters, states.values[:, 0])
    usable = ~states.malformed & states.present[:, 0] & (np.abs(angle) <= LARGEST_ANGLE)
    return states.stamped(received)[usable], angle[usable]


class _Columns:
    """Values of the states of a topic, thinned out evenly if there are too many."""

    def __init__(self, most: int) -> None:
        self._most, self._seen, self.every = most, 0, 1
        self._batches: list[list[Array]] = []

    def add(self, columns: Sequence[Array]) -> None:
        first = -self._seen % self.every
        self._seen += len(columns[0])
        self._batches.append([column[first :: self.every].copy() for column in columns])
        while sum(len(batch[0]) for batch in self._batches) > self._most:
            self.every *= 2
            self._batches = [[column[::2].copy() for column in self.joined()]]

    def joined(self) -> list[Array]:
        """Join the columns of all batches."""
        return [np.concatenate(batches) for batches in zip(*self._batches, strict=True)]


def _in_order(columns: Sequence[Array], topic: str, remarks: list[Observed]) -> list[Array]:
    """Keep the rows whose stamps, ns, the first column, are in order; remark on those left out.

    As in the node, stamps that go back by more than a second are those of another clock.
    """
    late = np.maximum.accumulate(columns[0]) - columns[0]
    late = late[~np.logical_or.accumulate(late > CLOCK_RESET)]
    kept = np.flatnonzero(late == 0)
    if disordered := len(late) - len(kept):
        remarks.append(Observation.STATES_OUT_OF_ORDER(topic=topic, count=disordered))
    if rest := len(columns[0]) - len(late):
        remarks.append(Observation.SET_BACK_FAR(topic=topic, count=rest))
    return [column[kept] for column in columns]


def _compared(
    motion: RotorMotion, stamps: Array, angles: Array, parameters: NodeParameters, sources: Sources
) -> Encoders:
    """Interpolate the rotor to the angles of the output."""
    before, share, inside = match(motion.stamp, stamps, parameters.longest_delay_ns)
    outside = int(np.count_nonzero((stamps < motion.stamp[0]) | (stamps > motion.stamp[-1])))
    unmatched = {
        'outside of the rotor states': outside,
        'gap of the rotor states': len(stamps) - len(before) - outside,
    }
    return Encoders(
        motion,
        timed=True,
        before=before,
        share=share,
        measured=angles[inside],
        rotor_step=step_of(sources.rotor_counts, motion.turned),
        output_step=step_of(sources.output_counts, angles),
        unmatched={cause: count for cause, count in unmatched.items() if count},
    )
