// The explicit method of a pair, as lanes take it (ensembles/lanes/pair_of_lane.hpp).
#pragma once
#include <string_view>

#include <continuo/methods/automatic.hpp>

namespace continuo::model {

template <class Both, class Explicit>
struct ExplicitPart : Explicit {
  using Pair = Both;
  static constexpr std::string_view name = Both::name;
};

}  // namespace continuo::model
