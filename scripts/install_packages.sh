#!/usr/bin/env bash
# Installs the Debian packages libahm needs: install_packages.sh [extra package ...]. Does nothing where all are there.
set -euo pipefail

packages=(
  build-essential cmake ninja-build
  libeigen3-dev libsuitesparse-dev libopenblas0-pthread       # linear algebra, with an optimised BLAS
  libnanoflann-dev libflann-dev liblz4-dev                    # neighbour search
  libpcl-dev                                                  # PCD files, voxel grid, outlier removal
  libminizip-dev                                              # .npz files
  libcli11-dev nlohmann-json3-dev libfmt-dev                  # the program
  libstb-dev libjs-three                                      # pictures
  libgtest-dev libbenchmark-dev                               # tests and benchmarks
  "$@"
)

missing=()
for package in "${packages[@]}"; do
  dpkg-query -W -f '${db:Status-Status}\n' "$package" 2>/dev/null | grep -qx installed || missing+=("$package")
done
if [ "${#missing[@]}" -eq 0 ]; then
  echo "All Debian packages are installed."
  exit 0
fi

echo "Installing ${#missing[@]} Debian packages: ${missing[*]}"
as_root=()
if [ "$(id -u)" -ne 0 ]; then
  command -v sudo >/dev/null || { echo "error: run this as root, or install sudo" >&2; exit 1; }
  as_root=(sudo)
fi
"${as_root[@]}" apt-get update -qq
# --no-install-recommends: PCL alone would recommend hundreds of packages more.
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}" >/dev/null
