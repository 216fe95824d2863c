#include "ahm/tiles/manifest.hpp"

#include <array>
#include <bit>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "ahm/error.hpp"
#include "ahm/io/atomic_file.hpp"
#include "ahm/tiles/array_file.hpp"

namespace ahm::tiles {
namespace {

using Json = nlohmann::json;

constexpr std::array names{"planned", "indexed", "measured", "triangulated", "oriented", "built"};

Json to_json(const Manifest& m) {
  Json tiles = Json::array();
  for (const TileFacts& t : m.tiles) tiles.push_back({t.cut, t.hash, t.points, t.vertices, t.edges});
  const TileOptions& o = m.options;
  Json result{{"input", m.input},
              {"options",
               {{"tile_points", o.tile_points},
                {"k", o.k},
                {"max_edge_ratio", o.max_edge_ratio},
                {"drop_non_finite", o.drop_non_finite},
                {"ignore_normals", o.ignore_normals}}},
              {"stage", to_string(m.stage)},
              {"points", m.points},
              {"non_finite", m.non_finite},
              {"placement", m.exponent},
              {"k", m.k},
              {"noise", m.noise},
              {"mollification", m.mollification},
              {"blocks", m.kind == TransportKind::block},
              {"reflections", m.reflections},
              {"components", m.components},
              {"mean_edge_length", m.mean_edge_length},
              {"tiles", tiles}};
  if (m.is_surface) result["surface"] = {{"delaunay", m.is_delaunay}};
  return result;
}

Stage stage_of(const std::string& name) {
  for (std::size_t k = 0; k < names.size(); ++k)
    if (name == names[k]) return static_cast<Stage>(k);
  throw IoError("'" + name + "' is not a stage");
}

Manifest from_json(const Json& j, bool is_surface) {
  Manifest m;
  const Json& o = j.at("options");
  m.input = j.at("input").get<std::string>();
  m.options = {o.at("tile_points").get<Index>(), o.at("k").get<Index>(), o.at("max_edge_ratio").get<double>(),
               o.at("drop_non_finite").get<bool>(), o.at("ignore_normals").get<bool>()};
  m.stage = stage_of(j.at("stage").get<std::string>());
  m.points = j.at("points").get<std::uint64_t>();
  m.non_finite = j.at("non_finite").get<std::uint64_t>();
  m.exponent = j.at("placement").get<int>();
  m.k = j.at("k").get<Index>();
  m.noise = j.at("noise").get<double>();
  m.mollification = j.at("mollification").get<double>();
  m.kind = j.at("blocks").get<bool>() ? TransportKind::block : TransportKind::rotation2;
  m.reflections = j.at("reflections").get<std::int64_t>();
  m.components = j.at("components").get<Index>();
  m.mean_edge_length = j.at("mean_edge_length").get<double>();
  m.is_surface = is_surface;
  m.is_delaunay = is_surface && j.at("surface").at("delaunay").get<bool>();
  for (const Json& t : j.at("tiles"))
    m.tiles.push_back({t.at(0).get<std::uint64_t>(), t.at(1).get<std::uint64_t>(), t.at(2).get<Index>(),
                       t.at(3).get<Index>(), t.at(4).get<std::int64_t>()});
  return m;
}

std::string hash_of(const std::string& text) {
  std::ostringstream out;
  out << std::hex << checksum(std::as_bytes(std::span(text)));
  return out.str();
}

std::filesystem::path manifest_in(const std::filesystem::path& folder) { return folder / "manifest.json"; }

template <class Of>
std::vector<Index> sums(const std::vector<TileFacts>& tiles, const Of& of) {
  std::vector<Index> result{0};
  for (const TileFacts& tile : tiles) result.push_back(result.back() + of(tile));
  return result;
}

}  // namespace

std::string_view to_string(Stage stage) noexcept { return names[static_cast<std::size_t>(stage)]; }

Manifest Manifest::read(const std::filesystem::path& folder) {
  const std::string place = "cannot read '" + manifest_in(folder).string() + "': ";
  std::ifstream file(manifest_in(folder));
  if (!file) throw IoError(place + "the file does not exist; plan the tiles first");
  try {
    const Json whole = Json::parse(file);
    const Json& version = whole.at("version");
    if (version != cloud_version && version != surface_version)
      throw IoError(place + "its version is " + version.dump() + "; " + std::to_string(cloud_version) + " and " +
                    std::to_string(surface_version) + " are supported; plan the tiles again");
    if (whole.at("checksum") != hash_of(whole.at("tiles").dump()))
      throw IoError(place + "it is damaged (its checksum is wrong); plan the tiles again");
    return from_json(whole.at("tiles"), version == surface_version);
  } catch (const Json::exception& e) {
    throw IoError(place + "it is damaged (" + e.what() + "); plan the tiles again");
  }
}

void Manifest::write(const std::filesystem::path& folder) const {
  const Json content = to_json(*this);
  const Json whole{{"version", is_surface ? surface_version : cloud_version},
                   {"checksum", hash_of(content.dump())},
                   {"tiles", content}};
  io::AtomicFile file(manifest_in(folder));
  file.write(whole.dump(1) + "\n");
  file.commit();
}

std::filesystem::path Manifest::file(const std::filesystem::path& folder, std::string_view kind, std::size_t tile) {
  std::array<char, 32> number{};
  std::snprintf(number.data(), number.size(), "%06zu.", tile);
  return folder / (std::string(number.data()) + std::string(kind));
}

std::vector<std::uint64_t> Manifest::identity(std::size_t tile) const {
  std::vector<std::uint64_t> points{static_cast<std::uint64_t>(k),
                                    std::bit_cast<std::uint64_t>(options.max_edge_ratio)};
  for (const TileFacts& t : tiles) points.push_back(t.hash);
  return {checksum(std::as_bytes(std::span(points))), tile};
}

std::vector<Index> Manifest::first_points() const {
  return sums(tiles, [](const TileFacts& t) { return t.points; });
}

std::vector<Index> Manifest::first_vertices() const {
  return sums(tiles, [](const TileFacts& t) { return t.vertices; });
}

}  // namespace ahm::tiles
