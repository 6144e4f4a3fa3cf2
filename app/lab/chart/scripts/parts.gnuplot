# SPDX-License-Identifier: Apache-2.0
set terminal svg size 1000,800 dynamic enhanced font "sans-serif,13" background "#ffffff"
set multiplot title ARG2 noenhanced font ",16"
set label 1 ARG3 at @READING
stats ARG1 using (1) nooutput
set yrange [STATS_records - 0.5 : -0.5]
set logscale x
set format x "%g"
set tmargin at screen 0.88
set bmargin at screen 0.18
set ytics noenhanced
set key off
left(p) = p == 0 ? 0.18 : 0.20 + 0.16 * p
array COLUMN[4] = ["16_bit", "8_bit", "h264", "noise"]
percent(d) = column("percent_" . COLUMN[d])
lostOf(d) = column("contact_lost_" . COLUMN[d]) == 1 ? percent(d) : NaN
set lmargin at screen left(0)
set rmargin at screen left(0) + 0.15
set title "to force ●, whole tick ◇" offset 0, -0.6
set xlabel "µs, median to p99.9"
set xrange [0.03:300]
set xtics (0.1, 1, 10, 100)
whole(name) = column(name) + column("frame_us_per_tick")
plot ARG1 using (whole("whole_median_us")):(column(0) + 0.25):(whole("whole_median_us")):(whole("whole_p999_us")) \
     with xerrorbars pt 12 ps 0.8 lc rgb "#a8b0ba", \
     ARG1 using (column("update_median_us")):0:(column("update_median_us")):(column("update_p999_us")):ytic(strcol("method")) \
     with xerrorbars pt 7 ps 0.8 lc rgb "#5f6b7a"
unset label 1
set label 2 LOST at screen 0.98, 0.94 right
set format y ""
set xlabel "force error, %"
set xrange [0.01:1000]
set xtics (0.01, "" 0.1, 1, "" 10, 100)
do for [d = 1:4] {
  set lmargin at screen left(d)
  set rmargin at screen left(d) + 0.14
  set title word(DEPTHS, d) noenhanced offset 0, -0.6
  if (d > 1) { unset label 2 }
  plot ARG1 using (0.01):0:(percent(d) - 0.01):(0) with vectors nohead lw 1.2 lc rgb "#d81b60", \
       ARG1 using (percent(d)):0 with points pt 7 ps 0.8 lc rgb "#d81b60", \
       ARG1 using (lostOf(d)):0 with points pt 7 ps 0.45 lc rgb "#ffffff"
}
unset multiplot
