#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# mdf4-rs 0.3.3 (Rust): merging makes 1500 of a position of 1.5 rad and times that go back, and a cut recording cannot
# be read.
#
# A channel has whole numbers with a factor of 0.001 and the unit rad. Expected after merge_files() of two recordings of
# 5 s: 10 values of 1.500 to 1.504 rad at times that rise. What happens: of a channel only its bits and its name are
# kept, not its conversion and unit, so that the values are 1500 to 1504 without a unit; the time is no longer marked as
# the time, and goes from 4 back to 0. Expected of cut_mdf_by_time() from 1 to 3 s: three values. What happens: it
# reports success, but the new file points to where the conversion was in the old one, and mdf4-rs itself refuses to
# open it.
# For us: merge and cut recordings with another library, or give the recordings to gearkin one by one.
#
# Exit code 0: still so. Needs cargo; installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir "$folder/src"
cd "$folder"
cat > Cargo.toml <<'TOML'
[package]
name = "merge"
version = "0.1.0"
edition = "2021"
[dependencies]
mdf4-rs = "=0.3.3"
TOML
cat > src/main.rs <<'RUST'
use mdf4_rs::{cut::cut_mdf_by_time, merge::merge_files, DataType, DecodedValue, MdfWriter, MDF};

fn write(path: &str) {
    let mut file = MdfWriter::new(path).unwrap();
    file.init_mdf_file().unwrap();
    let group = file.add_channel_group(None, |_| {}).unwrap();
    let time = file.add_channel(&group, None, |channel| {
        channel.data_type = DataType::FloatLE;
        channel.name = Some("time".into());
        channel.bit_count = 64;
    });
    let time = time.unwrap();
    file.set_time_channel(&time).unwrap();
    let position = file.add_channel(&group, Some(&time), |channel| {
        channel.data_type = DataType::SignedIntegerLE;
        channel.name = Some("position".into());
        channel.bit_count = 32;
    });
    let position = position.unwrap();
    file.add_linear_conversion(&position, 0.0, 0.001).unwrap();
    file.set_channel_unit(&position, "rad").unwrap();
    file.start_data_block_for_cg(&group, 0).unwrap();
    for sample in 0..5 {
        let values = [DecodedValue::Float(sample as f64), DecodedValue::SignedInteger(1500 + sample)];
        file.write_record(&group, &values).unwrap();
    }
    file.finish_data_block(&group).unwrap();
    file.finalize().unwrap();
}

/// The unit and the values of the first file's time and position.
fn read(path: &str) -> Vec<(Option<String>, Vec<f64>)> {
    let file = MDF::from_file(path).unwrap();
    let groups = file.channel_groups();
    let channels = groups[0].channels();
    let number = |value| match value {
        Some(DecodedValue::Float(number)) => number,
        Some(DecodedValue::SignedInteger(number)) => number as f64,
        other => panic!("{other:?}"),
    };
    let found: Vec<_> = channels
        .iter()
        .map(|channel| (channel.unit().unwrap(), channel.values().unwrap().into_iter().map(number).collect()))
        .collect();
    println!("{path}: {found:?}");
    found
}

fn main() {
    write("first.mf4");
    write("second.mf4");
    let one = read("first.mf4");
    assert!(one[1].0.as_deref() == Some("rad") && (one[1].1[4] - 1.504).abs() < 1e-9);

    merge_files("merged.mf4", "first.mf4", "second.mf4").unwrap();
    let merged = read("merged.mf4");
    assert!(merged[1].0.is_none() && merged[1].1[..5] == [1500.0, 1501.0, 1502.0, 1503.0, 1504.0]);
    assert_eq!(merged[0].1, [0.0, 1.0, 2.0, 3.0, 4.0, 0.0, 1.0, 2.0, 3.0, 4.0]);

    cut_mdf_by_time("first.mf4", "cut.mf4", 1.0, 3.0).unwrap();
    let error = MDF::from_file("cut.mf4").map(|_| ()).unwrap_err().to_string();
    println!("cut.mf4: {error}");
    assert!(error.contains("##CC"));
}
RUST
timeout 280 cargo run --quiet
