// Decides when a tape is worth compiling, has it compiled beside the run, and puts the machine code in its place.
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

constexpr std::string_view heading =
    "double sin(double), cos(double), tan(double), asin(double), acos(double), atan(double), atan2(double, double);\n"
    "double sinh(double), cosh(double), tanh(double), exp(double), log(double), log10(double), pow(double, double);\n"
    "double sqrt(double), fabs(double), floor(double), ceil(double);\n"
    "#define INFINITY __builtin_inf()\n"
    "#define NAN __builtin_nan(\"\")\n";

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

}  // namespace

NativeCompiler::NativeCompiler(NativeOptions options) : options_(std::move(options)) {}

NativeCompiler::~NativeCompiler() {
  worker_.request_stop();
  wake_.notify_all();
}

NativeCompiler::Report NativeCompiler::report() const {
  const std::lock_guard lock(mutex_);
  return report_;
}

void NativeCompiler::note_trouble(const std::string& what) {
  const std::lock_guard lock(mutex_);
  if (report_.trouble.empty()) report_.trouble = what;
}

void NativeCompiler::watch(const std::shared_ptr<const Tape>& tape) {
  if (options_.use == NativeUse::never || !is_worth_compiling(*tape)) return;
  if (options_.use == NativeUse::always) return make_now({tape}, {});
  tape->notify_of_use(operations_before_cache,
                      [compiler = weak_from_this(), of = std::weak_ptr(tape)](std::uint64_t operations) {
                        const auto self = compiler.lock();
                        const auto used = of.lock();
                        return self && used ? self->after(operations, {used}) : 0;
                      });
}

std::shared_ptr<LaneCode> NativeCompiler::lane_code(const std::shared_ptr<const Tape>& tape) {
  auto lanes = std::make_shared<LaneCode>();
  if (options_.use == NativeUse::never || !is_worth_compiling(*tape)) return lanes;
  if (options_.use == NativeUse::always) {
    make_now({tape, lanes}, {});
    return lanes;
  }
  lanes->notify_ = [compiler = weak_from_this(), tape, of = std::weak_ptr(lanes)](std::uint64_t operations) {
    const auto self = compiler.lock();
    const auto used = of.lock();
    return self && used ? self->after(operations, {tape, used}) : 0;
  };
  lanes->wanted_ = operations_before_cache;
  return lanes;
}

std::uint64_t NativeCompiler::after(std::uint64_t operations, const Wanted& wanted) {
  if (operations < operations_before_compiler)
    return load_from_cache(wanted, text_of(wanted)) ? 0 : operations_before_compiler;
  const std::lock_guard lock(mutex_);
  waiting_.push_back(wanted);
  if (!worker_.joinable()) worker_ = std::jthread([this](std::stop_token stop) { work(std::move(stop)); });
  wake_.notify_all();
  return 0;
}

void NativeCompiler::work(std::stop_token stop) {
  for (;;) {
    Wanted wanted;
    {
      std::unique_lock lock(mutex_);
      if (!wake_.wait(lock, stop, [&] { return !waiting_.empty(); }) || stop.stop_requested()) return;
      wanted = std::move(waiting_.front());
      waiting_.pop_front();
    }
    make_now(wanted, stop);
  }
}

void NativeCompiler::make_now(const Wanted& wanted, std::stop_token stop) {
  const std::string text = text_of(wanted);
  if (!load_from_cache(wanted, text)) compile(wanted, text, std::move(stop));
}

std::string NativeCompiler::text_of(const Wanted& wanted) const {
  const Tape& tape = *wanted.tape;
  const CArray states[] = {{"x", tape.states_begin(), tape.states_end()}};
  const std::string_view type = wanted.lanes ? "lanes" : "double";
  const std::string signature =
      fmt::format("void evaluate({0} *restrict r, const {0} *restrict x, {0} *restrict y)", type);
  std::string function =
      c_function(tape, {.signature = signature, .arrays = states, .in_lanes = wanted.lanes != nullptr});
  if (wanted.lanes) function = c_lane_helpers(function) + function;
  return std::string(heading) + c_helpers(function, tape.tables()) + function;
}

bool NativeCompiler::load_from_cache(const Wanted& wanted, const std::string& text) {
  std::call_once(found_, [&] {
    compiler_ = find_c_compiler();
    cache_.emplace(options_.cache);
    if (!cache_->status()) note_trouble(cache_->status().message);
  });
  const auto file = cache_->find(compiler_->identity + "\n" + text);
  if (!file) return false;
  load(wanted, *file);
  const std::lock_guard lock(mutex_);
  ++report_.loaded;
  return true;
}

void NativeCompiler::compile(const Wanted& wanted, const std::string& text, std::stop_token stop) {
  const TemporaryFolder folder;
  if (folder.path().empty()) return note_trouble("no folder for temporary files can be made");
  if (const Status status = check_private(folder.path()); !status) return note_trouble(status.message);
  const fs::path source = folder.path() / "tape.c", made = folder.path() / "tape.so";
  {
    std::ofstream stream(source, std::ios::binary);
    stream << text;
    if (!stream.flush()) return note_trouble(fmt::format("{} cannot be written", source.string()));
  }
  if (const Status status = compiler_->compile(source, made, std::move(stop)); !status)
    return note_trouble(status.message);
  cache_->keep(compiler_->identity + "\n" + text, made);
  load(wanted, made);
  const std::lock_guard lock(mutex_);
  ++report_.compiled;
}

void NativeCompiler::load(const Wanted& wanted, const fs::path& shared_object) {
  void* const opened = dlopen(shared_object.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (opened == nullptr) return note_trouble(fmt::format("{}: {}", shared_object.string(), dlerror()));
  std::shared_ptr<void> code(opened, [](void* handle) { dlclose(handle); });
  const auto function = reinterpret_cast<NativeEvaluation>(dlsym(opened, "evaluate"));
  if (function == nullptr) return note_trouble(fmt::format("{}: no function in it", shared_object.string()));
  wanted.lanes ? wanted.lanes->use(function, std::move(code)) : wanted.tape->use_native(function, std::move(code));
}

}  // namespace continuo::model
