/// \file
/// Runs a program, and hears it out.
#pragma once

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <string>

namespace ahm::test {

/// What it says on both streams. @param status  that it must end with
inline std::string said_by(const std::string& command, int status = 0) {
  std::FILE* const pipe = ::popen((command + " 2>&1").c_str(), "r");
  EXPECT_NE(pipe, nullptr);
  if (pipe == nullptr) return {};
  std::string text;
  for (std::array<char, 400> part{}; const std::size_t length = std::fread(part.data(), 1, part.size(), pipe);)
    text.append(part.data(), length);
  EXPECT_EQ(WEXITSTATUS(::pclose(pipe)), status) << text;
  return text;
}

}  // namespace ahm::test
