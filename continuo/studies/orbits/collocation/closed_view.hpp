// An orbit on an open interval as orbit_collocation knows it: closed, as far on as its end lies from its beginning. For
// what needs no equations: states between nodes, extremes, errors, meshes. Internal to homoclinic_curve.
#pragma once
#include <memory>
#include <span>
#include <vector>

#include <continuo/studies/orbits/collocation/orbit_collocation.hpp>

namespace continuo::studies::detail {

class ClosedView {
 public:
  /// `nodes`: x at all nodes of the mesh, both ends among them.
  ClosedView(std::size_t n, std::span<const double> nodes, std::shared_ptr<const OrbitMesh> mesh)
      : system_{.size = n, .constants = {0}}, orbit_(system_, std::move(mesh)) {
    unknowns_.assign(nodes.begin(), nodes.end() - static_cast<std::ptrdiff_t>(n));
    unknowns_.push_back(1);
    unknowns_.push_back(0);
    for (std::size_t i = 0; i < n; ++i) system_.advance.push_back(nodes[nodes.size() - n + i] - nodes[i]);
  }
  ClosedView(const ClosedView&) = delete;
  ClosedView& operator=(const ClosedView&) = delete;

  [[nodiscard]] const OrbitCollocation& orbit() const { return orbit_; }
  [[nodiscard]] const std::vector<double>& unknowns() const { return unknowns_; }
  /// Of each interval, in sizes.
  [[nodiscard]] std::vector<double> errors(std::span<const double> sizes) const {
    return orbit_.errors(unknowns_, sizes, true);
  }
  void state(double s, std::span<double> x) const { orbit_.state(unknowns_, s, x); }

 private:
  ParametricSystem system_;
  OrbitCollocation orbit_;
  std::vector<double> unknowns_;
};

}  // namespace continuo::studies::detail
