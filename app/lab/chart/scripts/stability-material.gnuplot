# SPDX-License-Identifier: Apache-2.0
set terminal svg size 1240,520 dynamic enhanced font "sans-serif,13" background "#ffffff"
set title ARG2 noenhanced font ",16" offset -4, 0.3
set label 1 ARG3 at @READING
NAMES = "plain friction softer stiffer texture"
# The rows of a scenario stand together, in the order of the names.
ROWS = words(NAMES)
x(i) = int(i) / ROWS
y(i) = ROWS - 1 - int(i) % ROWS
stats ARG1 using (column("pass")) nooutput
SCENARIOS = int(STATS_records) / ROWS
unset grid
set xrange [-0.5 : SCENARIOS - 0.5]
set yrange [-0.5 : ROWS - 0.5]
set xtics rotate by 35 right noenhanced scale 0
set ytics scale 0
do for [m = 1:ROWS] { set ytics add (word(NAMES, m) ROWS - m) }
set ytics noenhanced
set border 0
set lmargin at screen 0.07
set rmargin at screen 0.99
set tmargin at screen 0.89
set bmargin at screen 0.27
unset key
set style fill solid border lc rgb "#ffffff"
size(v) = abs(v) < 0.0005 ? "0" : abs(v) < 0.00995 ? sprintf("%.1g", v) : abs(v) < 0.995 ? sprintf("%.2g", v) : abs(v) < 9.95 ? sprintf("%.1f", v) : sprintf("%.0f", v)
# A cell says it by its colour, by its mark and, where it failed, by a heavy border: 2 passed, 1 failed by no more than
# the material itself does, 0 failed.
verdict(i) = 2 * int(column("pass")) + int(column("explained"))
cell(i, wanted) = verdict(i) == wanted ? x(i) : NaN
mark(i) = verdict(i) == 2 ? "✓" : verdict(i) == 1 ? "(✓)" : "✗"
held(i) = verdict(i) == 1 ? sprintf("%s %.0f", int(column("theory_at_most")) == 1 ? "≤" : "≥", column("theory")) : ""
plot ARG1 using (cell($0, 2)):(y($0)):(0.47):(0.45) with boxxyerror lc rgb "#cfe6f5", \
     ARG1 using (cell($0, 1)):(y($0)):(0.47):(0.45) with boxxyerror lc rgb "#f7edc4", \
     ARG1 using (cell($0, 0)):(y($0)):(0.47):(0.45) with boxxyerror lc rgb "#f6c8b0", \
     ARG1 using (cell($0, 0)):(y($0)):(0.47):(0.45) with boxxyerror lc rgb "#a33000" lw 2 fs empty border, \
     ARG1 using (x($0)):(y($0) + 0.27):(mark($0)) with labels font ",15" tc rgb "#1c2024", \
     ARG1 using (x($0)):(y($0) + 0.02):(size(column("figure"))) with labels font ",12" tc rgb "#1c2024", \
     ARG1 using (x($0)):(y($0) - 0.16):(strcol("unit")) with labels font ",10" tc rgb "#1c2024" noenhanced, \
     ARG1 using (x($0)):(y($0) - 0.33):(held($0)) with labels font ",10" tc rgb "#1c2024" noenhanced, \
     ARG1 using (x($0)):(NaN):xtic(strcol("scenario")) with dots
