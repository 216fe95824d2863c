#include "read/skipped_lines.hpp"

#include <algorithm>

#include "ahm/util/text.hpp"
#include "read/input.hpp"

namespace ahm::io {

bool has_control_characters(std::string_view text) noexcept {
  return std::ranges::any_of(text, [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return (byte < ' ' && (byte < '\t' || byte > '\r')) || byte == 127;
  });
}

bool is_remark(std::string_view line) noexcept {
  const std::size_t first = line.find_first_not_of(" \t");
  constexpr std::string_view marks = "#$%&*/:;<=>?@\\^`|~!";
  return first != std::string_view::npos && marks.find(line[first]) != std::string_view::npos &&
         !has_control_characters(line);
}

void SkippedLines::add(std::int64_t number, std::string_view line) {
  if (count_++ > 0) return;
  first_ = number;
  text_ = in_quotes(line);
}

void SkippedLines::report(std::vector<Warning>& warnings) const {
  if (count_ == 0) return;
  warnings.push_back({"lines_skipped", {static_cast<double>(count_), static_cast<double>(first_)}, {}, text_});
}

std::string SkippedLines::hint() const {
  if (count_ == 0) return {};
  return "; not understood: " + detail::counted(count_, "line") + ", the first is line " + std::to_string(first_) +
         ": " + text_;
}

}  // namespace ahm::io
