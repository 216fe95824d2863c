#!/usr/bin/env bash
# Installs the packages that libahm requires on Debian 12, builds it and runs all tests.
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/install_packages.sh tests
echo "Configuring and building (build/release) ..."
cmake --preset release
cmake --build --preset release
echo "Testing ..."
ctest --preset release --parallel "$(nproc)"
