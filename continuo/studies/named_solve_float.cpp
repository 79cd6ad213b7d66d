// Some methods turn a count into a number through double, which a warning takes for a loss: counts are exact in both.
#pragma GCC diagnostic ignored "-Wfloat-conversion"
#ifdef __clang__
#pragma clang diagnostic ignored "-Wimplicit-float-conversion"
#endif
#include <continuo/studies/named_solve_body.hpp>

namespace continuo::studies {

template Solution<std::vector<float>> named_solve(std::string_view, const NamedSystem<float>&, std::vector<float>,
                                                  Interval<float>, const Options<std::vector<float>>&);

}  // namespace continuo::studies
