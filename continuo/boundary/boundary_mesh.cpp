// Where the mesh begins, and where it is made finer or coarser.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <utility>

#include <continuo/boundary/boundary_mesh.hpp>
#include <continuo/boundary/lobatto.hpp>

namespace continuo::boundary {

namespace {

constexpr std::size_t intervals_at_first = 8;              // of each part between two times of conditions
constexpr double most_refined = 6, most_coarsened = 0.25;  // intervals made of one
constexpr double most_growth = 4;                          // of the whole mesh
constexpr double wanted_part = 0.3;                        // of the goal, that a new mesh aims at

}  // namespace

std::vector<double> first_mesh(const BoundaryValueProblem& problem, const BoundaryValueOptions& options) {
  std::vector<double> mesh(options.mesh);
  std::erase_if(mesh, [&](double t) { return !(t > problem.times.front() && t < problem.times.back()); });
  const bool even = mesh.empty();
  mesh.insert(mesh.end(), problem.times.begin(), problem.times.end());
  for (std::size_t i = 0; even && i + 1 < problem.times.size(); ++i) {
    const double from = problem.times[i], h = (problem.times[i + 1] - from) / double(intervals_at_first);
    for (std::size_t k = 1; k < intervals_at_first; ++k) mesh.push_back(from + h * static_cast<double>(k));
  }
  std::ranges::sort(mesh);
  mesh.erase(std::ranges::unique(mesh).begin(), mesh.end());
  return mesh;
}

std::vector<double> remeshed(const std::vector<double>& mesh, std::span<const double> wanted,
                             std::span<const double> fixed) {
  std::vector<double> result{mesh.front()};
  std::size_t k = 0;
  for (std::size_t part = 0; part + 1 < fixed.size(); ++part) {
    const std::size_t first = k;
    double total = 0;
    for (; k < wanted.size() && mesh[k] < fixed[part + 1]; ++k) total += wanted[k];
    const double count = std::max(2.0, std::ceil(total));
    double sum = 0;
    double next = 1;
    for (std::size_t i = first; i < k; ++i) {
      const double share = wanted[i] * count / total;
      for (; next <= sum + share && next < count - 0.5; ++next) {
        const double t = mesh[i] + (next - sum) / share * (mesh[i + 1] - mesh[i]);
        if (t > result.back() && t < fixed[part + 1]) result.push_back(t);  // as far as there are digits of t
      }
      sum += share;
    }
    result.push_back(fixed[part + 1]);
  }
  return result;
}

namespace {

std::vector<double> within_growth(std::vector<double> wanted) {
  const double total = std::accumulate(wanted.begin(), wanted.end(), 0.0);
  const double most = most_growth * static_cast<double>(wanted.size()) + 50;
  if (total > most)
    for (double& count : wanted) count *= most / total;
  return wanted;
}

}  // namespace

std::vector<double> wanted_intervals(std::span<const double> residuals, double goal) {
  std::vector<double> wanted(residuals.size());
  for (std::size_t k = 0; k < wanted.size(); ++k) {
    const double power = std::pow(residuals[k] / (wanted_part * goal), 1.0 / static_cast<double>(lobatto4.stages));
    wanted[k] = std::clamp(power, most_coarsened, most_refined);
  }
  return within_growth(std::move(wanted));
}

std::vector<double> wanted_for_error(std::span<const double> shares, double factor) {
  std::vector<double> wanted(shares.size(), 2.0);
  const double mean = std::accumulate(shares.begin(), shares.end(), 0.0) / static_cast<double>(shares.size());
  for (std::size_t k = 0; k < wanted.size() && mean > 0; ++k) {
    const double power = std::pow(shares[k] / (wanted_part * factor * mean), 1.0 / double(lobatto4.stages + 1));
    wanted[k] = std::clamp(power, 1.0, most_refined);
  }
  return within_growth(std::move(wanted));
}

}  // namespace continuo::boundary
