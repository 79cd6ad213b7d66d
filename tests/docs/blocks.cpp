#include <algorithm>
#include <cctype>
#include <fstream>
#include <regex>
#include <sstream>
#include <stdexcept>
#include <string_view>

#include <tests/docs/blocks.hpp>

namespace continuo::docs {
namespace {

constexpr std::string_view fence = "```";

void read_information(const std::string& information, Block& block) {
  std::istringstream words(information);
  words >> block.language;
  for (std::string word; words >> word;) {
    const auto equals = word.find('=');
    block.tags[word.substr(0, equals)] = equals == std::string::npos ? "" : word.substr(equals + 1);
  }
}

}  // namespace

std::string Block::place() const {
  return file.filename().string() + ":" + std::to_string(line);
}

std::vector<Block> blocks_of(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::vector<Block> blocks;
  bool inside = false;
  int number = 0;
  for (std::string line; std::getline(in, line);) {
    ++number;
    const bool is_fence = line.starts_with(fence);
    if (is_fence && !inside) {
      blocks.push_back({file, number, "", {}, ""});
      read_information(line.substr(fence.size()), blocks.back());
    } else if (!is_fence && inside) {
      blocks.back().text += line + "\n";
    }
    if (is_fence) inside = !inside;
  }
  if (inside) throw std::runtime_error(blocks.back().place() + ": this block is never closed");
  return blocks;
}

std::string prose_of(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::string prose;
  bool inside = false;
  for (std::string line; std::getline(in, line);) {
    const bool is_fence = line.starts_with(fence);
    if (!is_fence && !inside) prose += line + "\n";
    if (is_fence) inside = !inside;
  }
  static const std::regex code("`[^`\n]*`");
  return std::regex_replace(prose, code, "");
}

std::vector<std::filesystem::path> documentation() {
  const std::filesystem::path root = CONTINUO_SOURCE_DIR;
  std::vector<std::filesystem::path> files{root / "README.md", root / "models/README.md"};
  for (const auto& entry : std::filesystem::directory_iterator(root / "docs")) {
    if (entry.path().extension() == ".md") files.push_back(entry.path());
  }
  std::ranges::sort(files);
  return files;
}

std::vector<Block> blocks_in_documentation(const std::string& language) {
  std::vector<Block> all;
  for (const auto& file : documentation()) {
    for (Block& block : blocks_of(file)) {
      if (block.language == language) all.push_back(std::move(block));
    }
  }
  return all;
}

std::string test_name(const Block& block) {
  std::string name = block.file.parent_path().filename().string() + "_" + block.file.stem().string() + "_line_" +
                     std::to_string(block.line);
  std::ranges::replace_if(name, [](unsigned char c) { return std::isalnum(c) == 0; }, '_');
  return name;
}

}  // namespace continuo::docs
