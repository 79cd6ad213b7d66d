// tests/architecture/source_tree.hpp
// The sources below a root as text: what they include, and which module and folder they lie in.
//
//   const SourceTree tree(root);
//   tree.upward_includes();  // "continuo/solve/steps/a.hpp includes continuo/solve/driver/b.hpp, a folder above its
//   own"
#pragma once
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace continuo::architecture {

std::string text_of(const std::filesystem::path& file);
/// The lines that the preprocessor reads.
std::string directives_of(const std::string& text);
/// First group of every match.
std::vector<std::string> all_matches(const std::string& text, const char* pattern);
/// .hpp and .cpp, in all folders below.
std::vector<std::filesystem::path> sources_below(const std::filesystem::path& folder);

struct Module {
  std::string path;                  // "continuo/solve"
  std::vector<std::string> folders;  // lowest first, as CMake has them: "steps", "check/world"
};

class SourceTree {
 public:
  explicit SourceTree(const std::filesystem::path& root);

  /// Lowest first: the modules of continuo_library in CMakeLists.txt, then the command.
  const std::vector<Module>& modules() const { return modules_; }

  /// An include of a module above; of a folder above within a module, or of a public header that leads to one; a module
  /// or folder that CMake does not name. Public headers themselves, and their sources, may use all of their module.
  std::vector<std::string> upward_includes() const;

  /// Folders with too many subjects (a header with its source is one) or files for a reader to survey.
  std::vector<std::string> crowded_folders(std::size_t most_subjects, std::size_t most_files) const;

  /// The .cpp files without a comment at their top, or with one that contains only their own path.
  std::vector<std::string> sources_without_purpose() const;

 private:
  struct Place {
    std::size_t module;  // its number
    std::string folder;  // within that; empty: public
  };
  /// Empty if CMake has no such module.
  std::vector<Place> place_of(const std::string& file) const;
  std::size_t number_of(const Place& place) const;
  void follow(const std::string& file, const std::string& from, const Place& own, std::vector<std::string>& seen,
              std::vector<std::string>& faults) const;

  std::filesystem::path root_;
  std::vector<Module> modules_;
  std::map<std::string, std::vector<std::string>> includes_;  // of every source in continuo/ and apps/, from the root
};

}  // namespace continuo::architecture
