// Where a homoclinic orbit is cut off, and its mesh: from a closed orbit to begin with, then as it needs them.
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <unsupported/Eigen/MatrixFunctions>
#include <utility>

#include <continuo/studies/equilibrium.hpp>
#include <continuo/studies/orbits/collocation/closed_view.hpp>
#include <continuo/studies/orbits/curves/homoclinic_steps.hpp>
#include <continuo/studies/support/arclength.hpp>
#include <continuo/studies/support/vector_algebra.hpp>

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
constexpr double slowly = 2;  // the rate times the length
constexpr double slow_ends_within = 1e-2, hardly_felt = 1e-10;
constexpr double error_at_most = 1000;  // of the error wanted: with which a mesh serves that could not be made better
constexpr double most_longer = 10;      // times as long, in one go
constexpr double most_longer_along_centre = 5;  // to begin with; less where that is not found
constexpr double worth_it = 1.02;               // likewise
constexpr int most_improvements = 8;
constexpr int most_lengthenings = 20;  // along a centre, where what an end misses dies away as slowly as 1 / t
// In sizes: where a closed orbit near a saddle-node is like a homoclinic one. It is the more so the farther out.
constexpr std::array outside_of_ghost{0.01, 0.02, 0.05, 0.1};
constexpr double at_saddle = 0.1;    // of the orbit's size: how near to the saddle the closed orbit passes
constexpr double hyperbolic = 1e-6;  // of the largest eigenvalue: the least real part to begin with

/// Beyond an end: y moves by the linear part at the saddle within one of its spaces, in which all rates have one sign,
/// for a time of that sign, so that nothing grows. Along a centre it dies away as y' = c y^2 has it.
class Tail {
 public:
  /// `y`: of the end, in sizes.
  Tail(const Eigen::MatrixXd& a, const Eigenspace& space, const std::optional<Centre>& centre, double curvature,
       const Eigen::VectorXd& y)
      : y_(y), centre_(centre), curvature_(curvature) {
    if (space.dimension() == 0) return;
    basis_ = real_basis(space.right);
    within_ = basis_.transpose() * a * basis_;
  }
  Eigen::VectorXd state(double t) const { return moved(y_, t, 1 / slower(t)); }
  /// Of a small change of y at the end.
  Eigen::VectorXd change(const Eigen::VectorXd& dy, double t) const {
    return moved(dy, t, 1 / (slower(t) * slower(t)));
  }

 private:
  double slower(double t) const { return centre_ ? std::max(1.0, 1 - curvature_ * centre_->left.dot(y_) * t) : 1; }
  Eigen::VectorXd moved(const Eigen::VectorXd& y, double t, double along_centre) const {
    Eigen::VectorXd result = Eigen::VectorXd::Zero(y.size());
    Eigen::VectorXd rest = y;
    if (centre_) {
      const Eigen::VectorXd part = centre_->left.dot(y) * centre_->right;
      result += along_centre * part;
      rest -= part;
    }
    if (within_.size() == 0) return result;
    const Eigen::MatrixXd motion = (within_ * t).exp();
    return result + basis_ * (motion * (basis_.transpose() * rest));
  }

  Eigen::VectorXd y_;
  std::optional<Centre> centre_;
  double curvature_;
  Eigen::MatrixXd basis_{}, within_{};
};

/// Intervals before 0 or behind 1 that grow from `width` there, each twice as long as its neighbour. The last point,
/// `to`, is left out.
void add_graded(OrbitMesh& mesh, double from, double to, double width) {
  const double whole = to - from;
  std::vector<double> reached{0};
  for (double next = width; reached.back() + 1.5 * next < whole; next *= 2) reached.push_back(reached.back() + next);
  reached.push_back(whole);
  const std::size_t last = reached.size() - 1;
  for (std::size_t k = 0; k < last; ++k) mesh.push_back(from < 0 ? to - reached[last - k] : from + reached[k]);
}

}  // namespace

