#!/usr/bin/env bash
# Builds two folders, and runs their tests in Node and Chromium:
#   build/web/package  the npm package: libahm as WebAssembly, with types. The tests use the packed package
#   build/web/site     the viewer without a server: static files for any web server
# If build/release/bin/ahm exists, the tests compare the maps with its maps.
#   web.sh [--serve]    --serve: then serves the site to this machine, until Ctrl-C
set -euo pipefail
cd "$(dirname "$0")/.."

scripts/install_packages.sh web
# The compiler does not search the folder of the system's headers. Debian's libc++ for WebAssembly is configured without std::filesystem,
# but has its headers: web/src/filesystem.cpp defines the functions that libahm uses.
headers=build/web/include
mkdir -p "$headers"
cp -a /usr/include/nanoflann.hpp /usr/include/nlohmann /usr/include/fmt /usr/include/stb "$headers"
[ -e "$headers/__config_site" ] || sed '/define _LIBCPP_HAS_NO_FILESYSTEM/d' /usr/lib/llvm-19/include/wasm32-wasi/c++/v1/__config_site >"$headers/__config_site"

# Debian's libc++ for WebAssembly has no exceptions. Those of emscripten's package have the same ABI; its other parts are not used.
runtime=build/web/emscripten
if [ ! -e "$runtime/libunwind-except.a" ]; then
  echo "Downloading the package emscripten (110 MB) for its exception library ..."
  mkdir -p "$runtime/download"
  (cd "$runtime/download" && { apt-get download emscripten 2>/dev/null || { apt-get update -qq && apt-get download emscripten; }; })
  for name in libc++abi-except.a libunwind-except.a; do
    dpkg-deb --fsys-tarfile "$runtime"/download/emscripten_*.deb |
      tar -xO "./usr/share/emscripten/cache/sysroot/lib/wasm32-emscripten/$name" >"$runtime/$name.part"
    mv "$runtime/$name.part" "$runtime/$name"
  done
  rm -r "$runtime/download"
fi

echo "Building (build/web) ..."
cmake -S . -B build/web -G Ninja -DCMAKE_TOOLCHAIN_FILE=cmake/wasm32-wasi.cmake -DCMAKE_BUILD_TYPE=Release -DAHM_UNITY_BUILD=ON \
  -DAHM_WITH_FILES=OFF -DAHM_WITH_FLANN=OFF -DAHM_WITH_MINIZIP=OFF -DAHM_WITH_PCL=OFF -DAHM_WITH_PUGIXML=OFF \
  -DAHM_WITH_THREADS=OFF -DAHM_WITH_THREE=OFF -DAHM_WITH_VIEWER=OFF -DAHM_WITH_ZLIB=OFF -DAHM_BUILD_APPS=OFF \
  -DAHM_BUILD_PYTHON=OFF -DAHM_BUILD_EXAMPLES=OFF -DAHM_BUILD_TESTS=OFF -DAHM_INSTALL=OFF \
  -DCMAKE_CXX_STANDARD_INCLUDE_DIRECTORIES="$PWD/$headers" -DSTB_INCLUDE_DIR="$PWD/$headers/stb" \
  -DAHM_WASM_EXCEPTIONS="$PWD/$runtime/libc++abi-except.a;$PWD/$runtime/libunwind-except.a" >/dev/null
cmake --build build/web --target ahm_web ahm_web_viewer

site=build/web/site
rm -rf "$site"
cp -r web/site "$site"
cp build/web/ahm.wasm web/package/wasi.js LICENSE "$site"
# The page of ahm view, with the transport of the site.
node web/page.mjs libahm/render/src web/site/transport.js >"$site/view.html"
rm "$site/transport.js"

program="$PWD/build/release/bin/ahm"
[ -x "$program" ] || program=""
program="${AHM_PROGRAM:-$program}"
rm -rf build/web/package
cp -r web/package build/web/package
cp build/web/libahm.wasm LICENSE build/web/package/
echo "Packing and testing the package ..."
rm -rf build/web/installed && mkdir build/web/installed
(cd build/web/package && npm pack --silent --pack-destination ..)
(cd build/web/installed && npm init -y >/dev/null && npm install --silent --no-audit --no-fund --offline ../libahm-*.tgz)
cp web/package/test/*.mjs build/web/installed/
sed -n '/^```js$/,/^```$/p' web/package/README.md | grep -v '^```' >build/web/installed/readme.mjs
(cd build/web/installed && node readme.mjs)
(cd build/web/installed && AHM_PROGRAM="$program" node --test)

example=build/web/example
rm -rf "$example" && mkdir -p "$example/node_modules"
cp web/examples/decal.html "$example"
ln -s /usr/share/javascript/three "$example/node_modules/three"
ln -s "$PWD/build/web/installed/node_modules/libahm" "$example/node_modules/libahm"
echo "Testing the site and the example ..."
AHM_SITE="$PWD/$site" node --test web/test/
/usr/bin/python3 web/test/site_test.py --site "$site" --example "$example" --work build/web/browser ${program:+--ahm "$program"}

ls -l build/web/libahm-*.tgz
echo "site: $(tar cz -C "$site" . | wc -c) bytes, compressed"
if [ "${1:-}" = --serve ]; then
  echo "http://127.0.0.1:8000/"
  exec python3 -m http.server --bind 127.0.0.1 --directory "$site" 8000
fi
