# SPDX-License-Identifier: Apache-2.0
set terminal svg size 1240,420 dynamic enhanced font "sans-serif,13" background "#ffffff"
set title ARG2 noenhanced font ",16" offset -4, 0.3
set label 1 ARG3 at @READING
NAMES = "0.25 0.5 1 2 4 8 off"
ROWS = words(NAMES)
x(i) = int(i) / ROWS
y(i) = ROWS - 1 - int(i) % ROWS
stats ARG1 using (column("pass")) nooutput
unset grid
set border 0
set xrange [-0.5 : STATS_records / ROWS - 0.5]
set yrange [-0.5 : ROWS - 0.5]
set xtics rotate by 35 right noenhanced scale 0
set ytics scale 0
do for [m = 1:ROWS] { set ytics add (word(NAMES, m) . (m < ROWS ? " N" : "") ROWS - m) }
set ylabel "threshold" offset 1
set lmargin at screen 0.08
set rmargin at screen 0.99
set tmargin at screen 0.87
set bmargin at screen 0.33
unset key
set style fill solid border lc rgb "#ffffff"
cell(i, wanted) = int(column("pass")) == wanted ? x(i) : NaN
plot ARG1 using (cell($0, 1)):(y($0)):(0.47):(0.45) with boxxyerror lc rgb "#cfe6f5", \
     ARG1 using (cell($0, 0)):(y($0)):(0.47):(0.45) with boxxyerror lc rgb "#f6c8b0", \
     ARG1 using (x($0)):(y($0)):(int(column("pass")) == 1 ? "✓" : "✗") with labels font ",15" tc rgb "#1c2024", \
     ARG1 using (x($0)):(NaN):xtic(strcol("scenario")) with dots
