/// \file
/// std::from_chars for floating-point numbers, also where the standard library has it for integers only (libc++ before 20). Not part of
/// the public interface.
#pragma once

#include <cerrno>
#include <charconv>
#include <clocale>
#include <cstdlib>
#include <string>
#include <system_error>
#include <type_traits>
#include <version>
#ifdef __APPLE__
#include <xlocale.h>
#endif

namespace ahm::detail {

/// As std::from_chars, by strtod in the C locale.
template <class Real>
std::from_chars_result from_chars_by_strtod(const char* first, const char* last, Real& value) {
  static_assert(std::is_same_v<Real, double> || std::is_same_v<Real, float>);
  static const locale_t c_locale = newlocale(LC_ALL_MASK, "C", nullptr);
  std::string text(first, last);
  const std::size_t sign = text.starts_with('-') ? 1 : 0;
  // strtod also accepts these, std::from_chars does not.
  if (text.find_first_of(" \t\n\v\f\r+", sign) == sign || text.find('-', sign) == sign)
    return {first, std::errc::invalid_argument};
  if (text.size() > sign + 1 && (text[sign + 1] == 'x' || text[sign + 1] == 'X')) text.resize(sign + 1);
  char* end = nullptr;
  errno = 0;
  Real result;
  if constexpr (std::is_same_v<Real, float>)
    result = strtof_l(text.c_str(), &end, c_locale);
  else
    result = strtod_l(text.c_str(), &end, c_locale);
  if (end == text.c_str()) return {first, std::errc::invalid_argument};
  const char* const stop = first + (end - text.c_str());
  // Subnormal results are in range.
  if (errno == ERANGE && (result == 0 || result > 1 || result < -1)) return {stop, std::errc::result_out_of_range};
  value = result;
  return {stop, std::errc{}};
}

/// The number at the start of [first, last), as std::from_chars.
template <class Real>
std::from_chars_result from_chars(const char* first, const char* last, Real& value) {
#ifdef __cpp_lib_to_chars
  return std::from_chars(first, last, value);
#else
  return from_chars_by_strtod(first, last, value);
#endif
}

}  // namespace ahm::detail
