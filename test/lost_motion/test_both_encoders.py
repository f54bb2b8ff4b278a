"""A delay between the stamps of both encoders is no lost motion, and another ratio no error."""

import math

import numpy as np
import pytest
from gear_recordings import Samples, write_csv, write_recording
from simulated_encoders import (
    ARC_MINUTE,
    MS,
    TURN,
    Drive,
    even_strokes,
    ramped_strokes,
    sine_strokes,
    stamps,
)

from gear_kinematics.commands.cli import main
from gear_kinematics.kinematics import GearRatio
from gear_kinematics.kinematics.rotor_turns import split_turns
from gear_kinematics.lost_motion import measure, read_bag
from gear_kinematics.lost_motion.dynamic.ratio import check_ratio
from gear_kinematics.lost_motion.dynamic.transmission import figures, separate_delay
from gear_kinematics.lost_motion.recorded.encoder_step import step_of
from gear_kinematics.lost_motion.recorded.motion import Motion, MotionError
from gear_kinematics.state import parameters
from gear_kinematics.state.transmission_error import TransmissionError

RATIO = GearRatio(-19)
PLAY = 3.0 * ARC_MINUTE
ERRORS = {order: size * ARC_MINUTE for order, size in {1: 4, 19: 1, 20: 0.3, 1520: 0.1}.items()}
COUNTS, OUTPUT_COUNTS = 2**16, 2**20
STEPS = {'rotor_step': TURN / COUNTS, 'output_step': TURN / OUTPUT_COUNTS}


def recorded(drive, profile, seconds, rate=1000.0, seed=1, ratio=RATIO) -> Motion:
    times, rotor, output = drive.readings(profile, seconds, rate, seed)
    turns, angle = ratio.output_angle(*split_turns(rotor), np)
    return Motion.from_angles(
        TransmissionError(max_gap=100 * MS, travel=math.radians(1.0)),
        (stamps(times), turns, angle),
        (stamps(times), output),
        step_of(COUNTS, rotor).scaled(1.0 / float(ratio)),
        step_of(OUTPUT_COUNTS, output),
    )


@pytest.mark.slow
@pytest.mark.parametrize('delay', [0.0, 2e-3, -2e-3, 10e-3])
@pytest.mark.parametrize(
    'profile',
    [sine_strokes(3.0, 4.0), ramped_strokes(3.0, 2.0, 0.3), sine_strokes(0.5, 2.0)],
    ids=['sine', 'ramped', 'short'],
)
def test_delay_is_told_from_play_and_taken_out(profile, delay):
    clean = recorded(Drive(PLAY, ERRORS, **STEPS), profile, 16.0)
    drive = Drive(PLAY, ERRORS, delay, noise=0.05 * ARC_MINUTE, **STEPS)
    reversals, motion = separate_delay(recorded(drive, profile, 16.0), None)
    found = figures(motion, RATIO, reversals)
    assert found.lost_motion.value == pytest.approx(PLAY, abs=0.06 * ARC_MINUTE)
    assert 0.0 < found.lost_motion.uncertainty < 0.15 * ARC_MINUTE
    assert found.delay.value == pytest.approx(delay, abs=2e-5)
    assert found.delay.uncertainty < 5e-5
    accuracy = figures(clean, RATIO, None).forward.value
    noise = 2 * 4.5 * drive.noise
    assert accuracy - 0.1 * ARC_MINUTE < found.forward.value < accuracy + noise


@pytest.mark.slow
def test_delay_at_one_speed_is_not_called_play():
    drive = Drive(PLAY, ERRORS, 2e-3, **STEPS)
    reversals, motion = separate_delay(recorded(drive, even_strokes(3.0, 1.0), 16.0), None)
    assert reversals.lost_motion is reversals.delay is None
    assert reversals.difference.value == pytest.approx(PLAY + 2e-3 * 6.0, rel=1e-2)
    reversals, motion = separate_delay(motion, 2e-3)
    assert reversals.lost_motion.value == pytest.approx(PLAY, abs=0.1 * ARC_MINUTE)
    assert figures(motion, RATIO, reversals).delay.value == 2e-3


