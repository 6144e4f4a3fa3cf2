# SPDX-License-Identifier: Apache-2.0
set terminal svg size 1000,720 dynamic enhanced font "sans-serif,13" background "#ffffff"
set title ARG2 noenhanced font ",16"
plot ARG1 using (column("triangles")):(column("psnr_away_db")) with points
