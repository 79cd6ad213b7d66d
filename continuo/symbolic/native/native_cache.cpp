// Finds, keeps and evicts compiled code in the folder of the user, and tests whether that folder may be trusted.
#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <sstream>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <continuo/symbolic/native/native_cache.hpp>

namespace continuo::model {

namespace fs = std::filesystem;

namespace {

std::optional<std::string> read_whole(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) return std::nullopt;
  std::ostringstream text;
  text << stream.rdbuf();  // in blocks
  if (stream.bad()) return std::nullopt;
  return std::move(text).str();
}

std::string with_hash(std::string_view text, std::string_view shared_object) {
  return fmt::format("{}\n/* machine code: {} bytes, {:016x} */\n", text, shared_object.size(),
                     fnv_hash(shared_object));
}

/// Under its name only when it is whole. Any number of threads and processes may write the same file.
bool write_whole(const fs::path& target, std::string_view bytes) {
  std::string unfinished = target.string() + ".XXXXXX";
  const int file = mkstemp(unfinished.data());  // for its owner alone
  if (file < 0) return false;
  bool fine = true;
  for (std::string_view left = bytes; fine && !left.empty();) {
    const ssize_t written = write(file, left.data(), left.size());
    fine = written > 0;
    if (fine) left.remove_prefix(static_cast<std::size_t>(written));
  }
  fine = close(file) == 0 && fine;
  std::error_code error, ignored;
  if (fine) fs::rename(unfinished, target, error);
  fine = fine && !error;
  if (!fine) fs::remove(unfinished, ignored);
  return fine;
}

/// A regular file of this user that nobody else can write.
bool is_own_file(const fs::path& file) {
  struct stat info = {};
  return lstat(file.c_str(), &info) == 0 && S_ISREG(info.st_mode) && info.st_uid == geteuid() &&
         (info.st_mode & (S_IWGRP | S_IWOTH)) == 0;
}

Status untrusted(const fs::path& folder, std::string_view why) {
  return {.ending = Ending::unreadable,
          .message = fmt::format("machine code is not loaded from {}: {}", folder.string(), why)};
}

}  // namespace

std::uint64_t fnv_hash(std::string_view bytes, std::uint64_t start) {
  std::uint64_t hash = start;
  for (const char byte : bytes) hash = (hash ^ static_cast<unsigned char>(byte)) * 0x100000001b3u;
  return hash;
}

fs::path default_cache_folder() {
  const char* cache = std::getenv("XDG_CACHE_HOME");
  if (cache != nullptr && fs::path(cache).is_absolute()) return fs::path(cache) / "continuo" / "native";
  const char* home = std::getenv("HOME");
  if (home != nullptr && fs::path(home).is_absolute()) return fs::path(home) / ".cache" / "continuo" / "native";
  return {};
}

Status check_private(const fs::path& folder) {
  std::error_code error;
  const fs::path whole = fs::canonical(folder, error);
  if (error) return untrusted(folder, error.message());
  for (fs::path at = whole;; at = at.parent_path()) {
    struct stat info = {};
    if (lstat(at.c_str(), &info) != 0) return untrusted(at, std::strerror(errno));
    if (!S_ISDIR(info.st_mode)) return untrusted(at, "it is no folder");
    if (info.st_uid != geteuid() && info.st_uid != 0) return untrusted(at, "it belongs to another user");
    const bool others_write = (info.st_mode & (S_IWGRP | S_IWOTH)) != 0;
    const bool is_sticky = (info.st_mode & S_ISVTX) != 0 && at != whole;
    if (others_write && !is_sticky) return untrusted(at, "others can write it");
    if (at == at.root_path()) return {};
  }
}

NativeCache::NativeCache(const fs::path& folder) : folder_(folder) {
  if (folder_.empty()) {
    status_ = untrusted("a cache", "neither HOME nor XDG_CACHE_HOME is set");
    return;
  }
  std::error_code error;
  if (!fs::exists(folder_, error)) {
    fs::create_directories(folder_.parent_path(), error);
    if (mkdir(folder_.c_str(), S_IRWXU) != 0 && errno != EEXIST) {
      status_ = untrusted(folder_, std::strerror(errno));
      return;
    }
  }
  status_ = check_private(folder_);
}

fs::path NativeCache::place(std::string_view text, std::string_view ending) const {
  return folder_ / fmt::format("{:016x}{:016x}{}", fnv_hash(text), fnv_hash(text, 0x9ae16a3b2f90404fu), ending);
}

std::optional<fs::path> NativeCache::find(std::string_view text) const {
  if (!status_) return std::nullopt;
  const fs::path source = place(text, ".c"), object = fs::path(source).replace_extension(".so");
  if (!is_own_file(source) || !is_own_file(object)) return std::nullopt;
  const std::optional<std::string> kept = read_whole(source), code = read_whole(object);
  if (!kept || !code || *kept != with_hash(text, *code)) return std::nullopt;
  std::error_code ignored;  // the time of use, by which the oldest are found
  fs::last_write_time(source, fs::file_time_type::clock::now(), ignored);
  return object;
}

void NativeCache::keep(std::string_view text, const fs::path& shared_object) const {
  if (!status_) return;
  const std::optional<std::string> code = read_whole(shared_object);
  if (!code || code->size() > most_bytes / 4) return;
  const fs::path object = place(text, ".so");
  if (!write_whole(object, *code)) return;
  if (write_whole(place(text, ".c"), with_hash(text, *code))) return remove_oldest();
  std::error_code ignored;
  fs::remove(object, ignored);
}

void NativeCache::remove_oldest() const {
  struct Entry {
    fs::file_time_type used;
    std::uint64_t bytes;
    fs::path source;
  };
  std::vector<Entry> entries;
  std::uint64_t total = 0;
  std::error_code error;
  for (const auto& file : fs::directory_iterator(folder_, error)) {
    std::error_code gone;
    const std::uint64_t bytes = file.file_size(gone);
    if (gone) continue;
    total += bytes;
    if (file.path().extension() != ".c") continue;
    fs::path object = file.path();
    const std::uint64_t code = fs::file_size(object.replace_extension(".so"), gone);
    entries.push_back({file.last_write_time(gone), bytes + (gone ? 0 : code), file.path()});
  }
  std::ranges::sort(entries, {}, &Entry::used);
  for (const Entry& entry : entries) {
    if (total <= most_bytes) return;
    fs::path object = entry.source;
    fs::remove(entry.source, error);
    fs::remove(object.replace_extension(".so"), error);
    total -= std::min(total, entry.bytes);
  }
}

}  // namespace continuo::model
