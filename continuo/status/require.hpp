// continuo/status/require.hpp
// For short programs, examples and benchmarks: what must succeed, or the program ends with the message.
//
//   const BodyHandle ball = continuo::require(world.add({.position = {{0, 0, 10}}}));
//   continuo::require(motion.advance_to(5));
#pragma once
#include <cstdio>
#include <cstdlib>
#include <utility>

#include <continuo/status/result.hpp>

namespace continuo {

/// Prints the status to the standard error and exits with EXIT_FAILURE where it is a failure. The library itself never
/// calls this.
inline void require(const Status& status) {
  if (status) return;
  std::fprintf(stderr, "%s\n", describe(status).c_str());
  std::exit(EXIT_FAILURE);
}

/// The value, or the end of the program as above. The value may be ignored.
template <class T>
T require(Result<T> result) {
  require(result.status());
  return *std::move(result);
}

}  // namespace continuo
