#include "requests.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>

#include "ahm/error.hpp"
#include "ahm/io/image.hpp"
#include "ahm/surface/mesh_repair.hpp"
#include "ahm/util/shell.hpp"
#include "ahm/util/text.hpp"
#include "ahm/util/vec.hpp"

namespace ahm::viewer {

std::string number(double x) {
  std::array<char, 40> text;
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), x).ptr};
}

namespace {

/// The settings as options of the command line; omits default values.
/// @param chosen  whether the command selects a method automatically without --method
std::vector<std::string> words(const Settings& settings, bool chosen) {
  const Settings usual;
  std::vector<std::string> out;
  const auto add = [&](const char* name, std::string value) { out.insert(out.end(), {name, std::move(value)}); };
  const bool heat = settings.method == Method::heat;
  if (!heat || chosen) add("--method", std::string(to_string(settings.method)));
  if (heat && settings.variant != usual.variant) add("--variant", std::string(to_string(settings.variant)));
  if (heat && settings.t_coef != usual.t_coef) add("--t-coef", number(settings.t_coef));
  if (settings.radius) add("--radius", number(*settings.radius));
  if (const auto& u = settings.u_axis)
    out.push_back("--u-axis=" + number((*u)[0]) + "," + number((*u)[1]) + "," + number((*u)[2]));
  return out;
}

}  // namespace

std::string command(const SessionOptions& session, const std::string& name, const std::vector<std::string>& arguments,
                    const Settings& settings) {
  std::string out = "ahm " + name + " " + session.input;
  for (const auto& list : {arguments, words(settings, name == "logmap")})
    for (const std::string& word : list) out.append(" ").append(detail::shell_word(word));
  if (!session.input_options.empty()) out.append(" ").append(session.input_options);
  return out;
}

std::string spec(const Surface& surface, const SurfacePoint& point) {
  if (const auto* row = std::get_if<Row>(&point)) return std::to_string(row->index);
  std::string out;
  const auto list = [&](const auto& values) {
    for (std::size_t k = 0; k < values.size(); ++k) out.append(k == 0 ? "" : ",").append(number(values[k]));
    return out;
  };
  if (const auto* face = std::get_if<FacePoint>(&point)) {
    const auto* repaired = dynamic_cast<const RepairedSurface*>(&surface);  // commands use the file's numbers
    out = "face:" + std::to_string(repaired ? repaired->mesh().given_face[face->face] : face->face) + ":";
    return list(face->barycentric);
  }
  return list(surface.position(point));
}

namespace {

using nlohmann::json;

json point_as_json(const SurfacePoint& point) {
  if (const auto* row = std::get_if<Row>(&point)) return {{"row", row->index}};
  const auto& face = std::get<FacePoint>(point);
  return {{"face", face.face}, {"weights", face.barycentric}};
}

/// A number with thousands separators, and a noun: "1,234 points".
std::string counted(std::size_t n, const char* noun) {
  std::string digits = std::to_string(n);
  for (auto k = static_cast<std::ptrdiff_t>(digits.size()) - 3; k > 0; k -= 3)
    digits.insert(static_cast<std::size_t>(k), ",");
  return digits + " " + detail::noun_after(n, noun);
}

}  // namespace

json session_info(const Surface& surface, const io::Geometry& geometry, const SessionOptions& options) {
  const std::size_t faces = surface.faces().size(), rows = geometry.points.size();
  json variants = json::array();
  for (const Variant variant : all_variants) variants.push_back(to_string(variant));
  // Columns that have isolines, with their range.
  json columns = json::array();
  for (const std::string& name : io::column_names(geometry)) {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    const auto values = io::column(geometry, name);
    for (const double x : *values)
      if (std::isfinite(x)) low = std::min(low, x), high = std::max(high, x);
    if (low < high) columns.push_back({{"name", name}, {"low", low}, {"high", high}});
  }
  const Settings& usual = options.settings;
  json info = {{"about", faces > 0 ? counted(rows, "vertex") + ", " + counted(faces, "face") : counted(rows, "point")},
               {"has_faces", faces > 0},
               {"variants", variants},
               {"formats", options.formats},
               {"columns", columns},
               {"method", to_string(usual.method)},
               {"variant", to_string(usual.variant)},
               {"t_coef", usual.t_coef}};
  if (usual.radius) info["radius"] = *usual.radius;
  if (options.source) info["source"] = point_as_json(standing_for(surface, *options.source));
  return info;
}

namespace {

std::string decoded(const std::string& base64) {
  constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : base64.substr(0, base64.find('='))) {
    const std::size_t digit = digits.find(c);
    if (digit == std::string_view::npos) throw InvalidArgument("request: \"image\" must be a file in base64");
    bits = bits << 6 | static_cast<std::uint32_t>(digit);
    if ((count += 6) < 8) continue;
    count -= 8;
    bytes.push_back(static_cast<char>(bits >> count & 0xff));
  }
  return bytes;
}

}  // namespace

Image image_of(const std::string& base64) {
  try {
    return io::decode_image(decoded(base64));
  } catch (const IoError&) {
    throw InvalidArgument("the image is not a PNG or JPEG file that ahm can read");
  }
}

