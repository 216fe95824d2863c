#include "input/unit_guess.hpp"

#include "ahm/util/vec.hpp"

namespace ahm::app {

UnitGuess guess_unit(std::string_view format, const Vec3& low, const Vec3& high) {
  const double diagonal = distance(low, high);
  const double east = low[0] / 2 + high[0] / 2, north = low[1] / 2 + high[1] / 2;
  if (format.starts_with("glTF")) return {"metres", "glTF counts in metres"};
  if (std::hypot(east, north) > 1e5 && std::hypot(east, north) > 20 * diagonal && diagonal > 1)
    return {"metres", "the coordinates look like those of a map projection"};
  if (format.starts_with("LAS")) return {"metres", "surveys are in metres as a rule"};
  if (format.starts_with("PCD") && diagonal > 0.02 && diagonal < 1e4) return {"metres", "PCD files are as a rule"};
  if (format.starts_with("STL") && diagonal > 1 && diagonal < 1e4)
    return {"millimetres", "STL files of parts are as a rule"};
  return {};
}

}  // namespace ahm::app
