/// \file
/// A temporary folder for one test.
#pragma once

#include "ahm/io/temporary_folder.hpp"

namespace ahm::test {

class TemporaryFolder : public ahm::io::TemporaryFolder {
 public:
  TemporaryFolder() : ahm::io::TemporaryFolder("ahm_test_") {}
};

}  // namespace ahm::test
