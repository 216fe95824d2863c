#!/usr/bin/env bash
# Installs the Debian packages for a task. Prints nothing if all are installed.
#   install_packages.sh [program|tests|checks|docs|packages|parity|web|wheel]
# program: the program without PCL, for scripts/demo.sh; tests (default): everything, including tests and benchmarks;
# checks: tests, and the tools of clang; docs: tests, and the tools for the documentation site; packages: tests, and the
# tools for Debian packages; parity: tests, and the libraries of scripts/parity.sh; web: the compiler for WebAssembly;
# wheel: the libraries and tools of scripts/wheel.sh.
set -euo pipefail

program=(
  build-essential cmake ninja-build
  libeigen3-dev                                               # linear algebra
  libnanoflann-dev                                            # neighbor search
  libcli11-dev nlohmann-json3-dev libfmt-dev                  # the program
  libstb-dev libjs-three                                      # pictures
  libcpp-httplib-dev pkgconf                                  # ahm view
  zlib1g-dev                                                  # files compressed with gzip
  libpugixml-dev                                              # .vtp files
  libxxhash-dev                                               # ahm-tiles: clouds that do not fit into memory
)
tests=(
  "${program[@]}"
  libflann-dev liblz4-dev                                     # neighbor search
  libpcl-dev                                                  # PCD files, voxel grid, outlier removal
  libminizip-dev                                              # .npz files
  libgtest-dev libbenchmark-dev                               # tests and benchmarks
  libsuitesparse-dev libopenblas0-pthread                     # CHOLMOD, for comparisons, with an optimized BLAS
  libcgal-dev python3-matplotlib                              # exact distances and plots of the experiments
  libpetsc-real-dev libopenmpi-dev openmpi-bin                # ahm-mpi: maps on many machines
  chromium chromium-driver python3-selenium                   # the viewer in a browser
  pybind11-dev python3-pybind11 python3-dev python3-numpy python3-scipy python3-pytest mypy python3-torch  # the Python package and its tests
  python3-yaml python3-geometry-msgs python3-nav-msgs         # messages of ROS
)
checks=("${tests[@]}" clang libclang-rt-14-dev clang-format clang-tidy)
debian=("${tests[@]}" dpkg-dev pkg-config file debootstrap)
docs=("${tests[@]}" doxygen python3-sphinx python3-myst-parser furo python3-sphinx-copybutton linkchecker pngquant)
parity=("${tests[@]}" python3-vtk9 python3-open3d python3-nibabel connectome-workbench python3-pandas)
web=(cmake ninja-build libeigen3-dev libnanoflann-dev clang-19 lld-19 wasi-libc libc++-19-dev-wasm32 libc++abi-19-dev-wasm32 libclang-rt-19-dev-wasm32
  libfmt-dev nlohmann-json3-dev libstb-dev libjs-three chromium chromium-driver python3-selenium)  # the site and its tests
command -v npm >/dev/null || web+=(nodejs npm)  # Debian 12 has Node 18
wheel=(cmake ninja-build g++ libeigen3-dev libnanoflann-dev nlohmann-json3-dev libstb-dev libcli11-dev libfmt-dev libgtest-dev binutils
  pybind11-dev python3-pybind11 python3-dev python3-numpy python3-pytest python3-venv python3-pip python3-wheel)
case "${1:-tests}" in
  program) packages=("${program[@]}") ;;
  tests) packages=("${tests[@]}") ;;
  checks) packages=("${checks[@]}") ;;
  docs) packages=("${docs[@]}") ;;
  packages) packages=("${debian[@]}") ;;
  parity) packages=("${parity[@]}") ;;
  web) packages=("${web[@]}") ;;
  wheel) packages=("${wheel[@]}") ;;
  *) echo "error: install_packages.sh [program|tests|checks|docs|packages|parity|web|wheel]" >&2; exit 2 ;;
esac

missing=()
for package in "${packages[@]}"; do
  dpkg-query -W -f '${db:Status-Status}\n' "$package" 2>/dev/null | grep -qx installed || missing+=("$package")
done
[ "${#missing[@]}" -gt 0 ] || exit 0

echo "Installing Debian packages and their dependencies (${#missing[@]}): ${missing[*]}"
as_root=()
if [ "$(id -u)" -ne 0 ]; then
  command -v sudo >/dev/null || { echo "error: run this as root, or install sudo" >&2; exit 1; }
  as_root=(sudo)
fi
# Converts apt's status lines, "pmstatus:PACKAGE:PERCENT:WHAT", to one line per ten percent. In bash, because Debian's awk reads
# blocks of 4096 bytes, which delays the output.
progress() {
  local kind package percent rest what last="" step reached=0
  while IFS=: read -r kind package percent rest; do
    case "$kind" in
      dlstatus) what=downloading package="" ;;
      pmstatus) what=installing ;;
      *) continue ;;
    esac
    step=$((${percent%%.*} / 10))
    [ "$what" = "$last" ] && [ "$step" -le "$reached" ] && continue
    printf '  %-11s %3d %%  %s\n' "$what" $((10 * step)) "$package"
    last="$what" reached="$step"
  done
}
apt=("${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -y -qq -o APT::Status-Fd=1 -o Dpkg::Use-Pty=0)
echo "  updating the package lists"
"${apt[@]}" update >/dev/null
# --no-install-recommends: PCL recommends hundreds of packages.
"${apt[@]}" install --no-install-recommends "${missing[@]}" | progress
