# SPDX-License-Identifier: Apache-2.0
set terminal svg size 1000,880 dynamic enhanced font "sans-serif,13" background "#ffffff"
set multiplot title ARG2 noenhanced font ",16"
set label 1 ARG3 at @READING
rate(i) = i < 2 ? "15" : "30"
depth(i) = i % 2 ? "16-bit" : "8-bit"
named(curve, i) = curve . " " . rate(i) . "/s " . depth(i)
do for [c = 1:words(ALL_CURVES)] {
  highest = -300
  do for [i = 0:3] {
    stats ARG1 using (column(named(word(ALL_CURVES, c), i))) name "LEVEL" nooutput
    highest = highest > LEVEL_max ? highest : LEVEL_max
  }
  kept = highest > -200 ? keep(c) : 0
}
LEGEND_Y = 0.955
@LEGEND
plot NaN notitle, for [c = 1:CURVE_COUNT] keyentry with lines lw 2.5 lc rgb TINT[c] title CURVE[c] . AHEAD[c]
@END_LEGEND

set xrange [0:60]
set yrange [-160:10]
set xlabel "frequency, Hz" offset 0, 0.5
left(i) = 0.075 + 0.48 * (i % 2)
top(i) = 0.85 - 0.40 * (i / 2)
do for [i = 0:3] {
  set lmargin at screen left(i)
  set rmargin at screen left(i) + 0.43
  set tmargin at screen top(i)
  set bmargin at screen top(i) - 0.285
  set title rate(i) . " frames/s, " . depth(i) . " depth" noenhanced offset 0, -0.6
  set ylabel (i % 2 ? "" : "density, dB re 1 N^2/Hz") offset 1
  plot for [c = 1:CURVE_COUNT] ARG1 \
         using (column("frequency_hz")):(column(named(CURVE[c], i))) \
         with lines lw 1.2 lc rgb TINT[c]
}
unset multiplot
