# SPDX-License-Identifier: Apache-2.0
set terminal svg size 1000,560 dynamic enhanced font "sans-serif,13" background "#ffffff"
set multiplot title ARG2 noenhanced font ",16"
set label 1 ARG3 at @READING
array TINTS[2] = ["#00897b", "#e08e0b"]
array ORDERS[2] = [1, 3]
LEGEND_Y = 0.9
@LEGEND
plot NaN notitle, keyentry with lines lw 2.5 lc rgb "#d81b60" title "relievo", \
     keyentry with linespoints pt 7 ps 0.8 lw 1.5 lc rgb TINTS[1] title "god-object, Gaussian", \
     keyentry with linespoints pt 5 ps 0.8 lw 1.5 lc rgb TINTS[2] title "god-object, third order"
@END_LEGEND
set logscale xy
set format y "%g"
set xtics (0.3, 0.6, 1.2, 2.4)
set tmargin at screen 0.78
set bmargin at screen 0.3
set xlabel "width of the smoothing, mm"
set key off
shown(d, order, value) = strcol("depth") eq word(DEPTHS, d) && column("order") == order ? value : NaN
set xrange [0.25:4]
do for [d = 1:4] {
  set lmargin at screen 0.07 + 0.235 * (d - 1)
  set rmargin at screen 0.07 + 0.235 * (d - 1) + 0.19
  set title word(DEPTHS, d) offset 0, -0.6
  set ylabel (d == 1 ? "force error in the worst smooth scene, %" : "")
  stats ARG1 using (shown(d, 0, column("worst_percent"))) name "OWN" nooutput
  plot OWN_min with lines lw 2.5 lc rgb "#d81b60", \
       for [o = 1:2] ARG1 using (shown(d, ORDERS[o], column("width_mm"))):(column("worst_percent")) \
         with linespoints pt (o == 1 ? 7 : 5) ps 0.8 lw 1.5 lc rgb TINTS[o]
  unset label 1
}
unset multiplot
