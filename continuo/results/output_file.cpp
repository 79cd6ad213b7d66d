// Writes a file beside its name through a buffer that keeps the first failure, and renames it when it is whole.
#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <utility>

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <continuo/results/output_file.hpp>

namespace continuo::results {
namespace {

constexpr std::size_t buffer_bytes = 1 << 16;
constexpr std::chrono::seconds longest_in_memory{1};
constexpr int most_unfinished = 1000;  // of one name; whoever has so many wants no more
constexpr mode_t usual_mode = 0666;    // less what the umask takes away

/// The file keeps who may read it, and whose it is as far as we may say so.
void keep_permissions(int descriptor, const std::string& target) {
  struct stat known{};
  if (::stat(target.c_str(), &known) != 0) return;
  const bool ours = ::fchown(descriptor, known.st_uid, known.st_gid) == 0;
  if (::fchmod(descriptor, known.st_mode & (ours ? 07777 : 0777)) != 0) return;
}

}  // namespace

std::string unfinished_name(const std::string& path, int number, std::string_view other_ending) {
  std::filesystem::path name(path);
  const std::string ending = other_ending.empty() ? name.extension().string() : std::string(other_ending);
  name.replace_extension();
  return fmt::format("{}.unfinished{}{}", name.string(), number > 1 ? std::to_string(number) : "", ending);
}

std::string free_unfinished_name(const std::string& path) {
  std::error_code error;
  int number = 1;
  while (std::filesystem::exists(unfinished_name(path, number), error) && number < most_unfinished) ++number;
  return unfinished_name(path, number);
}

OutputFile::OutputFile(std::string path, Unfinished unfinished, std::string_view unfinished_ending)
    : path_(std::move(path)),
      unfinished_ending_(unfinished_ending),
      unfinished_(unfinished),
      place_(place_of(path_)),
      last_flush_(std::chrono::steady_clock::now()) {
  open();
}

OutputFile::~OutputFile() {
  end(false);
}

void OutputFile::open() {
  if (place_.descriptor) {
    if (*place_.descriptor == STDOUT_FILENO) std::fflush(stdout);
    descriptor_ = ::dup(*place_.descriptor);
  } else if (place_.kind == FilePlace::Kind::stream) {
    descriptor_ = ::open(path_.c_str(), O_WRONLY | O_CLOEXEC);
  } else if (place_.kind == FilePlace::Kind::folder) {
    return fail("it is a folder");
  } else {
    is_file_ = true;
    // Renaming would take the place of a file that is not to be written.
    if (place_.number && ::access(place_.path.c_str(), W_OK) != 0) return fail();
    if (!open_without_name() && !open_beside()) return fail();
    keep_permissions(descriptor_, place_.path.string());
  }
  if (descriptor_ < 0) fail();
}

/// A file that disappears with the program, where the disk knows such. Of a table it gets a name with its first rows.
bool OutputFile::open_without_name() {
  const std::string folder = place_.path.parent_path().string();
  descriptor_ = ::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, usual_mode);
  return descriptor_ >= 0;
}

/// What an earlier run has left stays.
bool OutputFile::open_beside() {
  for (int number = 1; number <= most_unfinished; ++number) {
    present_name_ = unfinished_name(place_.path.string(), number, unfinished_ending_);
    descriptor_ = ::open(present_name_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_CLOEXEC, usual_mode);
    if (descriptor_ >= 0) return true;
    if (errno != EEXIST) break;
  }
  present_name_.clear();
  return false;
}

void OutputFile::write(std::string_view bytes) {
  if (!status_) return;
  buffer_ += bytes;
  if (buffer_.size() >= buffer_bytes || std::chrono::steady_clock::now() - last_flush_ >= longest_in_memory) flush();
}

void OutputFile::overwrite(std::uint64_t at, std::string_view bytes) {
  flush();
  if (!is_file_) return fail("this format needs a file on a disk");
  if (status_) store(bytes, at);
}

