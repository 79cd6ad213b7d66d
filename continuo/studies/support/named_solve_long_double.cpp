// Instantiates the solution by a named method for extended precision.
#include <utility>

#include <continuo/studies/support/named_solve_body.hpp>

namespace continuo::studies {

template Solution<std::vector<long double>> named_solve(std::string_view, const NamedSystem<long double>&,
                                                        std::vector<long double>, Interval<long double>,
                                                        const Options<std::vector<long double>>&);

}  // namespace continuo::studies
