# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Everything that a validation can find, each with the sentence about it.

A sentence is formatted with the values of a `Finding`; `{messages}`, `{items}` and `{gaps}` are
its count with a noun, and `{moment}` is its time. What is in brackets is written only if the time
is known.
"""

from enum import Enum

_FIRST = '[, the first at {moment}]'
_REMEDY = 'give the parameter file of the recorded node with --config'


class FindingCause(Enum):
    """The cause of a finding in a recording."""

    # The messages of an output topic, and their fields
    NOTHING_COMPARED = 'no message could be compared'
    NO_STAMP_OF_INPUT = (
        'no message has the stamp of an input on {topic}, as if messages on one of the two topics '
        'had been stamped anew, or lost digits of their stamps'
    )
    MISSING = '{messages} missing' + _FIRST
    EXTRA = '{messages} too many' + _FIRST
    OUT_OF_ORDER = '{messages} out of order' + _FIRST
    MALFORMED = 'malformed: {messages}, the first received at {received}'
    NO_JOINT = 'no joint {expected!r} (output_joint?), but {name}: {messages}' + _FIRST
    ANOTHER_FRAME = 'frame {name!r}, not {expected!r}: {messages}' + _FIRST
    BEYOND_TOLERANCE = (
        'error {error} {unit}{where} exceeds the tolerance{quantity}, {tolerance} {unit}'
        '[, at {moment}]'
    )
    NOT_FINITE = '{items} not finite' + _FIRST
    ABSENT = '{items} without a counterpart' + _FIRST
    # What explains their errors
    OFFSET = 'the recorded output angle is off by a constant {offset:.12g} rad'
    MEAN_OFFSET = (
        'the recorded output angle is off by {mean} rad on average, and scatters from '
        '{lowest:.3g} to {highest:.3g} rad'
    )
    SIGN_FLIPPED = (
        'the sign is flipped: the recorded output turns the other way (rotor_direction?), with a '
        'ratio of {ratio}'
    )
    ANOTHER_RATIO = 'the recorded ratio is {ratio}, not {expected}: ' + _REMEDY
    ANOTHER_TOOTH_PAIR = (
        'the recorded ratio is {ratio}, not {expected}: it is that of ring_teeth {ring}, '
        'satellite_teeth {satellite}{flipped}; ' + _REMEDY
    )
    ANOTHER_UNIT = 'the recorded {field} is {factor:.6g} times the expected one'
    CHANGED = (
        'from a certain moment on, all outputs differ, as if a parameter had been changed while '
        'the node ran' + _FIRST
    )
    CHANGED_TO_GIVEN = (
        'up to a certain moment, all outputs differ, as if a parameter had been changed to the '
        'given one while the node ran[, the first right one at {moment}]'
    )
    OTHER_JOINT = (
        'the outputs are not those of {joint}: they are those of {other}; repeat with '
        '--joint {other}'
    )
    OTHER_ROTOR = (
        'the outputs are not those of {joint}: they are those of {other}; set '
        '`{actuator}.rotor_joint: {other}`'
    )
    # The rotor's count, from where the outputs take it
    ALL_MOVED_BY_ENCODER = (
        'from the start, output angles are shifted by {angle:.12g} rad, by the output encoder'
    )
    ALL_MOVED_BY_HOMING = (
        'from the start, output angles are shifted by {angle:.12g} rad, as by another rotor_zero'
    )
    HOMED = 'the node was homed, and later outputs have the new zero[, at {moment}]'
    LAST_ALONE = 'only the last output is off'
    TURNS_TAKEN = 'the turns of the single-turn encoder are taken from the outputs'
    ENCODER_AGREES = 'the outputs agree with output_encoder'
    ENCODER_DISAGREES = '{disagreement}[, at {moment}]'
    ENCODER_UNKNOWN = (
        'the reference is not judged: no recorded output_encoder determines the turns'
    )
    ERRORS_AGREE = 'both encoders confirm {messages}'
    ERRORS_DIFFER = (
        'error {error} rad against the encoders of rotor and output exceeds the tolerance of the '
        'angle, {tolerance} rad: {messages}' + _FIRST
    )
    # The rotor's topic
    JUMPS = (
        '{gaps} of {rotor.topic} could hide a turn of the rotor: afterwards its turns are taken '
        'from the outputs'
    )
    JUMPED = '{rotor.jumped}'
    VELOCITY_IS = '{rotor.velocity_is}'
    BEYOND_LIMITS = '{rotor.beyond_limits}'
    OUTSIDE = '{rotor.outside}'
    EFFORT_IS = '{rotor.effort_is}'
    SET_BACK = '{rotor.set_back}'
    STOPPED = '{rotor.joint} stopped {seconds:.1f} s before other joints of {rotor.topic}'
    OF_OTHERS = '{messages} of {rotor.topic} for other joints, which is no fault'
    ZERO_STAMPS = (
        "{messages} of {rotor.topic} without a stamp: outputs have the node's time, and are "
        'matched in their order'
    )
    REPEATED_STAMPS = (
        '{rotor.duplicates} of {rotor.valid} stamps of {rotor.topic} repeat the one before, as if '
        'messages were merged twice, or nanoseconds lost: where messages are missing, outputs are '
        'compared with the wrong inputs; merge each recording once, and record the nanoseconds'
    )
    SHORT_SECONDS = (
        'the nanoseconds in the stamps of {rotor.topic} never reach a thousandth of a second, as '
        'if they were µs or ms: gaps and speeds are wrong'
    )
    REJECTED = '{rotor.topic}: rejected: {causes}'
    MOSTLY_REJECTED = (
        '{rejected} of {rotor.messages} messages of {rotor.topic} were rejected ({causes}): too '
        'few are left to pass'
    )
    JOINT_MISSING = '{topic}: {detail}'
    ONLY_JOINT = '{joint}, the only joint on {topic}, is taken'
    # The messages that the actuators of an arm share
    OF_ACTUATOR = '{actuator}: {sentence}'
    JOINT_LEFT_OUT = 'the joint is missing although its rotor is valid: {messages}' + _FIRST
    OTHER_JOINTS = 'the joints are not those of the actuators, but {joints}: {messages}' + _FIRST
    JOINTS_DISORDERED = (
        'the joints are not in the order of `actuators`, but {joints}: {messages}' + _FIRST
    )
    ARRAY_SIZE = '{field} lacks a value for some of {joints}: {messages}' + _FIRST
    NAN_FOR_ALL = '{field} is NaN for all of {joints}, and should be empty: {messages}' + _FIRST
    # The recorder
    RECORDER_LOST = 'the recorder says that it lost {messages}'
    NOT_CLOSED = (
        'the recording was never closed, as its recorder was killed or still writes: its last '
        'messages may be missing; mcap recover closes it'
    )
    TWICE = (
        '{messages} recorded twice, as where merged recordings overlap: they and their outputs '
        'are judged once'
    )
    ENDED_EARLY = (
        '{output} ends {seconds:.3f} s before {topic}: the node may have ended, or lagged behind'
    )
    NO_OUTPUT = (
        '{messages} of {topic} without any output: the node did not receive them, or was blocked'
    )
    LOST_ON_THE_WAY = (
        '{lost} missing, but none of {complete}: the node had the inputs, and the messages were '
        'lost on their way to the recording'
    )
    LEFT_OUT = '{messages} skipped: {why}'
    # What is compared
    PREFIX_TAKEN = 'frame_prefix {prefix!r} is taken from the outputs'
    NO_POSES = 'no poses are recorded: {output} alone is compared'
    POSES_UNJUDGED = '{poses} is not judged: only the ratio of the gear is known'
    CORRECTION_UNJUDGED = 'the corrected output is not judged: {why}'
    NOT_COMPARED = 'recorded, but not compared: {topics}'
    INDEPENDENT = '{independent.text}'


LESS_GRAVE = {
    FindingCause.NOTHING_COMPARED,
    FindingCause.NO_STAMP_OF_INPUT,
    FindingCause.MISSING,
    FindingCause.EXTRA,
    FindingCause.OUT_OF_ORDER,
    FindingCause.ENDED_EARLY,
    FindingCause.NO_OUTPUT,
    FindingCause.LOST_ON_THE_WAY,
}
"""Causes about missing or additional messages, which are less grave than wrong messages."""
