// The list of difference schemes, and the prediction of their best step.
#include <continuo/studies/difference_schemes.hpp>

namespace continuo::studies {

namespace {

template <class Real>
double error_of(const DifferenceScheme& scheme, const std::function<Real(Real)>& f, double at, double step,
                double exact) {
  const auto x = static_cast<Real>(at), h = static_cast<Real>(step);
  const Real above = x + h, below = x - h;
  if (above == x || below == x) return std::numeric_limits<double>::quiet_NaN();
  const std::array<Real, 3> values{f(below), f(x), f(above)};
  Real sum = 0;
  for (std::size_t k = 0; k < values.size(); ++k)
    if (scheme.weights[k] != 0) sum += static_cast<Real>(scheme.weights[k]) * values[k];
  const Real derivative = scheme.derivative == 1 ? sum / h : sum / (h * h);
  const double error = std::abs(double{derivative} - exact);
  return exact != 0 ? error / std::abs(exact) : error;
}

template <class Real>
Balance predict(const DifferenceScheme& scheme, const ErrorCurve& curve, double value, double exact) {
  double weights = 0;
  for (const double weight : scheme.weights) weights += std::abs(weight);
  const double rounding = weights * std::abs(value) * double{std::numeric_limits<Real>::epsilon()} / 2;
  return balance(curve.constant, scheme.order, rounding / (exact != 0 ? std::abs(exact) : 1), scheme.derivative);
}

}  // namespace

std::vector<DifferenceErrors> converge_differences(const std::function<double(double)>& f,
                                                   const std::function<float(float)>& in_float, double x,
                                                   double first_derivative, double second_derivative) {
  constexpr int halvings = 52;
  std::vector<DifferenceErrors> result;
  for (const DifferenceScheme& scheme : difference_schemes) {
    const double exact = scheme.derivative == 1 ? first_derivative : second_derivative;
    // In float x itself is another number: the derivatives are still those at x, and the error that this makes is below
    // that of rounding f.
    DifferenceErrors errors{.scheme = scheme,
                            .steps = {},
                            .in_double = {},
                            .in_float = {},
                            .of_double = {},
                            .of_float = {},
                            .predicted = {},
                            .predicted_in_float = {}};
    for (int k = 0; k <= halvings; ++k) {
      const double h = std::ldexp(1.0, -k);
      errors.steps.push_back(h);
      errors.in_double.push_back(error_of<double>(scheme, f, x, h, exact));
      errors.in_float.push_back(error_of<float>(scheme, in_float, x, h, exact));
    }
    errors.of_double = read_errors(errors.steps, errors.in_double);
    errors.of_float = read_errors(errors.steps, errors.in_float);
    errors.predicted = predict<double>(scheme, errors.of_double, f(x), exact);
    errors.predicted_in_float = predict<float>(scheme, errors.of_double, f(x), exact);
    result.push_back(std::move(errors));
  }
  return result;
}

}  // namespace continuo::studies
