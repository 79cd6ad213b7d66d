// The peer: the GNU Scientific Library's stiff methods, BDF of variable order and the implicit extrapolation method of
// Bader and Deuflhard, by its own driver. Its matrices are dense.
#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <utility>

#include <bench/stiff/measure.hpp>
#include <gsl/gsl_errno.h>
#include <gsl/gsl_odeiv2.h>

namespace continuo::bench {
namespace {

/// GSL hands over numbers and sizes in plain pointers.
template <class Problem>
auto array_at(const double* x) {
  std::array<double, Problem::size> values;
  std::copy_n(x, values.size(), values.begin());
  return values;
}
template <class Problem>
int derivative(double t, const double* x, double* dxdt, void* count) {
  std::array<double, Problem::size> slope;
  Problem{}(t, array_at<Problem>(x), slope);
  std::copy(slope.begin(), slope.end(), dxdt);
  if (count && ++*static_cast<std::size_t*>(count) > 3'000'000) return GSL_EFAILED;  // a run that never ends
  return GSL_SUCCESS;
}
template <class Problem>
int jacobian(double t, const double* x, double* rows, double* dfdt, void*) {
  Problem{}.jacobian(t, array_at<Problem>(x), std::span(rows, Problem::size * Problem::size));
  std::fill_n(dfdt, Problem::size, 0.0);  // none of the problems depends on t
  return GSL_SUCCESS;
}

template <class Problem>
std::array<double, Problem::size> run(const gsl_odeiv2_step_type* type, double tolerance, std::size_t* count,
                                      bool* arrived) {
  constexpr double first_step = 1e-6;  // as for Boost.odeint
  gsl_odeiv2_system system{derivative<Problem>, jacobian<Problem>, Problem::size, count};
  gsl_odeiv2_driver* driver =
      gsl_odeiv2_driver_alloc_y_new(&system, type, first_step, tolerance * absolute_part<Problem>, tolerance);
  auto x = Problem::start();
  double t = 0;
  const int status = gsl_odeiv2_driver_apply(driver, &t, Problem::duration, x.data());
  if (arrived) *arrived = status == GSL_SUCCESS;
  gsl_odeiv2_driver_free(driver);
  return x;
}

template <class Problem>
Solver gsl_solver(std::string name, const gsl_odeiv2_step_type* type) {
  return {std::move(name), false,
          [=](double tolerance) {
            std::size_t count = 0;
            bool arrived = false;
            const auto x = run<Problem>(type, tolerance, &count, &arrived);
            return arrived ? judged<Problem>(x, tolerance, count) : Answer{};
          },
          [=](double tolerance) { return timed([&] { return run<Problem>(type, tolerance, nullptr, nullptr); }); }};
}

}  // namespace

template <class Problem>
std::vector<Solver> gsl_stiff_solvers() {
  gsl_set_error_handler_off();
  return {gsl_solver<Problem>("gsl msbdf", gsl_odeiv2_step_msbdf),
          gsl_solver<Problem>("gsl bsimp", gsl_odeiv2_step_bsimp)};
}

template std::vector<Solver> gsl_stiff_solvers<Robertson<>>();
template std::vector<Solver> gsl_stiff_solvers<Hires<>>();
template std::vector<Solver> gsl_stiff_solvers<Oregonator<>>();
template std::vector<Solver> gsl_stiff_solvers<VanDerPol<>>();
template std::vector<Solver> gsl_stiff_solvers<VanDerPolScaled<>>();
template std::vector<Solver> gsl_stiff_solvers<Pollution<>>();

}  // namespace continuo::bench
