#include "command.hpp"

#include <array>
#include <charconv>

#include "ahm/surface/repaired_surface.hpp"
#include "ahm/util/shell.hpp"

namespace ahm::viewer {

std::string number(double x) {
  std::array<char, 40> text;
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), x).ptr};
}

namespace {

/// @param chosen  whether the command chooses its method unless it is given one
std::vector<std::string> words(const Settings& settings, bool chosen) {
  const Settings usual;
  std::vector<std::string> out;
  const auto add = [&](const char* name, std::string value) { out.insert(out.end(), {name, std::move(value)}); };
  const bool heat = settings.method == Method::heat;
  if (!heat || chosen) add("--method", std::string(to_string(settings.method)));
  if (settings.method == Method::exact && settings.tolerance > 0) add("--tolerance", number(settings.tolerance));
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
    const auto* repaired = dynamic_cast<const RepairedSurface*>(&surface);  // commands count the faces of the file
    out = "face:" + std::to_string(repaired ? repaired->mesh().given_face[face->face] : face->face) + ":";
    return list(face->barycentric);
  }
  return list(surface.position(point));
}

}  // namespace ahm::viewer
