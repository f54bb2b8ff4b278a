"""Models of torque ramps: of simulated gears that are known, and of a measured actuator."""

import math
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from gear_recordings import ramps
from judging_ramps import judge
from simulated_ramps import SCENARIOS, STEP, Ramps, Scenario, hysteresis, simulate

from gear_kinematics.lost_motion.recorded.encoder_step import Source, Step
from gear_kinematics.lost_motion.recorded.recording import Loading
from gear_kinematics.lost_motion.static import models
from gear_kinematics.lost_motion.static.breakaway import breakaway_friction
from gear_kinematics.lost_motion.static.friction import friction_of, without_build_up
from gear_kinematics.lost_motion.static.midline import Midlines
from gear_kinematics.lost_motion.static.pause import pauses_of
from gear_kinematics.lost_motion.static.play import Cause
from gear_kinematics.lost_motion.static.ramps import find_ramps
from gear_kinematics.lost_motion.static.residuals import residual_tests
from gear_kinematics.lost_motion.static.springs import SHAPES, Fitting, Gap, Model, Springs

ARC_MINUTE = math.radians(1.0 / 60.0)

pytestmark = pytest.mark.slow  # a recording takes 1 to 2 s to simulate


def scenario(name: str) -> Scenario:
    return next(scenario for scenario in SCENARIOS if scenario.name == name)


FEW = SCENARIOS[1:14:3]  # benchmark/lost_motion.py has them all


def test_the_mean_of_loops_holds_although_two_share_a_quarter():
    quarters = np.random.default_rng(5).normal(3.0, 0.7, (2000, 3, 4))
    quarters[:, 2, 3] = quarters[:, 1, 3]
    means = [models.mean_of_loops(loops, completed=True) for loops in quarters.mean(axis=2)]
    held = sum(abs(mean.value - 3.0) <= mean.uncertainty for mean in means)
    # Within four standard deviations of a binomial count; without the quarter, 93 % hold.
    assert abs(held - 0.95 * len(means)) < 4 * math.sqrt(len(means) * 0.95 * 0.05)
    single = models.mean_of_loops(np.array([3.0]), completed=True)
    assert (single.value, single.standard) == (3.0, None)


@pytest.mark.parametrize('scenario', FEW, ids=lambda scenario: scenario.name)
def test_figures_hold(scenario: Scenario):
    """Of 4 intervals of 95 %, fewer than 2 hold once in 2000 times, of 90 % once in 270."""
    found = judge(scenario, 4)
    assert not found.below_zero
    least = 2.0 / 4.0
    assert found.hysteresis >= least
    assert math.isnan(found.play) or found.play >= least
    if scenario.contained:
        assert found.friction >= least
        assert found.spring >= least
    if scenario.contained and not scenario.play:
        assert found.valued <= 1.0 / 4.0  # zero is within reach
    if scenario.contained and scenario.play:
        assert found.valued == 1.0
        assert abs(found.play_bias) < 0.3 * ARC_MINUTE


@cache
def recording(scenario: Scenario, seed: int) -> Ramps:
    return simulate(scenario, np.random.default_rng(seed))


def loading(scenario: Scenario, *, times: bool = True, seed: int = 3) -> Loading:
    recorded = recording(scenario, seed)
    return Loading(
        recorded.torque,
        recorded.angle,
        Step(STEP, Source.GIVEN),
        measured=True,
        time=recorded.time if times else None,
    )


def quantised(fine: Loading, step: float) -> Loading:
    angle = np.round(fine.angle / step) * step
    return replace(fine, angle=angle, angle_step=Step(step, Source.GIVEN))


def test_a_late_encoder_is_found_and_taken_out():
    late = scenario('encoder 20 ms late')
    found = models.settled(loading(late))
    effects = found.effects
    assert effects.lag.value == pytest.approx(late.lag, abs=0.003)
    assert effects.lag.uncertainty < 0.003
    assert effects.removed.value == pytest.approx(effects.lag.value, rel=1e-3)
    widths = [loop.width(0.0) for loop in found.ramps[0].loops]
    assert np.mean(widths) == pytest.approx(hysteresis(late), abs=0.5 * ARC_MINUTE)


