// The worked example of docs/guides/own_graphs.md quotes the source of this backend as it is.
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
#include <string>

namespace ahm::test {
namespace {

std::string read(const std::string& path) {
  std::ifstream file(path);
  EXPECT_TRUE(file) << path;
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

TEST(WorkedExample, QuotesTheSourceAsItIs) {
  const std::string source = read(AHM_ROOT "/backends/grid/src/grid_graph.cpp"),
                    page = read(AHM_ROOT "/docs/guides/own_graphs.md"), opening = "```cpp grid_graph.cpp\n";
  int quotations = 0;
  for (auto at = page.find(opening); at != std::string::npos; at = page.find(opening, at)) {
    at += opening.size();
    const std::string quotation = page.substr(at, page.find("```", at) - at);
    EXPECT_NE(source.find(quotation), std::string::npos) << quotation;
    ++quotations;
  }
  EXPECT_GT(quotations, 0);
}

}  // namespace
}  // namespace ahm::test
