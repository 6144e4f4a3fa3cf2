# SPDX-License-Identifier: Apache-2.0
set terminal svg size 1000,900 dynamic enhanced font "sans-serif,13" background "#ffffff"
set multiplot title ARG2 noenhanced font ",16"
set label 1 ARG3 at @READING
@SEE_METHODS
COLD = 3  # the first so many methods are timed with cold caches as well
LEGEND_Y = 0.955
@LEGEND
plot NaN notitle, for [m = 1:M] keyentry with points pt 7 ps 1.2 lc rgb word(COLOUR, m) title word(METHODS, m), \
     keyentry with points pt 2 ps 1.2 lc rgb "black" title "cold caches"
@END_LEGEND

stats ARG1 using (column("cols")) name "COLS" nooutput
stats ARG1 using (column("update_median_us")) name "LOW" nooutput
stats ARG1 using (column("whole_p999_us") + column("frame_us_per_tick")) name "HIGH" nooutput
SIZES = "720 1920 3840"
PANELS = COLS_max > 720 ? 3 : 1
set logscale xy
set xrange [0.06:9]
set xtics (0.1, 1, 5)
set yrange [LOW_min * 0.5 : HIGH_max * 1.5]
left(s) = 0.08 + 0.92 / PANELS * (s - 1)
array ROW[2] = ["time to force", "whole tick"]
first(w) = w == 1 ? column("update_median_us") : column("whole_median_us") + column("frame_us_per_tick")
last(w) = w == 1 ? column("update_p999_us") : column("whole_p999_us") + column("frame_us_per_tick")
mine(m, s, cache, value) = (strcol("method") eq word(METHODS, m) && strcol("caches") eq cache) ? where("cols", word(SIZES, s), value) : NaN
shift(m) = 1.07 ** (m - 6)  # so that bars stand side by side
do for [w = 1:2] {
  set tmargin at screen 0.84 - 0.37 * (w - 1)
  set bmargin at screen 0.84 - 0.37 * (w - 1) - 0.29
  set xlabel (w == 2 ? "finger, m/s" : "") offset 0, 0.5
  do for [s = 1:PANELS] {
    set lmargin at screen left(s)
    set rmargin at screen left(s) + 0.92 / PANELS - 0.02
    set title ROW[w] . ", " . word(SIZES, s) . " columns" offset 0, -0.6
    set ylabel (s == 1 ? "µs: median, with a bar to p99.9" : "")
    if (s > 1) { set format y "" } else { set format y "%g" }
    plot for [m = M:1:-1] ARG1 using (column("speed_m_per_s") * shift(m)):(mine(m, s, "warm", first(w))):(first(w)):(last(w)) \
           with yerrorbars pt 7 ps 0.7 lc rgb word(COLOUR, m), \
         for [m = 1:COLD] ARG1 using (column("speed_m_per_s") * shift(M + m)):(mine(m, s, "cold", first(w))):(first(w)):(last(w)) \
           with yerrorbars pt 2 ps 0.7 lc rgb word(COLOUR, m)
    unset label 1
  }
}
unset multiplot
