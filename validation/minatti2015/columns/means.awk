# Means of ensembles (FORMULATION.s1, .s2, ... and FORMULATION itself) over the experiments, with the standard error of the mean
# and the range in %: awk -F, -f means.awk results.csv
NR > 1 {
  sub(/\.s[0-9]+$/, "", $3)
  key = sprintf("%-14s %-12s a = %5.3f", $3, $2, $4)
  ++n[key]
  for (k = 10; k <= 11; ++k) {
    over = 100*($k/$14 - 1)
    sum[key, k] += over; squares[key, k] += over*over
    if (n[key] == 1 || over < low[key, k]) low[key, k] = over
    if (n[key] == 1 || over > high[key, k]) high[key, k] = over
  }
}
function show(key, k,   mean, error) {
  mean = sum[key, k]/n[key]
  error = n[key] > 1 ? sqrt((squares[key, k]/n[key] - mean*mean > 0 ? squares[key, k]/n[key] - mean*mean : 0)/(n[key] - 1)) : 0
  return sprintf("%+6.1f +- %.1f (%+.1f to %+.1f)", mean, error, low[key, k], high[key, k])
}
END {
  for (key in n)
    if (n[key] > 1) print key ": " n[key] " runs, connected " show(key, 10) ", layer " show(key, 11) | "sort"
}