Result<HomoclinicPlace> HomoclinicSteps::first(const OrbitMark& mark) {
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
  const Vector slow(nodes.begin() + static_cast<std::ptrdiff_t>(slowest * n_),
                    nodes.begin() + static_cast<std::ptrdiff_t>((slowest + 1) * n_));
  const auto found = find_equilibrium(system_, slow, p);
  double apart = 0;
  for (std::size_t i = 0; i < n_; ++i) apart = std::max(apart, std::abs(found.x[i] - slow[i]) / size[i]);
  const bool is_near = found.ending == EquilibriumEnding::found && apart <= at_saddle;
  bool is_hyperbolic = is_near;
  if (is_near) {
    kind_ = {};
    const auto values = describe_equilibrium(system_, found.x, p).eigenvalues;
    double largest = 0;
    for (const auto& value : values) largest = std::max(largest, std::abs(value));
    for (const auto& value : values) {
      is_hyperbolic = is_hyperbolic && std::abs(value.real()) >= hyperbolic * largest;
      if (value.real() < 0) ++kind_.stable;
    }
  }
  std::optional<SaddleNode> fold;
  if (!is_hyperbolic)
    fold = saddle_node_near(system_, options_.constants[0], slow, p, size, options_.high[0] - options_.low[0]);
  if (!is_hyperbolic && !fold)
    return not_found(is_near ? "the equilibrium next to which the orbit passes is no saddle: it has an eigenvalue on "
                               "the imaginary axis"
                             : "the orbit of long period does not pass next to an equilibrium");
  if (!fold && (kind_.stable == 0 || kind_.stable == n_))
    return not_found("the equilibrium next to which the orbit passes is no saddle");

  // From there once round.
  const ClosedView closed(n_, nodes, mesh);
  const double from = closed.orbit().place(slowest);
  OrbitMesh turned;
  for (const double s : *mesh)
    if (s > from && s < from + 1) turned.push_back(s - from);
  for (const double s : *mesh)
    if (s > 0 && s <= from) turned.push_back(s + 1 - from);
  double narrowest = 1;
  for (std::size_t k = 0; k + 1 < mesh->size(); ++k) narrowest = std::min(narrowest, (*mesh)[k + 1] - (*mesh)[k]);
  OrbitMesh own{0};
  for (const double s : turned)
    if (s > own.back() + narrowest / 2 && s < 1 - narrowest / 2) own.push_back(s);
  own.push_back(1);
  Vector states(((own.size() - 1) * interval_nodes + 1) * n_);
  for (std::size_t k = 0; k < states.size() / n_; ++k) {
    const std::size_t interval = std::min(k / interval_nodes, own.size() - 2), j = k - interval * interval_nodes;
    const double s = from + own[interval] + OrbitCollocation::table().nodes[j] * (own[interval + 1] - own[interval]);
    const auto x = std::span(states).subspan(k * n_, n_);
    closed.state(s > 1 ? s - 1 : s, x);
    if (s > 1 && !system_.advance.empty())
      for (std::size_t i = 0; i < n_; ++i) x[i] += system_.advance[i];
  }
  const Status none_near = not_found("no homoclinic orbit is found near the orbit of long period");
  longest_ = std::numeric_limits<double>::infinity();
  if (fold) {
    auto central = first_central(own, period, states, *fold);
    return central ? Result<HomoclinicPlace>(std::move(*central)) : none_near;
  }
  states.insert(states.end(), found.x.begin(), found.x.end());
  for (std::size_t c = 0; c < 2; ++c) states.push_back(p[options_.constants[c]]);
  auto place = settled(std::make_shared<const OrbitMesh>(std::move(own)), period, states);
  if (!place) return none_near;
  improve(*place);
  longest_ = options_.longest_period * place->length;
  return *std::move(place);
}

