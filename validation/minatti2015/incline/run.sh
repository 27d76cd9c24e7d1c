#!/usr/bin/env bash
# Flow down a plane (see README.md). Usage: run.sh [PROGRAM] [SCRATCH] [RUN...]
# Runs what is named (default: everything) and has not been completed in SCRATCH, then rewrites results.csv from all that is there.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
top=$(cd "$here/../../.." && pwd)
program=${1:-$top/build/release/bagnold}
scratch=${2:-$top/out/incline}
shift $(($# < 2 ? $# : 2))

literal="--set numerics.operator=minatti2015 --set numerics.stepping=minatti2015 --set numerics.shifting=0
         --set numerics.volume_correction=0 --set numerics.density_diffusion=0 --set numerics.cfl=0.5"
options() {
  echo "--set output.series_every=0.1 --set output.vtk_every=100 --set output.snapshot_every=100"
  case $1 in
    improved-1s | improved-3s | improved-6.5s) local t=${1#*-}; echo "--set time.end=${t%s}" ;;
    improved-steady) echo "--set time.end=20" ;;
    rows-* | steady-*) awk -v run="$1" 'BEGIN { split(run, a, "-"); n = a[2]; dp = 0.1/n; print "--set time.end=" (a[1] == "rows" ? 3 : 20) " --set scenario.spacing=" dp " --set scenario.length=" (n > 20 ? 20*dp : 0.1) }' ;;
    literal-alpha*-*s) # literal-alphaALPHA-TIMEs
      local a=${1#literal-alpha} t=${1##*-}
      echo "--set time.end=${t%s} $literal --set numerics.artificial_viscosity=${a%-*}" ;;
    responding-steady) # exact operators with the friction the printed ones act like, (a/b^2) mu(b^1.5 i), a = 0.866, b = 0.973
      awk 'BEGIN { a = 0.866; b = 0.973; rad = atan2(0, -1)/180; s = sin(20.9*rad)/cos(20.9*rad); l = sin(32.76*rad)/cos(32.76*rad)
        printf "--set time.end=40 --set material.static_angle_deg=%.4f --set material.limit_angle_deg=%.4f --set material.i0=%.4f",
          atan2(a/b^2*s, 1)/rad, atan2(a/b^2*l, 1)/rad, 0.279/b^1.5 }' ;;
    *) echo "unknown run $1" >&2; return 1 ;;
  esac
}
runs=("$@")
[ ${#runs[@]} = 0 ] && runs=(improved-1s improved-3s improved-6.5s improved-steady rows-10 rows-20 rows-40 rows-80 steady-10 steady-20 steady-40
  literal-alpha{0,0.05}-{1,2,3,5,7,9,20,30}s responding-steady)
for run in "${runs[@]}"; do
  grep -q '"status": "completed"' "$scratch/$run/summary.json" 2>/dev/null && continue
  # shellcheck disable=SC2046
  "$program" run "$top/cases/incline.toml" -o "$scratch/$run" --overwrite --quiet $(options "$run") || echo "$run failed" >&2
done

columns=(particles time steps profile_error_l2 transient_error_l2 pressure_error_l2 u_surface u_surface_exact u_mean
         u_mean_responding stress_response gradient_response git_hash)
{
  echo "run ${columns[*]}" | tr ' ' ,
  for directory in "$scratch"/*/; do
    s=$directory/summary.json
    [ -f "$s" ] || continue
    line=$(basename "$directory")
    for column in "${columns[@]}"; do # the last line of an object has no comma; what a run does not have stays empty
      line+=,$(sed -n "s/^ *\"$column\": \(.*[^,]\),\{0,1\}\$/\1/p" "$s" | head -1 | tr -d '"')
    done
    echo "$line"
  done
} > "$here/results.csv"
