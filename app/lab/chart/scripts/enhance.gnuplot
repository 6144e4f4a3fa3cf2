# SPDX-License-Identifier: Apache-2.0
set terminal svg size 1000,1360 dynamic enhanced font "sans-serif,13" background "#ffffff"
set multiplot title ARG2 noenhanced font ",16"
set label 1 ARG3 at @READING
KINDS = "none median dibm space-time"
FELT = "modified-proxy-graph god-object god-object-smoothed relievo"
array TINTS[4] = ["#8a8f98", "#e08e0b", "#1e88e5", "#d81b60"]
array BITS[2] = ["8", "16"]
array DASH[2] = [1, 2]
array SHAPE[2] = [7, 6]
LEGEND_Y = 0.968
@LEGEND
plot NaN notitle, for [k = 1:4] keyentry with lines lw 2.5 lc rgb TINTS[k] title word(KINDS, k), \
     for [b = 1:2] keyentry with linespoints pt SHAPE[b] dt DASH[b] lc rgb "black" title (b == 1 ? "coded with 8 bits" : "as enhanced, 16 bits"), \
     keyentry with points pt 7 ps 0.35 lc rgb "black" title "inside a mark: contact lost"
@END_LEGEND

array WHAT[2] = ["noise alone", "with salt, holes and flying pixels"]
set datafile missing NaN
set xrange [0.7:4.3]
set xtics 1
of(figure, faults, k, value) = (strcol("figure") eq figure && column("faults") == faults && strcol("enhancement") eq word(KINDS, k)) ? value : NaN
felt(m, b, value) = (strcol("method") eq word(FELT, m) && strcol("bits") eq BITS[b]) ? value : NaN
do for [row = 1:5] {
  do for [f = 0:1] {
    set lmargin at screen 0.075 + 0.49 * f
    set rmargin at screen 0.075 + 0.49 * f + 0.41
    set tmargin at screen 0.905 - 0.168 * (row - 1)
    set bmargin at screen 0.905 - 0.168 * (row - 1) - 0.122
    if (row < 5) {
      set logscale y; set format y "%g"; set yrange [0.8:500]
      set title "felt by " . word(FELT, row) . ", " . WHAT[f + 1] noenhanced offset 0, -0.6
      set ylabel (f ? "" : "force error rms, %") offset 1
      unset xlabel
      plot for [k = 1:4] for [b = 1:2] ARG1 using (column("noise_levels")):(felt(row, b, of("force", f, k, column("force_rms_percent")))) \
             with linespoints pt SHAPE[b] ps 0.8 dt DASH[b] lw 1.8 lc rgb TINTS[k] notitle, \
           for [k = 1:4] for [b = 1:2] ARG1 using (column("noise_levels")):(lost(felt(row, b, of("force", f, k, column("force_rms_percent"))))) \
             with points pt 7 ps 0.35 lc rgb "black" notitle
    } else {
      unset logscale y; set format y "%g"; set yrange [-0.2:11]
      set title "edges, " . WHAT[f + 1] offset 0, -0.6
      set ylabel (f ? "" : "off by, px: mean and most") offset 1
      set xlabel "noise, levels of 255" offset 0, 0.5
      plot for [k = 1:4] ARG1 using (column("noise_levels") + 0.06 * (k - 2.5)):(of("edge", f, k, column("edge_mean_px"))):(of("edge", f, k, column("edge_mean_px"))):(of("edge", f, k, column("edge_most_px"))) \
             with yerrorbars pt 7 ps 0.8 lw 1.8 lc rgb TINTS[k] notitle
    }
    unset label 1
  }
}
unset multiplot
