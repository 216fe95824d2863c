#!/usr/bin/env bash
# Builds the Debian packages (build/packages/*.deb) with shared libraries. Then tests them in a fresh root file system of this Debian,
# where apt installs them with their dependencies. The tests run the program and the Python package, build a program against the
# headers with CMake and with pkg-config, and read PCD files with and without the package for them. Finally they remove the packages
# and check that no files are left. On the system itself only the packages for building are installed. Requires root or sudo, for
# chroot.
set -euo pipefail
cd "$(dirname "$0")/.."
scripts/install_packages.sh packages
build="$PWD/build/packages" base="$PWD/build/packages/base" root="$PWD/build/packages/root"
as_root=()
[ "$(id -u)" -eq 0 ] || as_root=(sudo)

cmake -S . -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_COMPILE_WARNING_AS_ERROR=ON -DBUILD_SHARED_LIBS=ON -DCMAKE_INSTALL_PREFIX=/usr \
  -DAHM_PYTHON_DIR=lib/python3/dist-packages -DPython3_EXECUTABLE=/usr/bin/python3 -DAHM_WITH_MPI=OFF -DAHM_BUILD_TESTS=OFF -DAHM_BUILD_EXAMPLES=OFF
cmake --build "$build"
rm -f "$build"/*.deb
(cd "$build" && cpack -G DEB)

echo "Testing in a fresh root ..."
if [ ! -d "$base" ]; then
  "${as_root[@]}" rm -rf "$base.part"
  # shellcheck disable=SC1091
  "${as_root[@]}" /usr/sbin/debootstrap --variant=minbase "$(. /etc/os-release && echo "$VERSION_CODENAME")" "$base.part" >/dev/null
  "${as_root[@]}" mv "$base.part" "$base"
fi
"${as_root[@]}" rm -rf "$root"
"${as_root[@]}" cp -a "$base" "$root"
"${as_root[@]}" mkdir "$root/packages" "$root/try"
"${as_root[@]}" cp "$build"/*.deb "$root/packages"
"${as_root[@]}" cp -r tests/house/installed_consumer tests/house/consumer.cpp tests/house/contract_consumer.cpp "$root/try"

inside() {
  "${as_root[@]}" chroot "$root" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive \
    bash -euo pipefail -c "cd /try; $1"
}
install='apt-get install -y -qq --no-install-recommends -o Dpkg::Use-Pty=0'

inside 'apt-get update -qq'
inside "$install /packages/libahm0.1_*.deb /packages/ahm_*.deb /packages/python3-ahm_*.deb >/dev/null"
inside '
  { echo x y z; seq 0 399 | awk "{ print 0.1 * (\$1 % 20), 0.1 * int(\$1 / 20), 0 }"; } > plane.xyz
  { printf "# .PCD v.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 400\nHEIGHT 1\nPOINTS 400\nDATA ascii\n"
    tail -n 400 plane.xyz; } > plane.pcd
  ahm --version
  ahm logmap plane.xyz --source 0 -o map.csv --quiet
  tail -n 1 map.csv | grep -q "^399,1.9,1.9,0," || { echo "error: wrong map: $(tail -n 1 map.csv)" >&2; exit 1; }
  python3 -c "import ahm; m = ahm.log_map(ahm.shapes.plane(20, 20), 0); print(ahm.__file__, round(float(m.distance[399] ** 2), 9))"
  ahm-tiles --help >/dev/null
  zcat -f /usr/share/man/man1/ahm-logmap.1* | grep -q logmap || [ ! -d /usr/share/man/man1 ]
  if ahm logmap plane.pcd --source 0 -o pcd.csv 2>message; then echo "error: a PCD file was read without the package libahm0.1-pcl" >&2; exit 1; fi
  cat message'

inside "$install /packages/libahm0.1-pcl_*.deb >/dev/null"
inside 'ahm logmap plane.pcd --source 0 -o pcd.csv --voxel 0.01 --quiet; tail -n 1 pcd.csv'

inside "$install /packages/libahm-dev_*.deb g++ cmake ninja-build pkgconf >/dev/null"
inside '
  cmake -G Ninja -S installed_consumer -B consumer >/dev/null
  cmake --build consumer --target consumer >/dev/null
  consumer/consumer
  c++ $(pkg-config --cflags ahm-pointcloud) consumer.cpp -o by_pkg_config $(pkg-config --libs ahm-pointcloud)
  ./by_pkg_config'

inside 'apt-get purge -y -qq ahm python3-ahm libahm-dev libahm0.1 libahm0.1-pcl >/dev/null'
left="$("${as_root[@]}" find "$root" -xdev \( -path "$root/packages" -o -path "$root/try" -o -path "$root/proc" -o -path "$root/var/log" \) -prune \
  -o -iname '*ahm*' -print)"
[ -z "$left" ] || { echo "error: files left after removal: $left" >&2; exit 1; }
"${as_root[@]}" rm -rf "$root"
echo "The packages:"
ls -l "$build"/*.deb
