#!/usr/bin/env bash
# Installs the packages that libahm requires on Debian 12, builds the program, downloads a real scan and draws its logarithmic map.
set -euo pipefail
cd "$(dirname "$0")/.."
demo=build/demo

# Builds only the program, without the parts that the demo does not use: half of the packages and a fraction of the time of a full build.
scripts/install_packages.sh program
echo "Configuring and building the program (build/demo/program) ..."
cmake -S . -B "$demo/program" -G Ninja -DCMAKE_BUILD_TYPE=Release -DAHM_BUILD_TESTS=OFF -DAHM_INSTALL=OFF \
  -DAHM_WITH_PCL=OFF -DAHM_WITH_FLANN=OFF -DAHM_WITH_MINIZIP=OFF >/dev/null
cmake --build "$demo/program" --target ahm_program
ahm="$demo/program/bin/ahm"

# Debian's package libcgal-demo contains real point sets. It is only unpacked here, not installed.
scan="$demo/kitten.xyz"
source_point=0,0.35,0.1
if [ ! -s "$scan" ]; then
  echo "Downloading a scan from Debian's package libcgal-demo (24 MB) ..."
  unpack="$(mktemp -d)"
  trap 'rm -rf "$unpack"' EXIT
  if (cd "$unpack" && chmod 755 . && apt-get download -qq libcgal-demo 2>/dev/null) &&
     dpkg-deb --fsys-tarfile "$unpack"/libcgal-demo_*.deb | tar -xO ./usr/share/doc/libcgal-dev/data.tar.gz |
       tar -xzO data/points_3/kitten.xyz > "$unpack/kitten.xyz"; then
    mv "$unpack/kitten.xyz" "$scan"
  fi
fi
if [ ! -s "$scan" ]; then
  echo "The package cannot be downloaded; generating a scan with noise, holes and uneven density instead."
  scan="$demo/generated.xyz"
  source_point=0,0.3,1
  cmake --build "$demo/program" --target example_05_generate_scan
  "$demo/program/bin/example_05_generate_scan" > "$scan"
fi

echo
"$ahm" info "$scan"
echo
"$ahm" logmap "$scan" --source="$source_point" -o "$demo/map.ply" --view "$demo/map.png" --verbose
"$ahm" logmap "$scan" --source="$source_point" -o "$demo/map.csv" --view "$demo/map.html" >/dev/null
echo
echo "The map:     $demo/map.ply, $demo/map.csv"
echo "The picture: $demo/map.png; to rotate it, open $demo/map.html in a browser."
