// Where the runs of an ensemble begin, and what each is given.
#pragma once
#include <array>
#include <concepts>
#include <cstddef>
#include <type_traits>
#include <utility>

#include <continuo/numerics/state.hpp>

namespace continuo {

/// The start of one run: its state, and the parameters that the system, the guards and the actions of this run get.
/// Double numbers, as arrays or vectors.
template <State X, State P = std::array<double, 0>>
struct RunStart {
  X x;    // the state at the beginning
  P p{};  // the parameters; none if left out
};

/// The starts of `size()` runs, made by a function of the number of the run when the run begins: there is no list of
/// them. Threads call the function at the same time.
template <class Make>
struct GeneratedStarts {
  std::size_t count;  // the number of runs
  Make make;          // number of the run -> RunStart, or only a state

  /// The number of runs.
  [[nodiscard]] std::size_t size() const { return count; }
  /// The start of one run.
  [[nodiscard]] auto operator[](std::size_t run) const { return make(run); }
};

/// `count` runs, run i beginning at make(i): starts(1000, [](std::size_t run) { return RunStart{x(run), p(run)}; }).
template <class Make>
  requires std::invocable<const Make&, std::size_t>
[[nodiscard]] GeneratedStarts<Make> starts(std::size_t count, Make make) {
  return {count, std::move(make)};
}

namespace detail {

/// One start as a RunStart: a state alone has no parameters.
template <State X, State P>
[[nodiscard]] RunStart<X, P> as_run_start(RunStart<X, P> start) {
  return start;
}
template <State X>
[[nodiscard]] RunStart<X> as_run_start(X x) {
  return {std::move(x)};
}

template <class Starts>
using StartOf = decltype(as_run_start(std::declval<const Starts&>()[std::size_t{}]));
template <class Starts>
using StateOf = std::remove_cvref_t<decltype(std::declval<StartOf<Starts>>().x)>;
template <class Starts>
using ParametersOf = std::remove_cvref_t<decltype(std::declval<StartOf<Starts>>().p)>;

}  // namespace detail

/// A list of starts: a vector or an array of RunStart or of states, or `starts(count, function)`.
template <class S>
concept RunStarts = requires(const S& list, std::size_t run) {
  { list.size() } -> std::convertible_to<std::size_t>;
  detail::as_run_start(list[run]);
  requires std::same_as<Scalar<detail::StateOf<S>>, double>;
  requires std::same_as<Scalar<detail::ParametersOf<S>>, double>;
};

}  // namespace continuo
