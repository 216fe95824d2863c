// Floating-point numbers from text, where the standard library has no std::from_chars for them.
#include "ahm/util/from_chars.hpp"

#include <gtest/gtest.h>

#include <charconv>
#include <cstring>
#include <string_view>

namespace ahm::test {
namespace {

template <class Real>
void expect_as_standard(std::string_view word) {
  Real expected = 7, found = 7;
  const char *first = word.data(), *last = first + word.size();
  const auto wanted = std::from_chars(first, last, expected), got = detail::from_chars_by_strtod(first, last, found);
  EXPECT_EQ(got.ec, wanted.ec) << word;
  EXPECT_EQ(got.ptr - first, wanted.ptr - first) << word;
  EXPECT_EQ(std::memcmp(&found, &expected, sizeof(Real)), 0) << word << ": " << found << ", " << expected;
}

TEST(FromChars, ByStrtodIsThatOfTheStandardLibrary) {
  for (const std::string_view word :
       {"",       "-",      "+1",     " 1",   "1 ",    "1",         "-0",     "0.1",
        "-2.5e3", "1e",     "1e+",    "1e5x", ".5",    "5.",        ".",      "0x10",
        "-0X1p3", "--1",    "-+1",    "- 1",  "1e400", "-1e400",    "1e-400", "1e-310",
        "1e-40",  "3.4e38", "3.5e38", "1,5",  "inf",   "-Infinity", "nan",    "0.1234567890123456789",
        "e5",     "x"}) {
    expect_as_standard<double>(word);
    expect_as_standard<float>(word);
  }
}

}  // namespace
}  // namespace ahm::test
