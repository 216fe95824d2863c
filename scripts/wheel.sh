#!/usr/bin/env bash
# Builds a self-contained wheel of the Python package in build/wheel, from the preset lean: static libraries.
# Checks the libraries that it needs, installs it into a new virtual environment, and runs the tests of the package that need only
# numpy and pytest.
#   wheel.sh
# The wheel is packed by Debian's python3-wheel. numpy and pytest in the environment are Debian's, so this works without a package index.
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/install_packages.sh wheel
python=/usr/bin/python3
folder=build/wheel
echo "Building (build/lean) ..."
# libgcc is shared: exceptions pass through functions of glibc, such as pthread_once, which use the shared one.
cmake --preset lean >/dev/null
cmake --build --preset lean --target ahm_python
mkdir -p "$folder"

echo "Checking the needed libraries ..."
module="$(echo build/lean/python/ahm/_core.*.so)"
needed="$(objdump -p "$module" | awk '$1 == "NEEDED" { print $2 }')"
others="$(grep -Ev '^(libc\.so\.6|libm\.so\.6|libpthread\.so\.0|libgcc_s\.so\.1|ld-linux-x86-64\.so\.2)$' <<<"$needed" || true)"
[ -z "$others" ] || { echo "error: $module needs $others" >&2; exit 1; }
# The tag names the newest version of glibc among the needed symbols.
glibc="$(objdump -T "$module" | grep -o 'GLIBC_2\.[0-9]*' | sort -Vu | tail -1)"
platform="manylinux_2_${glibc#GLIBC_2.}_$(uname -m)"

version="$(sed -n 's/^version = "\(.*\)"/\1/p' pyproject.toml)"
tag="$("$python" -c 'import sys; print("cp%d%d" % sys.version_info[:2])')"
root="$folder/ahm-$version"
rm -rf "$root" "$folder"/*.whl && mkdir -p "$root/ahm-$version.dist-info"
cp -r build/lean/python/ahm "$root/ahm"
find "$root" -name __pycache__ -prune -exec rm -r {} +
strip --strip-unneeded "$root"/ahm/_core.*.so
cp LICENSE "$root/ahm-$version.dist-info/"
cat >"$root/ahm-$version.dist-info/WHEEL" <<END
Wheel-Version: 1.0
Generator: libahm scripts/wheel.sh
Root-Is-Purelib: false
Tag: $tag-$tag-$platform
END
{
  printf '%s\n' "Metadata-Version: 2.1" "Name: ahm" "Version: $version" "Summary: Logarithmic maps on meshes, clouds and grids" \
    "License: MIT" "Requires-Python: >=3.9" "Requires-Dist: numpy>=1.21" "Description-Content-Type: text/markdown" ""
  cat README.md
} >"$root/ahm-$version.dist-info/METADATA"
"$python" -m wheel pack --dest-dir "$folder" "$root" >/dev/null

echo "Installing and testing ..."
environment="$folder/environment"
rm -rf "$environment"
"$python" -m venv --system-site-packages "$environment"
"$environment/bin/pip" install --quiet --no-index --no-deps "$folder"/ahm-*.whl
tests=()
for name in arguments exact maps surface_solver; do tests+=("$PWD/python/tests/test_$name.py"); done
(cd "$folder" && environment/bin/python -m pytest -q -p no:cacheprovider "${tests[@]}")
ls -l "$folder"/*.whl
