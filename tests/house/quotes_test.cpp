// Pages quote sources as they are: the worked example of docs/guides/own_graphs.md, and the tasks of docs/tutorial.md.
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

/// Without the indentation of the body of a function.
std::string dedented(std::string text) {
  for (auto at = text.find("\n  "); at != std::string::npos; at = text.find("\n  ", at + 1)) text.erase(at + 1, 2);
  return text;
}

/// @param opening  first line of the quotations
void expect_quotations(const std::string& page, const std::string& opening, const std::string& source) {
  int quotations = 0;
  for (auto at = page.find(opening); at != std::string::npos; at = page.find(opening, at)) {
    at += opening.size();
    const std::string quotation = page.substr(at, page.find("```", at) - at);
    EXPECT_NE(source.find(quotation), std::string::npos) << quotation;
    ++quotations;
  }
  EXPECT_GT(quotations, 0);
}

TEST(WorkedExample, QuotesTheSourceAsItIs) {
  expect_quotations(read(AHM_ROOT "/docs/guides/own_graphs.md"), "```cpp grid_graph.cpp\n",
                    read(AHM_ROOT "/backends/grid/src/grid_graph.cpp"));
}

TEST(Tutorial, QuotesTheTasksAsTheyAreCompiled) {
  expect_quotations(read(AHM_ROOT "/docs/tutorial.md"), "```cpp 14_tasks.cpp\n",
                    dedented(read(AHM_ROOT "/examples/14_tasks.cpp")));
}

}  // namespace
}  // namespace ahm::test
