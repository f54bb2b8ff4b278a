#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# rsruckig 3.0.1 (Rust): a joint with a guaranteed limit of -2 rad is driven to -2.49 rad, and no error is returned.
#
# The readme says of `min_position` and `max_position` that the trajectory stays inside them or that
# ErrorPositionalLimits is returned ("never a silent violation"). The joint rests at 1 rad and is to pass -1 rad at
# +1.5 rad/s, with at most 3 rad/s, 1 rad/s² and 2 rad/s³. To reach 1.5 rad/s it needs a run of about
# 1.5 · (1.5/1 + 1/2)/2 = 1.5 rad, so that it turns at -2.49 rad. Expected with a limit of -2 rad: the error.
# What happens: validate_input() accepts the motion with both checks, and update() leads the joint to -2.49 rad. An
# error comes only for limits above -1.71 rad, where the acceleration has just become constant:
# get_position_extrema() misses each turn of the joint at a constant acceleration. It does so in ruckig, too (0.19.4;
# its issue 215 about extrema is open), which has no such guarantee.
# For us: sample the trajectory, and compare the positions with the limits yourself before a joint follows it.
#
# Exit code 0: still so. Needs cargo; installs the version into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/src"
cd "$folder"
cat > Cargo.toml <<'TOML'
[package]
name = "limits"
version = "0.1.0"
edition = "2021"
[dependencies]
rsruckig = "=3.0.1"
TOML
cat > src/main.rs <<'RUST'
use rsruckig::prelude::*;

/// The lowest position that is commanded and the one that the library reports, or its error.
fn lowest(limit: f64) -> Result<(f64, f64), String> {
    let mut generator = Ruckig::<1, ThrowErrorHandler>::new(None, 0.01);
    let mut input = InputParameter::new(None);
    let mut output = OutputParameter::new(None);
    input.current_position[0] = 1.0;
    input.target_position[0] = -1.0;
    input.target_velocity[0] = 1.5;
    input.max_velocity[0] = 3.0;
    input.max_acceleration[0] = 1.0;
    input.max_jerk[0] = 2.0;
    input.min_position = Some(daov_stack![limit]);
    input.max_position = Some(daov_stack![10.0]);
    generator.validate_input(&input, true, true).map_err(|error| error.to_string())?;
    let mut lowest = f64::INFINITY;
    loop {
        match generator.update(&input, &mut output).map_err(|error| error.to_string())? {
            RuckigResult::Working => lowest = lowest.min(output.new_position[0]),
            RuckigResult::Finished => return Ok((lowest, output.trajectory.get_position_extrema()[0].min)),
            other => return Err(format!("{other:?}")),
        }
        output.pass_to_input(&mut input);
    }
}

fn main() {
    for limit in [-1.7, -1.8, -2.0, -2.4] {
        match lowest(limit) {
            Ok((commanded, reported)) => {
                println!("A limit of {limit} rad: down to {commanded:.3} rad, reported as {reported:.3} rad");
                assert!(limit < -1.7 && (commanded + 2.490).abs() < 0.001 && (reported + 1.708).abs() < 0.001);
            }
            Err(error) => {
                println!("A limit of {limit} rad: {}", error.lines().next().unwrap_or_default());
                assert!(limit == -1.7 && error.contains("position limits"));
            }
        }
    }
}
RUST
timeout 280 cargo run --quiet
