// Work without the interpreter's lock that Ctrl-C ends at once: it goes on in a thread of its own, while the thread
// that asked for it answers signals and tells somebody how far it has come.
#pragma once
#include <atomic>
#include <functional>

#include <pybind11/pybind11.h>

namespace continuo::python {

/// What the work and its watcher share.
struct Watched {
  std::atomic<bool> interrupt{false};  // the work is to end
  std::atomic<double> place{};         // how far it has come
};

/// Does the work, and returns when it has ended. `tell` is called ten times a second with the place, unless it is None.
/// What a signal handler or `tell` has raised ends the work and is returned: a null object where nothing was raised.
/// What the work itself has thrown is thrown.
[[nodiscard]] pybind11::object do_watched(const std::function<void()>& work, Watched& watched,
                                          const pybind11::object& tell);

}  // namespace continuo::python