def test_a_late_encoder_is_found_where_the_torque_arrives_at_a_pause():
    late = scenario('encoder 20 ms late, pauses')
    assert models.settled(loading(late)).effects.removed.value == pytest.approx(0.02, abs=0.003)


def test_a_late_torque_is_told_and_stays_in_the_uncertainty():
    early = replace(scenario('play, linear spring'), lag=-0.02)
    found = models.settled(loading(early))
    assert found.effects.lag.value == pytest.approx(-0.02, abs=0.003)
    assert found.effects.removed is None
    friction = models.models_of(found, STEP).plays[0].friction
    off = early.friction - friction.value
    assert friction.uncertainty > off > 0.05 * early.friction


def test_a_lag_is_found_that_is_about_as_long_as_the_search_for_it():
    """Of the small ramps, those that seem latest by noise are only found near this lag."""
    gear = scenario('encoder 20 ms late, pauses')
    late = replace(gear, lag=0.04, noise=0.13)
    lags = [models.settled(loading(late, seed=seed)).effects.lag.value for seed in range(2)]
    assert np.mean(lags) == pytest.approx(0.04, abs=0.002)


@pytest.mark.parametrize('friction', [0.7, 1.9])
def test_a_gear_breaks_away_within_its_small_loops(friction):
    """Of 4 N·m, twice the friction are up to 3.8 N·m."""
    gear = replace(scenario('play, linear spring'), friction=friction)
    recorded = loading(gear)
    group = find_ramps(recorded.torque, recorded.angle, recorded.time)[0]
    assert breakaway_friction(group) == pytest.approx(friction, rel=0.05)


def test_coarse_steps_tell_nothing_of_a_lag():
    """The gear turns by 0.002 rad in the window before a reversal, that is, by a step or two."""
    late = scenario('encoder 20 ms late')
    coarse = quantised(loading(late), 2.0 * np.pi / 4096.0)
    assert models.settled(coarse).effects.late is None


@pytest.mark.parametrize('friction', [0.2, 0.6, 1.5])
def test_an_encoder_in_time_is_not_late_with_any_friction(friction):
    """The gear stands still for twice the friction after a reversal, however small that is."""
    effects = models.settled(loading(Scenario('', play=0.01, friction=friction))).effects
    assert effects.lag is None or effects.lag.value < 1e-3


def test_a_lag_that_may_be_the_gears_is_half_taken_out():
    heavy = replace(scenario('inertia, no play'), inertia=0.02)
    effects = models.settled(loading(heavy)).effects
    lag, removed = effects.lag.value, effects.removed
    assert 0.003 < lag < 0.01  # half of sqrt(0.02 kg·m² / 300 N·m/rad) to all of it
    assert removed.value == pytest.approx(0.5 * lag)
    assert removed.value - removed.uncertainty < 0.0
    assert removed.value + removed.uncertainty > lag


def test_a_drift_is_found_and_taken_out():
    drifting = scenario('drift')
    effects = models.settled(loading(drifting)).effects
    assert effects.lag is None
    assert effects.drifts[0].rate == pytest.approx(drifting.drift, rel=0.2)


@pytest.mark.parametrize('seed', range(4))
def test_no_drift_is_found_where_there_is_none(seed):
    effects = models.settled(loading(scenario('play, linear spring'), seed=seed)).effects
    assert effects.drifts == (None, None)


def test_an_uneven_drift_is_followed():
    """The zero goes through a period in 12 loops."""
    wandering = replace(scenario('thermal sine'), thermal=(3e-3, 48.0))
    found = models.settled(loading(wandering))
    assert not found.effects.drifts[0].steady
    assert not found.effects.drifts[1]  # not in three loops of 20 s
    middles = [loop.middle(0.0) for loop in found.ramps[0].loops]
    before = models.settled(loading(wandering, times=False)).ramps
    wandered = [loop.middle(0.0) for loop in before[0].loops]
    assert np.ptp(middles) < 0.1 * np.ptp(wandered)


