# SPDX-License-Identifier: Apache-2.0
set terminal svg size 1000,740 dynamic enhanced font "sans-serif,13" background "#ffffff"
set multiplot title ARG2 noenhanced font ",16"
set label 1 ARG3 at @READING
KINDS = '"H.264 8 even" "H.264 10 even" "HEVC 8 even" "HEVC 10 even" "HEVC 12 even" "FFV1" "H.264 8 dithered" "H.264 8 disparity" "H.264 8 hue" "H.264 8 hue-disparity" "H.264 8 turbo"'
NAMES = '"H.264 8 bits" "H.264 10 bits" "HEVC 8 bits" "HEVC 10 bits" "HEVC 12 bits" "FFV1 8 to 16 bits" "8 bits dithered" "8 bits by disparity" "hue 4:2:0" "hue of disparity 4:2:0" "turbo 4:2:0"'
array TINTS[11] = ["#d81b60", "#e08e0b", "#26c6da", "#7986cb", "#5d4db3", "#8a8f98", "#7cb342", "#c2a878", "#d84315", "#ab47bc", "#00acc1"]
kind(dummy) = strcol("codec") eq "FFV1" ? "FFV1" : strcol("codec") . " " . strcol("bits") . " " . strcol("steps")
stats ARG1 using (see(kind(0))) nooutput
PRESENT = ""
do for [k = 1:11] { PRESENT = PRESENT . (seen(word(KINDS, k)) ? " " . k : "") }
# What others make of the films of H.264 in 8 bits.
OTHERS = "god-object god-object-smoothed"
FIGURES = "god_object_rms_percent god_object_smoothed_rms_percent"
array OTHER_TINTS[2] = ["#1e88e5", "#00897b"]
LEGEND_Y = 0.935
@LEGEND
plot NaN notitle, for [i = 1:words(PRESENT)] keyentry with linespoints pt 7 ps 1 lw 1.5 lc rgb TINTS[int(word(PRESENT, i))] title word(NAMES, int(word(PRESENT, i))), \
     for [o = 1:2] keyentry with lines lw 1.5 dt 2 lc rgb OTHER_TINTS[o] title "felt by " . word(OTHERS, o), \
     keyentry with points pt 6 ps 2 lw 2 lc rgb "black" title "the author's default"
@END_LEGEND
mine(k, value) = kind(0) eq word(KINDS, k) && (k == 6 || column("crf") > 0) ? value : NaN
lossless(k, value) = kind(0) eq word(KINDS, k) && k != 6 && column("crf") == 0 ? value : NaN
array SHOWN[3] = [1, 7, 8]
set logscale xy
set format xy "%g"
set tmargin at screen 0.75
set bmargin at screen 0.2
set xlabel "depth, kbit/s"
array TITLE[2] = ["Codecs and bits", "Where the steps of 8 bits lie, H.264"]
array FROM[2] = [1, 7]
array TO[2] = [6, 11]
stats ARG1 using (column("force_rms_percent")) name "Y" nooutput
stats ARG1 using (column("god_object_rms_percent")) name "WORST" nooutput
stats ARG1 using (column("kbit_s")) name "X" nooutput
set yrange [Y_min * 0.8 : (Y_max > WORST_max ? Y_max : WORST_max) * 1.3]
set xrange [X_min * 0.6 : X_max * 1.7]
do for [p = 1:2] {
  set lmargin at screen 0.08 + 0.48 * (p - 1)
  set rmargin at screen 0.08 + 0.48 * (p - 1) + 0.42
  set title TITLE[p] offset 0, -0.6
  set ylabel (p == 1 ? "force error against the oracle, %" : "")
  plot for [k = FROM[p]:TO[p]] ARG1 using (mine(k, column("kbit_s"))):(column("force_rms_percent")) \
         with linespoints pt 7 ps 0.7 lw 1.5 lc rgb TINTS[k] notitle, \
       for [o = 1:2] ARG1 using (p == 1 ? mine(1, column("kbit_s")) : NaN):(column(word(FIGURES, o))) \
         with lines lw 1.5 dt 2 lc rgb OTHER_TINTS[o] notitle, \
       ARG1 using (p == 2 ? mine(1, column("kbit_s")) : NaN):(column("force_rms_percent")) \
         with linespoints pt 7 ps 0.7 lw 1.5 lc rgb TINTS[1] notitle, \
       for [i = 1:3] ARG1 using (p == 2 ? lossless(SHOWN[i], column("kbit_s")) : NaN):(column("force_rms_percent")):("lossless") \
         with labels point pt 5 ps 1 lc rgb TINTS[SHOWN[i]] font ",10" tc rgb TINTS[SHOWN[i]] offset 0, 0.9 noenhanced notitle, \
       ARG1 using (p == 1 ? mine(1, column("kbit_s")) : NaN):(column("force_rms_percent")):("crf " . strcol("crf")) \
         with labels font ",10" tc rgb TINTS[1] offset 0, 0.8 noenhanced notitle, \
       ARG1 using (column("default") == 1 ? column("kbit_s") : NaN):(column("force_rms_percent")) \
         with points pt 6 ps 2 lw 2 lc rgb "black" notitle
  unset label 1
}
unset multiplot
