// Threads that are in this module when the interpreter ends.
#include "gil.hpp"

#include <atomic>
#include <chrono>
#include <thread>
#include <utility>

namespace continuo::python {
namespace {

namespace py = pybind11;
using namespace std::chrono_literals;

/// Those who visit with the lock, or wait for it, and who ends the interpreter. There is one of them, as there is one
/// interpreter.
std::atomic<int> visits{0};
std::atomic<std::thread::id> who_ends{};
/// Whether this thread is among them.
thread_local bool is_counted = false;

void count(bool is_here) {
  if (std::exchange(is_counted, is_here) != is_here) visits += is_here ? 1 : -1;
}

void wait_for_visits() {
  who_ends = std::this_thread::get_id();
  const WithoutGil unlocked;
  constexpr auto longest = 1000ms, between = 1ms;
  for (auto waited = 0ms; visits > 0 && waited < longest; waited += between) std::this_thread::sleep_for(between);
}

}  // namespace

void wait_for_visits_at_exit() {
  py::module_::import("atexit").attr("register")(py::cpp_function(&wait_for_visits));
}

void stay() {
  count(false);
  for (;;) pause();
}

void stay_where_python_ends() {
  const std::thread::id one = who_ends;
  if (one == std::thread::id() || one == std::this_thread::get_id()) return;
  PyEval_SaveThread();
  stay();
}

Visit::Visit() : is_outermost_(!is_counted) {
  stay_where_python_ends();
  count(true);
}
Visit::~Visit() {
  if (is_outermost_) count(false);
}

WithoutGil::WithoutGil() : was_counted_(is_counted), state_(PyEval_SaveThread()) {
  count(false);
}
WithoutGil::~WithoutGil() {
  count(was_counted_);
  or_stay([this] { PyEval_RestoreThread(state_); });
  stay_where_python_ends();
}

}  // namespace continuo::python
