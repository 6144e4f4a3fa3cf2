# SPDX-License-Identifier: Apache-2.0
set terminal svg size 1000,640 dynamic enhanced font "sans-serif,13" background "#ffffff"
set multiplot title ARG2 noenhanced font ",16"
set label 1 ARG3 at screen 0.5, 0.075 center noenhanced
LEGEND_Y = 0.935
@LEGEND
plot NaN notitle, for [m = 1:6] keyentry with points pt 7 ps 1.2 lc rgb COLOUR[m] title word(METHODS, m), \
     keyentry with points pt 6 ps 1.2 lc rgb COLOUR[1] title "relievo, upkeep", \
     for [m = 1:2] keyentry with points pt 2 ps 1.2 lc rgb COLOUR[m] title word(METHODS, m) . ", cold caches"
@END_LEGEND

stats ARG1 using (column("cols")) name "COLS" nooutput
stats ARG1 using (column("update_median_us")) name "LOW" nooutput
stats ARG1 using (column("update_p999_us") > column("upkeep_p999_us") ? column("update_p999_us") : column("upkeep_p999_us")) name "HIGH" nooutput
SIZES = "720 1920 3840"
PANELS = COLS_max > 720 ? 3 : 1
set logscale xy
set format y "%g"
set xrange [0.06:9]
set xtics (0.1, 1, 5)
set yrange [LOW_min * 0.5 : HIGH_max * 1.5]
set xlabel "finger, m/s"
set tmargin at screen 0.79
set bmargin at screen 0.21
left(s) = 0.08 + 0.92 / PANELS * (s - 1)
mine(m, s, cache, value) = (strcol("method") eq word(METHODS, m) && strcol("caches") eq cache) ? where("cols", word(SIZES, s), value) : NaN
shift(m) = 1.08 ** (m - 4)  # so that bars stand side by side
do for [s = 1:PANELS] {
  set lmargin at screen left(s)
  set rmargin at screen left(s) + 0.92 / PANELS - 0.02
  set title word(SIZES, s) . " columns" offset 0, -0.6
  set ylabel (s == 1 ? "µs: median, with a bar to p99.9" : "")
  if (s > 1) { set format y "" }
  plot for [m = 6:1:-1] ARG1 using (column("speed_m_per_s") * shift(m)):(mine(m, s, "warm", column("update_median_us"))):(column("update_median_us")):(column("update_p999_us")) \
         with yerrorbars pt 7 ps 0.7 lc rgb COLOUR[m], \
       ARG1 using (column("speed_m_per_s") * shift(0)):(mine(1, s, "warm", column("upkeep_median_us"))):(column("upkeep_median_us")):(column("upkeep_p999_us")) \
         with yerrorbars pt 6 ps 0.7 lc rgb COLOUR[1], \
       for [m = 1:2] ARG1 using (column("speed_m_per_s") * shift(6 + m)):(mine(m, s, "cold", column("update_median_us"))):(column("update_median_us")):(column("update_p999_us")) \
         with yerrorbars pt 2 ps 0.7 lc rgb COLOUR[m]
}
unset multiplot
