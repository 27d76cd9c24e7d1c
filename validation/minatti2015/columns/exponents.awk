# Local exponents d ln(run-out)/d ln a between neighbouring aspect ratios, connected / layer:
#   sort -t, -k4,4g results.csv | awk -F, -v runs=REGEX -f exponents.awk
$2 == "axisymmetric" && $3 ~ "^(" runs ")$" {
  if (a) printf "%.2f to %.2f: %.2f / %.2f\n", a, $4, log($10/connected)/log($4/a), log($11/layer)/log($4/a)
  a = $4; connected = $10; layer = $11
}
