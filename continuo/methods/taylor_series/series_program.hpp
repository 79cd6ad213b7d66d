// A list of operations on truncated Taylor series, evaluated order by order: coefficient k of every result from the
// coefficients up to k of its operands. All coefficients are kept, so that the series of a solution, whose coefficient
// k + 1 needs coefficient k of its derivative, costs one sweep: order^2 / 2 products for each product in the equations.
//
//   SeriesProgram<double> program;
//   const std::uint32_t x = program.add_variable(), y = program.add(SeriesCode::product, x, x);
//   program.begin(8);                        // orders up to 8
//   program.coefficient(0, x) = 2, program.coefficient(1, x) = 1;
//   for (std::size_t k = 0; k <= 8; ++k) program.evaluate(k);
//   program.coefficient(2, y)                // of (2 + s)^2: 1
//
// The recurrences: A. Griewank, A. Walther, "Evaluating Derivatives", 2nd ed., SIAM (2008), chapter 13, tables 13.1 and
// 13.2. Each follows from a linear differential equation of the function, compared coefficient by coefficient.
//
// An operation may have many members, with operands side by side: the points of a grid, the pairs of N bodies. What is
// piecewise constant (floor, a comparison) is that of the coefficient of order 0; abs, min, max and tables, which are
// continuous, take the branch that the first coefficients that differ lead to.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

namespace continuo {

enum class SeriesCode : std::uint8_t {
  copy,  // members gathered from anywhere
  add,
  subtract,
  negate,
  add_number,            // a + b, where b has no coefficient but that of order 0
  subtract_from_number,  // a - b, where a has none
  scale,                 // a b, where a has none
  divide_by_number,      // a / b, where b has none
  product,
  square,
  quotient,
  square_root,
  exponential,
  logarithm,
  power,        // a^b, where b is one number for all members
  sine_cosine,  // two results, the cosines after the sines; of the next three the second is an aid
  hyperbolic_sine_cosine,
  tangent,             // and 1 + tan^2
  hyperbolic_tangent,  // and 1 - tanh^2
  arc_tangent,         // of a, with b = 1 + a^2
  arc_sine,            // of a, with b = sqrt(1 - a^2)
  arc_cosine,          // the same
  arc_tangent2,        // of a and b, with c = a^2 + b^2
  minimum,
  maximum,
  absolute,
  select,  // a != 0 ? b : c
  table,   // and its slope
  // piecewise constant
  table_slope,
  sign,
  floor,
  ceiling,
  less,
  less_equal,
  equal,
  not_equal,
  logical_and,
  logical_or,
  logical_not,
};

/// Whether the operation has jumps or corners, which no coefficient shows before they are there.
[[nodiscard]] constexpr bool is_piecewise(SeriesCode code) {
  return code >= SeriesCode::minimum;
}

/// A piece of a function that is linear between two points: value + slope (x - from) from `from` on.
template <class Real>
struct LinearPiece {
  Real from, value, slope;
};

/// One operation, or `count` equal ones with operands and results side by side.
struct SeriesOperation {
  SeriesCode code;
  std::uint32_t result, count, a, b, c;
};

template <class Real>
class SeriesProgram {
 public:
  using Register = std::uint32_t;
  using Operation = SeriesOperation;
  /// The piece of a table that holds x.
  using Pieces = std::function<LinearPiece<Real>(const Real& x)>;

  /// Forgets all operations, and keeps the memory.
  void clear() {
    operations_.clear();
    numbers_.clear();
    lists_.clear();
    tables_.clear();
    registers_ = 0;
    begun_ = 0;
    has_corners_ = false;
  }

