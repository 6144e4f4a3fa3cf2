# SPDX-License-Identifier: Apache-2.0
set terminal svg size 1000,760 dynamic enhanced font "sans-serif,13" background "#ffffff"
set multiplot title ARG2 noenhanced font ",16"
set label 1 ARG3 at @READING
KINDS = '"16-bit" "8-bit" "noise 1 %"'
array TINT3[3] = ["#1e88e5", "#d81b60", "#8a8f98"]
RATES = "15 30 60"
LEGEND_Y = 0.94
@LEGEND
plot NaN notitle, for [k = 1:3] keyentry with linespoints pt 7 ps 0.8 lc rgb TINT3[k] title word(KINDS, k), \
     keyentry with points pt 7 ps 0.8 lc rgb "black" title "0 to 5 ahead", \
     keyentry with points pt 6 ps 1.1 lc rgb "black" title "carried by half a period, by one", \
     keyentry with points pt 8 ps 1.4 lw 1.6 lc rgb "black" title "the player's"
@END_LEGEND
of(r, k) = column("frames_per_s") == word(RATES, r) + 0 && strcol("depth") eq word(KINDS, k)
waits(r, k, v) = of(r, k) && (strcol("surface") eq "hold" || strstrt(strcol("surface"), "ahead")) ? v : NaN
carries(r, k, v) = of(r, k) && strstrt(strcol("surface"), "carried") ? v : NaN
chosen(r, k, v) = of(r, k) && strcol("surface") eq "chosen" ? v : NaN
set key off
set arrow 1 from 50, graph 0 to 50, graph 1 nohead dt 3
do for [p = 1:3] {
  VALUE = word("now_rms_percent own_rms_percent under_hold_db", p)
  set tmargin at screen 1.065 - 0.245 * p
  set bmargin at screen 0.885 - 0.245 * p
  if (p < 3) { set logscale y; set yrange [0.05:60] } else { unset logscale y; set yrange [-8:155] }
  do for [r = 1:3] {
    set lmargin at screen 0.075 + 0.31 * (r - 1)
    set rmargin at screen 0.075 + 0.31 * (r - 1) + 0.285
    set xrange [0:(r == 1 ? 360 : r == 2 ? 190 : 110)]
    set title (p == 1 ? word(RATES, r) . " frames/s" : "") offset 0, -0.7
    set format y (r > 1 ? "" : "%g")
    set ylabel (r > 1 ? "" : p == 1 ? "off the present scene, %" : p == 2 ? "off the scene felt, %" : "tremor, dB under hold") offset 1.2, 0
    set xlabel (p == 3 && r == 2 ? "age of the felt surface, median, ms (dotted: 50)" : "") offset 0, 0.6
    plot for [k = 1:3] ARG1 using (waits(r, k, column("age_median_ms"))):(column(VALUE)) with linespoints pt 7 ps 0.6 lc rgb TINT3[k], \
         for [k = 1:3] ARG1 using (carries(r, k, column("age_median_ms"))):(column(VALUE)) with linespoints pt 6 ps 0.9 dt 2 lc rgb TINT3[k], \
         for [k = 1:3] ARG1 using (chosen(r, k, column("age_median_ms"))):(column(VALUE)) with points pt 8 ps 1.7 lw 1.6 lc rgb TINT3[k]
    unset label 1
  }
}
unset multiplot
