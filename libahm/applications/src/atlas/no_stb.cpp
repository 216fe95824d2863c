// Replaces pack.cpp in a build without stb.
#include "ahm/applications/atlas.hpp"
#include "ahm/error.hpp"

namespace ahm {

bool can_pack() noexcept { return false; }

TextureAtlas pack(const Atlas&, const FaceList&, const PackOptions&) {
  throw Error("this build cannot pack charts: it was built without stb (Debian: libstb-dev)");
}

}  // namespace ahm
