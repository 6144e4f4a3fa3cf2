# SPDX-License-Identifier: Apache-2.0
set terminal svg size 1000,680 dynamic enhanced font "sans-serif,13" background "#ffffff"
set multiplot title ARG2 noenhanced font ",16"
set label 1 ARG3 at @READING
KINDS = '"15 8-bit" "15 16-bit" "30 8-bit" "30 16-bit"'
array SHAPE[4] = [7, 6, 5, 4]
do for [c = 1:words(ALL_CURVES)] {
  stats ARG1 using (strcol("method") eq word(ALL_CURVES, c) && strlen(strcol("peak_db")) > 0 ? 1 : 0) nooutput
  kept = STATS_max > 0 ? keep(c) : 0
}
LEGEND_Y = 0.945
@LEGEND
plot NaN notitle, for [c = 1:CURVE_COUNT] keyentry with points pt 7 ps 1.2 lc rgb TINT[c] title CURVE[c] . AHEAD[c], \
     for [k = 1:4] keyentry with points pt SHAPE[k] ps 1.2 lc rgb "black" title word(word(KINDS, k), 1) . " frames/s, " . word(word(KINDS, k), 2)
@END_LEGEND

set logscale y
set format y "%g"
set xrange [-5:106]
set yrange [0.02:30]
set xlabel "peak at the frame rate, dB under holding the frame"
set tmargin at screen 0.755
set bmargin at screen 0.20
mine(c, k, finger, value) = (strcol("method") eq CURVE[c] && strcol("finger") eq finger && strcol("frames_per_s") eq word(word(KINDS, k), 1)) \
  ? where("depth", word(word(KINDS, k), 2), value) : NaN
do for [f = 1:2] {
  finger = word('"fixed point" "resting hand"', f)
  set lmargin at screen 0.08 + 0.47 * (f - 1)
  set rmargin at screen 0.08 + 0.47 * (f - 1) + 0.43
  set title finger offset 0, -0.6
  set ylabel (f == 1 ? "error of the force vector, rms, %" : "")
  plot for [c = 1:CURVE_COUNT] for [k = 1:4] ARG1 using (mine(c, k, finger, column("under_hold_db"))):(column("force_rms_percent")) \
         with points pt SHAPE[k] ps 1.1 lc rgb TINT[c]
}
unset multiplot
