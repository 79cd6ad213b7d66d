// Machine code kept between runs: a folder that only its owner can write, found by the text that was compiled.
//
//   const NativeCache cache(default_cache_folder());
//   if (const auto file = cache.find(text)) dlopen(file->c_str(), ...);
//
// An entry is two files, NAME.so and NAME.c. The second holds the whole text and a hash of the first, and is written
// last: what was cut short, altered or made of another text is not found.
#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include <continuo/status/result.hpp>

namespace continuo::model {

/// FNV-1a of 64 bits (Fowler, Noll, Vo), from another start for another hash.
[[nodiscard]] std::uint64_t fnv_hash(std::string_view bytes, std::uint64_t start = 0xcbf29ce484222325u);

/// `$XDG_CACHE_HOME/continuo/native`, or the same in `~/.cache`; empty where neither is known.
[[nodiscard]] std::filesystem::path default_cache_folder();

/// Whether the folder, and each one that it lies in, belongs to this user or the system and can be changed by no other:
/// code may be loaded from it. A folder with the sticky bit, as /tmp, may be around it.
[[nodiscard]] Status check_private(const std::filesystem::path& folder);

class NativeCache {
 public:
  /// No more than this lies in the folder; what was not used for longest goes first.
  static constexpr std::uint64_t most_bytes = 64u << 20u;

  /// Makes the folder, with permissions for its owner alone. Where that is impossible, or others can write it, the
  /// cache finds and keeps nothing, and `status` says why.
  explicit NativeCache(const std::filesystem::path& folder);

  [[nodiscard]] const Status& status() const { return status_; }
  /// The shared object of this text.
  [[nodiscard]] std::optional<std::filesystem::path> find(std::string_view text) const;
  /// Copies a shared object into the folder, where there is room; several processes may do so at once.
  void keep(std::string_view text, const std::filesystem::path& shared_object) const;

 private:
  [[nodiscard]] std::filesystem::path place(std::string_view text, std::string_view ending) const;
  void remove_oldest() const;

  std::filesystem::path folder_;
  Status status_;
};

}  // namespace continuo::model