def test_creep_does_not_move_the_corner_where_the_gear_breaks_away():
    """It widens the large loops as if there were 1.2 N·m more friction."""
    creeping = scenario('creep of 10 %, large loops only')
    recorded = loading(creeping)
    group = find_ramps(recorded.torque, recorded.angle, recorded.time)[0]
    assert np.median(Midlines.of(group.whole).friction) > 2.0 * creeping.friction
    assert breakaway_friction(group) == pytest.approx(creeping.friction, rel=0.05)
    assert models.settled(recorded).effects.removed is None  # no late encoder


@pytest.mark.parametrize('friction', [0.5, 1.5])
def test_pauses_tell_creep(friction):
    """And its time constant, by which the stiffness of the spring is known to 5 %."""
    gear = replace(scenario('creep of 10 %, pauses'), friction=friction)
    found = models.settled(loading(gear))
    creep = found.creeping.creep
    share, constant = gear.creeps[0]
    assert creep.constant == pytest.approx(constant, rel=0.3)
    assert 300.0 * creep.compliance.value == pytest.approx(share, rel=0.15)
    stiffness = models.models_of(found, STEP).spring.stiffness
    assert abs(stiffness.value - 300.0) < stiffness.uncertainty < 15.0


def test_a_sine_has_no_pauses():
    turn = 2.0 * np.pi * np.arange(24000) / 4000
    torque, time = 40.0 * np.sin(turn), 5e-3 * np.arange(24000)
    group = find_ramps(torque, torque / 300.0, time)[0]
    assert not list(pauses_of(time, torque, torque / 300.0, group, 1.0))
    flat = np.clip(torque, -35.0, 35.0)
    group = find_ramps(flat, flat / 300.0, time)[0]
    assert len(list(pauses_of(time, flat, flat / 300.0, group, 1.0))) > 8


def test_creep_is_found_where_the_gear_stands_still():
    creeping = scenario('creep of 10 %')
    creep = models.settled(loading(creeping)).creeping.creep
    share, constant = creeping.creeps[0]
    likely = {creep.constant: creep.compliance.value, **dict(creep.others)}
    assert 300.0 * np.interp(
        constant, *zip(*sorted(likely.items()), strict=True)
    ) == pytest.approx(share, rel=0.15)


@pytest.mark.parametrize(
    'gear',
    [
        scenario('creep, softening spring'),
        Scenario('little creep', friction=0.73, noise=0.08, creeps=((0.046, 1.7),)),
    ],
    ids=lambda gear: gear.name,
)
def test_the_stiffness_of_the_spring_covers_creep_that_is_hardly_known(gear):
    """It would be off by more than 1 % if creep were left alone."""
    found = models.settled(loading(gear))
    spring = models.models_of(found, STEP).spring
    load = np.linspace(spring.low, spring.high, 400)
    true = 1.0 / np.polyfit(load, gear.spring(load), 1)[0]
    assert abs(spring.stiffness.value - true) < spring.stiffness.uncertainty
    alone = models.models_of(replace(found, creeping=None), STEP).spring.stiffness
    assert true - alone.value > 0.01 * true > alone.uncertainty


def test_the_stiffness_of_the_spring_covers_creep_that_is_below_the_steps():
    hardly = scenario('creep of 10 %')
    step = 2.0 * np.pi / 4096.0
    found = models.settled(quantised(loading(hardly), step))
    assert found.creeping.creep is None
    stiffness = models.models_of(found, step).spring.stiffness
    assert abs(stiffness.value - 300.0) < stiffness.uncertainty
    alone = models.models_of(replace(found, creeping=None), step).spring.stiffness
    assert 300.0 - alone.value > alone.uncertainty


def test_creep_that_no_standstill_shows_is_in_the_stiffness_of_the_spring():
    """Of large loops with much noise, the standstills are lost in it."""
    gear = replace(
        scenario('creep of 10 %, large loops only'), friction=0.55, noise=0.19, softness=0.6
    )
    found = models.settled(loading(gear))
    assert found.creeping.creep is None
    spring = models.models_of(found, STEP).spring
    true = 300.0 / gear.softness
    assert spring.stiffness.uncertainty > true - spring.stiffness.value > 0.02 * true
    assert spring.by_creep > 0.9 * spring.stiffness.standard


