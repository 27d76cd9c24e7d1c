# From figures/compared.csv of a report on two runs of the grains and a layer, by time: L1 differences of the masses per
# area over the mass, x below which 50, 90 and 99 % of each lie, and the largest x where each is thicker than one grain.
BEGIN { FS = ","; runs = 3; split("1 2 layer", name, " ") }
NR == 1 {
  printf "t,l1_1,l1_2,l1_between_seeds"
  for (q = 1; q <= 4; ++q) for (r = 1; r <= runs; ++r) printf ",%s_%s", q < 4 ? "x" (q == 1 ? 50 : q == 2 ? 90 : 99) : "front", name[r]
  printf "\n"
  next
}
$1 != t || NR == 2 { finish(); n = 0; t = $1 }
{ ++n; x[n] = $2; for (r = 1; r <= runs; ++r) m[r, n] = $(1 + 2 * r) }
END { finish() }

function total(r,   k, s) {
  for (k = 1; k <= n; ++k) s += m[r, k]
  return s
}
function l1(r, q,   k, s) {
  for (k = 1; k <= n; ++k) s += m[r, k] > m[q, k] ? m[r, k] - m[q, k] : m[q, k] - m[r, k]
  return s / total(r)
}
function where(r, share,   k, below, wanted) {
  wanted = share * total(r)
  for (k = 1; k <= n; ++k) {
    if (below + m[r, k] >= wanted) return x[k] + dx * ((wanted - below) / m[r, k] - 0.5)
    below += m[r, k]
  }
}
function front(r,   k) {
  for (k = n - 1; k >= 1; --k)
    if (m[r, k] > 1) return m[r, k] > m[r, k + 1] ? x[k] + dx * (m[r, k] - 1) / (m[r, k] - m[r, k + 1]) : x[k]
}
function finish(   r) {
  if (!n) return
  dx = x[2] - x[1]
  printf "%g,%.3f,%.3f,%.3f", t, l1(1, 3), l1(2, 3), l1(1, 2)
  for (r = 1; r <= runs; ++r) printf ",%.1f", where(r, 0.5)
  for (r = 1; r <= runs; ++r) printf ",%.1f", where(r, 0.9)
  for (r = 1; r <= runs; ++r) printf ",%.1f", where(r, 0.99)
  for (r = 1; r <= runs; ++r) printf ",%.1f", front(r)
  printf "\n"
}
