/// \file
/// Formats numbers for messages. Not part of the public interface.
#pragma once

#include <cmath>
#include <concepts>
#include <cstdio>
#include <string>
#include <string_view>

namespace ahm::detail {

/// The number with six significant digits.
inline std::string number(double value) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.6g", value);
  return buffer;
}

/// Formats a number of bytes as "1.23 GB".
inline std::string gigabytes(double bytes) { return number(std::round(bytes / 1e7) / 100) + " GB"; }

/// The plural of a noun: "faces", "vertices", "entries".
inline std::string plural(std::string_view noun) {
  if (noun == "vertex") return "vertices";
  return noun.ends_with('y') ? std::string(noun.substr(0, noun.size() - 1)) + "ies" : std::string(noun) + "s";
}

/// The singular of a verb: "is" of "are", "has" of "have", "uses" of "use".
inline std::string singular(std::string_view verb) {
  return verb == "are"    ? "is"
         : verb == "were" ? "was"
         : verb == "have" ? "has"
         : verb == "do"   ? "does"
                          : std::string(verb) + "s";
}

/// The form of a noun after a count: "face" after 1, otherwise "faces".
std::string noun_after(std::integral auto count, std::string_view noun) {
  return count == 1 ? std::string(noun) : plural(noun);
}

/// A count with its noun, and optionally a verb: "1 face", "2 faces", "1 face is", "2 faces are".
/// @param noun  in the singular
/// @param verb  in the plural
std::string counted(std::integral auto count, std::string_view noun, std::string_view verb = {}) {
  std::string text = std::to_string(count) + " " + noun_after(count, noun);
  if (!verb.empty()) text += " " + (count == 1 ? singular(verb) : std::string(verb));
  return text;
}

}  // namespace ahm::detail
