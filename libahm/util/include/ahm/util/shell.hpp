/// \file
/// Quoting for command lines in messages, which users copy into a shell. Not part of the public interface.
#pragma once

#include <string>
#include <string_view>

namespace ahm::detail {

/// The text in single quotes, escaped for POSIX shells.
inline std::string in_quotes(std::string_view text) {
  std::string result = "'";
  for (const char c : text) c == '\'' ? result.append("'\\''") : result.append(1, c);
  return result + "'";
}

/// The word, in quotes if it contains characters that are special to a shell.
inline std::string shell_word(std::string_view word) {
  constexpr std::string_view plain = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_-./,:=+@%";
  const bool is_plain = !word.empty() && word.find_first_not_of(plain) == std::string_view::npos;
  return is_plain ? std::string(word) : in_quotes(word);
}

}  // namespace ahm::detail
