// Newton's iteration on one mesh after the other, until the residuals are below the tolerances.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <continuo/boundary/number_size.hpp>
#include <continuo/boundary/two_point.hpp>
#include <continuo/boundary/two_point_equations.hpp>

namespace continuo::boundary {

namespace {

constexpr std::size_t most_meshes_for_conditions = 10;
constexpr double most_relative_error = 0.3;  // of a solution that is one
constexpr std::size_t most_doubts = 2;       // halving all intervals divides the error by 16, where there is a solution
/// Times the tolerance: with such residuals y changes so little on the next mesh that the derivatives serve again.
constexpr double near = 10;
/// Times the tolerance: of an accepted mesh such residuals are found once more by more points, since the few of the
/// first estimate see up to three times too little of what varies within an interval.
constexpr double refined_from = 0.3;
constexpr double much_too_large = 100;  // times the tolerance: such intervals are cut in three, not in two

/// Into how many parts each interval is to be cut.
std::vector<std::size_t> parts_of_intervals(const std::vector<double>& residuals, double tolerance) {
  std::vector<std::size_t> parts;
  parts.reserve(residuals.size());
  for (const double residual : residuals)
    parts.push_back(residual >= much_too_large * tolerance ? 3 : residual > tolerance ? 2 : 1);
  return parts;
}

/// The end of a part of an interval, one of two or of three.
double inner_node(double first, double last, std::size_t part, std::size_t parts) {
  if (parts == 2) return 0.5 * (first + last);
  return part == 1 ? (2 * first + last) / 3 : (first + 2 * last) / 3;
}

/// Of a cubic at s.
template <class Number>
Number value(const std::array<Number, 4>& c, double s) {
  return ((c[0] * s + c[1]) * s + c[2]) * s + c[3];
}

template <class Number>
class TwoPointSearch {
 public:
  TwoPointSearch(const TwoPointProblem<Number>& problem, const TwoPointOptions& options)
      : problem_(problem), options_(options) {}

  TwoPointSolution<Number> operator()(std::vector<double> x, std::vector<Number> y, std::vector<Number> p) {
    TwoPointFunctions<Number> functions(problem_, x.front());
    functions.restrict_first(std::span(y).first(problem_.size));
    solution_.x = std::move(x);
    for (;;) {
      std::vector<Number> z(std::move(y));
      z.insert(z.end(), p.begin(), p.end());
      TwoPointEquations<Number> equations(functions, solution_.x, std::move(z), std::move(known_));
      const bool begins = equations.is_finite(solution_);
      const NewtonEnding ending =
          begins ? equations.iterate(options_.tolerance, options_.condition_tolerance) : NewtonEnding::not_finite;
      keep(equations, begins);
      if (is_done(equations, ending, begins)) return std::move(solution_);
      p = solution_.p;
      y = refine(equations, ending == NewtonEnding::converged && functions.points_are_independent());
      if (y.empty()) return std::move(solution_);
    }
  }

 private:
  void keep(TwoPointEquations<Number>& equations, bool has_values) {
    solution_.y.assign(equations.y().begin(), equations.y().end());
    solution_.p.assign(equations.p().begin(), equations.p().end());
    const std::vector<Number>& f = equations.f_at_nodes();
    const std::size_t n = problem_.size, nodes = solution_.x.size();
    solution_.f.resize(n * nodes);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t k = 0; k < nodes; ++k) solution_.f[k * n + i] = f[i * nodes + k];
    solution_.residuals = has_values ? equations.residuals()
                                     : std::vector(solution_.x.size() - 1, std::numeric_limits<double>::quiet_NaN());
    TwoPointProgress& last = solution_.last;
    ++last.iteration;
    last.nodes = solution_.x.size();
    last.residual = std::ranges::max(solution_.residuals);
    last.condition = 0;
    for (const Number& g : equations.conditions()) last.condition = std::max(last.condition, size_of(g));
  }

  /// Whether the search ends here; else `parts_` says how the mesh is to be refined.
  bool is_done(TwoPointEquations<Number>& equations, NewtonEnding newton, bool begins) {
    using enum TwoPointEnding;
    if (newton == NewtonEnding::singular) return end(singular);
    if (newton == NewtonEnding::not_finite) {
      if (begins) solution_.not_finite = TwoPointQuantity::jacobian;
      return end(not_finite);
    }
    if (!equations.is_finite(solution_)) return end(not_finite);
    if (std::ranges::all_of(solution_.residuals, [this](double r) { return r <= options_.tolerance; })) {
      equations.refine_residuals(solution_.residuals, refined_from * options_.tolerance);
      solution_.last.residual = std::ranges::max(solution_.residuals);
    }
    const auto strange = std::ranges::find_if_not(solution_.residuals, [](double r) { return std::isfinite(r); });
    if (strange != solution_.residuals.end()) {
      solution_.not_finite = TwoPointQuantity::derivative;
      solution_.where = solution_.x[static_cast<std::size_t>(strange - solution_.residuals.begin())];
      return end(not_finite);
    }
    parts_ = parts_of_intervals(solution_.residuals, options_.tolerance);
    TwoPointProgress& last = solution_.last;
    if (std::ranges::max(parts_) == 1 && is_doubtful(equations)) {
      if (doubts_ > most_doubts) return end(undetermined);
      std::ranges::fill(parts_, 2);
    }
    last.added = 0;
    for (const std::size_t parts : parts_) last.added += parts - 1;
    last.exceeds = last.nodes + last.added > options_.most_nodes;
    if (options_.progress) options_.progress(last);
    if (last.exceeds) return end(too_many_nodes);
    if (last.added > 0) return false;
    if (last.condition <= options_.condition_tolerance) return end(solved);
    return last.iteration >= most_meshes_for_conditions && end(conditions_not_met);
  }
  /// Where the residual, small as it is, may have made all of the solution: the conditions may then determine none.
  bool is_doubtful(TwoPointEquations<Number>& equations) {
    if (equations.relative_error(options_.tolerance) < most_relative_error) return false;
    ++doubts_;
    return true;
  }
  bool end(TwoPointEnding ending) {
    solution_.ending = ending;
    return true;
  }

