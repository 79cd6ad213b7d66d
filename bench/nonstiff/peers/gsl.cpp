// The peer: the GNU Scientific Library, its Runge-Kutta method of Prince and Dormand of order 8 and its Adams method of
// variable order, by its own driver.
#include <cstddef>
#include <string>
#include <utility>

#include <bench/nonstiff/measure.hpp>
#include <bench/nonstiff/peers/for_c.hpp>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_odeiv2.h>

namespace continuo::bench {
namespace {

template <class Problem>
int derivative(double t, const double* x, double* dxdt, void* count) {
  evaluate_by_pointers<Problem>(t, x, dxdt);
  if (count) ++*static_cast<std::size_t*>(count);
  return GSL_SUCCESS;
}

/// The end of the run; not where it should be where GSL gives up.
template <class Problem>
std::array<double, Problem::size> run(const gsl_odeiv2_step_type* type, double first_step, double tolerance,
                                      std::size_t* count) {
  gsl_odeiv2_system system{derivative<Problem>, nullptr, Problem::size, count};
  gsl_odeiv2_driver* driver = gsl_odeiv2_driver_alloc_y_new(&system, type, first_step, tolerance, tolerance);
  auto x = Problem::start();
  double t = 0;
  gsl_odeiv2_driver_apply(driver, &t, Problem::duration, x.data());
  gsl_odeiv2_driver_free(driver);
  return x;
}

template <class Problem>
Solver gsl_solver(std::string name, const gsl_odeiv2_step_type* type, double first_step) {
  return {std::move(name), false,
          [=](double tolerance) {
            std::size_t count = 0;
            const auto x = run<Problem>(type, first_step, tolerance, &count);
            return Answer{end_error<Problem>(x), count};
          },
          [=](double tolerance) { return timed([&] { return run<Problem>(type, first_step, tolerance, nullptr); }); }};
}

}  // namespace

template <class Problem>
std::vector<Solver> gsl_solvers(double first_step) {
  gsl_set_error_handler_off();
  return {gsl_solver<Problem>("gsl rk8pd", gsl_odeiv2_step_rk8pd, first_step),
          gsl_solver<Problem>("gsl msadams", gsl_odeiv2_step_msadams, first_step)};
}

template std::vector<Solver> gsl_solvers<Lorenz>(double);
template std::vector<Solver> gsl_solvers<Arenstorf>(double);
template std::vector<Solver> gsl_solvers<Kepler>(double);
template std::vector<Solver> gsl_solvers<Pleiades>(double);
template std::vector<Solver> gsl_solvers<OuterPlanets>(double);

}  // namespace continuo::bench
