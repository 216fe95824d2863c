// Manual pages and completions: they have every option of the help.
#include <cstdlib>
#include <regex>

#include "program.hpp"

namespace ahm::test {
namespace {

Words matches(const std::string& text, const std::string& pattern) {
  const std::regex expression(pattern);
  Words result;
  for (std::sregex_iterator at(text.begin(), text.end(), expression), end; at != end; ++at) result.push_back((*at)[1]);
  return result;
}

Words subcommands() { return matches(run("--help").out, "\n  ([a-z][a-z-]*) {2,}[A-Z]"); }

Words options(const std::string& subcommand) {
  return matches(run(subcommand + " --help").out, "\n  (?:-[a-z],)?(--[a-z0-9-]+)");
}

using Manual = InFolder;

TEST_F(Manual, HasEveryOptionOfTheHelp) {
  const auto page = [](const std::string& command) {
    std::string text = run_ok(command).out;
    std::erase(text, '\\');
    return text;
  };
  const std::string overview = page("manual");
  ASSERT_GE(subcommands().size(), 10U);
  for (const std::string& name : subcommands()) {
    EXPECT_TRUE(has(overview, "fBahm-" + name + "fR"));
    const std::string text = page("manual " + name);
    ASSERT_GE(options(name).size(), 3U) << name;
    for (const std::string& option : options(name)) EXPECT_TRUE(has(text, option + "fR")) << name;
  }
}

using Completion = InFolder;

TEST_F(Completion, HasEveryOptionOfTheHelp) {
  const std::string bash = run_ok("completion bash").out, zsh = run_ok("completion zsh").out,
                    fish = run_ok("completion fish").out;
  for (const std::string& name : subcommands()) {
    const std::string label = "\n    " + name + ") ";
    ASSERT_TRUE(has(bash, label));
    ASSERT_TRUE(has(zsh, label));
    const std::string in_bash = bash.substr(bash.find(label)), in_zsh = zsh.substr(zsh.find(label)),
                      words = in_bash.substr(0, in_bash.find(";;")), arguments = in_zsh.substr(0, in_zsh.find(";;"));
    for (const std::string& option : options(name)) {
      EXPECT_TRUE(std::regex_search(words, std::regex("[ ']" + option + "[ ']"))) << name << " " << option;
      EXPECT_TRUE(has(arguments, "'" + option + "[")) << name;
      EXPECT_TRUE(std::regex_search(fish, std::regex("from " + name + "'[^\n]* -l " + option.substr(2) + " ")))
          << name << " " << option;
    }
  }
}

/// Completions that bash offers for the last of some words.
std::string offered(const std::string& words) {
  write("ahm.bash", run("completion bash").out);
  std::system(("bash -c 'source ./ahm.bash; COMP_WORDS=(" + words +
               "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _ahm; echo \"${COMPREPLY[*]}\"' > offered.txt")
                  .c_str());
  const std::string text = read_text("offered.txt");
  return text.substr(0, text.find('\n'));
}

TEST_F(Completion, OffersTheValuesOfAnOption) {
  if (std::system("bash -c 'type compgen' >/dev/null 2>&1") != 0) GTEST_SKIP() << "there is no bash";
  EXPECT_EQ(offered("ahm logmap --method \"\""), "auto heat polar exact");
  EXPECT_EQ(offered("ahm logmap --method e"), "exact");
  EXPECT_EQ(offered("ahm logmap --method = e"), "exact");
  EXPECT_EQ(offered("ahm logmap --method ="), "auto heat polar exact");
  EXPECT_EQ(offered("ahm coverage --pattern s"), "spiral");
  EXPECT_EQ(offered("ahm logmap --output ahm"), "ahm.bash");
  EXPECT_EQ(offered("ahm logm"), "logmap");
  const std::string zsh = run("completion zsh").out, fish = run("completion fish").out;
  EXPECT_TRUE(has(zsh, ":(heat exact)'"));
  EXPECT_TRUE(has(fish, " -l method -x -a 'heat exact' -d "));
}

}  // namespace
}  // namespace ahm::test
