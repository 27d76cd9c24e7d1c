# From figures/compared.csv of a report on grains and a layer, by time: the L1 difference of the masses per area over the
# mass, x below which 50, 90 and 99 % of each lie, and the largest x where each is thicker than about one grain.
BEGIN { FS = "," }
NR == 1 {
  print "t,l1,x50_grains,x50_layer,x90_grains,x90_layer,x99_grains,x99_layer,front_grains,front_layer"
  next
}
$1 != t || NR == 2 { finish(); n = 0; t = $1 }
{ ++n; x[n] = $2; a[n] = $3; b[n] = $5 }
END { finish() }

function total(m,   k, s) {
  for (k = 1; k <= n; ++k) s += m[k]
  return s
}
function where(m, share,   k, below, wanted) {
  wanted = share * total(m)
  for (k = 1; k <= n; ++k) {
    if (below + m[k] >= wanted) return x[k] + dx * ((wanted - below) / m[k] - 0.5)
    below += m[k]
  }
}
function front(m,   k) {
  for (k = n - 1; k >= 1; --k)
    if (m[k] > 1) return m[k] > m[k + 1] ? x[k] + dx * (m[k] - 1) / (m[k] - m[k + 1]) : x[k]
}
function finish(   k, l1) {
  if (!n) return
  dx = x[2] - x[1]
  for (k = 1; k <= n; ++k) l1 += a[k] > b[k] ? a[k] - b[k] : b[k] - a[k]
  printf "%g,%.3f,%.1f,%.1f,%.1f,%.1f,%.1f,%.1f,%.1f,%.1f\n", t, l1 / total(a), where(a, 0.5), where(b, 0.5),
    where(a, 0.9), where(b, 0.9), where(a, 0.99), where(b, 0.99), front(a), front(b)
}