// Along the centre a closed orbit near by needs about as long as one of the saddle-node, where it is far enough from
// it: what lies nearer is cut off.
std::optional<HomoclinicPlace> HomoclinicSteps::first_central(const OrbitMesh& mesh, double period, const Vector& nodes,
                                                              const SaddleNode& rest) {
  kind_ = {.stable = rest.stable, .is_saddle_node = true};
  const std::size_t intervals = mesh.size() - 1, stride = interval_nodes * n_;
  Vector size(n_);
  for (std::size_t j = 0; j < nodes.size(); ++j)
    size[j % n_] = std::max(size[j % n_], std::abs(nodes[j] - rest.x[j % n_]));
  const auto apart_at = [&](std::size_t node, bool turns) {
    double apart = 0;
    for (std::size_t i = 0; i < n_; ++i) {
      const double turn = turns && !system_.advance.empty() ? system_.advance[i] : 0;
      apart = std::max(apart, std::abs(nodes[node * n_ + i] - rest.x[i] - turn) / size[i]);
    }
    return apart;
  };
  for (const double outside : outside_of_ghost) {
    std::size_t first = 0, last = intervals;
    while (first < intervals && apart_at(first * interval_nodes, false) < outside) ++first;
    while (last > 0 && apart_at(last * interval_nodes, true) < outside) --last;
    if (first + 1 >= last) return std::nullopt;
    const auto own = std::make_shared<OrbitMesh>();
    for (std::size_t k = first; k <= last; ++k) own->push_back((mesh[k] - mesh[first]) / (mesh[last] - mesh[first]));
    own->back() = 1;
    Vector z(nodes.begin() + static_cast<std::ptrdiff_t>(first * stride),
             nodes.begin() + static_cast<std::ptrdiff_t>(last * stride + n_));
    z.insert(z.end(), rest.x.begin(), rest.x.end());
    for (std::size_t c = 0; c < 2; ++c) z.push_back(rest.constants[options_.constants[c]]);
    auto place = settled(own, period * (mesh[last] - mesh[first]), z);
    if (!place) continue;
    improve(*place);
    if (std::max(place->apart_first, place->apart_last) <= ends_within) return place;
  }
  return std::nullopt;
}

void HomoclinicSteps::improve(HomoclinicPlace& place) {
  for (int k = 0; k < most_improvements; ++k)
    if (!renew(place) || (place.error <= error_wanted_ && std::max(place.apart_first, place.apart_last) <= ends_within))
      break;
}

bool HomoclinicSteps::move_to(HomoclinicPlace& place, const std::shared_ptr<const OrbitMesh>& mesh, double begin,
                              double end) {
  const std::size_t rest = equations_->rest();
  const Eigen::MatrixXd a = equations_->matrix_at(Values(place.z).subspan(rest, n_), Values(place.z).last(2));
  const Tail before(a, place.spaces.unstable, place.spaces.centre, place.curvature,
                    equations_->from_rest(place.z, false)),
      after(a, place.spaces.stable, place.spaces.centre, place.curvature, equations_->from_rest(place.z, true));
  const double length_of_old = place.length;
  const std::size_t count = (mesh->size() - 1) * interval_nodes + 1;
  // Of the states, or of a small change of them.
  const auto moved = [&](const Vector& z, bool is_change) {
    const ClosedView old(n_, Values(z).first(rest), place.mesh);
    const auto turns = [&](std::size_t i) { return is_change || system_.advance.empty() ? 0 : system_.advance[i]; };
    const auto end_from_rest = [&](bool at_end) {
      Eigen::VectorXd y(static_cast<Index>(n_));
      for (std::size_t i = 0; i < n_; ++i)
        y(static_cast<Index>(i)) =
            (z[(at_end ? rest - n_ : 0) + i] - z[rest + i] - (at_end ? turns(i) : 0)) / sizes_[i];
      return y;
    };
    Vector result;
    Vector x(n_);
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t interval = std::min(k / interval_nodes, mesh->size() - 2), j = k - interval * interval_nodes;
      const double s = begin + (end - begin) * ((*mesh)[interval] + OrbitCollocation::table().nodes[j] *
                                                                        ((*mesh)[interval + 1] - (*mesh)[interval]));
      if (s >= 0 && s <= 1) {
        old.state(s, x);
      } else {
        const Tail& tail = s < 0 ? before : after;
        const double t = (s < 0 ? s : s - 1) * length_of_old;
        const Eigen::VectorXd y = is_change ? tail.change(end_from_rest(s > 1), t) : tail.state(t);
        for (std::size_t i = 0; i < n_; ++i)
          x[i] = z[rest + i] + sizes_[i] * y(static_cast<Index>(i)) + (s > 1 ? turns(i) : 0);
      }
      result.insert(result.end(), x.begin(), x.end());
    }
    result.insert(result.end(), z.begin() + static_cast<std::ptrdiff_t>(rest), z.end());
    return result;
  };
  Vector tangent(place.tangent);
  for (std::size_t j = 0; j < tangent.size(); ++j) tangent[j] *= scale_[j];
  const Vector z = moved(place.z, false);
  tangent = moved(tangent, true);
  std::vector<Vector> carried;
  for (const Vector& each : place.carried) carried.push_back(moved(each, true));
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

