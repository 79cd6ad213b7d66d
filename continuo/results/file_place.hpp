// continuo/results/file_place.hpp
// Where a file of some name lies: the file behind links, and what kind of place it is. Two names are of one file where
// their places are equal.
//
//   if (place_of("link.csv") == place_of("./ball.csv")) ...   // also of files that are not there yet
#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>

namespace continuo::results {

/// The place of a file, which all of its names share.
struct FilePlace {
  /// A file on a disk, or none yet; a device or a pipe, which takes what comes; or a folder.
  enum class Kind { file, stream, folder };
  Kind kind = Kind::file;
  std::filesystem::path path{};     // absolute, without links; of "-" and its like empty
  std::optional<int> descriptor{};  // of "-", /dev/stdout, /dev/fd/3: the open file that is meant
  std::optional<std::pair<std::uint64_t, std::uint64_t>> number{};  // device and file, where there is one already

  /// Whether both are one file on a disk. Streams take what comes: no two of them are.
  friend bool operator==(const FilePlace& a, const FilePlace& b);
};

/// Links are followed, also those that lead to nothing yet. "-" is standard output.
[[nodiscard]] FilePlace place_of(const std::string& path);

/// That of an open file: whether standard output goes into a file on a disk, and into which.
[[nodiscard]] FilePlace place_of_open(int descriptor);

}  // namespace continuo::results
