# SPDX-License-Identifier: Apache-2.0
# gnuplot -c force.gnuplot finger.csv force.svg: what the finger felt over time, from a recorded session.
set terminal svg size 1000,620 dynamic font "sans-serif,14" background "white"
set output ARG2
set datafile separator ","
set key above right  # beside no curve
set grid lc rgb "#dddddd"
set autoscale xfix
set multiplot layout 2,1 title "Force on the finger, and where it was" font ",16"
set lmargin 9
set ylabel "force, N"
set yrange [0:*]
plot ARG1 using "t_s":(sqrt(column("force_x_n")**2 + column("force_y_n")**2 + column("force_z_n")**2)) \
     with lines lw 1.5 lc rgb "#c0392b" title "magnitude", \
     ARG1 using "t_s":(abs(column("force_z_n"))) with lines lw 1 lc rgb "#2c3e50" title "along z, towards the viewer"
set ylabel "height, mm"
set yrange [*:*]
set xlabel "time of the film, s"
plot ARG1 using "t_s":"proxy_z_mm" with lines lw 1.5 lc rgb "#27ae60" title "proxy: on the surface", \
     ARG1 using "t_s":"hip_z_mm" with lines lw 1 lc rgb "#8e44ad" title "finger"
unset multiplot
