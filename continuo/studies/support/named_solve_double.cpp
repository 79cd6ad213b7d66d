// Instantiates the solution by a named method for double precision.
#include <continuo/studies/support/named_solve_body.hpp>

namespace continuo::studies {

template Solution<std::vector<double>> named_solve(std::string_view, const NamedSystem<double>&, std::vector<double>,
                                                   Interval<double>, const Options<std::vector<double>>&);

}  // namespace continuo::studies
