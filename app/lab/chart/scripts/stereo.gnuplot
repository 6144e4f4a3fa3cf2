# SPDX-License-Identifier: Apache-2.0
set terminal svg size 1000,860 dynamic enhanced font "sans-serif,13" background "#ffffff"
set multiplot title ARG2 noenhanced font ",16"
set label 1 ARG3 at @READING
ALL_WHO = '"author" "SGBM" "BM" "quick 160" "quick 320" "quick 640"'
ALL_TINTS = "#d81b60 #1e88e5 #8a8f98 #c2a878 #e08e0b #7cb342"
stats ARG1 using (see(strcol("matcher"))) nooutput
WHO = ""
TINTS = ""
do for [w = 1:words(ALL_WHO)] {
  if (seen(word(ALL_WHO, w))) { WHO = WHO . ' "' . word(ALL_WHO, w) . '"'; TINTS = TINTS . " " . word(ALL_TINTS, w) }
}
M = words(WHO)
AXES = "size baseline codec texture"
array WHAT[4] = ["columns of a view", "disparity, far to near", "codec", "texture"]
array SHAPE[3] = [7, 5, 9]
array SIGN[3] = ["\U+25CF", "\U+25A0", "\U+25B2"]
LEGEND_Y = 0.95
@LEGEND
plot NaN notitle, for [w = 1:M] keyentry with lines lw 2.5 lc rgb word(TINTS, w) title word(WHO, w), \
     keyentry with points pt 6 ps 2 lw 1.6 lc rgb "#d81b60" title "the author's", \
     keyentry with points pt 8 ps 2 lw 1.6 lc rgb "black" title "the player's on this machine"
@END_LEGEND
set datafile missing NaN
set logscale xy
set format "%g"
set key off
stats ARG1 using (strcol("matcher") eq "exact" ? NaN : column("force_rms_percent")) name "ALL" nooutput
stats ARG1 using (strcol("matcher") eq "exact" ? NaN : column("cpu_ms")) name "MS" nooutput
set yrange [ALL_min / 1.4 : ALL_max * 1.4]
set xrange [MS_min / 1.6 : MS_max * 1.6]
of(a, w, v) = strcol("axis") eq word(AXES, a) && strcol("matcher") eq word(WHO, w) ? v : NaN
marked(a, m, v) = strcol("axis") eq word(AXES, a) && strcol("marked") eq m ? v : NaN
do for [a = 1:4] {
  COL = (a - 1) % 2
  ROW = (a - 1) / 2
  set lmargin at screen 0.075 + 0.49 * COL
  set rmargin at screen 0.075 + 0.49 * COL + 0.41
  set tmargin at screen 0.84 - 0.39 * ROW
  set bmargin at screen 0.84 - 0.39 * ROW - 0.28
  VALUES = ""
  stats ARG1 using (strcol("axis") eq word(AXES, a) && !strstrt(VALUES, '"'.strcol("value").'"') ? (VALUES = VALUES . ' "' . strcol("value") . '"', 0) : 0) nooutput
  TITLE = WHAT[a] . ": "
  do for [v = 1:words(VALUES)] { TITLE = TITLE . "  " . SIGN[v] . " " . word(VALUES, v) }
  set title TITLE offset 0, -0.6
  set xlabel (ROW == 1 ? "processor's time a picture, ms" : "")
  set ylabel (COL ? "" : "force error rms, %") offset 1
  plot for [w = 1:M] ARG1 using (of(a, w, column("cpu_ms"))):(column("force_rms_percent")) with lines lw 1.5 lc rgb word(TINTS, w) notitle, \
       for [w = 1:M] for [v = 1:words(VALUES)] ARG1 using (of(a, w, where("value", word(VALUES, v), column("cpu_ms")))):(column("force_rms_percent")) \
         with points pt SHAPE[v] ps 0.9 lc rgb word(TINTS, w) notitle, \
       ARG1 using (marked(a, "author", column("cpu_ms"))):(column("force_rms_percent")) with points pt 6 ps 2 lw 1.6 lc rgb "#d81b60" notitle, \
       ARG1 using (marked(a, "player", column("cpu_ms"))):(column("force_rms_percent")) with points pt 8 ps 2 lw 1.6 lc rgb "black" notitle
  unset label 1
}
unset multiplot
