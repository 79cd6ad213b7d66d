// continuo/language/check/declarations/folder_file.cpp
// Opens a file of a folder one part of its name after the other, following no link: each part is looked up in the
// folder that was opened before, so that a folder exchanged for a link in the meantime leads nowhere else.
#include <array>
#include <cerrno>
#include <cstddef>
#include <filesystem>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <continuo/language/check/declarations/folder_file.hpp>

namespace continuo::model::detail {

namespace {

constexpr std::size_t largest_file = std::size_t{64} << 20;

class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
  }
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  [[nodiscard]] int number() const { return number_; }
  explicit operator bool() const { return number_ >= 0; }

 private:
  int number_;
};

Status refused(const std::string& name, std::string_view why) {
  return {.ending = Ending::unreadable, .message = std::string(why), .place = name};
}

bool is_regular(int file) {
  struct stat about{};
  return ::fstat(file, &about) == 0 && S_ISREG(about.st_mode) &&
         static_cast<std::size_t>(about.st_size) <= largest_file;
}

Result<std::string> read_all(int file, const std::string& name) {
  std::string text;
  std::array<char, 65536> part{};
  while (text.size() <= largest_file) {
    const ssize_t count = ::read(file, part.data(), part.size());
    if (count == 0) return text;
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return refused(name, "the file cannot be read");
    text.append(part.data(), static_cast<std::size_t>(count));
  }
  return refused(name, "the file is too large");
}

}  // namespace

Result<std::string> read_from_folder(const std::string& folder, const std::string& name) {
  const std::filesystem::path path(name);
  if (path.is_absolute() || name.find('\0') != std::string::npos)
    return refused(name, "files are read only from the model's folder");
  Descriptor here(::open(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  for (auto part = path.begin(); here && part != path.end(); ++part) {
    if (*part == "..") return refused(name, "files are read only from the model's folder");
    if (part->empty() || *part == ".") continue;
    const bool is_last = std::next(part) == path.end();
    // What is no file is not even opened, where that can be told; a pipe would wait for who writes to it.
    struct stat about{};
    if (is_last && ::fstatat(here.number(), part->c_str(), &about, AT_SYMLINK_NOFOLLOW) == 0 && !S_ISREG(about.st_mode))
      return refused(name, "this is no file; links are not followed");
    const int kind = is_last ? O_NONBLOCK | O_NOCTTY : O_DIRECTORY;
    here = Descriptor(::openat(here.number(), part->c_str(), O_RDONLY | O_NOFOLLOW | O_CLOEXEC | kind));
  }
  if (!here) {
    const bool absent = errno == ENOENT;
    return refused(name, absent ? "there is no such file in the model's folder" : "the file cannot be read");
  }
  if (!is_regular(here.number())) return refused(name, "this is no file, or it is too large");
  return read_all(here.number(), name);
}

}  // namespace continuo::model::detail
