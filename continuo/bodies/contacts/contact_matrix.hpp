// The linear system of contacts that act together. Its matrix has the change of every contact speed by a unit of every
// contact force. Two contacts are coupled only through a body that both touch, so that the matrix of many contacts is
// sparse. For few contacts it is solved as a dense matrix.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include <continuo/bodies/world.hpp>
#include <continuo/numerics/dense_lu.hpp>
#include <continuo/numerics/sparse_lu.hpp>

namespace continuo {

/// A direction in which a contact acts: the force and the torque on each body at its ends. By virtual work the speed in
/// the direction is the sum of force . v + torque . spin.
template <class Real, int Dim>
struct ContactDirection {
  struct End {
    std::uint32_t body = 0;
    Vector<Real, Dim> force{};
    Spin<Real, Dim> torque{};
  };
  std::array<End, 2> at{};
  std::size_t count = 0;

  void add(const End& end) { at[count++] = end; }
  [[nodiscard]] std::span<const End> ends() const { return std::span(at).first(count); }
};

/// The change of the speed in one direction by a unit force in another.
template <class Real, int Dim>
[[nodiscard]] Real response(const World<Real, Dim>& world, const ContactDirection<Real, Dim>& of,
                            const ContactDirection<Real, Dim>& to) {
  Real sum(0);
  for (const auto& e : of.ends())
    for (const auto& f : to.ends())
      if (e.body == f.body)
        sum += world.inverse_mass[e.body] * dot(e.force, f.force) +
               world.inverse_inertia[e.body] * dot(e.torque, f.torque);
  return sum;
}

template <class Real, int Dim>
class ContactMatrix {
 public:
  using Directions = std::vector<ContactDirection<Real, Dim>>;

  /// Sets the entries: the change of a row's speed by a unit of a column's force. Rows and columns belong to the same
  /// contacts.
  void fill(const World<Real, Dim>& world, const Directions& rows, const Directions& columns) {
    if (!is_of(rows)) make_pattern(world, rows);
    for (std::size_t column = 0; column < columns.size(); ++column)
      for (std::size_t entry = pattern_.begin(column); entry < pattern_.end(column); ++entry)
        values_[entry] = response(world, rows[pattern_.row(entry)], columns[column]);
  }

  /// Replaces the wanted changes of speed by the forces that cause them; false where the matrix is singular. More
  /// contacts than bodies need would make it so. A small addition to the diagonal, 1e-5 of each entry, then selects the
  /// smallest of all forces that cause these changes. Two rounds of iterative refinement lower the error by that
  /// addition to 1e-15. If no forces cause the wanted changes, the result is at most 3e5 times as large as for possible
  /// ones.
  ///
  /// Where masses differ by more than a thousand, the matrix has eigenvalues below the addition, and refinement leaves
  /// an error. An addition of 1e-10 then replaces it, unless the error stays: then no forces cause these changes.
  [[nodiscard]] bool solve(std::vector<Real>& wanted) {
    if (!refine(wanted, Real(1e-5))) return false;
    const Real error = greatest(rest_), size = greatest(wanted);
    constexpr Real finest = std::numeric_limits<Real>::epsilon() * 4096;
    if (error > finest * size) {
      const std::vector<Real> coarse = force_;
      if (!refine(wanted, std::max(Real(1e-10), finest)) || !(greatest(rest_) < error / 1000)) force_ = coarse;
    }
    wanted = force_;
    return true;
  }

 private:
  /// Up to so many rows a dense matrix is faster. Measured with square packings: both take equally long at 55 rows.
  static constexpr std::size_t greatest_dense = 48;
  using Bodies = std::array<std::uint32_t, 2>;

