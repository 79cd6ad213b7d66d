// continuo_integrate of continuo.h: functions of other languages, by any method.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <exception>
#include <limits>
#include <memory>
#include <new>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include <continuo/c_interface/continuo.h>
#include <continuo/foreign/foreign_run.hpp>
#include <continuo/solve/catalogue.hpp>
#include <continuo/solve/choice.hpp>
#include <continuo/status/status.hpp>

using namespace continuo;

namespace {

/// The caller's function, which can refuse.
struct Caller {
  continuo_function f;
  void* user;
  std::size_t n;
  std::atomic<bool> has_refused{false};

  static void derivative(double t, const double* y, double* dydt, void* self) {
    Caller& caller = *static_cast<Caller*>(self);
    if (!caller.has_refused && caller.f(t, y, dydt, caller.user) == 0) return;
    caller.has_refused = true;
    std::fill_n(dydt, caller.n, std::numeric_limits<double>::quiet_NaN());
  }
};

struct Answer {
  int code;
  std::string message;
};

/// What is wrong with the call; empty where it can be done.
std::string mistake(continuo_function f, std::size_t n, const double* y0, const double* times, std::size_t count,
                    const double* rows) {
  if (!f || !y0 || !times || !rows) return "f, y0, times or rows is NULL";
  if (n == 0 || count == 0) return "there is no equation, or no time";
  for (std::size_t i = 0; i < n; ++i) {
    if (!std::isfinite(y0[i])) return fmt::format("y0[{}] is {}", i, y0[i]);
  }
  for (std::size_t k = 0; k < count; ++k) {
    if (!std::isfinite(times[k])) return fmt::format("times[{}] is {}", k, times[k]);
    if (k > 0 && (times[count - 1] > times[0] ? times[k] <= times[k - 1] : times[k] >= times[k - 1]))
      return fmt::format("the times must ascend or descend, and times[{}] is {} after {}", k, times[k], times[k - 1]);
  }
  return {};
}

Answer integrate(Caller& caller, const double* y0, std::span<const double> times, std::string_view method,
                 Options<std::vector<double>> options, double* rows) {
  const std::size_t n = caller.n;
  std::fill_n(rows, times.size() * n, std::numeric_limits<double>::quiet_NaN());
  std::copy_n(y0, n, rows);
  if (times.size() == 1) return {CONTINUO_OK, "there is one time, and y is y0 there"};
  const auto functions = std::make_shared<ForeignFunctions>();
  functions->size = n;
  functions->derivative = {Caller::derivative, &caller};
  options.interrupt = &caller.has_refused;
  const auto run = begin_foreign_run(functions, {y0, y0 + n}, {times.front(), times.back()}, method, options);
  if (!run) return {CONTINUO_MISUSE, fmt::format("the method {} cannot integrate this", method)};
  ForeignRecord record({.steps = false, .times = {times.begin(), times.end()}});
  while (run->advance(record)) {
  }
  std::copy_n(record.x.begin(), std::min(record.x.size(), times.size() * n), rows);
  if (caller.has_refused) return {CONTINUO_FAILED, fmt::format("f has ended the integration near t = {}", run->t())};
  return {succeeded(run->outcome().ending) ? CONTINUO_OK : CONTINUO_FAILED, describe(run->outcome())};
}

Answer answer_to(continuo_function f, void* user, std::size_t n, const double* y0, const double* times,
                 std::size_t count, const char* method, double rtol, double atol, double* rows) {
  const std::string wrong = mistake(f, n, y0, times, count, rows);
  if (!wrong.empty()) return {CONTINUO_MISUSE, wrong};
  Options<std::vector<double>> options;
  if (rtol != CONTINUO_DEFAULT) options.rtol = rtol;
  if (atol != CONTINUO_DEFAULT) options.atol = atol;
  const MethodInfo* info = method ? find_method(method) : nullptr;
  if (method && !info) {
    return {CONTINUO_MISUSE, fmt::format("there is no method `{}`; `continuo methods` lists them", method)};
  }
  const std::string_view name = info ? info->name : choose_method({.size = n, .rtol = options.rtol}).method;
  Caller caller{f, user, n};
  return integrate(caller, y0, {times, count}, name, options, rows);
}

}  // namespace

extern "C" int continuo_integrate(continuo_function f, void* user, size_t n, const double* y0, const double* times,
                                  size_t count, const char* method, double rtol, double atol, double* rows,
                                  char* message, size_t size) {
  Answer answer{CONTINUO_MEMORY, {}};
  try {
    answer = answer_to(f, user, n, y0, times, count, method, rtol, atol, rows);
  } catch (const std::bad_alloc&) {
    answer.code = CONTINUO_MEMORY;
  } catch (const std::exception& problem) {
    try {
      answer = {CONTINUO_ERROR, problem.what()};
    } catch (...) {
      answer.code = CONTINUO_MEMORY;
    }
  }
  if (message && size > 0) {
    const std::size_t length = std::min(size - 1, answer.message.size());
    std::memcpy(message, answer.message.data(), length);
    message[length] = '\0';
  }
  return answer.code;
}
