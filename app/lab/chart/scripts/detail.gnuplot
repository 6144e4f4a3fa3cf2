# SPDX-License-Identifier: Apache-2.0
set terminal svg size 1000,1060 dynamic enhanced font "sans-serif,13" background "#ffffff"
set multiplot title ARG2 noenhanced font ",16"
set label 1 ARG3 at @READING
MODELS = "network grid"
KINDS = '"8-bit" "H.264 crf 23"'
array TINTS[2] = ["#d81b60", "#1e88e5"]
array SHAPE[2] = [7, 6]
array DASH[2] = [1, 2]
RIVALS = "god-object god-object-smoothed"
RIVAL_COLUMNS = "god_object_rms_percent god_object_smoothed_rms_percent"
array RIVAL_SHAPE[2] = [5, 9]
K = 1  # a quick run has no coded depth
stats ARG1 using (K = strcol("depth") eq word(KINDS, 2) ? 2 : K) nooutput
LEGEND_Y = 0.96
@LEGEND
plot NaN notitle, \
     for [m = 1:2] for [k = 1:K] keyentry with linespoints pt SHAPE[k] ps 1.1 dt DASH[k] lw 1.5 lc rgb TINTS[m] title word(MODELS, m) . ", " . word(KINDS, k), \
     for [r = 1:2] keyentry with linespoints pt RIVAL_SHAPE[r] ps 0.9 dt 3 lw 1 lc rgb "#757575" title word(RIVALS, r) . ", 8-bit", \
     keyentry with points pt 6 ps 2.6 lw 2 lc rgb "black" title "the player's level"
@END_LEGEND

ROWS = "truth_psnr_db away_psnr_db force_rms_percent"
array TITLE[3] = ["Whole picture, against what the eyes would see", "Away from silhouettes, against the full mesh", "A finger on these triangles"]
set logscale x
set format x "%g"
# A network's fine levels stand close together: of them the finest alone is named, above its mark. To the finger the
# coarsest are the same.
coarse(row) = column("error_px") < 0.5 ? "" : row < 3 || column("error_px") < 2 ? strcol("error_px") . " px" : \
  column("error_px") == 2 ? "2, 4 px" : ""
finest(row) = column("error_px") == 0.125 ? "0.125 px" : ""
mine(m, k, value) = (strcol("model") eq word(MODELS, m) && strcol("depth") eq word(KINDS, k)) ? value : NaN
do for [p = 0:5] {
  row = p / 2 + 1
  value = word(ROWS, row)
  abscissa = p % 2 ? "frame_ms" : row < 3 ? "triangles" : "touch_triangles"
  set autoscale
  stats ARG1 using (column(abscissa)) name "X" nooutput
  set xrange [X_min * (p == 4 ? 0.35 : 0.55) : X_max * 1.6]
  set offsets 0, 0, graph 0.12, graph 0.06
  if (row == 3) { set logscale y; set format y "%g"; set yrange [0.6:60]; unset offsets }
  set lmargin at screen 0.075 + 0.48 * (p % 2)
  set rmargin at screen 0.075 + 0.48 * (p % 2) + 0.435
  set tmargin at screen 0.88 - 0.265 * (row - 1)
  set bmargin at screen 0.88 - 0.265 * (row - 1) - 0.19
  set title TITLE[row] offset 0, -0.6
  set ylabel (p % 2 ? "" : row < 3 ? "PSNR, dB" : "force error, %") offset 1
  set xlabel (p % 2 ? "time of a frame, ms" : row < 3 ? "triangles" : "triangles of the face that is felt") offset 0, 0.5
  plot for [m = 1:2] for [k = 1:K] ARG1 using (mine(m, k, column(abscissa))):(column(value)) \
         with linespoints pt SHAPE[k] ps 0.8 dt DASH[k] lw 1.5 lc rgb TINTS[m] notitle, \
       for [m = 1:2] for [r = 1:(row == 3 ? 2 : 0)] ARG1 using (mine(m, 1, column(abscissa))):(column(word(RIVAL_COLUMNS, r))) \
         with linespoints pt RIVAL_SHAPE[r] ps 0.6 dt 3 lw 1 lc rgb TINTS[m] notitle, \
       ARG1 using (mine(1, 1, column(abscissa))):(column(value)):(coarse(row)) \
         with labels right font ",10" tc rgb TINTS[1] offset -1.4, -0.1 noenhanced notitle, \
       ARG1 using (mine(1, 1, column(abscissa))):(column(value)):(finest(row)) \
         with labels font ",10" tc rgb TINTS[1] offset 0, 0.8 noenhanced notitle, \
       ARG1 using (mine(2, 1, column(abscissa))):(column(value)):("1:" . strcol("grid_step")) \
         with labels font ",10" tc rgb TINTS[2] offset 0, 0.8 noenhanced notitle, \
       for [k = 1:K] ARG1 using (column("players") == 1 ? mine(1, k, column(abscissa)) : NaN):(column(value)) \
         with points pt 6 ps 2.2 lw 2 lc rgb "black" notitle
  unset label 1
}
unset multiplot
