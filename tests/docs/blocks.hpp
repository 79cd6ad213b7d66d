// tests/docs/blocks.hpp
// The fenced code blocks of a Markdown text:
//
//   ```sim error=E201        language "sim", tags {"error": "E201"}
//   x' = ...
//   ```
#pragma once
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace continuo::docs {

struct Block {
  std::filesystem::path file;
  int line;  // of the opening fence, from 1
  std::string language;
  std::map<std::string, std::string> tags;  // "name=value", or "name" with an empty value
  std::string text;

  std::string place() const;  // "language.md:12"
};

/// Every fenced block of one file, in order. Throws std::runtime_error where a fence is never closed.
std::vector<Block> blocks_of(const std::filesystem::path& file);

/// The text outside of code: without blocks, and without `code` in lines.
std::string prose_of(const std::filesystem::path& file);

/// Every block of one language in README.md, models/README.md and docs/*.md.
std::vector<Block> blocks_in_documentation(const std::string& language);

/// The documentation: README.md, models/README.md and docs/*.md, sorted.
std::vector<std::filesystem::path> documentation();

/// The name of a parameterised test: letters, digits and underscores only.
std::string test_name(const Block& block);

}  // namespace continuo::docs
