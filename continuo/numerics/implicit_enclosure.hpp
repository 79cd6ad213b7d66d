// What equations F(theta, u) = 0 make of u, over an interval of theta: where the solution lies, and how steep it is.
//
//   ImplicitEnclosure<double> root(1);        // u^2 = 2 + theta for theta within 0.1 of 0, near 1.4
//   const std::array guess{Enclosure(1.3, 1.5)};
//   const std::array start{1.4};
//   const Enclosure<double> part(-0.1, 0.1);
//   root.over(guess, start, part,
//       [](auto u, auto f) { f[0] = u[0]*u[0] - 2; },                                    // at the middle, theta = 0
//       [](auto u, auto f) { f[0] = square(Enclosure(u[0])) - Enclosure(2.0); },
//       [](auto u, auto by_u, auto by_theta) { by_u[0] = u[0] + u[0], by_theta[0] = Enclosure(-1.0); });
//   root.values()[0], root.slopes()[0]        // 1.378..1.450, 0.34..0.37
//
// By the operator of Krawczyk, with a Newton iterate m at the middle of the interval and Y near the inverse of dF/du:
//   K(U) = m - Y F(0, m) - Y S theta + (I - Y A)(U - m),
// where A holds the slopes of F by u over the box U, S those by theta. If K(U) lies inside U there is one solution in U
// for every theta, it lies in K(U), and it is continuous: u - Y F(theta, u) maps U into K(U), so Brouwer gives one; two
// would differ by (I - Y A) times their difference, but |I - Y A| d <= radius of K(U) < d with d the radii of U. For
// the slopes v of the solution, A v = -S, hence v = -Y S + (I - Y A) v, and |v| <= d max(|Y S|/d)/(1 - rho) with rho =
// max of (|I - Y A| d)/d. U is guessed, and inflated until the test holds or has failed too often.
//
// R. Krawczyk, Computing 4 (1969), 187-201; R. E. Moore, R. B. Kearfott, M. J. Cloud, Introduction to Interval Analysis
// (2009), chapter 8; A. Neumaier, Interval Methods for Systems of Equations (1990), chapter 5.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include <continuo/numerics/dense_lu.hpp>
#include <continuo/numerics/enclosure.hpp>

namespace continuo {

/// Encloses the solution of a system of equations that depends on one variable, with a proof that it is the only one
/// nearby.
template <class Real>
class ImplicitEnclosure {
 public:
  using Range = Enclosure<Real>;

  /// For `size` equations in as many unknowns. Allocates about 8 size^2 numbers.
  explicit ImplicitEnclosure(std::size_t size)
      : size_(size),
        middle_(size),
        numbers_(size),
        correction_(size),
        weights_(size),
        rounding_(size),
        least_width_(size),
        columns_(size * size),
        centres_(size * size),
        radii_(size * size),
        lu_(size),
        box_(size),
        image_(size),
        residuals_(size),
        by_part_(size),
        values_(size),
        slopes_(size),
        by_unknowns_(size * size),
        rest_(size * size) {}

  /// True where it is proved that there is one solution for each theta of `part`, which holds 0, the middle. Of several
  /// branches that near `start` at the middle; what `guess` holds, roughly the range over the part, belongs to the box
  /// in which the solution is the only one.
  ///   numbers(u, f): F at the middle, as near as the format has it.
  ///   residuals(u, f): the same enclosed.
  ///   slopes(box, by_u, by_theta): F(u) - F(v) is in by_u (u - v) for all u and v of the box and every theta of the
  ///       part, row by row, and by_theta the same for every u; unbounded where F may jump.
  template <class Numbers, class Residuals, class Slopes>
  [[nodiscard]] bool over(std::span<const Range> guess, std::span<const Real> start, const Range& part,
                          Numbers&& numbers, Residuals&& residuals, Slopes&& slopes) {
    is_proved_ = false;
    if (find_middle(start, numbers, residuals, slopes)) {
      for (std::size_t i = 0; i < size_; ++i) {
        const Range shifted = guess[i] + Range(middle_[i] - start[i]);
        box_[i] = inflated(hull(hull(guess[i], shifted), Range(middle_[i])), 2 * rounding_[i]);
      }
      is_proved_ = prove(part, slopes);
    }
    if (!is_proved_) std::ranges::fill(values_, Range::entire());
    return is_proved_;
  }

  /// Of the solution over the last part, wider by the rounding of an iteration that solves for it in the number format;
  /// entire where nothing is proved.
  [[nodiscard]] std::span<const Range> values() const { return values_; }
  /// The difference quotients of the solution by theta over the last part; entire where nothing is proved. Costs a few
  /// times size^2 products at each call.
  [[nodiscard]] std::span<const Range> slopes() {
    if (is_proved_) {
      bound_slopes();
    } else {
      std::ranges::fill(slopes_, Range::entire());
    }
    return slopes_;
  }

