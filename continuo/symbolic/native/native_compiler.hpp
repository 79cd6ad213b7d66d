// Tapes replaced by machine code of the system's C compiler, while they run.
//
//   const auto native = std::make_shared<NativeCompiler>(NativeOptions{});
//   native->watch(tape);                 // tape: std::shared_ptr<const Tape>
//   ... evaluations: of the tape first, of machine code as soon as it is there; the same bits ...
//   native->report().compiled            // how many were replaced
//
// `automatic` waits until a tape has done so much that a compilation will pay: code that lies in the cache is loaded
// after about a millisecond of work, the compiler is started after some thirty, and a thread waits for it. Where there
// is no compiler or no private folder, the tape goes on.
#pragma once
#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include <continuo/status/result.hpp>
#include <continuo/symbolic/native/c_compiler.hpp>
#include <continuo/symbolic/native/lane_code.hpp>
#include <continuo/symbolic/native/native_cache.hpp>
#include <continuo/symbolic/tape/tape.hpp>

namespace continuo::model {

enum class NativeUse : std::uint8_t {
  automatic,  // as soon as it pays
  always,     // before the first evaluation
  never,
};

struct NativeOptions {
  NativeUse use = NativeUse::automatic;
  std::filesystem::path cache = default_cache_folder();
};

class NativeCompiler : public std::enable_shared_from_this<NativeCompiler> {
 public:
  explicit NativeCompiler(NativeOptions options = {});
  /// Gives up what is being compiled, at once.
  ~NativeCompiler();
  NativeCompiler(const NativeCompiler&) = delete;
  NativeCompiler& operator=(const NativeCompiler&) = delete;

  /// With `always` the tape is machine code when this returns, or `report` says why not.
  void watch(const std::shared_ptr<const Tape>& tape);

  /// The machine code of the tape for several runs at once, to be counted on and asked for: with `always` it is there
  /// when this returns.
  [[nodiscard]] std::shared_ptr<LaneCode> lane_code(const std::shared_ptr<const Tape>& tape);

  struct Report {
    std::size_t compiled = 0;  // tapes, by the compiler
    std::size_t loaded = 0;    // tapes, from the cache
    std::string trouble;       // of the first tape that could not be compiled
  };
  [[nodiscard]] Report report() const;

 private:
  /// A tape whose machine code is wanted, and for several runs at once who gets it; else the tape does.
  struct Wanted {
    std::shared_ptr<const Tape> tape;
    std::shared_ptr<LaneCode> lanes{};
  };
  /// What has been done so far decides what is tried next.
  [[nodiscard]] std::uint64_t after(std::uint64_t operations, const Wanted& wanted);
  void make_now(const Wanted& wanted, std::stop_token stop);
  [[nodiscard]] std::string text_of(const Wanted& wanted) const;
  [[nodiscard]] bool load_from_cache(const Wanted& wanted, const std::string& text);
  void compile(const Wanted& wanted, const std::string& text, std::stop_token stop);
  void load(const Wanted& wanted, const std::filesystem::path& shared_object);
  void note_trouble(const std::string& what);
  void work(std::stop_token stop);

  NativeOptions options_;
  std::optional<CCompiler> compiler_;
  std::optional<NativeCache> cache_;
  std::once_flag found_;
  mutable std::mutex mutex_;
  std::condition_variable_any wake_;
  std::deque<Wanted> waiting_;
  Report report_;
  std::jthread worker_;  // the last member: it ends before what it uses
};

}  // namespace continuo::model