  /// A series whose coefficients the caller sets.
  [[nodiscard]] Register add_variable(std::uint32_t count = 1) { return std::exchange(registers_, registers_ + count); }
  /// A number: the coefficients of higher orders are 0.
  [[nodiscard]] Register add_number(const Real& value) {
    numbers_.push_back({registers_, value});
    begun_ = 0;
    return registers_++;
  }
  /// The n-th number that was added is another one from the next `begin` on.
  void set_number(std::size_t n, const Real& value) { numbers_[n].value = value; }
  [[nodiscard]] std::size_t number_count() const { return numbers_.size(); }
  /// The number in this register, which has one.
  [[nodiscard]] const Real& number_in(Register place) const {
    return std::ranges::find(numbers_, place, &Number::place)->value;
  }
  /// The results of `count` equal operations, side by side as their operands are. Of those with two results, the
  /// second ones follow the first ones.
  [[nodiscard]] Register add(SeriesCode code, Register a, Register b = 0, Register c = 0, std::uint32_t count = 1) {
    operations_.push_back({code, registers_, count, a, b, c});
    has_corners_ = has_corners_ || is_piecewise(code);
    return std::exchange(registers_, registers_ + count * results_of(code));
  }
  /// Series that lie anywhere, side by side.
  [[nodiscard]] Register add_copies(std::span<const Register> from) {
    const auto count = static_cast<std::uint32_t>(from.size());
    operations_.push_back({SeriesCode::copy, registers_, count, static_cast<Register>(lists_.size()), 0, 0});
    lists_.insert(lists_.end(), from.begin(), from.end());
    return std::exchange(registers_, registers_ + count);
  }
  /// The number of a table, for operations on it: their operand b.
  [[nodiscard]] Register add_table(Pieces pieces) {
    tables_.push_back(std::move(pieces));
    return static_cast<Register>(tables_.size() - 1);
  }

  [[nodiscard]] bool has_corners() const { return has_corners_; }
  [[nodiscard]] std::size_t register_count() const { return registers_; }
  /// In the order in which they are evaluated. Operand a of a copy is the place of its first member in `copied`.
  [[nodiscard]] std::span<const Operation> operations() const { return operations_; }
  /// The registers that copies are made of.
  [[nodiscard]] std::span<const Register> copied() const { return lists_; }

  /// Room for coefficients up to this order. Those of the numbers are there; the others are the caller's and become
  /// what `evaluate` computes.
  void begin(std::size_t order) {
    const std::size_t size = (order + 1) * row_size();
    if (begun_ != size) {
      row_size_ = row_size();
      if (rows_.size() < size) rows_.resize(size);
      for (const Number& number : numbers_)
        for (std::size_t k = 1; k <= order; ++k) row(k)[number.place] = Real(0);
      begun_ = size;
    }
    for (const Number& number : numbers_) row(0)[number.place] = number.value;
  }
  /// Coefficients of neighbouring orders are so far apart. Rows a power of two apart would share few places of the
  /// cache.
  [[nodiscard]] std::size_t row_size() const {
    return registers_ / line * line + (registers_ / line % 2 == 0 ? line : 2 * line);
  }
  /// All coefficients, row by row.
  [[nodiscard]] std::span<Real> rows() { return rows_; }
  /// The coefficient of s^k.
  [[nodiscard]] Real& coefficient(std::size_t k, Register place) { return rows_[k * row_size_ + place]; }
  [[nodiscard]] const Real& coefficient(std::size_t k, Register place) const { return rows_[k * row_size_ + place]; }

  /// Coefficient k of all results, those of lower orders being there.
  void evaluate(std::size_t k) {
#if defined(__x86_64__)
    if constexpr (std::is_same_v<Real, double> || std::is_same_v<Real, float>) {
      static const bool is_wide = __builtin_cpu_supports("avx2") != 0;
      if (is_wide) return evaluate_wide(k);
    }
#endif
    for (const Operation& operation : operations_) evaluate(operation, k);
  }

 private:
  static constexpr std::uint32_t line = 8;  // numbers of a cache line

  struct Number {
    Register place;
    Real value;
  };

  [[nodiscard]] static std::uint32_t results_of(SeriesCode code) {
    const bool is_double =
        (code >= SeriesCode::sine_cosine && code <= SeriesCode::hyperbolic_tangent) || code == SeriesCode::table;
    return is_double ? 2 : 1;
  }

  [[nodiscard]] Real* row(std::size_t k) { return rows_.data() + k * row_size_; }

  /// each(i) becomes the coefficient of member i.
  template <class Each>
  [[gnu::always_inline]] void set_each(const Operation& o, std::size_t k, Each&& each) {
    Real* const r = row(k) + o.result;
    for (std::uint32_t i = 0; i < o.count; ++i) r[i] = each(i);
  }

