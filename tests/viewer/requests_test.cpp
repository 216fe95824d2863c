// Bodies that no page sends.
#include <gtest/gtest.h>

#include "sphere.hpp"

namespace ahm::viewer::test {
namespace {

TEST(ViewerRequests, SurviveEveryBody) {
  const Sphere sphere(2);
  const Session session(sphere.surface, sphere.geometry, sphere_options());
  std::vector<std::string> bodies{"",
                                  "{",
                                  "null",
                                  "[]",
                                  "3",
                                  "\"map\"",
                                  std::string(100'000, '['),
                                  std::string(1000, '\0'),
                                  "\xff\xfe{}",
                                  R"({"client": 3})",
                                  R"({"client": null})",
                                  R"({"client": "a", "source": {"row": 1e999}})",
                                  R"({"client": "a", "source": {"row": 18446744073709551615}})",
                                  R"({"client": "a", "source": {"face": 0, "weights": [1e308, -1e308, 1]}})",
                                  R"({"client": ")" + std::string(65, 'a') + R"(", "source": {"row": 0}})"};
  std::string deep = R"({"client": "a", "source": )";
  for (int k = 0; k < 50'000; ++k) deep += R"({"row":)";
  bodies.push_back(deep + "0" + std::string(50'000, '}') + "}");
  std::mt19937 random(1);
  for (int k = 0; k < 200; ++k) {
    std::string noise(random() % 200, ' ');
    for (char& c : noise) c = static_cast<char>(random());
    bodies.push_back(noise);
  }
  for (const char* name : {"map", "stroke", "path", "coverage", "export"})
    for (const std::string& body : bodies) {
      const Answer answer = session.answer(name, body);
      EXPECT_EQ(answer.status, 400) << name << ' ' << body.substr(0, 60);
      EXPECT_TRUE(json::parse(answer.body).contains("error"));
    }
  EXPECT_EQ(session.answer("map", R"({"client": "a", "source": {"row": 0}})").status, 200);
}

}  // namespace
}  // namespace ahm::viewer::test
