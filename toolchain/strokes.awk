# SPDX-License-Identifier: Apache-2.0
# Prints a finger's path of four seconds: strokes across the picture, in and out of the surface.
BEGIN {
  print "t_s,x_mm,y_mm,z_mm"
  for (i = 0; i < 4000; ++i) {
    t = i / 1000
    printf "%.3f,%.6f,%.6f,%.6f\n", t, 55 * sin(1.3 * t), 28 * sin(1.7 * t + 1), 14 + 14 * cos(2.9 * t)
  }
}
