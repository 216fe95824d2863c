#!/usr/bin/env bash
# Builds the Debian packages (build/packages/*.deb) with shared libraries, then tries them in a fresh root: installs, runs the
# program, the Python package and a program built against the headers by CMake and by pkg-config, and uninstalls without a trace.
# Nothing of this touches the system but the packages it takes to build.
set -euo pipefail
cd "$(dirname "$0")/.."
scripts/install_packages.sh packages
build="$PWD/build/packages" root="$PWD/build/packages/root"

cmake -S . -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_COMPILE_WARNING_AS_ERROR=ON -DBUILD_SHARED_LIBS=ON -DCMAKE_INSTALL_PREFIX=/usr \
  -DAHM_PYTHON_DIR=lib/python3/dist-packages -DPython3_EXECUTABLE=/usr/bin/python3 -DAHM_BUILD_TESTS=OFF -DAHM_BUILD_EXAMPLES=OFF
cmake --build "$build"
rm -f "$build"/*.deb
(cd "$build" && cpack -G DEB)

echo "In a fresh root ..."
rm -rf "$root"
mkdir -p "$root/var/lib/dpkg/updates" "$root/var/lib/dpkg/info" "$root/var/log"
touch "$root/var/lib/dpkg/status"
packages=("$build"/*.deb)
# The root has no other packages: what ours depend on is the system's. No maintainer script runs, since none is there.
dpkg_there() { dpkg --root="$root" --force-not-root --force-depends --log=/dev/null "$@"; }
dpkg_there --install "${packages[@]}" 2>/dev/null >/dev/null
for package in "${packages[@]}"; do
  dpkg-deb --field "$package" Depends | tr ',' '\n' | sed 's/|.*//; s/[ (].*$//; s/^ *//' | while read -r need; do
    dpkg-query -W "$need" >/dev/null 2>&1 || dpkg-query --admindir="$root/var/lib/dpkg" -W "$need" >/dev/null 2>&1 ||
      { [ -z "$need" ] || { echo "error: $package needs $need, which is nowhere" >&2; exit 1; }; }
  done
done

libraries="$root/usr/lib/$(gcc -print-multiarch)"
[ -d "$libraries" ] || libraries="$root/usr/lib"
export LD_LIBRARY_PATH="$libraries"
work="$build/tried"
rm -rf "$work" && mkdir "$work"
printf '# .PCD v.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 400\nHEIGHT 1\nPOINTS 400\nDATA ascii\n' > "$work/plane.pcd"
seq 0 399 | awk '{ print 0.1 * ($1 % 20), 0.1 * int($1 / 20), 0 }' >> "$work/plane.pcd"
"$root/usr/bin/ahm" logmap "$work/plane.pcd" --source 0 -o "$work/map.csv"
tail -n 1 "$work/map.csv"
PYTHONPATH="$root/usr/lib/python3/dist-packages" PYTHONDONTWRITEBYTECODE=1 /usr/bin/python3 -c '
import ahm; m = ahm.log_map(ahm.shapes.plane(20, 20), 0); print(ahm.__file__, round(float(m.distance[399] ** 2), 9))'

cmake -G Ninja -S tests/house/installed_consumer -B "$work/consumer" -DCMAKE_PREFIX_PATH="$root/usr" >/dev/null
cmake --build "$work/consumer" --target consumer >/dev/null
"$work/consumer/consumer"
export PKG_CONFIG_PATH="$libraries/pkgconfig"
# shellcheck disable=SC2046
c++ $(pkg-config --cflags ahm-pointcloud) tests/house/consumer.cpp -o "$work/by_pkg_config" $(pkg-config --libs ahm-pointcloud)
"$work/by_pkg_config"

names=()
for package in "${packages[@]}"; do names+=("$(dpkg-deb --field "$package" Package)"); done
dpkg_there --purge "${names[@]}" >/dev/null
left="$(find "$root" -path "$root/var" -prune -o ! -type d -print)"
[ -z "$left" ] || { echo "error: left behind: $left" >&2; exit 1; }
echo "The packages:"
ls -l "$build"/*.deb