namespace {

using nlohmann::json;

constexpr std::size_t most_points = 10'000;  // maximum number of points of a stroke
constexpr std::size_t longest_name = 64;

[[noreturn]] void refuse(const std::string& name, const std::string& what) {
  throw InvalidArgument("request: \"" + name + "\" " + what);
}

double finite(const json& value, const std::string& name) {
  if (!value.is_number()) refuse(name, "must be a number");
  const double x = value.get<double>();
  if (!std::isfinite(x)) refuse(name, "must be finite");
  return x;
}

Index index(const json& value, const std::string& name) {
  if (!value.is_number_integer()) refuse(name, "must be a whole number");
  const bool fits =
      value.is_number_unsigned() ? value.get<std::uint64_t>() <= std::numeric_limits<Index>::max() : false;
  if (!fits) refuse(name, "must lie between 0 and " + std::to_string(std::numeric_limits<Index>::max()));
  return value.get<Index>();
}

SurfacePoint read_point(const json& value, const std::string& name) {
  if (value.is_object() && value.size() == 1 && value.contains("row")) return Row(index(value["row"], name + ".row"));
  if (!value.is_object() || value.size() != 2 || !value.contains("face") || !value.contains("weights"))
    refuse(name, R"(must be {"row": 42} or {"face": 7, "weights": [0.2, 0.3, 0.5]})");
  FacePoint point{index(value["face"], name + ".face"), {}};
  const json& weights = value["weights"];
  if (!weights.is_array() || weights.size() > most_points) refuse(name + ".weights", "must be a list of numbers");
  for (const json& weight : weights) point.barycentric.push_back(finite(weight, name + ".weights"));
  return point;
}

}  // namespace

SurfacePoint standing_for(const Surface& surface, const SurfacePoint& point) {
  const auto* row = std::get_if<Row>(&point);
  if (!row) return point;
  try {
    surface.vertex(*row);
  } catch (const InvalidArgument& e) {
    if (e.fault() != "row_left_out") return point;  // the caller rejects it when it uses the point
    const Vec3& position = surface.positions()[row->index];
    if (is_finite(position)) return surface.nearest_row(position);
  }
  return point;
}

Request::Request(std::string_view body) : json_(json::parse(body, nullptr, false)) {
  if (json_.is_discarded()) throw InvalidArgument("request: the body is not JSON");
  if (!json_.is_object()) throw InvalidArgument("request: the body must be a JSON object");
}

const json& Request::at(const char* name) const {
  const auto found = json_.find(name);
  if (found == json_.end()) refuse(name, "is missing");
  return *found;
}

bool Request::has(const char* name) const {
  const auto found = json_.find(name);
  return found != json_.end() && !found->is_null();
}

std::string Request::client() const {
  const json& value = at("client");
  if (!value.is_string() || value.get_ref<const std::string&>().size() > longest_name)
    refuse("client", "must be a string of at most 64 bytes");
  return value.get<std::string>();
}

std::optional<Index> Request::number() const {
  return has("number") ? std::optional(index(at("number"), "number")) : std::nullopt;
}

SurfacePoint Request::point(const char* name) const { return read_point(at(name), name); }

std::vector<SurfacePoint> Request::points(const char* name) const {
  const json& list = at(name);
  if (!list.is_array() || list.size() > most_points)
    refuse(name, "must be a list of at most " + detail::counted(most_points, "point"));
  std::vector<SurfacePoint> points;
  for (std::size_t k = 0; k < list.size(); ++k)
    points.push_back(read_point(list[k], std::string(name) + "[" + std::to_string(k) + "]"));
  return points;
}

double Request::finite(const char* name) const { return viewer::finite(at(name), name); }

std::string Request::text(const char* name) const {
  const json& value = at(name);
  if (!value.is_string()) refuse(name, "must be a string");
  return value.get<std::string>();
}

CoverageOptions Request::coverage() const {
  CoverageOptions options;
  options.radius = positive("coverage_radius");
  options.spacing = positive("spacing");
  if (options.radius / options.spacing > 500)
    throw InvalidArgument("request: more than 500 lines from the source; choose a larger \"spacing\"");
  options.pattern =
      word("pattern", {"raster", "spiral"}) == "raster" ? CoveragePattern::raster : CoveragePattern::spiral;
  return options;
}

double Request::positive(const char* name) const {
  const double x = finite(name);
  if (!(x > 0)) refuse(name, "must be greater than 0");
  return x;
}

std::string Request::word(const char* name, const std::vector<std::string>& allowed) const {
  const json& value = at(name);
  if (!value.is_string() || std::find(allowed.begin(), allowed.end(), value.get<std::string>()) == allowed.end()) {
    std::string list;
    for (const std::string& word : allowed) list.append(list.empty() ? "" : ", ").append(word);
    refuse(name, "must be one of " + list);
  }
  return value.get<std::string>();
}

Settings Request::settings(const Settings& usual) const {
  Settings out = usual;
  if (has("method")) {
    const std::string name = word("method", {"polar", "heat", "exact"});
    out.method = name == "polar" ? Method::polar : name == "exact" ? Method::exact : Method::heat;
  }
  if (has("variant")) {
    std::vector<std::string> names;
    for (const Variant variant : all_variants) names.emplace_back(to_string(variant));
    const std::string name = word("variant", names);
    for (const Variant variant : all_variants)
      if (to_string(variant) == name) out.variant = variant;
  }
  if (has("t_coef")) out.t_coef = positive("t_coef");
  if (has("radius")) out.radius = positive("radius");
  if (const auto none = json_.find("radius"); none != json_.end() && none->is_null()) out.radius.reset();
  if (!has("u_axis")) return out;
  const json& axis = at("u_axis");
  if (!axis.is_array() || axis.size() != 3) refuse("u_axis", "must be a list of three numbers");
  out.u_axis = {viewer::finite(axis[0], "u_axis"), viewer::finite(axis[1], "u_axis"),
                viewer::finite(axis[2], "u_axis")};
  return out;
}

}  // namespace ahm::viewer