def test_steps_that_show_no_creep_hardly_widen_the_stiffness():
    found = models.settled(loading(scenario('play, linear spring')))
    assert found.creeping.creep is None
    stiffness = models.models_of(found, STEP).spring.stiffness
    assert stiffness.uncertainty < 3e-3 * stiffness.value


def test_without_times_nothing_is_said_of_time():
    found = models.settled(loading(scenario('creep of 10 %'), times=False))
    assert found.effects.lag is None
    assert found.effects.drifts == (None, None)
    assert found.creeping is None


def test_friction_that_grows_with_the_load():
    growing = scenario('friction that grows by 10 % of the load')
    found = models.settled(loading(growing))
    model = models.models_of(found, STEP).plays[0]
    assert model.growth.value == pytest.approx(growing.load_friction, abs=0.03)
    assert model.friction.value == pytest.approx(growing.friction, abs=0.04)


def dahl(missing: float, growth: float = 0.0) -> tuple[Midlines, np.ndarray]:
    """Middle lines with 1 N·m of friction, of which the loads lack some; and the true loads."""
    load = np.linspace(-3.0, 3.0, 101)
    noise = 0.01 * np.random.default_rng(5).standard_normal((5, 101))
    lacking = missing * np.exp((np.abs(load) - 3.0) / 0.5) + noise
    angle = np.tile(load / 300.0, (5, 1))
    friction = 1.0 + growth * np.abs(load) - lacking
    read = load + np.sign(load) * lacking
    return Midlines(angle, read, friction, np.zeros((5, 101)), np.zeros(5), 0.0, 0.0), load


@pytest.mark.parametrize('start', [0.0, 2.0])
def test_friction_may_grow_from_some_load_on(start):
    load = np.tile(np.linspace(-10.0, 10.0, 100), (5, 1))
    scatter = np.random.default_rng(7).normal(1.0, 0.01, (5, 1))
    friction = scatter + 0.3 * np.maximum(np.abs(load) - start, 0.0)
    lines = Midlines(load / 300.0, load, friction, 0.0 * load, np.zeros(5), 0.0, 0.0)
    found, growth = friction_of(lines, STEP)
    assert abs(found.value - 1.0) < found.uncertainty < 0.4
    assert 0.2 < growth.value < 0.31


def test_friction_that_builds_up_is_taken_out_of_the_load():
    lines, load = dahl(missing=0.4)
    corrected, missing = without_build_up(lines)
    assert np.abs(np.mean(corrected.load, axis=0) - load)[3:-3].max() < 0.025
    read = np.mean(lines.load, axis=0)
    near_peaks = np.abs(read) > 0.825 * 3.4
    assert missing.near.value == pytest.approx(np.mean(np.abs(read - load)[near_peaks]), rel=0.15)


def test_friction_may_not_have_built_up_without_load_either():
    """Either branch lacks friction that falls with the load since its peak, by 1/e in 2 N·m."""
    load = np.tile(np.linspace(-3.0, 3.0, 101), (5, 1))
    lacking = 0.3 * np.cosh(load / 2.0) + np.random.default_rng(5).normal(0.0, 1e-3, (5, 1))
    lines = Midlines(load / 300.0, load, 1.0 - lacking, 0.0 * load, np.zeros(5), 0.0, 0.0)
    _, missing = without_build_up(lines)
    assert missing.rest == pytest.approx(0.3, rel=0.05)


@pytest.mark.parametrize('growth', [0.0, 0.1])
def test_friction_that_does_not_build_up_is_left(growth):
    lines, _ = dahl(missing=0.0, growth=growth)
    assert without_build_up(lines) == (lines, None)


