// Decides when a tape or a function is worth compiling, has it compiled beside the run, and puts the machine code in
// its place.
#include <algorithm>
#include <array>
#include <cstdlib>
#include <fstream>
#include <system_error>
#include <utility>

#include <dlfcn.h>
#include <fmt/format.h>

#include <continuo/symbolic/native/c_source.hpp>
#include <continuo/symbolic/native/native_compiler.hpp>

namespace continuo::model {

namespace fs = std::filesystem;

namespace {

// An operation of a tape takes about a nanosecond. The cache is asked in a fifth of a millisecond, and the compiler
// takes 30 milliseconds and more.
constexpr std::uint64_t operations_before_cache = 1'000'000, operations_before_compiler = 30'000'000;
constexpr std::size_t most_functions = 256;  // that are remembered

constexpr std::string_view heading =
    "double sin(double), cos(double), tan(double), asin(double), acos(double), atan(double), atan2(double, double);\n"
    "double sinh(double), cosh(double), tanh(double), exp(double), log(double), log10(double), pow(double, double);\n"
    "double sqrt(double), fabs(double), floor(double), ceil(double);\n"
    "#define INFINITY __builtin_inf()\n"
    "#define NAN __builtin_nan(\"\")\n";

/// gcc 12 makes vfmaddsub of products beside sums and differences, in loops too, whatever -ffp-contract says
/// (tree-vect-slp-patterns.cc asks for the instruction only): code for one run gets no such instructions, which AVX-512
/// has of its own. Code in lanes has its vectors in its text, and nothing for gcc to join.
constexpr std::string_view without_fused =
    "#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)\n"
    "#pragma GCC target(\"no-fma,no-avx512f\")\n"
    "#endif\n";

/// Whether gcc could join statements of the text, which says so of its loops. Where all are written out there is
/// nothing to join, and the code may use all registers of AVX-512: it takes a seventh less time.
bool has_loops(std::string_view text) {
  return text.find("#pragma GCC ivdep") != std::string_view::npos;
}

/// A folder for one compilation, which nobody else can read.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::error_code error;
    std::string name = (fs::temp_directory_path(error) / "continuo-native-XXXXXX").string();
    if (!error && mkdtemp(name.data()) != nullptr) path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    if (!path_.empty()) fs::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  [[nodiscard]] const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

/// What Tape::evaluate does, as a function of C.
std::string function_of(const Tape& tape, Fusing fusing) {
  const CArray states[] = {{"x", tape.states_begin(), tape.states_end()}};
  return c_function(tape,
                    {.signature = "void evaluate(double *restrict r, const double *restrict x, double *restrict y)",
                     .arrays = states,
                     .fused = fusing != Fusing::none})
      .text;
}

/// All that a compiler needs of functions on a tape.
std::string whole_text(const std::string& functions, const Tape& tape) {
  return std::string(heading) + c_helpers(functions, tape.tables()) + functions;
}

}  // namespace

std::optional<NativeUse> native_use_named(std::string_view word) {
  constexpr std::array<std::pair<std::string_view, NativeUse>, 4> words{{{"auto", NativeUse::automatic},
                                                                         {"always", NativeUse::always},
                                                                         {"fused", NativeUse::fused},
                                                                         {"never", NativeUse::never}}};
  const auto found = std::ranges::find(words, word, &std::pair<std::string_view, NativeUse>::first);
  return found == words.end() ? std::nullopt : std::optional(found->second);
}

bool has_fused_operations() {
#if defined(__x86_64__)
  return __builtin_cpu_supports("fma") != 0;
#elif defined(__aarch64__)
  return true;
#else
  return false;
#endif
}

std::string why_not(NativeUse use) {
  if (use != NativeUse::fused || has_fused_operations()) return {};
  return "this processor has no fused operations (fma); take `always`, which has the bits of a tape";
}

NativeCompiler::NativeCompiler(NativeOptions options) : options_(std::move(options)) {}

NativeCompiler::~NativeCompiler() {
  worker_.request_stop();
  wake_.notify_all();
}

NativeCompiler::Report NativeCompiler::report() const {
  const std::lock_guard lock(mutex_);
  return report_;
}

std::string NativeCompiler::missing() const {
  const std::lock_guard lock(mutex_);
  if (options_.use != NativeUse::fused || report_.failed == 0) return {};
  return report_.trouble.empty() ? "no machine code could be made" : report_.trouble;
}

void NativeCompiler::note_trouble(const std::string& what) {
  const std::lock_guard lock(mutex_);
  if (report_.trouble.empty()) report_.trouble = what;
}

void NativeCompiler::note_failure(const std::string& what) {
  const std::lock_guard lock(mutex_);
  // It matters more than a cache that cannot be used.
  if (report_.failed++ == 0) report_.trouble = what;
}

Fusing NativeCompiler::fused_of(Fusing allowed, const Tape& tape, const CStepFormula& formula) const {
  if (options_.use != NativeUse::fused || allowed == Fusing::none) return Fusing::none;
  if (!is_worth_compiling(tape) || !is_without_loops(tape)) return Fusing::none;
  // Of one run and of many alike: where one run has no step in machine code, neither has fused ones.
  return allowed == Fusing::steps && !is_worth_a_step(tape, formula) ? Fusing::equations : allowed;
}

void NativeCompiler::watch(const std::shared_ptr<const Tape>& tape, Fusing fusing) {
  if (options_.use == NativeUse::never || !is_worth_compiling(*tape)) return;
  if (waits()) return make_now(job_of(tape, fused_of(fusing, *tape, {})), {});
  tape->notify_of_use(operations_before_cache,
                      [compiler = weak_from_this(), of = std::weak_ptr(tape)](std::uint64_t operations) {
                        const auto self = compiler.lock();
                        const auto used = of.lock();
                        return self && used ? self->after(operations, job_of(used, Fusing::none)) : 0;
                      });
}

std::shared_ptr<NativeFunction> NativeCompiler::function(const std::string& key, std::function<std::string()> text) {
  if (options_.use == NativeUse::never) return std::make_shared<NativeFunction>();
  std::shared_ptr<NativeFunction> made;
  {
    const std::lock_guard lock(mutex_);
    if (functions_.size() >= most_functions) functions_.clear();  // who uses one keeps it
    std::shared_ptr<NativeFunction>& place = functions_[key];
    if (place) return place;
    made = place = std::make_shared<NativeFunction>();
  }
  provide(made, [text = std::move(text)] { return std::string(without_fused) + text(); });
  return made;
}

std::shared_ptr<NativeFunction> NativeCompiler::lane_code(const std::shared_ptr<const Tape>& tape, CStepFormula formula,
                                                          Fusing fusing) {
  const auto lanes = std::make_shared<NativeFunction>();
  if (options_.use == NativeUse::never || !is_worth_compiling(*tape)) return lanes;
  fusing = fused_of(fusing, *tape, formula);
  provide(lanes, [tape, formula = std::move(formula), fusing] {
    return whole_text(c_lane_evaluation(*tape, formula, fusing), *tape);
  });
  return lanes;
}

std::shared_ptr<NativeFunction> NativeCompiler::step_code(const std::shared_ptr<const Tape>& tape, CStepFormula formula,
                                                          Fusing fusing) {
  const auto step = std::make_shared<NativeFunction>();
  if (options_.use == NativeUse::never || !is_worth_a_step(*tape, formula)) return step;
  fusing = fused_of(fusing, *tape, formula);
  provide(step, [tape, formula = std::move(formula), fusing] {
    const std::string text = whole_text(c_step(*tape, formula, fusing), *tape);
    // Of fused equations only the step has loops, and none of those has sums beside differences.
    return has_loops(text) && fusing == Fusing::none ? std::string(without_fused) + text : text;
  });
  return step;
}

void NativeCompiler::provide(const std::shared_ptr<NativeFunction>& function, std::function<std::string()> text) {
  const auto job = [text = std::move(text)](const std::shared_ptr<NativeFunction>& user) {
    return Job{text, [user](void* made, std::shared_ptr<const void> code) { user->use(made, std::move(code)); }};
  };
  if (waits()) return make_now(job(function), {});
  function->notify_of_use(
      operations_before_cache,
      [compiler = weak_from_this(), of = std::weak_ptr(function), job](std::uint64_t operations) -> std::uint64_t {
        const auto self = compiler.lock();
        const auto user = of.lock();
        return self && user ? self->after(operations, job(user)) : 0;
      });
}

std::uint64_t NativeCompiler::after(std::uint64_t operations, Job job) {
  if (operations < operations_before_compiler) return load_from_cache(job, job.text()) ? 0 : operations_before_compiler;
  const std::lock_guard lock(mutex_);
  waiting_.push_back(std::move(job));
  if (!worker_.joinable()) worker_ = std::jthread([this](std::stop_token stop) { work(std::move(stop)); });
  wake_.notify_all();
  return 0;
}

void NativeCompiler::work(std::stop_token stop) {
  for (;;) {
    Job job;
    {
      std::unique_lock lock(mutex_);
      if (!wake_.wait(lock, stop, [&] { return !waiting_.empty(); }) || stop.stop_requested()) return;
      job = std::move(waiting_.front());
      waiting_.pop_front();
    }
    make_now(job, stop);
  }
}

void NativeCompiler::make_now(const Job& job, std::stop_token stop) {
  const std::string text = job.text();
  if (!load_from_cache(job, text)) compile(job, text, std::move(stop));
}

NativeCompiler::Job NativeCompiler::job_of(const std::shared_ptr<const Tape>& tape, Fusing fusing) {
  return {.text =
              [tape, fusing] {
                const std::string text = whole_text(function_of(*tape, fusing), *tape);
                return fusing == Fusing::none ? std::string(without_fused) + text : text;
              },
          .use =
              [tape](void* function, std::shared_ptr<const void> code) {
                tape->use_native(reinterpret_cast<NativeEvaluation>(function), std::move(code));
              }};
}

bool NativeCompiler::load_from_cache(const Job& job, const std::string& text) {
  std::call_once(found_, [&] {
    compiler_ = find_c_compiler();
    cache_.emplace(options_.cache);
    if (!cache_->status()) note_trouble(cache_->status().message);
  });
  const auto file = cache_->find(compiler_->identity + "\n" + text);
  if (!file) return false;
  load(job, *file);
  const std::lock_guard lock(mutex_);
  ++report_.loaded;
  return true;
}

void NativeCompiler::compile(const Job& job, const std::string& text, std::stop_token stop) {
  const TemporaryFolder folder;
  if (folder.path().empty()) return note_failure("no folder for temporary files can be made");
  if (const Status status = check_private(folder.path()); !status) return note_failure(status.message);
  const fs::path source = folder.path() / "tape.c", made = folder.path() / "tape.so";
  {
    std::ofstream stream(source, std::ios::binary);
    stream << text;
    if (!stream.flush()) return note_failure(fmt::format("{} cannot be written", source.string()));
  }
  if (const Status status = compiler_->compile(source, made, std::move(stop)); !status)
    return note_failure(status.message);
  cache_->keep(compiler_->identity + "\n" + text, made);
  load(job, made);
  const std::lock_guard lock(mutex_);
  ++report_.compiled;
}

void NativeCompiler::load(const Job& job, const fs::path& shared_object) {
  void* const opened = dlopen(shared_object.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (opened == nullptr) return note_failure(fmt::format("{}: {}", shared_object.string(), dlerror()));
  std::shared_ptr<void> code(opened, [](void* handle) { dlclose(handle); });
  void* const function = dlsym(opened, "evaluate");
  if (function == nullptr) return note_failure(fmt::format("{}: no function in it", shared_object.string()));
  job.use(function, std::move(code));
}

}  // namespace continuo::model
