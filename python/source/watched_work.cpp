// Does work in a thread, while signals are answered.
#include "watched_work.hpp"

#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <thread>

#include "gil.hpp"

namespace continuo::python {
namespace {

namespace py = pybind11;
using namespace std::chrono_literals;
using Clock = std::chrono::steady_clock;

constexpr auto between_signals = 20ms;
constexpr auto between_places = 100ms;

/// The exception that is set, taken from the interpreter.
py::object taken_exception() {
  PyObject *type = nullptr, *value = nullptr, *trace = nullptr;
  PyErr_Fetch(&type, &value, &trace);
  PyErr_NormalizeException(&type, &value, &trace);
  if (trace != nullptr) PyException_SetTraceback(value, trace);
  Py_XDECREF(type);
  Py_XDECREF(trace);
  return py::reinterpret_steal<py::object>(value);
}

/// A thread that works, and tells when it has ended.
class Worker {
 public:
  explicit Worker(const std::function<void()>& work) : thread_([this, &work] { run(work); }) {}
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;
  ~Worker() { thread_.join(); }

  /// Waits for so long at most; whether the work has ended.
  bool wait_for(std::chrono::milliseconds time) {
    std::unique_lock lock(mutex_);
    return ended_.wait_for(lock, time, [this] { return has_ended_; });
  }
  /// What the work has thrown; it must have ended.
  [[nodiscard]] const std::exception_ptr& failure() const { return failure_; }

 private:
  void run(const std::function<void()>& work) {
    try {
      work();
    } catch (...) {
      failure_ = std::current_exception();
    }
    const std::scoped_lock lock(mutex_);
    has_ended_ = true;
    ended_.notify_one();
  }

  std::mutex mutex_;
  std::condition_variable ended_;
  bool has_ended_ = false;
  std::exception_ptr failure_;
  std::thread thread_;  // the last member: it uses the others from its start on
};

}  // namespace

py::object do_watched(const std::function<void()>& work, Watched& watched, const py::object& tell) {
  py::object raised;
  std::exception_ptr failure;
  {
    const WithoutGil unlocked;
    Worker worker(work);
    Clock::time_point next = Clock::now() + between_places;
    while (!worker.wait_for(between_signals)) {
      const WithGil locked;
      if (raised) continue;
      if (PyErr_CheckSignals() == 0 && !tell.is_none() && Clock::now() >= next) {
        next = Clock::now() + between_places;
        py::reinterpret_steal<py::object>(
            or_stay([&] { return PyObject_CallFunction(tell.ptr(), "d", watched.place.load()); }));
      }
      if (PyErr_Occurred() == nullptr) continue;
      raised = taken_exception();
      watched.interrupt.store(true);
    }
    failure = worker.failure();
  }
  if (failure) std::rethrow_exception(failure);
  return raised;
}

}  // namespace continuo::python