def test_friction_that_builds_up_leaves_the_play_right():
    building = scenario('friction that builds up')
    found = models.settled(loading(building))
    model = models.models_of(found, STEP).plays[0]
    assert abs(model.play.value - building.play) < model.play.uncertainty
    assert model.play.uncertainty < 0.5 * ARC_MINUTE
    assert 0.1 < model.missing.value < 0.4


def test_the_steps_of_stick_slip_do_not_come_and_go_in_the_stiffness():
    found = models.settled(loading(scenario('stick-slip')))
    spring = models.models_of(found, STEP).spring
    assert spring.stiffness.value == pytest.approx(300.0, rel=2e-3)
    assert spring.stiffness.uncertainty < 3e-3 * 300.0


def test_a_gear_that_speeds_up_in_its_backlash_has_wider_intervals():
    fast = scenario('inertia, play')
    found = models.settled(loading(fast))
    model = models.models_of(found, STEP).plays[0]
    assert model.more.value > 0.1
    assert abs(model.play.value - fast.play) < model.play.uncertainty
    assert abs(model.friction.value - fast.friction) < model.friction.uncertainty


@pytest.mark.parametrize('name', ['play, linear spring', 'stick-slip'])
def test_friction_that_is_the_same_within_the_backlash_adds_nothing(name):
    found = models.settled(loading(scenario(name)))
    assert models.models_of(found, STEP).plays[0].more is None


@pytest.mark.parametrize(
    ('centre', 'gap'), [(0.0, 0.0), (0.001, 0.0), (0.002, 0.0103), (0.0, 0.003)]
)
def test_a_model_has_the_mean_of_the_angle_beyond_the_gap(centre, gap):
    """Against the mean of many angles around each."""
    angle = np.linspace(-0.02, 0.02, 41)[None]
    near = angle[..., None] + 1e-3 * ((np.arange(2000) + 0.5) / 2000.0 - 0.5)
    off = near - centre
    beyond = np.sign(off) * np.maximum(np.abs(off) - 0.5 * gap, 0.0)
    springs = Springs(np.array([centre]), np.array([gap]), np.array([[0.0, 3.0, 2.0]]))
    lines = Midlines(angle, angle, angle, angle, np.zeros(1), 0.0, 0.0)
    load = Fitting(lines).load(Model(SHAPES[0], Gap.PLAY), springs, angle)
    expected = np.mean(np.where(beyond > 0.0, 3.0, 2.0) * beyond, axis=-1) / 0.02
    assert load == pytest.approx(expected, abs=1e-6)


def test_a_soft_middle_is_a_bound_and_says_why():
    found = models.settled(loading(scenario('soft middle')))
    model = models.models_of(found, STEP).plays[0]
    assert model.play is None
    assert model.cause == Cause.SOFT
    assert 0.2 < model.softness < 0.6


def hardening_within(softer: float, **figures: float) -> models.Models:
    """Of a spring that no model fits well: it hardens over a small part of the loops."""
    hardening = scenario('play, hardening spring, large loops only')
    gear = replace(hardening, softness=softer, **figures)
    return models.models_of(models.settled(loading(gear)), STEP)


def test_a_spring_that_no_model_fits_widens_the_play():
    """By more than its repeats scatter, and the models differ."""
    play = hardening_within(0.4).plays[0].play
    assert play.uncertainty > abs(play.value - 0.01) > 2e-3


@pytest.mark.parametrize(('softer', 'friction'), [(0.6, 0.7), (0.65, 1.0)])
def test_a_model_of_another_hysteresis_tells_no_play_beyond_it(softer, friction):
    """The soft middles of these models are 24 and 26 mrad wide, the loops 16 and 19 mrad."""
    model = hardening_within(softer, friction=friction).plays[0]
    assert model.name == 'tanh 0.3 spring, soft middle'
    assert (model.play, model.limit, model.cause) == (None, None, Cause.MODELS)