  [[nodiscard]] static Bodies bodies_of(const ContactDirection<Real, Dim>& direction) {
    return {direction.at[0].body, direction.at[direction.count - 1].body};
  }
  [[nodiscard]] bool is_of(const Directions& rows) const {
    return std::ranges::equal(rows, bodies_, {}, &ContactMatrix::bodies_of);
  }
  [[nodiscard]] static Real greatest(const std::vector<Real>& values) {
    Real most(0);
    for (const Real& value : values) most = std::max(most, std::abs(value));
    return most;
  }
  /// Finds forces, in three rounds, with an addition to the diagonal, relative to its entries; the error of the speeds
  /// that they cause is in `rest_`.
  [[nodiscard]] bool refine(const std::vector<Real>& wanted, const Real& addition) {
    const std::size_t n = wanted.size();
    if (!factor(addition)) return false;
    force_.assign(n, Real(0));
    rest_ = wanted;
    for (int round = 0; round < 3; ++round) {
      solve_factored();
      for (std::size_t k = 0; k < n; ++k) force_[k] += rest_[k];
      rest_ = wanted;
      for (std::size_t column = 0; column < n; ++column)
        for (std::size_t entry = pattern_.begin(column); entry < pattern_.end(column); ++entry)
          rest_[pattern_.row(entry)] -= values_[entry] * force_[column];
    }
    return true;
  }
  void make_pattern(const World<Real, Dim>& world, const Directions& rows) {
    const std::size_t n = rows.size();
    bodies_.clear();
    for (const auto& row : rows) bodies_.push_back(bodies_of(row));
    std::vector<std::pair<std::uint32_t, std::uint32_t>> at_bodies;  // a body and a row there
    for (std::uint32_t r = 0; r < n; ++r)
      for (const auto& end : rows[r].ends())
        if (!world.is_fixed(end.body)) at_bodies.emplace_back(end.body, r);
    std::ranges::sort(at_bodies);
    std::vector<MatrixPlace> places;
    for (auto first = at_bodies.begin(); first != at_bodies.end();) {
      const auto last =
          std::find_if(first, at_bodies.end(), [&](const auto& one) { return one.first != first->first; });
      for (auto r = first; r != last; ++r)
        for (auto c = first; c != last; ++c) places.push_back({r->second, c->second});
      first = last;
    }
    pattern_ = SparsePattern(n, places);
    values_.assign(pattern_.entries(), Real(0));
    diagonal_.resize(n);
    for (std::size_t k = 0; k < n; ++k) diagonal_[k] = pattern_.find(k, k);
    dense_.reset(), sparse_.reset();
    if (n > greatest_dense) {
      sparse_.emplace(pattern_);
    } else {
      dense_.emplace(n);
    }
  }

  [[nodiscard]] bool factor(const Real& addition) {
    const auto more = [&](std::size_t k) { return addition * std::abs(values_[diagonal_[k]]); };
    if (sparse_) {
      std::ranges::copy(values_, sparse_->values().begin());
      for (std::size_t k = 0; k < diagonal_.size(); ++k)
        sparse_->values()[diagonal_[k]] += static_cast<double>(more(k));
      return sparse_->factor();
    }
    const std::size_t n = pattern_.size();
    auto& matrix = dense_->matrix();
    std::ranges::fill(matrix, Real(0));
    for (std::size_t column = 0; column < n; ++column)
      for (std::size_t entry = pattern_.begin(column); entry < pattern_.end(column); ++entry)
        matrix[pattern_.row(entry) * n + column] = values_[entry];
    for (std::size_t k = 0; k < n; ++k) matrix[k * n + k] += more(k);
    return dense_->factor();
  }
  void solve_factored() {
    if (!sparse_) return dense_->solve(rest_.data());
    if constexpr (std::is_same_v<Real, double>) {
      sparse_->solve(rest_.data());
    } else {
      std::vector<double> wide(rest_.begin(), rest_.end());
      sparse_->solve(wide.data());
      std::ranges::transform(wide, rest_.begin(), [](double value) { return static_cast<Real>(value); });
    }
  }

  std::vector<Bodies> bodies_;
  SparsePattern pattern_;
  std::vector<Real> values_, force_, rest_;
  std::vector<std::size_t> diagonal_;
  std::optional<DenseLU<Real, run_time_size>> dense_;
  std::optional<SparseLU<double>> sparse_;
};

}  // namespace continuo
