/// \file
/// Checks the type and the message of an exception.
#pragma once

#include <gtest/gtest.h>

#include <string>

namespace ahm::test {

/// Expects that the call throws an Exception whose message contains `text`.
template <class Exception, class Call>
void expect_error(const Call& call, const std::string& text) {
  try {
    call();
    ADD_FAILURE() << "no error; expected: " << text;
  } catch (const Exception& e) {
    EXPECT_NE(std::string(e.what()).find(text), std::string::npos) << e.what();
  }
}

}  // namespace ahm::test
