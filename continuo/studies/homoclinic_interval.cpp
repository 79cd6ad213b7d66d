// Where a homoclinic orbit is cut off, and its mesh: from a closed orbit to begin with, then as it needs them.
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <unsupported/Eigen/MatrixFunctions>
#include <utility>

#include <continuo/studies/closed_view.hpp>
#include <continuo/studies/equilibrium.hpp>
#include <continuo/studies/homoclinic_steps.hpp>
#include <continuo/studies/vector_algebra.hpp>

namespace continuo::studies::detail {

namespace {

using Vector = std::vector<double>;
using Index = Eigen::Index;

constexpr std::size_t interval_nodes = OrbitCollocation::degree;
constexpr std::size_t most_homoclinic_intervals = 300, most_to_lengthen = 150;
constexpr std::size_t most_added_intervals = 30;
// How far an end may be from the saddle, in sizes, how far it is to be, and where it need not be that near.
constexpr double ends_within = 1e-4, ends_wished = 1e-5, ends_needless = 1e-7;
// Next to a saddle-node motions come like 1/t, ever nearer in ever more time; nor need they where that is hardly felt.
constexpr double slow = 2;  // the rate times the length
constexpr double slow_ends_within = 1e-2, hardly_felt = 1e-10;
constexpr double error_at_most = 1000;  // of the error wanted: with which a mesh serves that could not be made better
constexpr double most_longer = 10;      // times as long, in one go
constexpr double worth_it = 1.02;       // likewise
constexpr double at_saddle = 0.1;       // of the orbit's size: how near to the saddle the closed orbit passes
constexpr double hyperbolic = 1e-6;     // of the largest eigenvalue: the least real part to begin with

/// y that moves by the linear part at the saddle within one of its spaces, in which all rates have one sign, for a time
/// of that sign, so that nothing grows.
class LinearTail {
 public:
  LinearTail(const Eigen::MatrixXd& a, const Eigenspace& space)
      : basis_(real_basis(space.right)), within_(basis_.transpose() * a * basis_) {}
  Eigen::VectorXd operator()(const Eigen::VectorXd& y, double t) const {
    const Eigen::MatrixXd motion = (within_ * t).exp();
    return basis_ * (motion * (basis_.transpose() * y));
  }

