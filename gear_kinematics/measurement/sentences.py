# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
"""Everything that a measurement can say of a recording, each with its sentence.

A sentence is formatted with the values of an `Observed`, in SI units. `{x:arcmin}` shows a number
or an estimate in a unit of `MeasuredFormatter`, and `{x:arcmin.2}` a number to two digits;
`{n:%d loop|%d loops}` shows a count with its noun, or nothing if it is 0; lists have commas.
"""

from enum import Enum
from typing import Any, NamedTuple

from gear_kinematics.measurement.wording import PERCENT, MeasuredFormatter
from gear_kinematics.wire.joint_reader import Rejection

NAMED = 3  # moments of a kind that are named

# Parts of several sentences
_ROWS = '{rows:%d row was|%d rows were} left out: '
_THINNED = ', to save memory: rates and speeds are those of what is left'
_RESTS = 'At zero torque the output rests anywhere within {hysteresis:arcmin}′ after ±{end:si} N·m'
_PLAY = _RESTS + '; backlash: {low:arcmin.2} to {high:arcmin.2}′; the rest is friction'
_DEVIATES = 'In one direction the output deviates by {error:arcmin}′ peak to peak'
_VALUE, _LIMIT = 'the {figure} of {value} ', 'the limit of {limit}'
_RATIO = 'the recorded ratio is {measured:si}, not {assumed}'
_SEEN = '{measured:si} after {degrees:.1f}° of the output'
_TURNED = 'the rotor turned {turns:si} turns'
_FALLS = 'The error falls from {before:arcmin} to {after:arcmin} arcmin rms on held-out data, '
_UNKNOWN = '{answer}; the loads are unknown for {seconds:si} s, first '
_INSIDE = '{inside:.1f} % of it within the {coverage} interval'
_JUDGED = (
    ': {inside:.1f} ± {spread:.1f} % of the measured angles are within the {coverage} interval; '
    'it changes the error from {before:arcmin} to {after:arcmin} arcmin rms.'
)
_NEEDED = (
    '; the least preload that would have held: {needed:si} N·m (set: {preload:si}); the ratio is '
    '{ratio}, by {source}'
)


class Cause(Enum):
    """Why the backlash has no value; the text says so, or what to record instead."""

    NONE = ''
    FRICTION = 'to separate them, ramp to a torque of at least twice the friction'
    REPEATS = 'to separate them, repeat the ramps five times or more'
    BENT = 'the spring bends too much near zero torque to separate them'
    SOFT = 'a spring that is soft around zero torque would show the same'
    CONTRADICTION = 'the ramps of different amplitude contradict each other: record them again'


