#!/bin/sh
# Copyright 2026 gear_kinematics contributors. SPDX-License-Identifier: Apache-2.0
# commons-math3 3.6.1 (Java): a smoother that is to withstand outliers gives 10 NaN around a single one, or follows it.
#
# An encoder that stands still trembles by one count, and one of its 201 readings is 4096 counts too large. Expected of
# LoessInterpolator with its 2 robust iterations: 1000 to 1001 counts everywhere. What happens: the bad reading spoils
# the first fit of its neighbours, so that all of them are taken as outliers; where all weights in a window are 0, the
# result is 0/0. 10 values are NaN, 28 with 4 iterations, without an error. On a shaft that turns evenly without any
# noise the opposite happens: the median of the residuals is 0, which ends the iterations, and a reading that is 50 rad
# too large draws the result by 8.6 rad.
# For us: leave out a reading that differs from both of its neighbours before smoothing, and look for NaN after it.
#
# Exit code 0: still so. Needs a JDK and mvn; installs the versions into a temporary folder.
set -eu
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
mkdir -p "$folder/src/main/java"
cd "$folder"
cat > pom.xml <<'XML'
<project>
  <modelVersion>4.0.0</modelVersion>
  <groupId>org.example</groupId><artifactId>loess</artifactId><version>1</version>
  <properties><maven.compiler.source>17</maven.compiler.source><maven.compiler.target>17</maven.compiler.target>
    <project.build.sourceEncoding>UTF-8</project.build.sourceEncoding></properties>
  <dependencies>
    <dependency><groupId>org.apache.commons</groupId><artifactId>commons-math3</artifactId>
      <version>3.6.1</version></dependency>
  </dependencies>
</project>
XML
cat > src/main/java/Main.java <<'JAVA'
import java.util.Random;
import org.apache.commons.math3.analysis.interpolation.LoessInterpolator;

public class Main {
    /** How many smoothed values are NaN, and the greatest difference of the others from those without the bad reading. */
    static double[] smoothed(double[] clean, double error, int iterations) {
        double[] times = new double[clean.length];
        for (int sample = 0; sample < times.length; sample++) {
            times[sample] = sample;
        }
        double[] readings = clean.clone();
        readings[100] += error;
        double[] values = new LoessInterpolator(0.05, iterations).smooth(times, readings);
        double[] found = {0, 0};
        for (int sample = 0; sample < values.length; sample++) {
            if (Double.isNaN(values[sample])) {
                found[0]++;
            } else {
                found[1] = Math.max(found[1], Math.abs(values[sample] - clean[sample]));
            }
        }
        System.out.println(iterations + " iterations: " + found[0] + " NaN, the others up to " + found[1] + " away");
        return found;
    }

    public static void main(String[] arguments) {
        Random random = new Random(1);
        double[] still = new double[201];
        double[] turning = new double[201];
        for (int sample = 0; sample < 201; sample++) {
            still[sample] = 1000 + random.nextInt(2);
            turning[sample] = 0.1 * sample;
        }
        double[] two = smoothed(still, 4096, LoessInterpolator.DEFAULT_ROBUSTNESS_ITERS);
        double[] four = smoothed(still, 4096, 4);
        double[] even = smoothed(turning, 50, 4);
        if (two[0] != 10 || four[0] != 28 || two[1] > 1 || even[0] != 0 || Math.abs(even[1] - 8.64) > 0.01) {
            System.exit(1);
        }
    }
}
JAVA
timeout 280 mvn --quiet --batch-mode -Dmaven.repo.local="$folder/repository" \
    compile dependency:build-classpath -Dmdep.outputFile=path > log || { cat log; exit 1; }
timeout 60 java -cp "target/classes:$(cat path)" Main
