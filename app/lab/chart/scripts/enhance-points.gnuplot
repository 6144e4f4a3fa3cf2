# SPDX-License-Identifier: Apache-2.0
set terminal svg size 1000,520 dynamic enhanced font "sans-serif,13" background "#ffffff"
set multiplot title ARG2 noenhanced font ",16"
set label 1 ARG3 at @READING
SCENES = ""
stats ARG1 using (strstrt(SCENES." ", " ".strcol("scene")." ") ? 0 : (SCENES = SCENES." ".strcol("scene"), 0)) nooutput
array TINTS[8] = ["#8a8f98", "#1e88e5", "#d81b60", "#7cb342", "#fb8c00", "#5e35b1", "#00897b", "#6d4c41"]
set lmargin at screen 0.08
set rmargin at screen 0.97
set tmargin at screen 0.88
set bmargin at screen 0.2
set logscale xy
set format "%g"
set xlabel "error bound, levels of 255"
set ylabel "points"
set xrange [0.05:10]
set yrange [2:*]
set key top right
plot for [s = 1:words(SCENES)] ARG1 using (column("bound_levels")):(where("scene", word(SCENES, s), column("points"))) \
  with linespoints pt 7 ps 0.9 lw 2 lc rgb TINTS[(s - 1) % 8 + 1] title word(SCENES, s)
unset multiplot
