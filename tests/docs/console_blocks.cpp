// Every ```console block shows commands after `$ ` and their output. The commands are run in order, in one folder per
// document, and must print the output shown. `exit=2` on the fence states the exit code of the block's last command;
// `needs=scipy` that the block is for computers which have this program or module of Python.
#include <cstdlib>
#include <iostream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <tests/docs/blocks.hpp>
#include <tests/docs/process.hpp>
#include <tests/docs/shown_text.hpp>

namespace continuo::docs {
namespace {

struct Example {
  std::string command, expected;
};

std::vector<Example> examples_of(const Block& block) {
  std::vector<Example> examples;
  std::istringstream lines(block.text);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("$ ")) {
      examples.push_back({line.substr(2), ""});
    } else if (!examples.empty() && examples.back().command.ends_with("\\")) {
      examples.back().command += "\n" + line;
    } else if (!examples.empty()) {
      examples.back().expected += line + "\n";
    }
  }
  return examples;
}

bool is_there(const std::string& name) {
  static std::map<std::string, bool> known;
  const auto [entry, is_new] = known.emplace(name, false);
  if (is_new) {
    const std::string test = "command -v " + name + " || python3 -c 'import " + name + "'";
    entry->second = run_in(CONTINUO_DOCS_SCRATCH, test).exit_code == 0;
  }
  return entry->second;
}

class Document : public testing::TestWithParam<std::filesystem::path> {};

TEST_P(Document, ShowsWhatTheCommandsPrint) {
  std::vector<Block> blocks;
  for (const Block& block : blocks_of(GetParam())) {
    if (block.language == "console" || block.tags.contains("file")) blocks.push_back(block);
  }
  const auto folder =
      fresh_folder("console_" + GetParam().parent_path().filename().string() + "_" + GetParam().stem().string());
  for (const Block& block : blocks) {
    SCOPED_TRACE(block.place());
    if (block.tags.contains("file")) {
      run_in(folder, "cat > '" + block.tags.at("file") + "' <<'END_OF_BLOCK'\n" + block.text + "END_OF_BLOCK");
      continue;
    }
    if (block.tags.contains("needs") && !is_there(block.tags.at("needs"))) {
      std::cout << block.place() << " was not run: there is no " << block.tags.at("needs") << "\n";
      continue;
    }
    const auto examples = examples_of(block);
    for (std::size_t i = 0; i < examples.size(); ++i) {
      const Finished finished = run_in(folder, examples[i].command);
      const bool last = i + 1 == examples.size();
      const int expected_code = last && block.tags.contains("exit") ? std::atoi(block.tags.at("exit").c_str()) : 0;
      EXPECT_EQ(finished.exit_code, expected_code) << "$ " << examples[i].command << "\n" << finished.printed;
      EXPECT_TRUE(shows(examples[i].expected, finished.printed))
          << "$ " << examples[i].command << "\nthe document shows\n"
          << examples[i].expected << "and the command printed\n"
          << finished.printed;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Documentation, Document, testing::ValuesIn(documentation()),
                         [](const auto& information) { return test_name({information.param, 0, "", {}, ""}); });

}  // namespace
}  // namespace continuo::docs
