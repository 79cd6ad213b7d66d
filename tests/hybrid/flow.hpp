// tests/hybrid/flow.hpp
// The motion between two changes in closed form: every state is a polynomial, an exponential and a sinusoid of the time
// since the first of them.
#pragma once
#include <array>
#include <span>
#include <string>
#include <vector>

#include <tests/hybrid/hybrid_model.hpp>
#include <tests/hybrid/jet.hpp>

namespace continuo::hybrid {

/// p0 + p1 s + p2 s^2 + p3 s^3 + c e^(-k s) + a cos(w s) + b sin(w s), s = t - t0.
struct Closed {
  std::array<Real, 4> p{};
  Real c = 0, k = 0, a = 0, b = 0, w = 0;

  Jet at(Real s) const;
  Real value(Real s) const;
};

/// A value below `zero` is a zero with the rounding of a root. Between `zero` and `clear` it is undecided, and a model
/// in which this matters is left out.
struct Margin {
  Real zero, clear;
};
inline constexpr Margin value_margin{1e-12L, 1e-6L}, derivative_margin{1e-11L, 1e-4L};

/// A function whose sign decides between two forms of the equations.
struct Surface {
  Expression function{};
  bool floors = false;  // its sign is irrelevant: the whole numbers below the values on its two sides matter
};

/// States, unknowns and time as jets, for expressions.
struct Quantities {
  Jet time{};
  std::vector<Jet> states{}, unknowns{};
};
Jet evaluate(const Expression& e, const Quantities& quantities);

/// The smooth function that has the sign of left - right.
Jet evaluate(const Comparison& comparison, const Quantities& quantities);

/// The motion of a model from t on, in the form that the equations have just after t.
class Flow {
 public:
  Flow(const HybridModel& model, int mode, Real t, std::span<const Real> x);

  /// The reason why the form just after t is undecided; empty where it is decided.
  const std::string& doubt() const { return doubt_; }
  Real begin() const { return t0_; }
  Quantities at(Real t) const;
  std::vector<Real> states_at(Real t) const;
  /// Where one of these changes sign the form may change.
  std::span<const Surface> surfaces() const { return surfaces_; }
  /// The number of sliding relays.
  int sliding() const { return sliding_; }

 private:
  void start(const Block& block, std::span<const Real> x);
  void start_switching(const Block& block, std::span<const Real> x, const Quantities& now);
  void start_relay(const Block& block, std::span<const Real> x, const Quantities& now);
  int sign(const Jet& g);
  Closed& closed(int state) { return closed_[static_cast<std::size_t>(state)]; }
  void solve_unknowns(Quantities& quantities) const;

  const HybridModel& model_;
  int mode_;
  Real t0_;
  std::vector<Closed> closed_;
  std::vector<Surface> surfaces_{};
  std::string doubt_{};
  int sliding_ = 0;
};

/// The sign just after now: of the value, or if that is zero, of the first nonzero derivative; 0 if all are zero.
/// `doubt` reports values within a margin.
int sign_just_after(const Jet& g, std::string& doubt);

}  // namespace continuo::hybrid
