// continuo/live/session/write_file.cpp
// Writes a file whole or not at all, by a temporary one beside it.
#include <cerrno>
#include <cstring>
#include <filesystem>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <continuo/live/session/write_file.hpp>

namespace continuo::live {

namespace {

bool write_all(int file, std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = ::write(file, text.data(), text.size());
    if (written < 0 && errno != EINTR) return false;
    if (written > 0) text.remove_prefix(static_cast<std::size_t>(written));
  }
  return ::fsync(file) == 0;
}

}  // namespace

Status write_atomically(const std::string& path, std::string_view text) {
  const auto failure = [&] {
    return Status{.ending = Ending::unwritable,
                  .message = fmt::format("cannot write {}: {}", path, std::strerror(errno))};
  };
  std::error_code error;
  const std::filesystem::path real = std::filesystem::weakly_canonical(path, error);  // a link stays a link
  const std::string target = error ? path : real.string();
  struct stat known{};
  const mode_t mode = ::stat(target.c_str(), &known) == 0 ? known.st_mode & 07777 : 0644;
  std::string beside = target + ".XXXXXX";
  const int file = ::mkstemp(beside.data());
  if (file < 0) return failure();
  const bool written = write_all(file, text) && ::fchmod(file, mode) == 0;
  const bool closed = ::close(file) == 0;
  if (written && closed && ::rename(beside.c_str(), target.c_str()) == 0) return {};
  Status what = failure();
  ::unlink(beside.c_str());
  return what;
}

}  // namespace continuo::live
