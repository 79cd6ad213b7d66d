// The kind of the runs of an ensemble: those of `ensemble`, with its events, or such as the system brings, which has
// events of its own.
#pragma once
#include <continuo/ensembles/lanes/run_of_lane.hpp>

namespace continuo::detail {

/// `template <class M> using Run` is a class like RunOfLane, for steps by the method M. Besides, it says of all runs
/// whether they have `any_guard`, and finds the lanes with `near_guards`.
template <class F, class M>
concept HasOwnRuns = requires { typename F::template Run<M>; };

template <class F, State X, State P, class M, class... E>
struct RunKind {
  using Type = RunOfLane<F, X, P, M, E...>;
};
template <class F, State X, State P, class M, class... E>
  requires HasOwnRuns<F, M>
struct RunKind<F, X, P, M, E...> {
  using Type = typename F::template Run<M>;
};

}  // namespace continuo::detail
