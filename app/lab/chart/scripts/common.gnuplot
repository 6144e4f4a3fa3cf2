# SPDX-License-Identifier: Apache-2.0
# What every chart begins with. ARG1: the CSV; ARG2: the title; ARG3: the reading, a few lines.
set datafile separator ","
set datafile columnheaders
set encoding utf8
set grid lc rgb "#d8dbe0"
set border lc rgb "black"
METHODS = "relievo god-object modified-proxy-graph proxy-graph proxy-blend penalty"
DEPTHS = '"16-bit" "8-bit" "H.264 crf 23" "noise 1 %"'
array COLOUR[6] = ["#d81b60", "#1e88e5", "#e08e0b", "#7cb342", "#8e5cc2", "#8a8f98"]
array SYMBOL[4] = [7, 5, 9, 13]
# Where contact was lost there is no force whose error could be told: a white spot on the mark.
lost(value) = column("contact_lost") == 1 ? value : NaN
LOST = "hollow: contact lost"
# A value where a cell of the row is the wanted text.
where(name, text, value) = (strcol(name) eq text) ? value : NaN
# An empty plot over the whole width that holds the legend of several panels: macros around its key entries.
set macros
LEGEND = "set lmargin at screen 0.02; set rmargin at screen 0.98; set tmargin at screen 0.9; set bmargin at screen 0.5; \
  unset border; unset tics; unset xlabel; unset ylabel; set xrange [0:1]; set yrange [0:1]; \
  set key at screen 0.5, LEGEND_Y center top horizontal maxrows 2 Left reverse noenhanced samplen 1.2 width 1"
END_LEGEND = "unset key; unset label 1; set border; set tics; set autoscale"
# The curves of the smoothness charts, those that are drawn first lie below; the frames ahead that each looks.
CURVES = '"relievo hold" "modified hold" "proxy-blend" "proxy-graph" "modified-proxy-graph" "relievo linear" "relievo bspline" "relievo fitted" "relievo"'
CURVE_COUNT = 9
array TINT[9] = ["#8a8f98", "#c2a878", "#8e5cc2", "#7cb342", "#e08e0b", "#1e88e5", "#26a69a", "#5d4db3", "#d81b60"]
array AHEAD[9] = ["", "", "", "", ", 1 ahead", ", 1 ahead", ", 2 ahead", ", 3 ahead", ", by plan"]
