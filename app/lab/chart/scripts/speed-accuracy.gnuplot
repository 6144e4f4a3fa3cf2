# SPDX-License-Identifier: Apache-2.0
set terminal svg size 1000,700 dynamic enhanced font "sans-serif,13" background "#ffffff"
set multiplot title ARG2 noenhanced font ",16"
set label 1 ARG3 at @READING
@SEE_METHODS
LEGEND_Y = 0.945
@LEGEND
plot NaN notitle, for [m = 1:M] keyentry with points pt 7 ps 1.2 lc rgb word(COLOUR, m) title word(METHODS, m), \
     for [d = 1:4] keyentry with points pt SYMBOL[d] ps 1.2 lc rgb "black" title word(DEPTHS, d), \
     keyentry with points pt 6 lw 2 ps 1.1 lc rgb "black" title LOST
@END_LEGEND

set logscale xy
set format xy "%g"
all(value) = strcol("scene") eq "all" ? value : NaN
first(p) = p == 1 ? column("update_median_us") : column("whole_median_us") + column("frame_us_per_tick")
last(p) = p == 1 ? column("update_p999_us") : column("whole_p999_us") + column("frame_us_per_tick")
stats ARG1 using (all(first(1))):(column("force_rms_percent")) name "LOW" nooutput
stats ARG1 using (all(last(2))):(column("force_rms_percent")) name "HIGH" nooutput
set xrange [LOW_min_x * 0.7 : HIGH_max_x * 1.4]
set yrange [LOW_min_y * 0.6 : LOW_max_y * 1.7]
set tmargin at screen 0.755
set bmargin at screen 0.195
array TITLE[2] = ["time to force", "whole tick: force, upkeep, share of a frame's work"]
set xlabel "µs: median, with a bar to p99.9"
mine(m, d, value) = (strcol("scene") eq "all" && strcol("method") eq word(METHODS, m)) ? where("depth", word(DEPTHS, d), value) : NaN
do for [p = 1:2] {
  set lmargin at screen 0.08 + 0.47 * (p - 1)
  set rmargin at screen 0.08 + 0.47 * (p - 1) + 0.43
  set title TITLE[p] offset 0, -0.6
  set ylabel (p == 1 ? "error of the force vector, rms over all scenes, %" : "")
  plot for [m = M:1:-1] for [d = 1:4] ARG1 using (mine(m, d, first(p))):(column("force_rms_percent")):(first(p)):(last(p)) \
         with xerrorbars pt SYMBOL[d] ps 1 lw 1.2 lc rgb word(COLOUR, m) notitle, \
       for [m = M:1:-1] for [d = 1:4] ARG1 using (lost(mine(m, d, first(p)))):(column("force_rms_percent")) \
         with points pt SYMBOL[d] ps 0.6 lc rgb "#ffffff" notitle
  unset label 1
}
unset multiplot
