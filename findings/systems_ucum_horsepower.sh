#!/bin/bash
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# systems-ucum 2.2 (Java, JSR 385): a motor of 1 [HP] has 1.356 W instead of 745.7 W, and 20 dB are a ratio of 0.301.
#
# UCUM defines the horsepower [HP] as 550 [ft_i].[lbf_av]/s, and the bel by the decimal logarithm. Expected of 1 [HP]:
# 745.7 W; of 20 dB: 100; of a ratio of 100: 2 B or 20 dB; of 1 Np: 2.718 (e). What happens: 1.356 W, which is
# 1 [ft_i].[lbf_av]/s, as the 550 is left out; 0.301, the logarithm of 2; 1e100 B or 1e101 dB, as logarithm and power
# are exchanged; and 0 for 1 Np. No error is raised. 550 [ft_i].[lbf_av]/s are 745.7 W, and [lbf_av].[ft_i], kgf.m,
# deg, gon, ' and circ are right. (An open issue of si-units asks whether the converter of its own bel is wrong.)
# For us: convert decibels by hand, and take HORSEPOWER of USCustomary in systems-common, which is 745.7 W.
#
# Exit code 0: still so. Needs a JDK and mvn; installs the versions into a temporary folder.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir -p "$folder/src/main/java"
cd "$folder"
cat > pom.xml <<'XML'
<project>
  <modelVersion>4.0.0</modelVersion>
  <groupId>org.example</groupId><artifactId>horsepower</artifactId><version>1</version>
  <properties><maven.compiler.source>17</maven.compiler.source><maven.compiler.target>17</maven.compiler.target>
    <project.build.sourceEncoding>UTF-8</project.build.sourceEncoding></properties>
  <dependencies>
    <dependency><groupId>systems.uom</groupId><artifactId>systems-ucum</artifactId><version>2.2</version></dependency>
    <dependency><groupId>systems.uom</groupId><artifactId>systems-quantity</artifactId>
      <version>2.2</version></dependency>
    <dependency><groupId>systems.uom</groupId><artifactId>systems-common</artifactId><version>2.2</version></dependency>
    <dependency><groupId>tech.units</groupId><artifactId>indriya</artifactId><version>2.2.3</version></dependency>
  </dependencies>
</project>
XML
cat > src/main/java/Main.java <<'JAVA'
import systems.uom.common.USCustomary;
import systems.uom.ucum.UCUM;
import systems.uom.ucum.format.UCUMFormat;
import tech.units.indriya.unit.Units;

public class Main {
    static final UCUMFormat FORMAT = UCUMFormat.getInstance(UCUMFormat.Variant.CASE_SENSITIVE);

    static void check(double value, String from, String to, double seen) throws Exception {
        double found = FORMAT.parse(from).getConverterToAny(FORMAT.parse(to)).convert(value);
        System.out.println(value + " " + from + " = " + found + " " + to);
        same(found, seen);
    }

    static void same(double found, double seen) {
        if (Math.abs(found - seen) > 1e-9 * Math.abs(seen)) {
            throw new AssertionError(seen + " was seen, not " + found);
        }
    }

    public static void main(String[] arguments) throws Exception {
        check(1, "[HP]", "W", 1.3558179483314003);
        same(UCUM.HORSEPOWER.getConverterTo(Units.WATT).convert(1.0), 1.3558179483314003);
        check(550, "[ft_i].[lbf_av]/s", "W", 745.6998715822702);
        same(USCustomary.HORSEPOWER.getConverterTo(Units.WATT).convert(1.0), 745.69987158227);
        check(20, "dB", "1", Math.log10(2));
        check(100, "1", "B", 1e100);
        check(100, "1", "dB", 1e101);
        check(1, "Np", "1", 0);
        check(1, "[lbf_av].[ft_i]", "N.m", 1.3558179483314003);
        check(1, "kgf.m", "N.m", 9.80665);
        check(180, "deg", "rad", Math.PI);
        check(100, "gon", "deg", 90);
        check(60, "'", "deg", 1);
        check(1, "circ", "deg", 360);
    }
}
JAVA
timeout 280 mvn --quiet --batch-mode -Dmaven.repo.local="$folder/repository" \
    compile dependency:build-classpath -Dmdep.outputFile=path > log || { cat log; exit 1; }
timeout 60 java -cp "target/classes:$(cat path)" Main
