// The lock of the interpreter, and what becomes of threads that are in this module when the interpreter ends.
//
// A daemon thread that asks for the lock after the end of the main thread never gets it: before 3.14 Python then ends
// it by `pthread_exit`, which unwinds the frames of C++ on its way, and their destructors, which need the lock in turn,
// end the process by `std::terminate` or touch what is no more. So no thread may be in the midst of this module when
// the interpreter ends: at its end the main thread waits for those that are about to return, those that would go on
// stay where they are, as Python 3.14 has it, and those that ask for the lock later stay there.
#pragma once
#include <utility>

#include <cxxabi.h>
#include <pybind11/pybind11.h>
#include <unistd.h>

namespace continuo::python {

/// Has the main thread wait at the end of the interpreter, a second at most, for threads that visit this module.
void wait_for_visits_at_exit();
/// Stays for good where the interpreter is at its end. The calling thread has the lock, which it gives back then.
void stay_where_python_ends();
/// Stays for good.
[[noreturn]] void stay();

/// A call of this module in which a thread may be when the interpreter ends, as a guard of the call (py::call_guard).
class Visit {
 public:
  Visit();
  Visit(const Visit&) = delete;
  Visit& operator=(const Visit&) = delete;
  ~Visit();

 private:
  bool is_outermost_;
};

/// Calls what may wait for the lock.
template <class Call>
decltype(auto) or_stay(Call&& call) {
#if defined(__GLIBC__)
  try {
    return std::forward<Call>(call)();
  } catch (const abi::__forced_unwind&) {
    stay();
  }
#else
  return std::forward<Call>(call)();
#endif
}

/// Without the lock, from its construction to its end. Nobody waits for such a thread.
class WithoutGil {
 public:
  WithoutGil();
  WithoutGil(const WithoutGil&) = delete;
  WithoutGil& operator=(const WithoutGil&) = delete;
  ~WithoutGil();

 private:
  bool was_counted_;
  PyThreadState* state_;
};

/// With the lock, from its construction to its end, also where the thread has it already.
class WithGil {
 public:
  WithGil() : state_(or_stay([] { return PyGILState_Ensure(); })) { stay_where_python_ends(); }
  WithGil(const WithGil&) = delete;
  WithGil& operator=(const WithGil&) = delete;
  ~WithGil() { PyGILState_Release(state_); }

 private:
  PyGILState_STATE state_;
};

}  // namespace continuo::python