 private:
  static constexpr Real epsilon = std::numeric_limits<Real>::epsilon();
  static constexpr int most_matrices = 4, most_steps = 4, most_boxes = 6;
  static constexpr Real greatest_contraction = Real(0.99);

  [[nodiscard]] static Real width(const Range& a) { return a.hi - a.lo; }
  [[nodiscard]] static Real mid(const Range& a) { return a.lo + width(a) / 2; }
  [[nodiscard]] static Range inflated(const Range& a, Real further) {
    const Real by = width(a) / 8 + 8 * epsilon * a.magnitude() + further + underflow<Real>;
    return {a.lo - by, a.hi + by};
  }

  /// Newton's iteration at the middle, down to rounding, with the matrix that is at hand as long as it serves.
  template <class Numbers, class Residuals, class Slopes>
  [[nodiscard]] bool find_middle(std::span<const Real> start, Numbers& numbers, Residuals& residuals, Slopes& slopes) {
    std::ranges::copy(start, middle_.begin());
    if (has_inverse_ && iterate(numbers, residuals)) return true;
    std::ranges::copy(start, middle_.begin());
    for (int matrix = 0; matrix < most_matrices; ++matrix) {
      std::ranges::transform(middle_, box_.begin(), [](Real u) { return Range(u); });
      if (!look(slopes) || !invert()) return false;
      if (iterate(numbers, residuals)) return true;
    }
    return false;
  }

  template <class Numbers, class Residuals>
  [[nodiscard]] bool iterate(Numbers& numbers, Residuals& residuals) {
    bool is_rounding = false;
    for (int step = 0; step < most_steps && !is_rounding; ++step) {
      numbers(std::span<const Real>(middle_), std::span<Real>(numbers_));
      is_rounding = true;
      for (std::size_t i = 0; i < size_; ++i) {
        correction_[i] = 0;
        for (std::size_t k = 0; k < size_; ++k) correction_[i] += columns_[k * size_ + i] * numbers_[k];
        is_rounding = is_rounding && std::abs(correction_[i]) <= 4 * epsilon * std::abs(middle_[i]);
      }
      for (std::size_t i = 0; i < size_ && !is_rounding; ++i) middle_[i] -= correction_[i];
    }
    residuals(std::span<const Real>(middle_), std::span<Range>(residuals_));
    return is_solved();
  }

  /// Whether the residuals at the middle are no more than their rounding.
  [[nodiscard]] bool is_solved() {
    bool solved = true;
    for (std::size_t i = 0; i < size_; ++i) {
      Real correction = 0, rounding = 0;
      for (std::size_t k = 0; k < size_; ++k) {
        correction += columns_[k * size_ + i] * mid(residuals_[k]);
        rounding += std::abs(columns_[k * size_ + i]) * width(residuals_[k]);
      }
      rounding_[i] = rounding + 4 * epsilon * std::abs(middle_[i]);
      solved = solved && std::abs(correction) <= rounding_[i];
    }
    return solved;
  }

  /// The slopes over the box.
  template <class Slopes>
  [[nodiscard]] bool look(Slopes& slopes) {
    slopes(std::span<const Range>(box_), std::span<Range>(by_unknowns_), std::span<Range>(by_part_));
    const auto is_bounded = [](const Range& slope) { return slope.is_bounded(); };
    return std::ranges::all_of(by_unknowns_, is_bounded) && std::ranges::all_of(by_part_, is_bounded);
  }

  [[nodiscard]] bool invert() {
    std::ranges::transform(by_unknowns_, lu_.matrix().begin(), [](const Range& slope) { return mid(slope); });
    has_inverse_ = lu_.factor();
    std::ranges::fill(columns_, Real(0));
    for (std::size_t j = 0; has_inverse_ && j < size_; ++j) {
      columns_[j * size_ + j] = 1;
      lu_.solve(columns_.data() + j * size_);
    }
    return has_inverse_;
  }

  template <class Slopes>
  [[nodiscard]] bool prove(const Range& part, Slopes& slopes) {
    bool is_proved = false;
    for (int tries = 0; tries < most_boxes; ++tries) {
      if (!look(slopes)) return false;
      // The slopes over a part of the proved box are among its slopes, and so the same Y needs no further proof.
      if (!is_proved && !invert()) return false;
      if (!map(part)) return false;
      if (!is_proved && !is_inside()) {
        for (std::size_t i = 0; i < size_; ++i)
          box_[i] = inflated(hull(image_[i], Range(middle_[i])), 2 * rounding_[i]);
        continue;
      }
      if (!is_proved) std::ranges::transform(box_, weights_.begin(), [](const Range& u) { return width(u) / 2; });
      is_proved = true;
      if (!take_image()) break;
    }
    return is_proved && contraction() < greatest_contraction;
  }

  /// Y times a column of enclosures.
  [[nodiscard]] Range times_inverse(std::size_t i, std::span<const Range> column) const {
    Range sum;
    for (std::size_t k = 0; k < size_; ++k) sum = sum + Range(columns_[k * size_ + i]) * column[k];
    return sum;
  }

