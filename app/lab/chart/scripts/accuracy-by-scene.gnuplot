# SPDX-License-Identifier: Apache-2.0
set terminal svg size 1000,900 dynamic enhanced font "sans-serif,13" background "#ffffff"
set multiplot title ARG2 noenhanced font ",16"
set label 1 ARG3 at @READING
@SEE_METHODS
LEGEND_Y = 0.955
@LEGEND
plot NaN notitle, for [m = 1:M] keyentry with points pt 7 ps 1.2 lc rgb word(COLOUR, m) title word(METHODS, m), \
     keyentry with points pt 6 lw 2 ps 1.1 lc rgb "black" title LOST
@END_LEGEND

set logscale y
set format y "%g"
set xtics rotate by -35 noenhanced
left(d) = 0.075 + 0.49 * ((d - 1) % 2)
top(d) = 0.85 - 0.405 * ((d - 1) / 2)
# The rows of a kind of depth and a method stand one after the other, a row per scene.
mine(m, d, value) = (strcol("method") eq word(METHODS, m)) ? where("depth", word(DEPTHS, d), value) : NaN
stats ARG1 using (strcol("method") eq "relievo" && strcol("depth") eq "8-bit" ? 1 : NaN) nooutput
SCENES = int(STATS_records)
set xrange [-0.5 : SCENES - 0.5]
set yrange [0.003:1000]
do for [d = 1:4] {
  set lmargin at screen left(d)
  set rmargin at screen left(d) + 0.41
  set tmargin at screen top(d)
  set bmargin at screen top(d) - 0.28
  set title word(DEPTHS, d) noenhanced offset 0, -0.6
  set ylabel (d % 2 ? "force error rms, %" : "") offset 1
  plot for [m = M:1:-1] ARG1 using (int(column(0)) % SCENES + 0.08 * (m - 0.5 * (M + 1))):(mine(m, d, column("force_rms_percent"))) \
         with points pt 7 ps 0.7 lc rgb word(COLOUR, m), \
       for [m = M:1:-1] ARG1 using (int(column(0)) % SCENES + 0.08 * (m - 0.5 * (M + 1))):(lost(mine(m, d, column("force_rms_percent")))) \
         with points pt 7 ps 0.35 lc rgb "#ffffff", \
       ARG1 using (int(column(0)) % SCENES):(NaN):xtic(strcol("scene")) with dots
}
unset multiplot
