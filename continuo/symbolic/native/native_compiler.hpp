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
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <thread>

#include <continuo/status/result.hpp>
#include <continuo/symbolic/native/c_compiler.hpp>
#include <continuo/symbolic/native/c_step.hpp>
#include <continuo/symbolic/native/native_cache.hpp>
#include <continuo/symbolic/native/native_function.hpp>
#include <continuo/symbolic/tape/tape.hpp>

namespace continuo::model {

enum class NativeUse : std::uint8_t {
  automatic,  // as soon as it pays
  always,     // before the first evaluation
  fused,      // the same, with fused operations: less time, and other bits than those of a tape
  never,
};

/// `auto`, `always`, `fused`, `never`; nothing for another word.
[[nodiscard]] std::optional<NativeUse> native_use_named(std::string_view word);

/// Whether this processor has operations that round a product and a sum once.
[[nodiscard]] bool has_fused_operations();

/// Why a run cannot have this use on this machine; empty where it can.
[[nodiscard]] std::string why_not(NativeUse use);

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

  /// With `always` the tape is machine code when this returns, or `report` says why not. `fusing`: what `fused` may
  /// fuse. It fuses in no tape whose C has loops: gcc 12 would fuse other operations of a loop as well.
  void watch(const std::shared_ptr<const Tape>& tape, Fusing fusing = Fusing::none);

  /// The function `evaluate` of a C text, which is asked for when it is needed. Equal keys stand for equal texts, whose
  /// users share the function and count together. With `always` it is there when this returns, or `report` says why
  /// not.
  [[nodiscard]] std::shared_ptr<NativeFunction> function(const std::string& key, std::function<std::string()> text);
  /// What Tape::evaluate does, for several runs at once in the lanes of TapeLanes, and steps of a method, if one is
  /// given: a NativeLaneEvaluation, for which nothing need be aligned. As `function`, and of this caller alone.
  [[nodiscard]] std::shared_ptr<NativeFunction> lane_code(const std::shared_ptr<const Tape>& tape,
                                                          CStepFormula formula = {}, Fusing fusing = Fusing::none);
  /// The same for one run with steps of this method.
  [[nodiscard]] std::shared_ptr<NativeFunction> step_code(const std::shared_ptr<const Tape>& tape, CStepFormula formula,
                                                          Fusing fusing = Fusing::none);

  struct Report {
    std::size_t compiled = 0;  // tapes and series, by the compiler
    std::size_t loaded = 0;    // from the cache
    std::string trouble;       // of the first that could not be compiled
    std::size_t failed = 0;    // that could not be
  };
  [[nodiscard]] Report report() const;
  [[nodiscard]] NativeUse use() const { return options_.use; }
  /// Why there is not all of the machine code without which the results are others, as `fused` needs it; else empty.
  [[nodiscard]] std::string missing() const;

 private:
  /// A function to be compiled, and who takes it.
  struct Job {
    std::function<std::string()> text;
    std::function<void(void* function, std::shared_ptr<const void> code)> use;
  };
  [[nodiscard]] static Job job_of(const std::shared_ptr<const Tape>& tape, Fusing fusing);
  [[nodiscard]] bool waits() const { return options_.use == NativeUse::always || options_.use == NativeUse::fused; }
  /// What is fused of what may be.
  [[nodiscard]] Fusing fused_of(Fusing allowed, const Tape& tape, const CStepFormula& formula) const;
  /// Has the text compiled for the function, now or when that pays.
  void provide(const std::shared_ptr<NativeFunction>& function, std::function<std::string()> text);
  /// What was done so far decides what is tried next.
  [[nodiscard]] std::uint64_t after(std::uint64_t operations, Job job);
  void make_now(const Job& job, std::stop_token stop);
  [[nodiscard]] bool load_from_cache(const Job& job, const std::string& text);
  void compile(const Job& job, const std::string& text, std::stop_token stop);
  void load(const Job& job, const std::filesystem::path& shared_object);
  void note_trouble(const std::string& what);
  void note_failure(const std::string& what);
  void work(std::stop_token stop);

  NativeOptions options_;
  std::optional<CCompiler> compiler_;
  std::optional<NativeCache> cache_;
  std::once_flag found_;
  mutable std::mutex mutex_;
  std::condition_variable_any wake_;
  std::deque<Job> waiting_;
  std::map<std::string, std::shared_ptr<NativeFunction>> functions_;  // by key
  Report report_;
  std::jthread worker_;  // the last member: it ends before what it uses
};

}  // namespace continuo::model
