# SPDX-License-Identifier: Apache-2.0
set terminal svg size 1000,890 dynamic enhanced font "sans-serif,13" background "#ffffff"
set multiplot title ARG2 noenhanced font ",16"
set label 1 ARG3 at @READING
NAMES = "relievo god-object god-object-smoothed modified-proxy-graph proxy-graph proxy-blend penalty"
PROFILES = "viscous full"
array PANEL[2] = ["without dry friction: 2b/((1+2n)T)", "with dry friction and encoder: the lesser of that and 2f_c/step"]
array TINTS[7] = ["#d81b60", "#1e88e5", "#00897b", "#e08e0b", "#7cb342", "#8e5cc2", "#8a8f98"]
LEGEND_Y = 0.96
@LEGEND
plot NaN notitle, keyentry with lines lw 2 lc rgb "black" title "bound", \
     keyentry with lines lw 2 dt 2 lc rgb "black" title "Choi, Tan 2004", \
     for [m = 1:7] keyentry with points pt 7 ps 1.2 lc rgb TINTS[m] title word(NAMES, m)
@END_LEGEND
set logscale y
set format y "%g"
mine(m, p, value) = strcol("method") eq word(NAMES, m) ? where("profile", word(PROFILES, p), value) : NaN
of_delay(value) = column("rate_hz") == 1000 ? value : NaN
of_rate(value) = column("delay_ticks") == 1 ? value : NaN
do for [p = 1:2] {
  set lmargin at screen 0.08 + 0.47 * (p - 1)
  set rmargin at screen 0.08 + 0.47 * (p - 1) + 0.43
  set ylabel (p == 1 ? "stiffness, N/mm" : "")

  set tmargin at screen 0.84
  set bmargin at screen 0.55
  set title PANEL[p] offset 0, -0.6
  unset logscale x
  set xrange [-0.4:3.4]
  set yrange [0.3:10]
  set xtics 0, 1, 3
  set xlabel "delay n, ticks of 1 ms"
  plot ARG1 using (mine(1, p, of_delay(column("delay_ticks"))) - 0.3):(column("bound_n_per_mm")):(0.6):(0) with vectors nohead lw 2 lc rgb "black" notitle, \
       for [m = 7:1:-1] ARG1 using (mine(m, p, of_delay(column("delay_ticks"))) + 0.07 * (m - 4)):(column("onset_n_per_mm")) \
         with points pt 7 ps 0.9 lc rgb TINTS[m] notitle

  set tmargin at screen 0.46
  set bmargin at screen 0.14
  unset title
  set logscale x 2
  set xrange [380:10500]
  set yrange [0.3:40]
  set xtics ("500" 500, "1000" 1000, "2000" 2000, "4000" 4000, "8000" 8000)
  set xlabel "rate, Hz; a force one tick late"
  plot ARG1 using (mine(1, p, of_rate(column("rate_hz"))) * 0.85):(column("bound_n_per_mm")):(0.3 * column("rate_hz")):(0) with vectors nohead lw 2 lc rgb "black" notitle, \
       ARG1 using (mine(1, p, of_rate(column("rate_hz"))) * 0.85):(column("choi_tan_n_per_mm")):(0.3 * column("rate_hz")):(0) with vectors nohead lw 2 dt 2 lc rgb "black" notitle, \
       for [m = 7:1:-1] ARG1 using (mine(m, p, of_rate(column("rate_hz"))) * (1 + 0.04 * (m - 4))):(column("onset_n_per_mm")) \
         with points pt 7 ps 0.9 lc rgb TINTS[m] notitle
}
unset multiplot
