/// \file
/// Errors of a type that say what they must.
#pragma once

#include <gtest/gtest.h>

#include <string>

namespace ahm::test {

/// The call throws an Exception whose text holds `text`.
template <class Exception, class Call>
void expect_error(const Call& call, const std::string& text) {
  try {
    call();
    ADD_FAILURE() << "no error; expected one that says: " << text;
  } catch (const Exception& e) {
    EXPECT_NE(std::string(e.what()).find(text), std::string::npos) << e.what();
  }
}

}  // namespace ahm::test
