#include <charconv>
#include <cmath>

#include "write/writers.hpp"

namespace ahm::io {

void append_decimals(std::string& text, double value) {
  if (std::isnan(value)) {
    text += "nan";  // never "-nan", which some readers refuse
    return;
  }
  char digits[32];
  text.append(digits, std::to_chars(digits, digits + sizeof digits, value).ptr);
}

}  // namespace ahm::io
