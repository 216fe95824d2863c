#!/usr/bin/env bash
# Runs the commands of docs/gallery.md in build/gallery, with the programs of build/release, and copies the pictures of the page to
# docs/images/gallery.
set -euo pipefail
cd "$(dirname "$0")/.."
page="$PWD/docs/gallery.md" pictures="$PWD/docs/images/gallery" programs="$PWD/build/release/bin"

mkdir -p build/gallery "$pictures"
cd build/gallery
awk '/^```sh$/ { code = 1; next } /^```$/ { code = 0 } code' "$page" > commands.sh
PATH="$programs:$PATH" bash -euo pipefail commands.sh
grep -oE 'images/gallery/[a-z_]+\.png' "$page" | while read -r picture; do
  pngquant --force --speed 1 --output "$pictures/$(basename "$picture")" "$(basename "$picture")"
done