void OutputFile::flush() {
  last_flush_ = std::chrono::steady_clock::now();
  if (descriptor_ >= 0 && status_ && !buffer_.empty()) {
    store(buffer_, stored_);
  }
  buffer_.clear();
}

void OutputFile::store(std::string_view bytes, std::uint64_t at) {
  while (!bytes.empty()) {
    const ssize_t count = is_file_ ? ::pwrite(descriptor_, bytes.data(), bytes.size(), static_cast<off_t>(at))
                                   : ::write(descriptor_, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return fail();
    bytes.remove_prefix(static_cast<std::size_t>(count));
    at += static_cast<std::uint64_t>(count);
    stored_ = std::max(stored_, at);
  }
  if (is_file_ && unfinished_ == Unfinished::kept && !name_beside()) fail();
}

void OutputFile::fail() {
  fail(std::strerror(errno));
}
void OutputFile::fail(const std::string& reason) {
  if (!status_) return;
  status_ = {.ending = Ending::unwritable,
             .message = "cannot write " + (path_ == "-" ? std::string("to standard output") : path_) + ": " + reason};
}

/// A file without a name gets one beside the wanted one.
bool OutputFile::name_beside() {
  const std::string open_file = fmt::format("/proc/self/fd/{}", descriptor_);
  for (int number = 1; present_name_.empty() && number <= most_unfinished; ++number) {
    const std::string beside = unfinished_name(place_.path.string(), number, unfinished_ending_);
    if (::linkat(AT_FDCWD, open_file.c_str(), AT_FDCWD, beside.c_str(), AT_SYMLINK_FOLLOW) == 0) {
      present_name_ = beside;
    } else if (errno != EEXIST) {
      return false;
    }
  }
  return !present_name_.empty();
}

bool OutputFile::give_name() {
  const std::string target = place_.path.string();
  if (!name_beside() || ::rename(present_name_.c_str(), target.c_str()) != 0) return false;
  present_name_ = target;
  return true;
}

void OutputFile::end(bool is_whole) {
  if (descriptor_ < 0) return;
  flush();
  // Before the older file goes, the new one is on the disk and not only on its way.
  bool has_name = false;
  if (is_whole && status_ && is_file_) {
    has_name = ::fsync(descriptor_) == 0 && give_name();
    if (!has_name) fail();
  }
  if (::close(descriptor_) != 0) fail();
  descriptor_ = -1;
  if (!is_file_ || has_name || present_name_.empty()) return;
  if (unfinished_ == Unfinished::kept && stored_ > 0) {
    if (!status_) status_.message += fmt::format("; what could be written is in {}", present_name());
    return;
  }
  ::unlink(present_name_.c_str());
  present_name_.clear();
}

Status OutputFile::close() {
  end(true);
  return status_;
}

Status OutputFile::leave() {
  end(false);
  return status_;
}

void OutputFile::discard() {
  unfinished_ = Unfinished::removed;
  end(false);
}

std::string OutputFile::present_name() const {
  const std::filesystem::path present(present_name_), path(path_);
  const bool is_beside = !present.empty() && place_.path.filename() == path.filename();
  return is_beside ? (path.parent_path() / present.filename()).string() : present_name_;
}

Status check_writable(const std::string& path) {
  const FilePlace place = place_of(path);
  if (place.descriptor) return {};
  const auto unwritable = [&](const std::string& reason) {
    return Status{.ending = Ending::unwritable, .message = fmt::format("cannot write {}: {}", path, reason)};
  };
  if (place.kind == FilePlace::Kind::folder) return unwritable("it is a folder");
  if (place.number && ::access(path.c_str(), W_OK) != 0) return unwritable(std::strerror(errno));
  const bool has_folder = place.kind != FilePlace::Kind::file || ::access(place.path.parent_path().c_str(), W_OK) == 0;
  return has_folder ? Status() : unwritable(std::strerror(errno));
}

Status write_file(const std::string& path, std::string_view text) {
  OutputFile file(path);
  file.write(text);
  return file.close();
}

}  // namespace continuo::results
