# SPDX-License-Identifier: Apache-2.0
set terminal svg size 1000,690 dynamic enhanced font "sans-serif,13" background "#ffffff"
set multiplot title ARG2 noenhanced font ",16"
set label 1 ARG3 at @READING
KINDS = '"relievo" "relievo 0.14" "relievo 0.28" "relievo 0.43" "relievo 0.72" "relievo 1.0" "relievo 0.28 + 0.72" "god-object" "god-object-smoothed" "modified-proxy-graph"'
array TINTS[4] = ["#1e88e5", "#26a69a", "#e08e0b", "#d81b60"]
LEGEND_Y = 0.915
@LEGEND
plot NaN notitle, for [d = 1:4] keyentry with points pt SYMBOL[d] ps 1 lc rgb TINTS[d] title word(DEPTHS, d), \
     keyentry with points pt 6 ps 1.6 lw 1.5 lc rgb "#5f6b7a" title "edge moving at 50 mm/s, either way"
@END_LEGEND
set yrange [10.5:0.5]
set logscale x
set xtics (0.1, 0.2, 0.5, 1, 2, 5)
set tmargin at screen 0.78
set bmargin at screen 0.27
set ytics () noenhanced
do for [k = 1:10] { set ytics add (word(KINDS, k) k) }
row(dummy) = sum [k = 1:10] (strcol("method") eq word(KINDS, k) ? k : 0)
shown(d, deep, value) = strcol("depth") eq word(DEPTHS, d) && (deep == 0 ? column("finger_deep_mm") == 2 : column("finger_deep_mm") == deep) ? value : NaN
moved(value) = column("edge_mm_per_s") != 0 ? value : NaN
array TITLE[3] = ["the surface is, in the mean", "swept off 2 mm deep, worst", "swept off 5 mm deep, worst"]
array DEEP[3] = [0, 2, 5]
figure(p) = p == 1 ? column("corner_mean_mm") : column("fall_off_worst_mm")
set xlabel "mm from the edge"
set xrange [0.08:10]
set key off
do for [p = 1:3] {
  set lmargin at screen 0.19 + 0.27 * (p - 1)
  set rmargin at screen 0.19 + 0.27 * (p - 1) + 0.25
  set title TITLE[p] offset 0, -0.6
  if (p == 2) { do for [k = 1:10] { set ytics add ("" k) } }
  plot for [d = 1:4] ARG1 using (shown(d, DEEP[p], figure(p))):(row(0) + 0.15 * (d - 2.5)) \
         with points pt SYMBOL[d] ps 0.8 lc rgb TINTS[d], \
       for [d = 1:4] ARG1 using (moved(shown(d, DEEP[p], figure(p)))):(row(0) + 0.15 * (d - 2.5)) \
         with points pt 6 ps 1.4 lw 1.2 lc rgb TINTS[d]
  unset label 1
}
unset multiplot