double HomoclinicSteps::missing(const HomoclinicPlace& place, bool at_end) const {
  const double apart = at_end ? place.apart_last : place.apart_first;
  if (apart <= ends_within) return 0;
  if (place.spaces.centre) {
    const double along =
        (at_end ? -1 : 1) * place.curvature * place.spaces.centre->left.dot(equations_->from_rest(place.z, at_end));
    const double wished = ends_wished * std::abs(place.curvature);
    if (along > wished)  // y' = c y^2 takes 1 / (c y)
      return std::min((1 / wished - 1 / along) / place.length, longer_along_centre_);
  }
  const Eigenspace& space = at_end ? place.spaces.stable : place.spaces.unstable;
  if (space.dimension() == 0) return 0;
  const double rate = std::abs(space.eigenvalues.front().real());
  if (rate * place.length < slowly && place.point.truncation < hardly_felt)
    return std::clamp(apart / slow_ends_within - 1, 0.0, most_longer);
  return std::min(std::log(apart / ends_wished) / (rate * place.length), most_longer);
}

/// Longer where an end is too far from the saddle, shorter where it is needlessly near.
bool HomoclinicSteps::lengthened(HomoclinicPlace& place) {
  use(place.mesh, place.length);
  measure(place.z);
  const std::size_t rest = equations_->rest();
  double before = missing(place, false), after = missing(place, true);
  // No longer than is allowed, nor than so many intervals as fine as these can serve.
  const double by_intervals = static_cast<double>(most_to_lengthen) / static_cast<double>(place.mesh->size() - 1);
  const double room = place.rest.is_saddle_node ? 2 * most_longer_along_centre
                                                : std::max(0.0, std::min(longest_ / place.length, by_intervals) - 1);
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
  const bool is_far = before + after > 0;  // a fast end comes near within little more time
  if (!is_far && change > 1 / worth_it) return true;
  const auto mesh = std::make_shared<OrbitMesh>();
  const auto add = [&](double from, double to, double width) {
    if (place.rest.is_saddle_node) return add_graded(*mesh, from, to, width);
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
  const int most = place.rest.is_saddle_node ? most_lengthenings : 1;
  longer_along_centre_ = most_longer_along_centre;
  for (int k = 0; k < most; ++k) {
    if (!lengthened(other)) {
      longer_along_centre_ /= 3;
    } else if (other.length == place.length) {
      break;
    } else {
      place = other;
      (void)refined(other);
      continue;
    }
    other = place;
  }
  other = place;
  if (refined(other)) place = std::move(other);
  return place.error <= error_at_most * error_wanted_;
}

}  // namespace continuo::studies::detail