  void begin_known(std::size_t nodes) {
    for (auto [known, points] : {std::pair(&known_.nodes, nodes), std::pair(&known_.middles, nodes - 1)})
      known->f.assign(problem_.size * points, Number{}), known->is_missing.assign(points, true);
  }
  /// The derivatives on the mesh, which the refined one has where it has the points. They are kept where the solution
  /// is so near that it will hardly change.
  void keep_jacobians(const PointJacobians<Number>& old, std::size_t nodes) {
    const std::size_t block = problem_.size * problem_.size, border = problem_.size * problem_.parameters;
    PointJacobians<Number>& to = known_.jacobians;
    to.by_y.resize((2 * nodes - 1) * block), to.by_p.resize((2 * nodes - 1) * border);
    known_.jacobian_is_known.assign(2 * nodes - 1, false);
    const auto keep = [&](std::size_t point, std::size_t from) {
      std::copy_n(&old.by_y[from * block], block, &to.by_y[point * block]);
      std::copy_n(old.by_p.data() + from * border, border, to.by_p.data() + point * border);
      known_.jacobian_is_known[point] = true;
    };
    std::size_t point = 0;
    for (std::size_t k = 0; k < parts_.size(); ++k) {
      keep(point, 2 * k);
      if (parts_[k] < 3) keep(point + parts_[k], 2 * k + 1);  // the middle stays one, or is a node now
      point += 2 * parts_[k];
    }
    keep(point, 2 * parts_.size());
  }
  /// The mesh refined, and y there by the spline; empty where nodes would be equal in the digits of a double. f is
  /// known at the old nodes, at new ones that were middles, and in the middles of intervals that are not cut.
  std::vector<Number> refine(const TwoPointEquations<Number>& equations, bool is_converged) {
    const std::size_t n = problem_.size, old_nodes = solution_.x.size();
    const std::size_t nodes = old_nodes + solution_.last.added;
    std::vector<double> x;
    std::vector<Number> y;
    x.reserve(nodes), y.reserve(n * nodes + problem_.parameters);
    begin_known(nodes);
    known_.jacobian_is_known.clear();
    if (is_converged && solution_.last.residual < near * options_.tolerance)
      keep_jacobians(equations.jacobians(), nodes);
    const auto keep_slope = [n](PartlyKnown<Number>& to, std::size_t point, std::size_t points,
                                const std::vector<Number>& f, std::size_t from, std::size_t old_points) {
      to.is_missing[point] = false;
      for (std::size_t i = 0; i < n; ++i) to.f[i * points + point] = f[i * old_points + from];
    };
    for (std::size_t k = 0; k < old_nodes; ++k) {
      const double first = solution_.x[k];
      keep_slope(known_.nodes, x.size(), nodes, equations.f_at_nodes(), k, old_nodes);
      x.push_back(first);
      for (std::size_t i = 0; i < n; ++i) y.push_back(solution_.y[k * n + i]);
      if (k + 1 == old_nodes) break;
      const std::vector<Number>& middles = equations.f_in_middles();
      if (parts_[k] == 1) keep_slope(known_.middles, x.size() - 1, nodes - 1, middles, k, old_nodes - 1);
      if (parts_[k] == 2) keep_slope(known_.nodes, x.size(), nodes, middles, k, old_nodes - 1);
      for (std::size_t part = 1; part < parts_[k]; ++part) {
        const double node = inner_node(first, solution_.x[k + 1], part, parts_[k]);
        x.push_back(node);
        for (std::size_t i = 0; i < n; ++i) y.push_back(value(equations.spline(k, i), node - first));
      }
    }
    const auto is_too_short = [](double a, double b) { return !(b > a && a + (b - a) / 4 > a); };
    const auto too_short = std::ranges::adjacent_find(x, is_too_short);
    if (too_short != x.end()) {
      solution_.where = *too_short;
      end(TwoPointEnding::too_fine);
      return {};
    }
    solution_.x = std::move(x);
    return y;
  }

  const TwoPointProblem<Number>& problem_;
  const TwoPointOptions& options_;
  TwoPointSolution<Number> solution_;
  std::vector<std::size_t> parts_;
  std::size_t doubts_ = 0;
  KnownSlopes<Number> known_;  // on the next mesh
};

}  // namespace

template <class Number>
TwoPointSolution<Number> solve_two_point(const TwoPointProblem<Number>& problem, std::vector<double> x,
                                         std::vector<Number> y, std::vector<Number> p, const TwoPointOptions& options) {
  return TwoPointSearch<Number>(problem, options)(std::move(x), std::move(y), std::move(p));
}

template TwoPointSolution<double> solve_two_point(const TwoPointProblem<double>&, std::vector<double>,
                                                  std::vector<double>, std::vector<double>, const TwoPointOptions&);
template TwoPointSolution<ComplexNumber<double>> solve_two_point(const TwoPointProblem<ComplexNumber<double>>&,
                                                                 std::vector<double>,
                                                                 std::vector<ComplexNumber<double>>,
                                                                 std::vector<ComplexNumber<double>>,
                                                                 const TwoPointOptions&);

}  // namespace continuo::boundary
