// The library's runs for states that are four numbers in an array.
#include <array>

#include <continuo/solve/in_library/runs_in_library.hpp>

template struct continuo::detail::RunsInLibrary<std::array<double, 4>>;
