#!/usr/bin/env bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# scurve_motion 0.1.0 (Rust): where a new phase begins, a joint at 2 rad/s is sent back by 2 mrad within 1 ms.
#
# A move of 3 rad with at most 2 rad/s, 10 rad/s² and 100 rad/s³ has seven phases, whose times, positions and speeds are
# right and join without a step. Its MotionPolynomialExecutor is to play them at 1 kHz. Expected: positions that rise
# from each tick to the next, within 1800 ticks of 1 ms. What happens: a phase of 1200 ticks is played for 1201, one
# beyond its end, and the tick after it is the first position of the next phase, which is the end of the phase before.
# So the position falls back by one tick's way six times, by 0.5 to 2 mrad, and the move takes 14 ms longer.
# For us: a following error of 2 mrad looks like play. Evaluate the polynomials by the time since the start of the move.
#
# Exit code 0: still so. Needs cargo; installs the version into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/src"
cd "$folder"
cat > Cargo.toml <<'TOML'
[package]
name = "back"
version = "0.1.0"
edition = "2021"
[dependencies]
scurve_motion = "=0.1.0"
TOML
cat > src/main.rs <<'RUST'
use scurve_motion::{MotionPolynomial, MotionPolynomialExecutor, SCurve};

fn position(phase: &MotionPolynomial, time: f64) -> f64 {
    phase.pos + time * (phase.vel + time * (phase.acc / 2.0 + time * phase.jrk / 6.0))
}

fn main() {
    let mut curve = SCurve::new(2.0, 10.0, 100.0, 1e-9);
    assert!(curve.set_goal((0.0, 3.0), (0.0, 0.0), (100.0, 100.0, 100.0)));
    let task = curve.process(true);
    let phases = task.s_curve(0.001);
    for pair in phases.windows(2) {
        assert!((position(&pair[0], pair[0].time) - pair[1].pos).abs() < 1e-6); // the phases themselves join
    }
    assert!((position(&phases[6], phases[6].time) - 3.0).abs() < 1e-6 && (task.duration - 1.8).abs() < 1e-6);

    let mut executor = MotionPolynomialExecutor::<8>::new(1000);
    for phase in phases {
        executor.add_task(phase);
    }
    let mut positions = vec![0.0];
    for _ in 0..3000 {
        executor.tick();
        positions.push(executor.get_pos());
    }
    let steps: Vec<f64> = positions.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let back: Vec<(usize, f64)> = steps.iter().copied().enumerate().filter(|(_, step)| *step < -1e-9).collect();
    let moving = steps.iter().rposition(|step| step.abs() > 1e-12).unwrap();
    for (tick, step) in &back {
        println!("tick {tick}: back by {:.2} mrad, where the phases are right at every time", -1000.0 * step);
    }
    println!("the move of {:.3} s takes {} ticks of 1 ms", task.duration, moving + 1);
    assert!(back.len() == 6 && (1813..=1815).contains(&(moving + 1)));
    let furthest = back.iter().map(|(_, step)| *step).fold(0.0, f64::min);
    assert!((furthest + 0.002).abs() < 1e-6);
}
RUST
timeout 280 cargo run --quiet