 private:
  Eigen::MatrixXd basis_, within_;
};

}  // namespace

std::optional<HomoclinicPlace> HomoclinicSteps::first(const OrbitMark& mark, std::string& message) {
  const auto mesh = std::make_shared<const OrbitMesh>(mark.mesh);
  const std::size_t closed_nodes = (mesh->size() - 1) * interval_nodes;
  Vector nodes(mark.unknowns.begin(), mark.unknowns.begin() + static_cast<std::ptrdiff_t>(closed_nodes * n_));
  for (std::size_t i = 0; i < n_; ++i) nodes.push_back(nodes[i] + (system_.advance.empty() ? 0 : system_.advance[i]));
  const double period = mark.unknowns[closed_nodes * n_];
  Vector p(system_.constants);
  p[options_.constants[0]] = mark.unknowns[closed_nodes * n_ + 1];

  // The saddle is where the orbit is slowest.
  Vector low(n_, std::numeric_limits<double>::infinity()), high(n_, -std::numeric_limits<double>::infinity());
  for (std::size_t j = 0; j < nodes.size(); ++j) {
    low[j % n_] = std::min(low[j % n_], nodes[j]);
    high[j % n_] = std::max(high[j % n_], nodes[j]);
  }
  Vector size(n_);
  for (std::size_t i = 0; i < n_; ++i) size[i] = high[i] > low[i] ? high[i] - low[i] : 1;
  std::size_t slowest = 0;
  double least = std::numeric_limits<double>::infinity();
  Vector f(n_);
  for (std::size_t k = 0; k < closed_nodes; ++k) {
    system_.derivative(0, Values(nodes).subspan(k * n_, n_), p, f);
    double speed = 0;
    for (std::size_t i = 0; i < n_; ++i) speed += std::pow(f[i] / size[i], 2);
    if (speed < least) least = speed, slowest = k;
  }
  const auto begin = nodes.begin() + static_cast<std::ptrdiff_t>(slowest * n_);
  const auto found = find_equilibrium(system_, Vector(begin, begin + static_cast<std::ptrdiff_t>(n_)), p);
  double apart = 0;
  for (std::size_t i = 0; i < n_; ++i)
    apart = std::max(apart, std::abs(found.x[i] - begin[static_cast<std::ptrdiff_t>(i)]) / size[i]);
  if (found.ending != EquilibriumEnding::found || apart > at_saddle) {
    message = "the orbit of long period does not pass next to a place of rest";
    return std::nullopt;
  }
  const auto values = describe_equilibrium(system_, found.x, p).eigenvalues;
  double largest = 0;
  for (const auto& value : values) largest = std::max(largest, std::abs(value));
  stable_ = 0;
  for (const auto& value : values) {
    if (std::abs(value.real()) < hyperbolic * largest) {
      message =
          "the place of rest next to which the orbit passes is no saddle: it has an eigenvalue on the imaginary axis";
      return std::nullopt;
    }
    if (value.real() < 0) ++stable_;
  }
  if (stable_ == 0 || stable_ == n_) {
    message = "the place of rest next to which the orbit passes is no saddle";
    return std::nullopt;
  }

  // From there once round.
  const ClosedView closed(n_, nodes, mesh);
  const double from = closed.orbit().place(slowest);
  OrbitMesh turned;
  for (const double s : *mesh)
    if (s > from && s < from + 1) turned.push_back(s - from);
  for (const double s : *mesh)
    if (s > 0 && s <= from) turned.push_back(s + 1 - from);
  OrbitMesh own{0};
  for (const double s : turned)
    if (s > own.back() + 1e-9 && s < 1 - 1e-9) own.push_back(s);
  own.push_back(1);
  const auto mesh_of_own = std::make_shared<const OrbitMesh>(std::move(own));
  use(mesh_of_own, period);
  Vector z(equations_->unknowns());
  for (std::size_t k = 0; k < equations_->nodes(); ++k) {
    const std::size_t interval = std::min(k / interval_nodes, mesh_->size() - 2), j = k - interval * interval_nodes;
    const double s =
        from + (*mesh_)[interval] + OrbitCollocation::table().nodes[j] * ((*mesh_)[interval + 1] - (*mesh_)[interval]);
    const auto x = std::span(z).subspan(k * n_, n_);
    closed.state(s > 1 ? s - 1 : s, x);
    if (s > 1 && !system_.advance.empty())
      for (std::size_t i = 0; i < n_; ++i) x[i] += system_.advance[i];
  }
  std::ranges::copy(found.x, z.begin() + static_cast<std::ptrdiff_t>(equations_->rest()));
  for (std::size_t c = 0; c < 2; ++c) z[equations_->rest() + n_ + c] = p[options_.constants[c]];
  measure(z);
  for (const std::size_t unknown : {z.size() - 1, z.size() - 2}) {
    Vector row(z.size());
    row[unknown] = 1;
    auto place = corrected(z, z, row, nullptr);
    if (!place) continue;
    longest_ = std::numeric_limits<double>::infinity();
    for (int k = 0; k < 5; ++k)
      if (!renew(*place) ||
          (place->error <= error_wanted_ && std::max(place->apart_first, place->apart_last) <= ends_within))
        break;
    longest_ = options_.longest_period * place->length;
    return place;
  }
  message = "no homoclinic orbit is found near the orbit of long period";
  return std::nullopt;
}

bool HomoclinicSteps::move_to(HomoclinicPlace& place, const std::shared_ptr<const OrbitMesh>& mesh, double begin,
                              double end) {
  const std::size_t rest = equations_->rest();
  if (!equations_->refer_to(place.z, sizes_, scale_)) return false;  // they may be new
  const Eigen::MatrixXd a = equations_->matrix_at(Values(place.z).subspan(rest, n_), Values(place.z).last(2));
  const LinearTail before(a, place.spaces.unstable), after(a, place.spaces.stable);
  const double length_of_old = place.length;
  const std::size_t count = (mesh->size() - 1) * interval_nodes + 1;
  const auto moved = [&](const Vector& z, bool turns) {
    const ClosedView old(n_, Values(z).first(rest), place.mesh);
    const auto end_from_rest = [&](bool at_end) {
      Eigen::VectorXd y(static_cast<Index>(n_));
      for (std::size_t i = 0; i < n_; ++i)
        y(static_cast<Index>(i)) = (z[(at_end ? rest - n_ : 0) + i] - z[rest + i] -
                                    (at_end && turns && !system_.advance.empty() ? system_.advance[i] : 0)) /
                                   sizes_[i];
      return y;
    };
    const Eigen::VectorXd at_begin = end_from_rest(false), at_end = end_from_rest(true);
    Vector result;
    Vector x(n_);
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t interval = std::min(k / interval_nodes, mesh->size() - 2), j = k - interval * interval_nodes;
      const double s = begin + (end - begin) * ((*mesh)[interval] + OrbitCollocation::table().nodes[j] *
                                                                        ((*mesh)[interval + 1] - (*mesh)[interval]));
      if (s >= 0 && s <= 1) {
        old.state(s, x);
      } else {
        const Eigen::VectorXd y = s < 0 ? before(at_begin, s * length_of_old) : after(at_end, (s - 1) * length_of_old);
        for (std::size_t i = 0; i < n_; ++i)
          x[i] = z[rest + i] + sizes_[i] * y(static_cast<Index>(i)) +
                 (s > 1 && turns && !system_.advance.empty() ? system_.advance[i] : 0);
      }
      result.insert(result.end(), x.begin(), x.end());
    }
    result.insert(result.end(), z.begin() + static_cast<std::ptrdiff_t>(rest), z.end());
    return result;
  };
  Vector tangent(place.tangent);
  for (std::size_t j = 0; j < tangent.size(); ++j) tangent[j] *= scale_[j];
  const Vector z = moved(place.z, true);
  tangent = moved(tangent, false);
  std::vector<Vector> carried;
  for (const Vector& each : place.carried) carried.push_back(moved(each, false));
  use(mesh, length_of_old * (end - begin));
  measure(z);
  for (std::size_t j = 0; j < tangent.size(); ++j) tangent[j] /= scale_[j];
  normalize(tangent);
  auto again = corrected(z, z, tangent, &place);
  if (!again) return false;
  place = std::move(*again);
  place.carried = std::move(carried);
  return true;
}