class Observation(Enum):
    """What can be observed in a recording."""

    # Readings that cannot be true; moments are seconds, or numbers of samples if not `timed`
    STRAY = (
        'left out: {count:%d reading that contradicts|%d readings that contradict} both '
        'neighbours, {at} {moments:si.6}{unit}{more: and %d more}'
    )
    SATURATED = (
        'the torque sensor is saturated, first {at} {moment:si.6}{unit}: {count} readings left '
        'out, in which the angle moves there and back'
    )
    STOOD_STILL = (
        'an encoder stood still while the other moved, from {spans}'
        '{more: and %d more time| and %d more times}: {count} readings left out'
    )
    JUMPED = (
        'the output jumps by {angle:deg}° against the rotor {at} {moment:si.6}{unit} (a slip, or '
        'an encoder that jumped)'
    )
    JUMPED_FURTHER = '{count:%d further jump|%d further jumps} of the output against the rotor'
    LONGEST_PART = (
        'only the longest part without a fault is used, {first:si.6} to {last:si.6}{unit}'
    )
    COMPUTED = (
        'the output follows the rotor within {deviation:arcmin.2}′, as if it were computed from '
        'it, and shows nothing of the gear'
    )
    # What was left out when a recording was read, or is assumed
    SET_BACK_AT = 'the clock was set back by {size:.3f} s at {stamp}: nothing is interpolated'
    SET_BACK_AFTER = 'the clock was set back by {size:si} s after {seconds:si.6} s'
    SET_BACK_FAR = '{topic}: the clock was set back; the last {count} states are left out'
    REJECTED = '{topic}: {count} states {cause}'
    STATES_THINNED = '{topic}: one state of {every} is used' + _THINNED
    STATES_OUT_OF_ORDER = '{topic}: {count} states out of order'
    ROWS_THINNED = 'one row of {every} is used' + _THINNED
    ROWS_LEFT_OUT = _ROWS + 'no numbers, too large ones, or sums and the like'
    ROWS_AGAIN = _ROWS + 'they repeat the one before'
    NO_TIMES = _ROWS + 'no time in {column}'
    TIMES_OUT_OF_ORDER = _ROWS + 'the time in {column} is out of order'
    TIMES_GO_BACK = 'the time in {column} goes back after {rows} rows: the others are left out'
    SAME_TIMES = (
        '{rows} rows have {times} different times in {column}: rows with the same time are taken '
        'to be evenly spaced'
    )
    READINGS_HELD = '{role}: each reading comes {every} times, and is used once'
    NO_RAMPS = '{why}'
    OPPOSED = 'the angle falls where the torque grows, and is used with the other sign'
    UNITS_ASSUMED = (
        'units are assumed, as none is given: {units}; if one is not right, the figures are '
        'wrong: write units into the names, or give --angle-unit'
    )
    # The ratio of both encoders
    NOT_THE_RATIO = 'The recording does not have the ratio {assumed}: {why}.'
    WRAPS_UNCOUNTED = (
        "the rotor's position stays within a turn and jumps by more than half of it: sample often "
        'enough to count its wraps, shorten a recording of which one sample of several is used, '
        'and set rotor_encoder to single_turn'
    )
    NOT_FOLLOWED = 'the output does not follow the rotor, or turns too little'
    EXCHANGED = 'the output turns more than the rotor: exchange the two'
    UPSIDE_DOWN = (
        _RATIO + ', which is upside down: give --ratio={ratio}, rotor speed over output speed'
    )
    COUNTS_BACKWARDS = _RATIO + ': an encoder counts backwards, or --ratio={ratio} is right'
    ANOTHER_RATIO = _RATIO + '; gearkin commission finds it, or give --ratio={ratio}'
    OTHER_RATIOS = _RATIO + '; gearkin commission finds it, or give it, such as --ratio={ratio}'
    MULTIPLE_RATIO = (
        _RATIO + ', but a multiple of it: check counts per turn and units, or give --ratio={ratio}'
    )
    TURN_FURTHER = 'turn the output by {degrees}° or more'
    PERHAPS_UNIT = (
        'if the rotor is in {sent}, its ratio is {ratio}: let the driver send rad; else {advice}'
    )
    SAMPLE_TOGETHER = 'turning further hardly helps: sample both encoders at once, and more often'
    # What torque ramps show
    NEGATIVE_HYSTERESIS = (
        'The hysteresis is negative, {hysteresis:arcmin}′, which no gear has: the torque comes '
        'later than the angle, as behind a filter or from another clock.'
    )
    LOOPS_DIFFER = (
        'The hysteresis is unknown: {hysteresis:arcmin}′. The loops differ by more than their '
        'width, as where the angle drifts or slips.'
    )
    PLAY_UNKNOWN = _RESTS + '. How much of it is play is not known; {cause.value}.'
    PLAY = _RESTS + '. Of it, {play:arcmin}′ is play; the rest is friction.'
    PLAY_WITHIN = _PLAY + '.'
    PLAY_NOT_SEPARATED = _PLAY + '; {cause.value}.'
    PLAY_BY_SLOW_RAMPS = _PLAY + '; to separate them, repeat slow ramps to ±{torque:si.2} N·m.'
    MEASURED_AT_OUTPUT = (
        'Measured at the output: the wind-up is that of the gear, if the rotor was measured as '
        'well, or locked.'
    )
    INFERRED = (
        'Inferred: no angle has a name such as output_angle, which says that its encoder is at '
        'the output. If it is that of the motor, with the output locked, the figures include the '
        'compliance of motor, bench and clamping.'
    )
    READ_BELOW_FRICTION = (
        'Lost motion is read at ±{torque:si} N·m, below the friction of {friction:si} N·m: it '
        'does not contain the play, and no limit is judged by it.'
    )
    UNEQUAL_PEAKS = (
        'The torque goes from {low:si} to {high:si} N·m: check that its sensor reads 0 without a '
        'load, as hysteresis and backlash are read at zero torque.'
    )
    ONE_AMPLITUDE = 'All ramps have about one amplitude: small ones would separate play better.'
    # What both encoders show
    HARDLY_MOVES = 'The output does not move far enough in one direction to show its errors.'
    DEVIATES = _DEVIATES + '.'
    LOSES = _DEVIATES + '; on reversals it loses {lost:arcmin}′.'
    LAGS = _DEVIATES + (
        '; backward it lags by {lost:arcmin}′, by lost motion or by a delay between the encoders.'
    )
    LOSS_NOT_TOLD = _DEVIATES + '; what it loses on reversals is unknown.'
    SCATTERS = _DEVIATES + (
        ', most of it from one reading to the next: it is noise, or falls if you turn slower or '
        'read both encoders at once.'
    )
    DELAY_TAKEN_OUT = 'A delay between the stamps of the encoders is not in these figures.'
    DELAY_NOT_TOLD = (
        'The speed varies too little to tell lost motion from a delay between the encoders: move '
        'at several speeds.'
    )
    NOT_COMPARED = '{count} output angles were not compared: {cause}.'
    PLUS_MINUS = (
        'Each ± contains the value with a probability of {coverage}, given the scatter of repeats '
        'and the steps of the encoders where they are known. Errors of scale (1 % of the torque '
        'is 1 % of friction and stiffness) and other positions of the output are not included.'
    )
    # What commissioning determines and leaves open, and the evidence
    GEAR_RATIO = 'The gear has the ratio {ratio} ({evidence}).'
    RATIO_AND_RANGE = GEAR_RATIO + " The rotor's position repeats after {size:si.6} rad."
    FITS_GIVEN_RATIO = _SEEN + ', which the given ratio fits'
    ONLY_FRACTION = _SEEN + ', the only simple fraction'
    NO_RATIO = 'The ratio is undetermined: {why}.'
    OPEN_RATIO = (
        'The ratio is undetermined: ' + _SEEN + ', such as {candidates}; {advice}, or give the '
        'ratio of the nameplate.'
    )
    GIVEN_RATIO_DISAGREES = (
        'The given ratio {given} does not agree with the measured ' + _SEEN + '.'
    )
    RECORD_ANEW = 'record it anew without these faults'
    RATIO_SO_FAR = '{measured:si}; {advice}'
    TEETH = '{evidence}; teeth such as {teeth}'
    JOINT = 'a joint of {topic}'
    WRAPS_OF_A_TURN = '{wraps:%d wrap|%d wraps} of a turn'
    TURNED = _TURNED + ' without a wrap'
    TURNED_WITH_WRAPS = _TURNED + ' with {wraps:%d wrap|%d wraps}'
    WRAPS_UNCLEAR = (
        'the position wraps too fast to be counted: turn the rotor slowly, or send more often'
    )
    DEGREES = '{wraps:%d wrap|%d wraps} of 360, as if in degrees: let the driver send rad'
    TURNED_TOO_LITTLE = _TURNED + '; turn it by more than one'
    RANGES_DIFFER = 'it differs: {ranges} rad; record again'
    EQUAL_STEPS = '{wraps:%d wrap|%d wraps} of {size:si.6} rad{turns: (%d turns)}'
    SAME_SENSE = 'the encoders count in the same sense'
    OPPOSITE_SENSES = 'the encoders count in opposite senses'
    SENSE_GIVES_SIGN = '{sense}, which gives the ratio its sign'
    SENSE_KEPT = 'the sense of the encoder is kept'
    ZERO_KEPT = 'the zero of the encoder is kept'
    ZERO_AT = 'the output angle is 0 at {moment} of {recording}'
    ENCODERS_AGREE = 'both encoders agree within {spread:deg}° of the output'
    FASTEST = 'The rotor turned at up to {speed:si} rad/s'
    SPEED_AND_RATES = (
        'The rotor turned at up to {speed:si} rad/s. Rates: {rotor:.4g} Hz of the rotor, '
        '{output:.4g} Hz of the output.'
    )
    LATE = 'The stamps of the output are late by {delay:ms} ms.'
    EARLY = 'The stamps of the output are early by {delay:ms} ms.'
    NOT_LATE = 'The stamps of the output have no measurable delay.'
    DELAY_OR_HYSTERESIS = (
        'it cannot be separated from hysteresis; turn the output there and back three times, at '
        'different speeds'
    )
    WITH_LATER_MESSAGES = 'With the messages that came later: {answer}'
    CONTRADICTED = '{target} is contradicted: {changes}.'
    AGREES = '{answer} {target} agrees.'
    WRITTEN = '{answer} It is written to {target}.'
    # What a calibration is worth, in shares of the samples, and what it lacks
    ERROR_FALLS = (
        _FALLS + _INSIDE + ' of ± {half_width:arcmin} arcmin. Give the file to the node as its '
        'parameter calibration.'
    )
    TOO_NARROW = (
        _FALLS + 'but the {coverage} interval of ± {half_width:arcmin} arcmin is too narrow for '
        'it: {inside:.1f} % of it is inside. Nothing is written; record more turns of the output, '
        'in both directions.'
    )
    MOVED = (
        '{recording}: {at} {moment:si.6}{unit} the output shifts against the rotor, at once or '
        'slowly: {angle:arcmin} arcmin, most of the error that a correction leaves. Nothing is '
        'written; let the gear warm up, check its couplings and encoders, and record again.'
    )
    NO_CORRECTION = (
        'No correction helps: with the best one the error is {after:arcmin} arcmin rms instead of '
        '{before:arcmin} on held-out data, ' + _INSIDE + '. Nothing is written.'
    )
    OUTPUT_LATE = (
        '{recording}: the output angles are later than the rotor angles by {delay:ms} ms, or the '
        'gear winds up in proportion to its speed. This part of the error is left out.'
    )
    NOT_FITTED = '{term} is not fitted: {cause}.'
    FEW_CYCLES = 'the longest travel holds {cycles:.2g} cycles, less than 2'
    SOME_EFFORTS = 'not every recording has an effort throughout'
    TORQUE_CONSTANT = 'the torque does not vary'
    STATE_UNKNOWN = 'its state is known at only {percent:.0f} % of the samples'
    HOLDS = 'The calibration holds' + _JUDGED
    DOES_NOT_HELP = 'The calibration does not help' + _JUDGED
    NO_LONGER_HOLDS = (
        'The calibration no longer holds: {inside:.1f} % instead of {coverage} lie within the '
        'interval; what is left: {left:arcmin}′ {often}. Calibrate the gear again.'
    )
    # What the loads of a recording show
    NO_PRELOAD = (
        'The output torque was at most {torque:si} N·m in {time}; without the parameter preload, '
        'nothing is known of the mesh; the ratio is {ratio}, by {source}'
    )
    IN_MESH = 'Both branches stayed in mesh over {time}' + _NEEDED
    OUT_OF_MESH = (
        'A branch was out of mesh in {count:%d interval|%d intervals}, {total:si} s of {time}, '
        'first at {start:.3f} s' + _NEEDED
    )
    IMPLAUSIBLE = '{answer}; {question}'
    LOADS_UNKNOWN = _UNKNOWN + 'from {start:.3f} s on'
    LOADS_BEGIN_LATE = _UNKNOWN + 'before the first known load, at 0 s'
    BRANCH_OUT_OF_MESH = (
        'branch {branch} was out of mesh for {duration:si} s from {start:.3f} s on: {torque:si} '
        'N·m beyond the preload'
    )
    MESSAGES_LEFT_OUT = 'Messages left out: {causes}.'
    LIFE = (
        'L10 by ISO 281 for ball bearings of C = {rating:si} N, at the speed and the cubic mean '
        'load of this recording; without lubrication and contamination factors.'
    )
    SLOT_LOSS = (
        'At μ = {friction:g}, friction of the slots takes {percent:.1f} % of the work of the '
        'output, if each couple acts as two forces at a distance of twice the rolling radius of '
        'the satellite.'
    )
    # What the messages of a rotor seem to have wrong
    SIZES_DIFFER = '{count:%d message|%d messages} rejected: ' + Rejection.ARRAY_SIZES
    COUNTS = (
        'the positions are whole numbers, as if in counts of an encoder: let the driver send rad '
        'of the rotor'
    )
    BEYOND_LIMITS = '{beyond}: {advice}'
    STAMPS_REPEAT = '{count} of {total} stamps repeat the one before'
    # What differs between recordings
    TWO_COMPARED = '{second} against {first}: {changes}'
    SEVERAL_COMPARED = 'against {first}: {changes} ({clear} of {count} significant)'
    CHANGED = '{figure} {before} → {value}'
    CHANGED_SURELY = CHANGED + ' ({judgement})'
    NO_CHANGE = 'no significant change'
    PLAY_LEFT = 'there is play of at least {low:arcmin}′'
    PLAY_UNDETERMINED = 'whether play is left is undetermined'
    PLAY_AT_MOST = PLAY_UNDETERMINED + ' (at most {high:arcmin}′)'
    BY_SCATTER = 'judged by the scatter within single recordings'
    REPEAT_RECORDINGS = (
        'Record each state several times, and compare with --group: recordings differ by more.'
    )
    SMALL_RAMPS_DIFFER = (
        'Hysteresis and friction: not compared where the smallest ramps of {names} are smaller '
        'than those of the others.'
    )
    # Limits
    WITHIN_LIMIT = _VALUE + 'meets ' + _LIMIT
    BEYOND_LIMIT = _VALUE + 'violates ' + _LIMIT
    PERHAPS_BEYOND = _VALUE + 'may violate ' + _LIMIT
    MEASURED_ONCE = (
        f'{_VALUE}cannot be shown to meet {_LIMIT}: it was measured once, so that its uncertainty '
        'is not known'
    )
    NOT_KNOWN = 'the {figure} is not known'
    NOT_JUDGED = 'the {figure} cannot be judged: it is read at a torque below the friction'

    def __call__(self, **values: Any) -> 'Observed':
        """Return what was observed, with its values."""
        return Observed(self, values)


class Observed(NamedTuple):
    """Something that was observed, with its values; as text it is the clause or the sentences."""

    what: Observation
    values: dict[str, Any]

    def __str__(self) -> str:
        at, unit = ('at', ' s') if self.values.get('timed') else ('at sample', '')
        known = {'at': at, 'unit': unit, 'coverage': PERCENT}
        return MeasuredFormatter().vformat(self.what.value, (), known | self.values)

    @property
    def sentence(self) -> str:
        """The sentences, or the clause as one."""
        text = str(self)
        return f'{text[0].upper()}{text[1:].removesuffix(".")}.'
