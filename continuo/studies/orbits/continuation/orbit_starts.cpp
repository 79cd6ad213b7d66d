// continuo/studies/orbits/continuation/orbit_starts.cpp
// Starts a branch of closed orbits from an orbit, a Hopf point or a mark.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <fmt/format.h>

#include <continuo/studies/orbits/continuation/orbit_follower.hpp>
#include <continuo/studies/support/arclength.hpp>
#include <continuo/studies/support/both_ways.hpp>

namespace continuo::studies::detail {

namespace {

using Vector = std::vector<double>;
using Place = OrbitPlace;

constexpr double growth_of_size = 5;  // of the first orbit beside a Hopf point: twenty steps make it ten times as large
constexpr std::size_t most_first_intervals = 400, even_intervals = 20;

/// From a mesh that knows where an orbit changes fast, or an even one.
std::shared_ptr<const OrbitMesh> first_mesh(const Vector& known) {
  const std::size_t intervals = known.size() < 2 ? 0 : known.size() - 1;
  if (intervals < even_intervals) {
    OrbitMesh even;
    for (std::size_t k = 0; k <= even_intervals; ++k)
      even.push_back(static_cast<double>(k) / static_cast<double>(even_intervals));
    return std::make_shared<const OrbitMesh>(std::move(even));
  }
  const std::size_t each = (intervals + most_first_intervals - 1) / most_first_intervals;
  OrbitMesh mesh;
  for (std::size_t k = 0; k < intervals; k += each) mesh.push_back(known[k] / known.back());
  mesh.push_back(1);
  return std::make_shared<const OrbitMesh>(std::move(mesh));
}

}  // namespace

OrbitBranch OrbitFollower::from_orbit(const std::function<Vector(double part)>& orbit, double period,
                                      const Vector& mesh) {
  OrbitBranch branch;
  steps_.use(first_mesh(mesh));
  Vector z;
  for (std::size_t k = 0; k < steps_.equations().nodes(); ++k) {
    const Vector x = orbit(steps_.equations().place(k));
    z.insert(z.end(), x.begin(), x.end());
  }
  z.push_back(period);
  z.push_back(system_.constants[options_.constant]);
  steps_.measure(z);
  auto first = steps_.at_constant(z, z.back());
  if (first) refine(*first);
  if (!first) {
    branch.status = is_interrupted() ? Status{.ending = Ending::interrupted, .message = "it was interrupted"}
                                     : not_found("there is no orbit near the start");
    return branch;
  }
  steps_.complete(*first);
  amplitude_ = amplitude(*first);
  OrbitBranch back;
  back.ends[1] = followed(back, *first, -1);
  branch = turned_round(std::move(back));
  branch.points.push_back(first->point);
  if (branch.ends[0].ending == OrbitEnding::closed || branch.ends[0].ending == OrbitEnding::interrupted) {
    branch.ends[1] = branch.ends[0];
  } else {
    // Anew, for the sizes have grown on the way.
    steps_.use(first->mesh);
    steps_.measure(first->z);
    if (auto again = steps_.at_constant(first->z, first->z.back())) first = std::move(again);
    steps_.complete(*first);
    branch.ends[1] = followed(branch, *first, 1);
  }
  return branch;
}

/// Until its mesh serves it, as far as that goes.
void OrbitFollower::refine(Place& place) {
  for (std::size_t k = 0; k < most_refinements && !steps_.is_exact(place); ++k)
    if (!steps_.refine(place, place)) return;
}

OrbitBranch OrbitFollower::from_hopf(const HopfPoint& start) {
  OrbitBranch branch;
  const std::size_t n = system_.size;
  steps_.use(first_mesh({}));
  const std::size_t nodes = steps_.equations().nodes();
  Vector rest;
  for (std::size_t k = 0; k < nodes; ++k) rest.insert(rest.end(), start.x.begin(), start.x.end());
  rest.push_back(2 * std::numbers::pi / start.angular_frequency);
  rest.push_back(start.constant);
  Vector sizes(start.x);
  for (double& size : sizes) size = std::max(std::abs(size), 1.0);
  steps_.forget_sizes(sizes);
  steps_.measure(rest);
  Vector along(rest.size());
  for (std::size_t k = 0; k < nodes; ++k) {
    const auto turn = std::polar(1.0, 2 * std::numbers::pi * steps_.equations().place(k));
    for (std::size_t i = 0; i < n; ++i) along[k * n + i] = (start.vector[i] * turn).real() / steps_.size(k * n + i);
  }
  normalize(along);
  std::optional<Place> first;
  for (double small = 1e-2; small > 1e-7 && !first; small /= 10) {
    first = steps_.across(predicted(rest, along, small, steps_.sizes()), along);
  }
  if (!first) {
    branch.status = not_found("no orbit was found near the Hopf point");
    return branch;
  }
  // What the orbit tells of the sizes: it is going to grow.
  for (std::size_t i = 0; i < n; ++i) {
    sizes[i] = std::abs(start.x[i]);
    for (std::size_t k = 0; k < nodes; ++k)
      sizes[i] = std::max(sizes[i], growth_of_size * std::abs(first->z[k * n + i] - start.x[i]));
  }
  first->tangent = along;
  steps_.forget_sizes(sizes);
  steps_.measure(*first);
  first = steps_.across(first->z, first->tangent);
  if (first) refine(*first);
  if (!first) {
    branch.status = not_found("no orbit was found near the Hopf point");
    return branch;
  }
  steps_.complete(*first);
  amplitude_ = amplitude(*first);
  branch.points = {as_orbit(start, first->point.stable), first->point};
  branch.ends[0] = {OrbitEnding::hopf, start.constant, "it begins at a Hopf point"};
  branch.ends[1] = followed(branch, *first, 1);
  return branch;
}

OrbitBranch OrbitFollower::from_mark(const OrbitMark& start) {
  OrbitBranch branch;
  doubled_ = start.kind == OrbitBifurcation::period_doubling;
  auto mesh = std::make_shared<OrbitMesh>(start.mesh);
  Vector z(start.unknowns);
  if (doubled_) {  // twice round
    for (double& s : *mesh) s /= 2;
    for (std::size_t k = 1; k < start.mesh.size(); ++k) mesh->push_back(0.5 + start.mesh[k] / 2);
    z.insert(z.begin(), start.unknowns.begin(), start.unknowns.end() - 2);
    if (const Vector& advance = start.at.advance; !advance.empty())
      for (std::size_t j = start.unknowns.size() - 2; j + 2 < z.size(); ++j) z[j] += advance[j % advance.size()];
    z[z.size() - 2] *= 2;
  }
  steps_.use(mesh);
  steps_.measure(z);
  // z is solved for, and to solve again would go astray: the equations are nearly singular there. So is what gives
  // the tangent; that of the place before is good.
  Vector along(start.tangent);
  if (doubled_) {
    along.insert(along.begin(), start.tangent.begin(), start.tangent.end() - 2);
    along[along.size() - 2] *= 2;
  }
  for (std::size_t j = 0; j < along.size(); ++j) along[j] /= steps_.size(j);
  normalize(along);
  const auto other = steps_.other_direction(z, along);
  if (!other) {
    branch.status = not_found("no other branch was found there");
    return branch;
  }
  const auto beside = [&](double direction) {
    std::optional<Place> place;
    for (double small = 1e-2; small > 1e-5 && !place; small /= 3) {
      steps_.use(mesh);
      steps_.measure(z);
      const Vector guess = predicted(z, *other, direction * small, steps_.sizes());
      place = steps_.across(guess, *other);
      if (!place) continue;
      for (double& part : place->tangent) part *= direction * (product(place->tangent, *other) < 0 ? -1 : 1);
      if (distance(place->z, guess, steps_.sizes()) > small) place.reset();  // it leapt to elsewhere
    }
    if (place) steps_.complete(*place);
    return place;
  };
  const std::string whence = fmt::format("it begins at a {}", to_string(start.kind));
  const auto ahead = beside(1);
  if (!ahead) {
    branch.status = not_found("no orbit was found on the other branch");
    return branch;
  }
  amplitude_ = amplitude(*ahead);
  if (doubled_) {
    branch.points = {start.at};
    branch.points.front().period *= 2;
    for (double& part : branch.points.front().advance) part *= 2;
    for (auto& value : branch.points.front().multipliers) value *= value;
    branch.ends[0] = {OrbitEnding::branching, start.at.constant, whence};
  } else if (const auto back = beside(-1)) {
    OrbitBranch behind;
    behind.points = {back->point};
    behind.ends[1] = followed(behind, *back, 1);
    // Of two sides that mirror each other one may break off next to where they meet; it would say nothing more.
    if (behind.ends[1].ending == OrbitEnding::lost && behind.points.size() < 5) {
      behind = {};
      behind.ends[1] = {OrbitEnding::branching, start.at.constant, whence};
    }
    branch = turned_round(std::move(behind));
    branch.points.push_back(start.at);
  } else {
    branch.points = {start.at};
    branch.ends[0] = {OrbitEnding::branching, start.at.constant, whence};
  }
  branch.points.push_back(ahead->point);
  branch.ends[1] = followed(branch, *ahead, 1);
  return branch;
}

}  // namespace continuo::studies::detail
