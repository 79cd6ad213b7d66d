// Forwards calls of the least-squares solver to the module that has it.
#include <apps/continuo/terminal/modules.hpp>

#include <continuo/studies/least_squares.hpp>

namespace continuo {

studies::LeastSquaresResult studies::least_squares(const LeastSquares& problem, const LeastSquaresOptions& options) {
  return app::entry_of<decltype(&least_squares)>(app::least_squares_module)(problem, options);
}

}  // namespace continuo
