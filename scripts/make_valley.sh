#!/bin/sh
# Writes the synthetic valley of cases/valley.toml: an elevation raster (ESRI ASCII, 10 m cells, UTM 32N) and a release
# polygon (GeoJSON). A steep flank falls east into a winding valley.
set -eu
out=${1:-$(dirname "$0")/../cases/valley}
mkdir -p "$out"
awk 'BEGIN {
  nx = 160; ny = 100; d = 10
  printf "ncols %d\nnrows %d\nxllcorner 500000\nyllcorner 5100000\ncellsize %d\nNODATA_value -9999\n", nx, ny, d
  for (j = ny - 1; j >= 0; j--) {
    for (i = 0; i < nx; i++) {
      x = (i + 0.5) * d; y = (j + 0.5) * d - 500 - 50 * sin(x / 250)
      z = 900 + 650 * exp(-exp(1.5 * log(x / 550))) - 0.02 * x + 0.0016 * y * y
      printf "%.2f%s", z, (i < nx - 1 ? " " : "\n")
    }
  }
}' > "$out/elevation.asc"
cat > "$out/elevation.prj" <<'PRJ'
PROJCS["WGS_1984_UTM_Zone_32N",GEOGCS["GCS_WGS_1984",DATUM["D_WGS_1984",SPHEROID["WGS_1984",6378137.0,298.257223563]],PRIMEM["Greenwich",0.0],UNIT["Degree",0.0174532925199433]],PROJECTION["Transverse_Mercator"],PARAMETER["False_Easting",500000.0],PARAMETER["False_Northing",0.0],PARAMETER["Central_Meridian",9.0],PARAMETER["Scale_Factor",0.9996],PARAMETER["Latitude_Of_Origin",0.0],UNIT["Meter",1.0]]
PRJ
cat > "$out/release.geojson" <<'JSON'
{"type": "FeatureCollection",
 "crs": {"type": "name", "properties": {"name": "urn:ogc:def:crs:EPSG::32632"}},
 "features": [{"type": "Feature", "properties": {"thickness": 8.0},
  "geometry": {"type": "Polygon", "coordinates": [[[500160, 5100480], [500200, 5100450], [500300, 5100470], [500340, 5100550],
    [500280, 5100610], [500190, 5100590], [500160, 5100480]]]}}]}
JSON