/// Longer where an end is too far from the saddle, shorter where it is needlessly near.
bool HomoclinicSteps::lengthened(HomoclinicPlace& place) {
  use(place.mesh, place.length);
  measure(place.z);
  const std::size_t rest = equations_->rest();
  const auto missing = [&](double apart, const Eigenspace& space) {
    const double rate = std::abs(space.eigenvalues.front().real());
    if (rate * place.length < slow && place.point.truncation < hardly_felt)
      return std::clamp(apart / slow_ends_within - 1, 0.0, most_longer);
    const double wish = apart > ends_within ? std::log(apart / ends_wished) / (rate * place.length) : 0;
    return std::min(wish, most_longer);
  };
  double before = missing(place.apart_first, place.spaces.unstable),
         after = missing(place.apart_last, place.spaces.stable);
  // No longer than is allowed, nor than so many intervals as fine as these can serve.
  const double by_intervals = static_cast<double>(most_to_lengthen) / static_cast<double>(place.mesh->size() - 1);
  const double room = std::max(0.0, std::min(longest_ / place.length, by_intervals) - 1);
  if (before + after > room) {
    const double part = room / (before + after);
    before *= part;
    after *= part;
  }
  const auto apart_at = [&](std::size_t node, bool at_end) {
    double apart = 0;
    for (std::size_t i = 0; i < n_; ++i) {
      const double turn = at_end && !system_.advance.empty() ? system_.advance[i] : 0;
      apart = std::max(apart, std::abs(place.z[node * n_ + i] - place.z[rest + i] - turn) / sizes_[i]);
    }
    return apart;
  };
  const OrbitMesh& old = *place.mesh;
  double begin = -before, end = 1 + after;
  const std::size_t intervals = old.size() - 1;
  if (place.apart_first < ends_needless)
    for (std::size_t k = 1; k < intervals && apart_at(k * interval_nodes, false) < ends_wished; ++k) begin = old[k];
  if (place.apart_last < ends_needless)
    for (std::size_t k = intervals - 1; k > 0 && apart_at(k * interval_nodes, true) < ends_wished; --k) end = old[k];
  if (!(begin < end)) return false;
  const double change = end - begin;
  if (change < worth_it && change > 1 / worth_it) return true;
  const auto mesh = std::make_shared<OrbitMesh>();
  const auto add = [&](double from, double to, double width) {
    const auto count = std::clamp<std::size_t>(static_cast<std::size_t>((to - from) / width), 1, most_added_intervals);
    for (std::size_t k = 0; k < count; ++k)
      mesh->push_back(from + (to - from) * static_cast<double>(k) / static_cast<double>(count));
  };
  if (begin < 0) add(begin, 0, old[1]);
  for (const double s : old)
    if (s >= begin && s <= end) mesh->push_back(s);
  if (end > 1) {
    mesh->pop_back();
    add(1, end, 1 - old[intervals - 1]);
    mesh->push_back(end);
  }
  for (double& s : *mesh) s = (s - begin) / change;
  mesh->front() = 0;
  mesh->back() = 1;
  return move_to(place, mesh, begin, end);
}

bool HomoclinicSteps::refined(HomoclinicPlace& place) {
  use(place.mesh, place.length);
  measure(place.z);
  const ClosedView closed(n_, Values(place.z).first(equations_->rest()), place.mesh);
  const auto errors = closed.errors(sizes_);
  const auto mesh = closed.orbit().better_mesh(errors, error_wanted_ / 10, most_homoclinic_intervals);
  if (std::ranges::max(errors) <= error_wanted_ / 2 && 2 * mesh->size() >= place.mesh->size()) return true;
  return move_to(place, mesh, 0, 1);
}

bool HomoclinicSteps::renew(HomoclinicPlace& place) {
  HomoclinicPlace other(place);
  if (lengthened(other)) place = other;
  other = place;
  if (refined(other)) place = std::move(other);
  return place.error <= error_at_most * error_wanted_;
}

}  // namespace continuo::studies::detail