  /// finish(i, sum) becomes coefficient k of member i, sum = sum of w(j) a_j b_(k - j) for j from `first` to `last`.
  template <class Weight, class Finish>
  [[gnu::always_inline]] void set_by_sum(const Operation& o, std::size_t k, Register a, Register b, std::size_t first,
                                         std::size_t last, Weight&& weight, Finish&& finish) {
    const Operand<Weight> terms{row(0) + a, row(k) + b, first, last, weight};
    std::uint32_t begin = 0;
    for (; begin + 8 <= o.count; begin += 8) set_piece<8>(o, k, terms, begin, finish);
    if (begin + 4 <= o.count) set_piece<4>(o, k, terms, begin, finish), begin += 4;
    if (begin + 2 <= o.count) set_piece<2>(o, k, terms, begin, finish), begin += 2;
    if (begin < o.count) set_piece<1>(o, k, terms, begin, finish);
  }
  template <class Weight>
  struct Operand {
    const Real *a, *b;  // a of order 0, b of order k
    std::size_t first, last;
    const Weight& weight;
  };
  /// Some members at once. Even and odd terms apart: one addition does not wait for the other. The first and the last
  /// term come last: they have the coefficients of order k, which were computed just now. -0 is what changes no sum.
  template <std::uint32_t piece, class Terms, class Finish>
  [[gnu::always_inline]] void set_piece(const Operation& o, std::size_t k, const Terms& terms, std::uint32_t begin,
                                        Finish&& finish) {
    Real even[piece], odd[piece];
    for (std::uint32_t i = 0; i < piece; ++i) even[i] = odd[i] = -Real(0);
    const auto add = [&](Real* sum, std::size_t j) __attribute__((always_inline)) {
      const Real weight = terms.weight(j);
      const Real *const u = terms.a + begin + j * row_size_, *const v = terms.b + begin - j * row_size_;
      for (std::uint32_t i = 0; i < piece; ++i) sum[i] += weight * (u[i] * v[i]);
    };
    std::size_t j = terms.first + 1;
    for (; j + 1 < terms.last; j += 2) add(even, j), add(odd, j + 1);
    if (j < terms.last) add(even, j);
    for (std::uint32_t i = 0; i < piece; ++i) even[i] += odd[i];
    if (terms.first <= terms.last) add(even, terms.first);
    if (terms.first < terms.last) add(even, terms.last);
    Real* const r = row(k) + o.result + begin;
    for (std::uint32_t i = 0; i < piece; ++i) r[i] = finish(begin + i, even[i]);
  }

  template <bool weighted>
  [[nodiscard]] Real sum(std::size_t k, Register a, Register b, std::size_t first, std::size_t last) {
    Real total(0);
    for (std::size_t j = first; j <= last; ++j) {
      const Real product = row(j)[a] * row(k - j)[b];
      total += weighted ? Real(Real(static_cast<double>(j)) * product) : product;
    }
    return total;
  }

#if defined(__x86_64__)
  /// The same in vectors of 256 bits. Without the instructions that round only once for a product and a sum, so that
  /// every machine computes the same.
  [[gnu::target("avx2")]] void evaluate_wide(std::size_t k) {
    for (const Operation& operation : operations_) {
      if (!evaluate_sums(operation, k)) evaluate_others(operation, k);
    }
  }
#endif
  void evaluate(const Operation& o, std::size_t k) {
    if (!evaluate_sums(o, k)) evaluate_others(o, k);
  }
  [[gnu::always_inline]] inline bool evaluate_sums(const Operation& o, std::size_t k);
  void evaluate_others(const Operation& o, std::size_t k);
  void begin_functions(const Operation& o);
  void choose(const Operation& o, std::size_t k);
  void step_functions(const Operation& o);
  void table(const Operation& o, std::size_t k);
  [[nodiscard]] Real power_at_zero(std::size_t k, Register a, Register result, const Real& p);
  /// a^p. Powers of distances by roots, in a third of the time.
  [[nodiscard]] static Real power_of(const Real& a, const Real& p) {
    using std::pow, std::sqrt;
    if (p == Real(1.5)) return a * sqrt(a);
    if (p == Real(-1.5)) return Real(1) / (a * sqrt(a));
    return pow(a, p);
  }

