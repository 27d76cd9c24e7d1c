# Run-outs of columns against their aspect ratio (see README.md, "Row 4"): gnuplot scaling.gp makes scaling.svg from results.csv and grains.csv.
set terminal svg size 800,480 font "sans,13"
set output "scaling.svg"
set datafile separator ","
set key top left
set logscale x
set xrange [0.17:7]
set xtics (0.19, 0.55, 0.9, 1.2, 1.6, 2, 3, 4, 6)
set xlabel "aspect ratio a"
set ylabel "run-out over min(1.24 a, 1.6 √a), %"
set yrange [-12:45]
set grid

low(a) = 1.24*a
high(a) = 1.6*sqrt(a)
fit(a) = a < 1.665 ? low(a) : high(a)
rounded(a, n) = (low(a)**-n + high(a)**-n)**(-1./n)
over(a, x) = 100*(x/fit(a) - 1)
# Runs of results.csv at half the spacing, means of ensembles: STEM alone is row 1 to 6, finetall... are columns of other heights.
half(names) = sprintf("< awk -F, '$2 == \"axisymmetric\" && $3 ~ /^(%s)(\\.s[0-9]+)?$/ {s[$4] += $10; ++n[$4]} END {for (a in n) print a \",\" s[a]/n[a]}' results.csv | sort -t, -g", names)
plot 0 lc "gray40" title "experiments, two lines (Lube et al. 2004)", \
     over(x, rounded(x, 7)) lc "gray40" dt 2 title "the same lines, corner rounded", \
     half("fine|finetall[0-9.]*") using 1:(over($1, $2)) with linespoints pt 7 lc "#1f77b4" title "drucker\\_prager", \
     half("finelade") using 1:(over($1, $2)) with linespoints pt 9 lc "#2ca02c" title "lade\\_duncan", \
     half("finetriaxial") using 1:(over($1, $2)) with linespoints pt 11 lc "#9467bd" title "triaxial\\_ratio 1.13", \
     half("finecone|finetall[0-9.]*n") using 1:(over($1, $2)) with linespoints pt 5 lc "#d62728" title "matsuoka\\_nakai", \
     "< grep ,grains, grains.csv | sort -t, -g" using 1:(over($1, $7)) with linespoints pt 13 lc "black" title "grains, r0 = 8 d"
