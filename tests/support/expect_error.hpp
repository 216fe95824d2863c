/// \file
<<<<<<< HEAD
/// Checks the type and the text of an error.
=======
/// Checks the type and the message of an exception.
>>>>>>> tio
#pragma once

#include <gtest/gtest.h>

#include <string>

namespace ahm::test {

/// Expects that the call throws an Exception whose message contains `text`.
template <class Exception, class Call>
void expect_error(const Call& call, const std::string& text) {
  try {
    call();
<<<<<<< HEAD
    ADD_FAILURE() << "no error; expected one that contains: " << text;
=======
    ADD_FAILURE() << "no error; expected: " << text;
>>>>>>> tio
  } catch (const Exception& e) {
    EXPECT_NE(std::string(e.what()).find(text), std::string::npos) << e.what();
  }
}

}  // namespace ahm::test