  /// K(U), and I - Y A.
  [[nodiscard]] bool map(const Range& part) {
    subtract_product();
    for (std::size_t i = 0; i < size_; ++i) {
      Range image = Range(middle_[i]) - times_inverse(i, residuals_) - times_inverse(i, by_part_) * part;
      least_width_[i] = width(image);
      for (std::size_t j = 0; j < size_; ++j) image = image + rest_[i * size_ + j] * (box_[j] - Range(middle_[j]));
      image_[i] = image;
      if (!image.is_bounded()) return false;
    }
    return true;
  }

  /// Y A with A = C +- R is fl(Y C) +- |Y| (R + gamma |C|): a product of n terms is off by n epsilon/2 of the sum of
  /// their sizes, and as many more roundings make the radius (N. J. Higham, Accuracy and Stability of Numerical
  /// Algorithms, chapter 3; S. M. Rump, BIT 39 (1999), 534-554). Entries that are zero cost nothing.
  void subtract_product() {
    const Real gamma = 4 * static_cast<Real>(size_ + 4) * epsilon;
    std::ranges::fill(centres_, Real(0));
    std::ranges::fill(radii_, Real(0));
    for (std::size_t k = 0; k < size_; ++k) {
      for (std::size_t j = 0; j < size_; ++j) {
        const Range& entry = by_unknowns_[k * size_ + j];
        if (entry.lo == 0 && entry.hi == 0) continue;
        const Real centre = mid(entry), radius = width(entry) / 2 + gamma * entry.magnitude() + underflow<Real>;
        for (std::size_t i = 0; i < size_; ++i) {
          centres_[j * size_ + i] += columns_[k * size_ + i] * centre;
          radii_[j * size_ + i] += std::abs(columns_[k * size_ + i]) * radius;
        }
      }
    }
    for (std::size_t i = 0; i < size_; ++i) {
      for (std::size_t j = 0; j < size_; ++j) {
        const Real centre = (i == j ? Real(1) : Real(0)) - centres_[j * size_ + i];
        const Real radius = radii_[j * size_ + i] * (1 + gamma) + epsilon * std::abs(centre) + underflow<Real>;
        rest_[i * size_ + j] = enclosing::bounded(centre - radius, centre + radius);
      }
    }
  }

  [[nodiscard]] bool is_inside() const {
    for (std::size_t i = 0; i < size_; ++i)
      if (!(image_[i].lo > box_[i].lo && image_[i].hi < box_[i].hi)) return false;
    return true;
  }

  /// The box becomes what the image leaves of it. True where that is so much less, and still so much more than it would
  /// be if I - Y A were zero, that another look pays.
  [[nodiscard]] bool take_image() {
    bool pays = false;
    for (std::size_t i = 0; i < size_; ++i) {
      const Range left = intersection(image_[i], box_[i]);
      const Real enough = 2 * least_width_[i] + 16 * rounding_[i];
      pays = pays || (width(left) < width(box_[i]) / 2 && width(left) > enough);
      box_[i] = left;
      values_[i] = {left.lo - 2 * rounding_[i], left.hi + 2 * rounding_[i]};
    }
    return pays;
  }

  [[nodiscard]] Real contraction() const {
    Real greatest = 0;
    for (std::size_t i = 0; i < size_; ++i) {
      Real sum = 0;
      for (std::size_t j = 0; j < size_; ++j) sum += rest_[i * size_ + j].magnitude() * weights_[j];
      greatest = std::max(greatest, sum / weights_[i]);
    }
    return greatest;
  }

  void bound_slopes() {
    Real steepest = 0;
    for (std::size_t i = 0; i < size_; ++i) {
      image_[i] = -times_inverse(i, by_part_);
      steepest = std::max(steepest, image_[i].magnitude() / weights_[i]);
    }
    constexpr Real rounding = 1 + Real(1) / 1024;
    const Real bound = steepest / (1 - contraction()) * rounding;
    for (std::size_t i = 0; i < size_; ++i) slopes_[i] = {-bound * weights_[i], bound * weights_[i]};
    for (int pass = 0; pass < 2; ++pass) {
      for (std::size_t i = 0; i < size_; ++i) {
        Range slope = image_[i];
        for (std::size_t j = 0; j < size_; ++j) slope = slope + rest_[i * size_ + j] * slopes_[j];
        slopes_[i] = intersection(slopes_[i], slope);
      }
    }
  }

  std::size_t size_;
  std::vector<Real> middle_, numbers_, correction_, weights_, rounding_, least_width_;
  std::vector<Real> columns_, centres_, radii_;  // of Y, and of the product Y A: column by column
  DenseLU<Real> lu_;
  std::vector<Range> box_, image_, residuals_, by_part_, values_, slopes_, by_unknowns_, rest_;
  bool has_inverse_ = false, is_proved_ = false;
};

}  // namespace continuo
