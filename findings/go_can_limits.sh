#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# go.einride.tech/can 0.17.0: a position beyond the range in a .dbc is read as its limit, and a float of 1.5 as
# 1069547520.
#
# A signal of 16 bits with a factor of 0.001 has the range [-12.5|12.5] in its .dbc; the shaft has gone on to 20 rad.
# Expected: UnmarshalPhysical() gives 20, or an error. What happens: it gives 12.5, as if the shaft stood still; that
# the range is [0|0] is the only way to have no limit. A signal of type float gives the whole number that has its bits;
# UnmarshalFloat() is right.
# For us: cantools and gearkin decode all values: the range of a .dbc is a note there. For Go set it to [0|0].
#
# Exit code 0: still so. Needs go; installs the version into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
export GOMODCACHE="$folder/modules" GOFLAGS=-modcacherw
go mod init example.org/signal 2> log
go get go.einride.tech/can@v0.17.0 2>> log || { cat log; exit 1; }
cat > main.go <<'GO'
package main

import (
	"fmt"
	"os"

	"go.einride.tech/can"
	"go.einride.tech/can/pkg/descriptor"
)

func main() {
	limited := descriptor.Signal{Length: 16, IsSigned: true, Scale: 0.001, Min: -12.5, Max: 12.5}
	unlimited := descriptor.Signal{Length: 16, IsSigned: true, Scale: 0.001}
	float := descriptor.Signal{Length: 32, IsSigned: true, IsFloat: true, Scale: 1}
	var position, speed can.Data
	unlimited.MarshalSigned(&position, 20000)
	float.MarshalFloat(&speed, 1.5)
	physical := [3]float64{limited.UnmarshalPhysical(position), unlimited.UnmarshalPhysical(position), float.UnmarshalPhysical(speed)}
	fmt.Println(physical, float.UnmarshalFloat(speed))
	if physical != [3]float64{12.5, 20, 1069547520} || float.UnmarshalFloat(speed) != 1.5 {
		os.Exit(1)
	}
}
GO
timeout 100 go run .
