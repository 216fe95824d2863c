#include <string>

#include "ahm/error.hpp"
#include "ahm/render/page.hpp"
#include "ahm/render/picture.hpp"

#ifdef AHM_RENDER_HAS_HTML

#include <string_view>
#include <utility>
#include <vector>

#include "ahm/io/atomic_file.hpp"
#include "resources.hpp"

namespace ahm::render {
namespace {

std::string base64(std::string_view data) {
  constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  const std::size_t size = data.size();
  std::string out;
  out.reserve((size + 2) / 3 * 4);
  for (std::size_t i = 0; i < size; i += 3) {
    const auto at = [&](std::size_t k) {
      return k < size ? static_cast<unsigned>(static_cast<unsigned char>(data[k])) : 0U;
    };
    const unsigned word = at(i) << 16U | at(i + 1) << 8U | at(i + 2);
    out += digits[word >> 18U];
    out += digits[word >> 12U & 63U];
    out += i + 1 < size ? digits[word >> 6U & 63U] : '=';
    out += i + 2 < size ? digits[word & 63U] : '=';
  }
  return out;
}

/// Escapes text for use anywhere in the page.
std::string escape(std::string_view text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      case '\'':
        out += "&#39;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

using Values = std::vector<std::pair<std::string_view, std::string_view>>;

/// Passes the page to `write` in pieces, and replaces every @NAME@ by its value. Does not search in the values.
template <class Write>
void fill_in(std::string_view page, const Values& values, const Write& write) {
  while (!page.empty()) {
    std::size_t nearest = std::string_view::npos, length = 0;
    std::string_view value;
    for (const auto& [name, text] : values) {
      const std::size_t at = page.find(name);
      if (at >= nearest) continue;
      nearest = at, length = name.size(), value = text;
    }
    write(page.substr(0, nearest));
    if (nearest == std::string_view::npos) break;
    write(value);
    page.remove_prefix(nearest + length);
  }
}

/// The values that do not depend on the data.
Values fixed_values() {
  using namespace resources;
  return {{"@STYLE@", style},      {"@PALETTE@", palette},
          {"@THREE@", three},      {"@ORBIT_CONTROLS@", orbit_controls},
          {"@DATA_JS@", data},     {"@TRANSPORT_JS@", transport},
          {"@PICK_JS@", pick},     {"@TEAR_JS@", tear},
          {"@COARSE_JS@", coarse}, {"@PAINT_JS@", paint},
          {"@SPLATS_JS@", splats}, {"@MARKS_JS@", marks},
          {"@STAGE_JS@", stage},   {"@PANEL_JS@", panel},
          {"@MAIN_JS@", main}};
}

}  // namespace

bool can_write_html() noexcept { return true; }

void write_html(const std::filesystem::path& path, const Scene& scene, const PictureOptions& options) {
  const PageSurface surface(scene, options);
  const std::string title = escape(scene.title.empty() ? "logarithmic map" : scene.title);
  const std::string geometry = base64(surface.bundle()), map = base64(surface.map_bundle(scene, options));
  Values values = fixed_values();
  values.insert(values.end(), {{"@TITLE@", title}, {"@NONCE@", ""}, {"@SURFACE@", geometry}, {"@MAP@", map}});
  io::AtomicFile file(path);
  fill_in(resources::page, values, [&](std::string_view text) { file.write(text); });
  file.commit();
}

std::string live_page(const std::string& title, const std::string& nonce) {
  const std::string text = escape(title), attribute = "nonce=\"" + escape(nonce) + "\"";
  Values values = fixed_values();
  values.insert(values.end(), {{"@TITLE@", text}, {"@NONCE@", attribute}, {"@SURFACE@", ""}, {"@MAP@", ""}});
  std::string out;
  fill_in(resources::page, values, [&](std::string_view piece) { out += piece; });
  return out;
}

}  // namespace ahm::render

#else

namespace ahm::render {

bool can_write_html() noexcept { return false; }

void write_html(const std::filesystem::path& path, const Scene&, const PictureOptions&) {
  throw Error(
      "cannot write " + path.string() +
      ": this build of libahm has no HTML pictures; install three.js (Debian: libjs-three) and configure again");
}

std::string live_page(const std::string&, const std::string&) { return {}; }

}  // namespace ahm::render

#endif
