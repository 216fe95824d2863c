#!/usr/bin/env bash
# Builds the documentation site, build/docs/html/index.html: the pages of docs/, the C++ API from the headers (Doxygen), and the
# Python API from the package in build/release, which is built if missing. Fails on warnings and on dead links within the site.
#   docs.sh [pictures]     pictures: first runs the commands of docs/gallery.md, which create its pictures
set -euo pipefail
cd "$(dirname "$0")/.."
out=build/docs

case "${1:-}" in
  "" | pictures) ;;
  *) echo "error: docs.sh [pictures]" >&2; exit 2 ;;
esac
scripts/install_packages.sh docs
if [ ! -d build/release/python/ahm ] || [ "${1:-}" = pictures ]; then
  cmake --preset release >/dev/null
  cmake --build --preset release --target ahm_python ahm_program example_05_generate_scan example_13_generate_mesh
fi
[ "${1:-}" != pictures ] || scripts/gallery.sh

echo "C++ API (Doxygen) ..."
rm -rf "$out/html"
mkdir -p "$out/html" "$out/pages"
version="$(sed -n 's/^version: //p' CITATION.cff)"
{
  cat docs/site/Doxyfile
  printf 'PROJECT_NUMBER = %s\nOUTPUT_DIRECTORY = %s\nGENERATE_TAGFILE = %s\n' "$version" "$out/html" "$out/cpp.tag"
} | doxygen -

echo "Pages and Python API (Sphinx) ..."
python=/usr/bin/python3
"$python" docs/site/stage.py . "$out/cpp.tag" "$out/pages"
PYTHONPATH=build/release/python PYTHONDONTWRITEBYTECODE=1 "$python" -m sphinx -b html -W --keep-going -q -j auto \
  -c docs/site -d "$out/doctrees" "$out/pages" "$out/html"

echo "Links ..."
linkchecker --no-status --no-warnings "$out/html/index.html"
echo "The site: $out/html/index.html"
