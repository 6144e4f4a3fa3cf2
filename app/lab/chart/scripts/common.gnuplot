# SPDX-License-Identifier: Apache-2.0
# What every chart begins with. ARG1: the CSV; ARG2: the title; ARG3: the reading's first two lines.
set datafile separator ","
set datafile columnheaders
set encoding utf8
set grid lc rgb "#d8dbe0"
set border lc rgb "black"
set macros
# The foot of the picture; chart.cpp goes on below.
READING = "screen 0.5, 0 center noenhanced offset 0, 1.5"
# SEE_METHODS: METHODS are those of which the table has rows, M of them, each with its COLOUR.
ALL_METHODS = "relievo god-object god-object-smoothed bullet bullet-smoothed modified-proxy-graph proxy-graph proxy-blend penalty"
ALL_COLOURS = "#d81b60 #1e88e5 #00897b #6d4c41 #c2a878 #e08e0b #7cb342 #8e5cc2 #8a8f98"
METHODS = ""
COLOUR = ""
SEEN = "|"
see(name) = strstrt(SEEN, "|" . name . "|") ? 0 : (SEEN = SEEN . name . "|", 1)
seen(name) = strstrt(SEEN, "|" . name . "|") > 0
SEE_METHODS = "stats ARG1 using (see(strcol('method'))) nooutput; \
  do for [i = 1:words(ALL_METHODS)] { METHODS = METHODS . (seen(word(ALL_METHODS, i)) ? ' ' . word(ALL_METHODS, i) : ''); \
    COLOUR = COLOUR . (seen(word(ALL_METHODS, i)) ? ' ' . word(ALL_COLOURS, i) : '') }; M = words(METHODS)"
DEPTHS = '"16-bit" "8-bit" "H.264 crf 23" "noise 1 %"'
array SYMBOL[4] = [7, 5, 9, 13]
# Where contact was lost there is no force whose error could be told: a white spot on the mark.
lost(value) = column("contact_lost") == 1 ? value : NaN
LOST = "hollow: contact lost"
# A value where a cell of the row is the wanted text.
where(name, text, value) = (strcol(name) eq text) ? value : NaN
# An empty plot over the whole width that holds the legend of several panels: macros around its key entries.
LEGEND = "set lmargin at screen 0.02; set rmargin at screen 0.98; set tmargin at screen 0.9; set bmargin at screen 0.5; \
  unset border; unset tics; unset xlabel; unset ylabel; set xrange [0:1]; set yrange [0:1]; \
  set key at screen 0.5, LEGEND_Y center top horizontal maxrows 2 Left reverse noenhanced samplen 1.2 width 1"
END_LEGEND = "unset key; unset label 1; set border; set tics; set autoscale"
# The curves of the smoothness charts, those that are drawn first lie below; the frames ahead that each looks. A script
# keeps those that have contact anywhere: CURVE[1 .. CURVE_COUNT].
ALL_CURVES = '"relievo hold" "modified hold" "god-object hold" "proxy-blend" "proxy-graph" "modified-proxy-graph" "god-object" "god-object-smoothed" "relievo linear" "relievo bspline" "relievo fitted" "relievo"'
ALL_TINTS = "#8a8f98 #c2a878 #90caf9 #8e5cc2 #7cb342 #e08e0b #1e88e5 #00897b #f48fb1 #26c6da #5d4db3 #d81b60"
ALL_AHEAD = '"" "" "" "" "" ", 1 ahead" ", 1 ahead" ", 1 ahead" ", 1 ahead" ", 2 ahead" ", 3 ahead" ", by plan"'
array CURVE[12]
array TINT[12]
array AHEAD[12]
CURVE_COUNT = 0
keep(c) = (CURVE_COUNT = CURVE_COUNT + 1, CURVE[CURVE_COUNT] = word(ALL_CURVES, c), TINT[CURVE_COUNT] = word(ALL_TINTS, c), AHEAD[CURVE_COUNT] = word(ALL_AHEAD, c), 1)
