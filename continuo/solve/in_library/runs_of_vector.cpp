// The library's runs for states that are a vector of numbers.
#include <vector>

#include <continuo/solve/in_library/runs_in_library.hpp>

template struct continuo::detail::RunsInLibrary<std::vector<double>>;
