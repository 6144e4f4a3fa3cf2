# SPDX-License-Identifier: Apache-2.0
set terminal svg size 1000,660 dynamic enhanced font "sans-serif,13" background "#ffffff"
set title ARG2 noenhanced font ",16"
set label 1 ARG3 at screen 0.5, 0.065 center noenhanced
set bmargin 8
set rmargin 28
set key outside right top vertical Left reverse noenhanced samplen 1
set logscale xy
set format xy "%g"
set xlabel "time of a tick, position to force, µs: median, with a bar to p99.9"
set ylabel "error of the force vector, rms over all scenes, % of the force"
stats ARG1 using (strcol("scene") eq "all" ? column("update_median_us") : NaN):(column("force_rms_percent")) name "LOW" nooutput
stats ARG1 using (strcol("scene") eq "all" ? column("update_p999_us") : NaN):(column("force_rms_percent")) name "HIGH" nooutput
set xrange [LOW_min_x * 0.7 : HIGH_max_x * 1.4]
set yrange [LOW_min_y * 0.6 : LOW_max_y * 1.7]
mine(m, d, value) = (strcol("scene") eq "all" && strcol("method") eq word(METHODS, m)) ? where("depth", word(DEPTHS, d), value) : NaN
plot for [m = 6:1:-1] for [d = 1:4] ARG1 \
       using (mine(m, d, column("update_median_us"))):(column("force_rms_percent")):(column("update_median_us")):(column("update_p999_us")) \
       with xerrorbars pt SYMBOL[d] ps 1.1 lw 1.2 lc rgb COLOUR[m] notitle, \
     for [m = 6:1:-1] for [d = 1:4] ARG1 using (lost(mine(m, d, column("update_median_us")))):(column("force_rms_percent")) \
       with points pt SYMBOL[d] ps 0.7 lc rgb "#ffffff" notitle, \
     for [m = 1:6] keyentry with points pt 7 ps 1.3 lc rgb COLOUR[m] title word(METHODS, m), \
     keyentry with lines lt nodraw title " ", \
     for [d = 1:4] keyentry with points pt SYMBOL[d] ps 1.3 lc rgb "black" title word(DEPTHS, d), \
     keyentry with points pt 6 lw 2 ps 1.2 lc rgb "black" title LOST
