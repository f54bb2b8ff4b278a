#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# gonum.org/v1/gonum 0.17.0 (Go): after the end of a table a joint stands at 36 rad, with a speed of 12 rad/s for ever.
#
# The predictors of `interp` give a value and a derivative, and one that has both "handles both interpolation and
# extrapolation". The angles of a joint that speeds up as t^2 are given until 6 s. Expected of 7 s and 100 s: either 36
# rad with 0 rad/s, or an angle that goes on with 12 rad/s. What happens in four of the five splines with a derivative:
# Predict() holds the last angle, and PredictDerivative() goes on to give the last speed; before the table likewise. As
# a feedforward, such a speed drives a joint on that has arrived. ClampedCubic, whose speed is 0 at its ends, is right.
# Output: AkimaSpline: at 6 s 36.0 rad, 12.5 rad/s; at 7 s 36.0 rad, 12.5 rad/s; at 100 s 36.0 rad, 12.5 rad/s
#         FritschButland: at 6 s 36.0 rad, 12.0 rad/s; at 7 s 36.0 rad, 12.0 rad/s; at 100 s 36.0 rad, 12.0 rad/s
#         NaturalCubic: at 6 s 36.0 rad, 11.4 rad/s; at 7 s 36.0 rad, 11.4 rad/s; at 100 s 36.0 rad, 11.4 rad/s
#         NotAKnotCubic: at 6 s 36.0 rad, 12.0 rad/s; at 7 s 36.0 rad, 12.0 rad/s; at 100 s 36.0 rad, 12.0 rad/s
#         ClampedCubic: at 6 s 36.0 rad, 0.0 rad/s; at 7 s 36.0 rad, 0.0 rad/s; at 100 s 36.0 rad, 0.0 rad/s
# For us: set the speed to 0 outside of a table, and let a table of a move end at rest.
#
# Exit code 0: still so. Needs go; installs the version into a temporary folder (about a minute).
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export GOMODCACHE="$folder/modules" GOFLAGS=-modcacherw
go mod init example.org/table 2> log
go get gonum.org/v1/gonum/interp@v0.17.0 2>> log || { cat log; exit 1; }
cat > main.go <<'GO'
package main

import (
	"fmt"
	"os"

	"gonum.org/v1/gonum/interp"
)

type spline interface {
	interp.FittablePredictor
	interp.DerivativePredictor
}

func main() {
	times := []float64{0, 1, 2, 3, 5, 6}
	angles := make([]float64, len(times))
	for i, time := range times {
		angles[i] = time * time
	}
	names := []string{"AkimaSpline", "FritschButland", "NaturalCubic", "NotAKnotCubic", "ClampedCubic"}
	splines := []spline{&interp.AkimaSpline{}, &interp.FritschButland{}, &interp.NaturalCubic{},
		&interp.NotAKnotCubic{}, &interp.ClampedCubic{}}
	speeds := []float64{12.5, 12, 11.395, 12, 0}
	for i, name := range names {
		if err := splines[i].Fit(times, angles); err != nil {
			panic(err)
		}
		start, before := splines[i].PredictDerivative(0), splines[i].PredictDerivative(-1)
		if splines[i].Predict(-1) != 0 || before != start {
			fmt.Println(name, "before the table: not as before")
			os.Exit(1)
		}
		text := name + ":"
		for k, time := range []float64{6, 7, 100} {
			angle, speed := splines[i].Predict(time), splines[i].PredictDerivative(time)
			text += fmt.Sprintf("%s at %v s %.1f rad, %.1f rad/s", []string{"", ";", ";"}[k], time, angle, speed)
			if angle != 36 || speed < speeds[i]-1e-3 || speed > speeds[i]+1e-3 {
				fmt.Println(text, "- not as before")
				os.Exit(1)
			}
		}
		fmt.Println(text)
	}
}
GO
timeout 170 go run .