@pytest.mark.slow
def test_intervals_hold_for_any_seed():
    inside, seeds = 0, 40
    for seed in range(seeds):
        random = np.random.default_rng(seed)
        play, delay = random.uniform(0, 10) * ARC_MINUTE, random.uniform(-5e-3, 5e-3)
        noise = random.uniform(0, 0.5) * ARC_MINUTE
        drive = Drive(play, ERRORS, delay, noise, **STEPS)
        profile = sine_strokes(random.uniform(0.5, 3.0), random.uniform(1.0, 4.0))
        motion = recorded(drive, profile, 12.0, 250.0, seed)
        reversals, _ = separate_delay(motion, None)
        for estimate, true in ((reversals.lost_motion, play), (reversals.delay, delay)):
            inside += abs(estimate.value - true) <= estimate.uncertainty
    # 95 % of 80: fewer than 70 have a probability of less than 1 %.
    assert inside >= 70


@pytest.mark.slow
def test_delay_of_a_bag_is_in_seconds_and_of_a_csv_in_rows(tmp_path, actuator, capsys):
    times, rotor, output = Drive(PLAY, delay=4e-3, **STEPS).readings(
        sine_strokes(1.0, 2.0), 8.0, 500.0
    )
    at = stamps(times)
    bag = write_recording(tmp_path / 'late', Samples(at, rotor), Samples(at, output))
    found = measure(read_bag(bag, parameters.load(parameters.default_config())), actuator)
    assert found.transmission.delay.value == pytest.approx(4e-3, abs=2e-5)
    csv = write_csv(tmp_path / 'late.csv', rotor=rotor, output=output)
    assert main(['lost-motion', str(csv)]) == 0
    printed = capsys.readouterr().out
    value = next(line for line in printed.splitlines() if 'delay of the output encoder' in line)
    number, unit = value.split(': ')[-1].split()
    assert float(number) == pytest.approx(2.0, abs=0.01)
    assert unit == 'rows'
    assert 'The stamps of the two encoders differ by a delay' in printed


# Another ratio


@pytest.mark.parametrize('assumed', ['-18', '-20', '-58/3', '19'])
@pytest.mark.parametrize(
    ('profile', 'spread'),
    [(sine_strokes(0.5, 2.0), 0.2), (sine_strokes(14.0, 8.0), 1e-3)],
    ids=['short', 'long'],
)
def test_ratio_of_a_recording_is_named_with_its_uncertainty(assumed, profile, spread):
    drive = Drive(PLAY, ERRORS, noise=0.3 * ARC_MINUTE, **STEPS)
    motion = recorded(drive, profile, 16.0, 100.0, ratio=GearRatio.parse(assumed))
    try:
        said = check_ratio(motion, GearRatio.parse(assumed))
    except MotionError as error:
        said = str(error)
    value, _, uncertainty, *_ = said.split('the recorded ratio is ')[1].split()
    assert abs(float(value) + 19) <= float(uncertainty.rstrip(',')) <= spread
    assert f'not {assumed}' in said
    assert '--ratio=-19 is' in said
    assert ('an encoder counts backwards' in said) == (assumed == '19')
    assert ('80/76' in said) == (assumed != '19')


@pytest.mark.parametrize(
    'profile',
    [
        even_strokes(3.0, 2.0),
        sine_strokes(0.1, 2.0),
        sine_strokes(0.5, 2.0),
        sine_strokes(6.0, 4.0),
        sine_strokes(14.0, 8.0),
    ],
)
@pytest.mark.parametrize('eccentricity', [0.0, 20.0 * ARC_MINUTE])
def test_right_ratio_is_not_doubted(profile, eccentricity):
    for seed in range(5):
        drive = Drive(PLAY, ERRORS | {1: eccentricity}, 2e-3, 0.2 * ARC_MINUTE, **STEPS)
        assert check_ratio(recorded(drive, profile, 16.0, 100.0, seed), RATIO) is None