  std::vector<Operation> operations_;
  std::vector<Number> numbers_;
  std::vector<Register> lists_;
  std::vector<Pieces> tables_;
  std::vector<Real> rows_;  // coefficients of order 0, then of order 1, ...
  std::uint32_t registers_ = 0;
  std::size_t row_size_ = 0;
  std::size_t begun_ = 0;  // size of the rows in which the coefficients of numbers are there
  bool has_corners_ = false;
};

// What is linear, products, and the functions from order 1 on. False where the operation is another.
template <class Real>
inline bool SeriesProgram<Real>::evaluate_sums(const Operation& o, std::size_t k) {
  const Real *const a = row(k) + o.a, *const b = row(k) + o.b, order = Real(static_cast<double>(k));
  const Real* const r = row(0) + o.result;
  const auto all = [&](auto&& each) __attribute__((always_inline)) { return set_each(o, k, each), true; };
  const auto sums = [&](auto&& weight, const Operation& of, Register u, Register v, std::size_t first, std::size_t last,
                        auto&& finish) __attribute__((always_inline)) {
    return set_by_sum(of, k, u, v, first, last, weight, finish), true;
  };
  const auto plain = [](std::size_t) { return Real(1); };
  const auto weighted = [](std::size_t j) { return Real(static_cast<double>(j)); };
  const auto just = [](std::uint32_t, const Real& sum) { return sum; };
  // Of a square: twice the half of the terms, and the middle one.
  const auto both_halves = [&](Register of) {
    return [m = row(k / 2) + of, even = k % 2 == 0](std::uint32_t i, const Real& sum) {
      return even ? 2 * sum + m[i] * m[i] : 2 * sum;
    };
  };
  // Divisors are known before the sums, which wait for the order before: their inverses are computed by then.
  const Real inverse_order = Real(1) / order;
  const auto by_order = [&](std::uint32_t, const Real& sum) { return sum * inverse_order; };
  // r' = slope a' / u: what is left of a_k when the products of known coefficients are taken away.
  const auto by_slope = [&](Register slope, const Real& sign) __attribute__((always_inline)) {
    return sums(weighted, o, o.result, slope, 1, k - 1, [&, u = row(0) + slope](std::uint32_t i, const Real& sum) {
      return (sign * a[i] - sum * inverse_order) * (Real(1) / u[i]);
    });
  };
  Operation second = o;
  second.result = o.result + o.count;
  switch (o.code) {
    case SeriesCode::copy:
      return all([&](std::uint32_t i) { return row(k)[lists_[o.a + i]]; });
    case SeriesCode::add:
      return all([&](std::uint32_t i) { return a[i] + b[i]; });
    case SeriesCode::subtract:
      return all([&](std::uint32_t i) { return a[i] - b[i]; });
    case SeriesCode::negate:
      return all([&](std::uint32_t i) { return -a[i]; });
    case SeriesCode::add_number:
      if (k == 0) return all([&](std::uint32_t i) { return a[i] + b[i]; });
      return all([&](std::uint32_t i) { return a[i]; });
    case SeriesCode::subtract_from_number:
      if (k == 0) return all([&](std::uint32_t i) { return a[i] - b[i]; });
      return all([&](std::uint32_t i) { return -b[i]; });
    case SeriesCode::scale:
      return all([&, factor = row(0) + o.a](std::uint32_t i) { return factor[i] * b[i]; });
    case SeriesCode::divide_by_number: {
      const Real* const divisor = row(0) + o.b;
      if (k == 0) return all([&](std::uint32_t i) { return a[i] / divisor[i]; });
      return all([&](std::uint32_t i) { return a[i] * (Real(1) / divisor[i]); });
    }
    case SeriesCode::product:
      return sums(plain, o, o.a, o.b, 0, k, just);
    case SeriesCode::square: {
      if (k == 0) return all([&](std::uint32_t i) { return a[i] * a[i]; });
      // The term with the coefficient of order k, which was computed just now, comes last.
      return sums(plain, o, o.a, o.a, 1, (k - 1) / 2,
                  [&, first = row(0) + o.a, others = both_halves(o.a)](std::uint32_t i, const Real& sum) {
                    return others(i, sum) + 2 * first[i] * a[i];
                  });
    }
    case SeriesCode::quotient: {
      const Real* const divisor = row(0) + o.b;
      if (k == 0) return all([&](std::uint32_t i) { return a[i] / divisor[i]; });
      return sums(plain, o, o.b, o.result, 1, k,
                  [&](std::uint32_t i, const Real& sum) { return (a[i] - sum) * (Real(1) / divisor[i]); });
    }
    default:
      if (k == 0 || o.code >= SeriesCode::arc_tangent2) return false;
  }
  switch (o.code) {
    case SeriesCode::square_root: {  // r r = a
      return sums(plain, o, o.result, o.result, 1, (k - 1) / 2,
                  [&, square = both_halves(o.result)](std::uint32_t i, const Real& sum) {
                    const Real rest = a[i] - square(i, sum);
                    return r[i] == Real(0) ? power_at_zero(k, o.a + i, o.result + i, Real(0.5))
                                           : rest * (Real(0.5) / r[i]);
                  });
    }
    case SeriesCode::exponential:
      return sums(weighted, o, o.a, o.result, 1, k, by_order);
    case SeriesCode::logarithm:
      return by_slope(o.a, Real(1));
    case SeriesCode::arc_tangent:
    case SeriesCode::arc_sine:
      return by_slope(o.b, Real(1));
    case SeriesCode::arc_cosine:
      return by_slope(o.b, Real(-1));
    case SeriesCode::power: {  // a r' = p r a': the sum of (p j - (k - j)) a_j r_(k - j)
      const Real* const base = row(0) + o.a;
      const Real p = row(0)[o.b];
      const auto weight = [&](std::size_t j) { return (p + Real(1)) * Real(static_cast<double>(j)) - order; };
      return sums(weight, o, o.a, o.result, 1, k, [&](std::uint32_t i, const Real& sum) {
        return base[i] == Real(0) ? power_at_zero(k, o.a + i, o.result + i, p)
                                  : sum * (inverse_order * (Real(1) / base[i]));
      });
    }
    case SeriesCode::sine_cosine:
    case SeriesCode::hyperbolic_sine_cosine: {  // the slopes are the second one and sign times the first one
      const Real sign(o.code == SeriesCode::sine_cosine ? -1 : 1);
      sums(weighted, o, o.a, second.result, 1, k, by_order);
      return sums(weighted, second, o.a, o.result, 1, k,
                  [&](std::uint32_t, const Real& sum) { return sign * sum * inverse_order; });
    }
    case SeriesCode::tangent:
    case SeriesCode::hyperbolic_tangent: {  // r' = u a' with u = 1 + sign r^2
      const Real sign(o.code == SeriesCode::tangent ? 1 : -1);
      sums(weighted, o, o.a, second.result, 1, k, by_order);
      return sums(plain, second, o.result, o.result, 0, k, [&](std::uint32_t, const Real& sum) { return sign * sum; });
    }
    default:
      return false;
  }
}

template <class Real>
void SeriesProgram<Real>::evaluate_others(const Operation& o, std::size_t k) {
  if (o.code >= SeriesCode::table_slope) {
    if (k == 0) step_functions(o);
  } else if (o.code >= SeriesCode::minimum) {
    choose(o, k);
  } else if (k == 0) {
    begin_functions(o);
  } else {  // of y and x with c = x^2 + y^2: c r' = x y' - y x'
    const Real *const c = row(0) + o.c, order = Real(static_cast<double>(k));
    set_each(o, k, [&](std::uint32_t i) {
      const Real rise = sum<true>(k, o.a + i, o.b + i, 1, k) - sum<true>(k, o.b + i, o.a + i, 1, k);
      return (rise - sum<true>(k, o.result + i, o.c + i, 1, k - 1)) / (order * c[i]);
    });
  }
}

/// The values of functions, of order 0.
template <class Real>
void SeriesProgram<Real>::begin_functions(const Operation& o) {
  using std::acos, std::asin, std::atan, std::atan2, std::cos, std::cosh, std::exp, std::log, std::pow, std::sin,
      std::sinh, std::sqrt, std::tan, std::tanh;
  const Real *const a = row(0) + o.a, *const b = row(0) + o.b;
  Real *const r = row(0) + o.result, *const second = r + o.count;
  for (std::uint32_t i = 0; i < o.count; ++i) {
    switch (o.code) {
      case SeriesCode::square_root:
        r[i] = sqrt(a[i]);
        break;
      case SeriesCode::exponential:
        r[i] = exp(a[i]);
        break;
      case SeriesCode::logarithm:
        r[i] = log(a[i]);
        break;
      case SeriesCode::power:
        r[i] = power_of(a[i], b[0]);
        break;
      case SeriesCode::sine_cosine:
        r[i] = sin(a[i]), second[i] = cos(a[i]);
        break;
      case SeriesCode::hyperbolic_sine_cosine:
        r[i] = sinh(a[i]), second[i] = cosh(a[i]);
        break;
      case SeriesCode::tangent:
        r[i] = tan(a[i]), second[i] = Real(1) + r[i] * r[i];
        break;
      case SeriesCode::hyperbolic_tangent:
        r[i] = tanh(a[i]), second[i] = (Real(1) - r[i]) * (Real(1) + r[i]);
        break;
      case SeriesCode::arc_tangent:
        r[i] = atan(a[i]);
        break;
      case SeriesCode::arc_sine:
        r[i] = asin(a[i]);
        break;
      case SeriesCode::arc_cosine:
        r[i] = acos(a[i]);
        break;
      default:
        r[i] = atan2(a[i], b[i]);
    }
  }
}

/// a^p, also a root, where a begins with a power s^m: then the result begins with s^(p m), and the recurrence is that
/// of a / s^m. Not a number where p m is not whole.
template <class Real>
Real SeriesProgram<Real>::power_at_zero(std::size_t k, Register a, Register result, const Real& p) {
  using std::pow;
  std::size_t m = 0;
  while (m <= k && row(m)[a] == Real(0)) ++m;
  if (m > k) return Real(0) * p;  // 0, or not a number where p is none
  const Real shift = p * Real(static_cast<double>(m));
  if (shift > Real(static_cast<double>(k))) return Real(0);
  std::size_t first = 0;
  while (Real(static_cast<double>(first)) < shift) ++first;
  if (Real(static_cast<double>(first)) != shift) return std::numeric_limits<double>::quiet_NaN();
  const Real leading = row(m)[a];
  if (k == first) return pow(leading, p);
  const std::size_t n = k - first;
  Real total(0);
  for (std::size_t j = 1; j <= n && m + j <= k; ++j) {
    const Real weight = p * Real(static_cast<double>(j)) - Real(static_cast<double>(n - j));
    total += weight * (row(m + j)[a] * row(k - j)[result]);
  }
  return total / (Real(static_cast<double>(n)) * leading);
}

/// What is one of its operands, or one up to its sign.
template <class Real>
void SeriesProgram<Real>::choose(const Operation& o, std::size_t k) {
  // The sign of the first coefficient of u - v that is not 0.
  const auto sign_of = [&](Register u, Register v, bool alone) {
    for (std::size_t j = 0; j <= k; ++j) {
      const Real difference = alone ? row(j)[u] : Real(row(j)[u] - row(j)[v]);
      if (difference != Real(0)) return difference < Real(0) ? -1 : 1;
    }
    return 0;
  };
  const Real* const here = row(k);
  switch (o.code) {
    case SeriesCode::minimum:
      return set_each(o, k,
                      [&](std::uint32_t i) { return here[sign_of(o.b + i, o.a + i, false) < 0 ? o.b + i : o.a + i]; });
    case SeriesCode::maximum:
      return set_each(o, k,
                      [&](std::uint32_t i) { return here[sign_of(o.b + i, o.a + i, false) > 0 ? o.b + i : o.a + i]; });
    case SeriesCode::absolute:
      return set_each(o, k,
                      [&](std::uint32_t i) { return sign_of(o.a + i, 0, true) < 0 ? -here[o.a + i] : here[o.a + i]; });
    case SeriesCode::select:
      return set_each(o, k, [&](std::uint32_t i) { return here[(row(0)[o.a + i] != Real(0) ? o.b : o.c) + i]; });
    default:
      table(o, k);
  }
}

/// The piece is that which a enters: on a corner the one before it where a falls.
template <class Real>
void SeriesProgram<Real>::table(const Operation& o, std::size_t k) {
  const Pieces& pieces = tables_[o.b];
  Real* const slopes = row(0) + o.result + o.count;
  for (std::uint32_t i = 0; i < o.count; ++i) {
    const Real at = row(0)[o.a + i];
    const LinearPiece<Real> piece = pieces(at);
    Real& result = row(k)[o.result + i];
    if (k == 0) {
      slopes[i] = piece.slope;
      result = piece.value + piece.slope * (at - piece.from);
      continue;
    }
    bool is_first = true;  // coefficient after that of order 0
    for (std::size_t j = 1; j < k && is_first; ++j) is_first = row(j)[o.a + i] == Real(0);
    if (is_first && at == piece.from && row(k)[o.a + i] < Real(0)) {
      using std::nextafter;
      slopes[i] = pieces(nextafter(at, -std::numeric_limits<Real>::infinity())).slope;
    }
    result = slopes[i] * row(k)[o.a + i];
  }
}

/// Functions that are constant between their jumps.
template <class Real>
void SeriesProgram<Real>::step_functions(const Operation& o) {
  using std::ceil, std::floor;
  const Real *const a = row(0) + o.a, *const b = row(0) + o.b;
  const auto truth = [](bool holds) { return holds ? Real(1) : Real(0); };
  switch (o.code) {
    case SeriesCode::table_slope:
      return set_each(o, 0, [&](std::uint32_t i) { return tables_[o.b](a[i]).slope; });
    case SeriesCode::sign:
      return set_each(o, 0, [&](std::uint32_t i) {
        return a[i] > Real(0) ? Real(1) : a[i] < Real(0) ? Real(-1) : a[i];
      });
    case SeriesCode::floor:
      return set_each(o, 0, [&](std::uint32_t i) { return floor(a[i]); });
    case SeriesCode::ceiling:
      return set_each(o, 0, [&](std::uint32_t i) { return ceil(a[i]); });
    case SeriesCode::less:
      return set_each(o, 0, [&](std::uint32_t i) { return truth(a[i] < b[i]); });
    case SeriesCode::less_equal:
      return set_each(o, 0, [&](std::uint32_t i) { return truth(a[i] <= b[i]); });
    case SeriesCode::equal:
      return set_each(o, 0, [&](std::uint32_t i) { return truth(a[i] == b[i]); });
    case SeriesCode::not_equal:
      return set_each(o, 0, [&](std::uint32_t i) { return truth(a[i] != b[i]); });
    case SeriesCode::logical_and:
      return set_each(o, 0, [&](std::uint32_t i) { return truth(a[i] != Real(0) && b[i] != Real(0)); });
    case SeriesCode::logical_or:
      return set_each(o, 0, [&](std::uint32_t i) { return truth(a[i] != Real(0) || b[i] != Real(0)); });
    default:
      return set_each(o, 0, [&](std::uint32_t i) { return truth(a[i] == Real(0)); });
  }
}

/// The coefficients of the solution of x' = f(t, x): c[k n + i] of component i of x(t + scale s), of n components,
/// those of order 0 being there. Of the program's registers the first is the time and the next are the components of x;
/// `derivatives` are those of f.
template <class Real>
void expand_solution(SeriesProgram<Real>& program, std::span<const std::uint32_t> derivatives, const Real& t,
                     const Real& scale, std::span<Real> c) {
  const std::size_t n = derivatives.size(), order = c.size() / n - 1;
  program.begin(order);
  for (std::size_t k = 0; k < order; ++k) {
    program.coefficient(k, 0) = k == 0 ? t : k == 1 ? scale : Real(0);
    for (std::uint32_t i = 0; i < n; ++i) program.coefficient(k, i + 1) = c[k * n + i];
    program.evaluate(k);
    const Real factor = scale / Real(static_cast<double>(k + 1));
    for (std::size_t i = 0; i < n; ++i) c[(k + 1) * n + i] = factor * program.coefficient(k, derivatives[i]);
  }
}

}  // namespace continuo