def test_a_soft_middle_is_no_stiff_one():
    """The middle of these lines is ten times as stiff as the rest."""
    angle = np.tile(np.linspace(-0.02, 0.02, 100), (3, 1))
    load = 100.0 * angle + 900.0 * np.clip(angle, -0.002, 0.002)
    fitting = Fitting(Midlines(angle, load, load, load, np.zeros(3), 0.0, 0.0))
    straight, soft = (fitting.fit(Model(SHAPES[0], gap)) for gap in (Gap.NONE, Gap.SOFT))
    assert soft.errors == pytest.approx(straight.errors, rel=0.01)


def test_ramps_that_stay_within_the_backlash_say_so():
    """Up to 6 N·m the gear yields at a tenth of its stiffness beyond: over 2 · 0.1 rad."""

    def spring(load: np.ndarray) -> np.ndarray:
        return load / 600.0 + 0.015 * np.clip(load, -6.0, 6.0)

    found = models.settled(loading(Scenario('soft', spring=spring)))
    small, large = models.models_of(found, STEP).plays
    assert (small.cause, small.play, small.limit) == (Cause.WITHIN, None, None)
    assert large.play.value == pytest.approx(0.2, rel=0.01)


def test_rejected_models_have_their_scores():
    found = models.settled(loading(scenario('play, hardening spring')))
    model = models.models_of(found, STEP).plays[0]
    errors = [candidate.error for candidate in model.candidates]
    assert errors == sorted(errors)
    assert model.candidates[0].plausible
    linear = next(c for c in model.candidates if c.name == 'linear spring, no play')
    assert not linear.plausible
    assert linear.error > 5.0 * errors[0]


@pytest.mark.parametrize(('folder', 'every'), [('torque_ramps', 2), ('torque_ramps_more', 5)])
def test_no_play_of_a_measured_actuator_is_negative_or_exceeds_its_hysteresis(
    shared_path, folder, every
):
    for path in sorted(shared_path(f'data/{folder}').glob('*.csv'))[::every]:
        data = np.genfromtxt(path, delimiter=',', names=True)
        recorded = Loading(
            data['TORQUE'],
            2.0 * math.pi * data['POSITION'],
            Step(2.0 * math.pi / 65536.0, Source.FOUND),
            measured=False,
        )
        found = models.settled(recorded)
        for group, model in zip(found.ramps, models.models_of(found, 0.0).plays, strict=True):
            hysteresis = np.mean([loop.width(0.0) for loop in group.loops])
            if model.play:
                assert model.play.value > model.play.uncertainty, path.name
            if model.limit is not None:
                assert 0.0 < model.limit < hysteresis, path.name


@pytest.mark.parametrize(
    ('loops', 'curve'),
    [
        (1, lambda torque: torque + 3.0 * np.abs(torque)),
        (4, lambda torque: torque**3 / 100.0 - 0.22 * np.sin(torque)),
    ],
    ids=['angle goes back', 'neither stiff nor soft'],
)
def test_what_is_no_spring_still_has_a_hysteresis(loops, curve):
    torque = ramps(*[(10.0, 60)] * loops)
    angle = 1e-3 * curve(torque)
    found = models.settled(Loading(torque, angle, Step(1e-5, Source.GIVEN), measured=True))
    for model in models.models_of(found, 1e-5).plays:
        assert model is None or model.play is None or model.play.value >= 0.0


def test_residuals_that_depend_on_load_or_speed_or_time_are_found():
    random = np.random.default_rng(4)
    load = np.linspace(-3.0, 3.0, 100) + np.zeros((6, 1))
    pace = np.tile(np.linspace(1.0, 2.0, 100), (6, 1))
    chance = 0.02 * random.standard_normal(load.shape)
    cases = {
        'runs along the angle': chance + 0.02 * np.sin(3.0 * load),
        'scatter over the load': chance * (0.2 + np.abs(load)),
        'residual over the load': chance + 0.02 * load,
        'residual over the speed': chance - 0.05 * pace * np.sign(load),
        'scatter over time': chance * np.arange(1.0, 7.0)[:, None],
    }
    for name, rest in cases.items():
        found = {test.name: test.probability for test in residual_tests(rest, load, pace)}
        assert found[name] < 0.01, name
    assert all(test.probability > 0.02 for test in residual_tests(chance, load, pace))
