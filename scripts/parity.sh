#!/usr/bin/env bash
# Compares the Python package with other libraries in Debian: CGAL, VTK, scipy, Open3D, connectome-workbench, nibabel, pandas and
# PyTorch. docs/reference/parity.md lists what is compared. Installs the packages and builds what is missing. Not part of CI.
#   scripts/parity.sh [pytest options]
set -euo pipefail
cd "$(dirname "$0")/.."
scripts/install_packages.sh parity
cmake --preset release
cmake --build --preset release --target ahm_python
mkdir -p build/parity
g++ -std=c++17 -O1 -frounding-math -I/usr/include/eigen3 -DCGAL_EIGEN3_ENABLED scripts/parity/cgal_distances.cpp -o build/parity/cgal_distances -lgmp -lmpfr
PYTHONPATH="$PWD/build/release/python" PYTHONDONTWRITEBYTECODE=1 /usr/bin/python3 -m pytest -q -p no:cacheprovider scripts/parity "$@"
PYTHONPATH="$PWD/build/release/python" PYTHONDONTWRITEBYTECODE=1 /usr/bin/python3 -m pytest -q -p no:cacheprovider \
  python/tests/test_arguments.py -k other_packages
