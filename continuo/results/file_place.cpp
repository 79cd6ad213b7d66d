// Follows the links of a path, and asks the system for the file behind it.
#include <charconv>
#include <string_view>
#include <system_error>

#include <sys/stat.h>
#include <unistd.h>

#include <continuo/results/file_place.hpp>

namespace continuo::results {
namespace {

namespace fs = std::filesystem;

/// "/dev/fd/3" and its like: the open file that they name. Opening such a name would empty a file that somebody else
/// appends to.
std::optional<int> descriptor_of(std::string_view path) {
  if (path == "-" || path == "/dev/stdout") return STDOUT_FILENO;
  if (path == "/dev/stderr") return STDERR_FILENO;
  for (const std::string_view folder : {"/dev/fd/", "/proc/self/fd/"}) {
    if (!path.starts_with(folder)) continue;
    const char *const begin = path.data() + folder.size(), *const end = path.data() + path.size();
    int number = 0;
    const auto read = std::from_chars(begin, end, number);
    if (read.ec == std::errc() && read.ptr == end && number >= 0) return number;
  }
  return std::nullopt;
}

/// The path behind links. A link that leads to nothing is followed as well: what is written through it lies there.
fs::path behind_links(fs::path path) {
  constexpr int most_links = 40;                                                    // as the system has it
  if (!path.has_filename() && path.has_relative_path()) path = path.parent_path();  // frames/ is frames
  std::error_code error;
  for (int links = 0; links < most_links && fs::is_symlink(path, error); ++links) {
    const fs::path target = fs::read_symlink(path, error);
    if (error) break;
    path = target.is_absolute() ? target : path.parent_path() / target;
  }
  const fs::path whole = fs::absolute(path, error);
  const fs::path folder = fs::weakly_canonical(whole.parent_path(), error);
  return (error ? whole : folder / whole.filename()).lexically_normal();
}

void take(const struct stat& found, FilePlace& place) {
  using Kind = FilePlace::Kind;
  place.kind = S_ISREG(found.st_mode) ? Kind::file : S_ISDIR(found.st_mode) ? Kind::folder : Kind::stream;
  place.number.emplace(static_cast<std::uint64_t>(found.st_dev), static_cast<std::uint64_t>(found.st_ino));
}

}  // namespace

bool operator==(const FilePlace& a, const FilePlace& b) {
  if (a.kind == FilePlace::Kind::stream || b.kind == FilePlace::Kind::stream) return false;
  if (a.number && b.number) return a.number == b.number;
  return !a.path.empty() && a.path == b.path;
}

FilePlace place_of_open(int descriptor) {
  FilePlace place{.kind = FilePlace::Kind::stream, .descriptor = descriptor};
  struct stat found{};
  if (::fstat(descriptor, &found) == 0) take(found, place);
  return place;
}

FilePlace place_of(const std::string& path) {
  if (const auto descriptor = descriptor_of(path)) return place_of_open(*descriptor);
  FilePlace place{.path = behind_links(path)};
  struct stat found{};
  if (::stat(path.c_str(), &found) == 0) take(found, place);
  return place;
}

}  // namespace continuo::results
