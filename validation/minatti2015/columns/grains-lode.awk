# Friction of grains by the Lode angle and the inertial number, from fields.csv of `bagnold cg` (one file an instant; see README.md).
# cos 3 theta of the rate of strain is 1 in triaxial compression, 0 in plane strain, -1 in triaxial extension. Compression is positive.
# mu = |s|/p, |s|^2 = s:s/2, and the part of it along the rate of strain, mu_rate = s:D/(p sqrt(2 D:D)), which dissipates: ratios of sums
# over the nodes of a class, without the shear across the kernel in the kinetic stress. mu_rate_err: from the scatter between instants.
# power_share: of all nodes not left out. Left out: nodes below 2.5 d, those above which there is less than about two grains (phi, p), and what hardly moves.
# Variables: flow (first column), d, rho (of the grains), g, H (height of the column).
BEGIN {
  FS = ","
  split("0.02 0.05 0.08 0.13 0.2 0.35 0.6", edge, " ")
  split("extension,mid-extension,plane,mid-compression,compression", class, ",")
}
FNR == 1 { ++instants; for (i = 1; i <= NF; ++i) at[$i] = i; next }
FNR == 2 || $at["phi"] < 0.45 || $at["z"] < 2.5*d { next }
{
  for (a = 1; a <= 3; ++a)
    for (b = a; b <= 3; ++b) {
      x = substr("xyz", a, 1)
      y = substr("xyz", b, 1)
      D[a, b] = D[b, a] = -($at["grad_u_" x y] + $at["grad_u_" y x])/2
      s[a, b] = s[b, a] = ($at["sigma_" x y] + $at["sigma_" y x])/2 - $at["sigma_shear_" x y]
    }
  p = deviator(s)
  deviator(D)
  rate = 2*norm(D)
  if (p < 1.5*0.56*rho*g*d || rate < 0.3*sqrt(g/H)) next
  power = double_dot(s, D)
  all += power
  I = rate*d/sqrt(p/rho)
  lode = cos3theta(D)
  for (k = 0; k < 7 && I >= edge[k + 1];) ++k
  if (k == 0 || k == 7) next
  c = lode > 0.7 ? 5 : lode > 0.3 ? 4 : lode > -0.3 ? 3 : lode > -0.7 ? 2 : 1
  along = power/rate
  ++nodes[c, k]
  sum_p[c, k] += p
  sum_s[c, k] += norm(s)
  sum_along[c, k] += along
  sum_power[c, k] += power
  sum_I[c, k] += I
  sum_phi[c, k] += $at["phi"]
  sum_lode[c, k] += cos3theta(s)
  p_of[c, k, instants] += p
  along_of[c, k, instants] += along
}
END {
  for (c = 5; c >= 1; --c)
    for (k = 1; k < 7; ++k) {
      if (nodes[c, k] < 10) continue
      n = nodes[c, k]
      mu_rate = sum_along[c, k]/sum_p[c, k]
      squares = times = 0
      for (t = 1; t <= instants; ++t)
        if ((c, k, t) in p_of) {
          ++times
          squares += (along_of[c, k, t] - mu_rate*p_of[c, k, t])^2
        }
      if (times < 3) continue
      printf "%s,%s,%.3f,%.3f,%.3f,%.3f,%.3f,%.2f,%.3f,%d,%d\n", flow, class[c], sum_I[c, k]/n, sum_s[c, k]/sum_p[c, k], mu_rate,
             sqrt(squares*times/(times - 1))/sum_p[c, k], sum_phi[c, k]/n, sum_lode[c, k]/n, sum_power[c, k]/all, n, times
    }
}
function deviator(A,   third, a) {
  third = (A[1, 1] + A[2, 2] + A[3, 3])/3
  for (a = 1; a <= 3; ++a) A[a, a] -= third
  return third
}
function double_dot(A, B,   a, b, sum) {
  for (a = 1; a <= 3; ++a)
    for (b = 1; b <= 3; ++b) sum += A[a, b]*B[a, b]
  return sum
}
function norm(A) { return sqrt(double_dot(A, A)/2) }
function cos3theta(A,   det) {
  det = A[1, 1]*(A[2, 2]*A[3, 3] - A[2, 3]^2) - A[1, 2]*(A[1, 2]*A[3, 3] - A[2, 3]*A[1, 3])
  det += A[1, 3]*(A[1, 2]*A[2, 3] - A[2, 2]*A[1, 3])
  return 1.5*sqrt(3)*det/norm(A)^3
}
