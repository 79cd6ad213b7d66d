// Instantiates the solution by a named method for single precision.
#include <continuo/studies/support/named_solve_body.hpp>

namespace continuo::studies {

template Solution<std::vector<float>> named_solve(std::string_view, const NamedSystem<float>&, std::vector<float>,
                                                  Interval<float>, const Options<std::vector<float>>&);

}  // namespace continuo::studies
