/// \file
/// Words of command lines that people copy. Not part of the public interface.
#pragma once

#include <string>
#include <string_view>

namespace ahm::detail {

/// In single quotes, as every shell reads it.
inline std::string in_quotes(std::string_view text) {
  std::string result = "'";
  for (const char c : text) c == '\'' ? result.append("'\\''") : result.append(1, c);
  return result + "'";
}

/// In quotes where a shell would take the word apart.
inline std::string shell_word(std::string_view word) {
  constexpr std::string_view plain = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-./,:=+@%";
  const bool is_plain = !word.empty() && word.find_first_not_of(plain) == std::string_view::npos;
  return is_plain ? std::string(word) : in_quotes(word);
}

}  // namespace ahm::detail
