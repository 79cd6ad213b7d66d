// Losses that count an outlier less than squares do, of a residual u in units of its deviation:
//
//   weight_of(Loss::huber, 3.0);  // 1.345/3: so much of an outlier at three deviations is left
//
// rho(u) stands in place of u^2, and psi = rho'/2 in place of u. The multiples of the deviation at which they depart
// from squares keep 95 % of the efficiency on normal noise: P. W. Holland, R. E. Welsch, "Robust regression using
// iteratively reweighted least-squares", Comm. Statist. A6 (1977).
#pragma once
#include <cmath>
#include <string_view>

namespace continuo::studies {

enum class Loss { squares, huber, soft_l1, cauchy, tukey };
inline constexpr std::string_view loss_names[] = {"squares", "huber", "soft_l1", "cauchy", "tukey"};

inline constexpr double huber_tuning = 1.345, cauchy_tuning = 2.3849, tukey_tuning = 4.6851;

/// Far residuals pull the less the further off they are, so that there may be minima of their own.
[[nodiscard]] constexpr bool redescends(Loss loss) {
  return loss == Loss::cauchy || loss == Loss::tukey;
}

/// rho(u).
[[nodiscard]] inline double loss_of(Loss loss, double u) {
  const double s = u * u;
  switch (loss) {
    case Loss::squares:
      break;
    case Loss::huber:
      return std::abs(u) <= huber_tuning ? s : huber_tuning * (2 * std::abs(u) - huber_tuning);
    case Loss::soft_l1: {
      const double a = huber_tuning * huber_tuning;
      return 2 * a * (std::sqrt(1 + s / a) - 1);
    }
    case Loss::cauchy: {
      const double a = cauchy_tuning * cauchy_tuning;
      return a * std::log1p(s / a);
    }
    case Loss::tukey: {
      const double a = tukey_tuning * tukey_tuning, rest = s < a ? 1 - s / a : 0;
      return a / 3 * (1 - rest * rest * rest);
    }
  }
  return s;
}

/// psi(u)/u.
[[nodiscard]] inline double weight_of(Loss loss, double u) {
  const double s = u * u;
  switch (loss) {
    case Loss::squares:
      break;
    case Loss::huber:
      return std::abs(u) <= huber_tuning ? 1 : huber_tuning / std::abs(u);
    case Loss::soft_l1:
      return 1 / std::sqrt(1 + s / (huber_tuning * huber_tuning));
    case Loss::cauchy:
      return 1 / (1 + s / (cauchy_tuning * cauchy_tuning));
    case Loss::tukey: {
      const double rest = 1 - s / (tukey_tuning * tukey_tuning);
      return rest > 0 ? rest * rest : 0;
    }
  }
  return 1;
}

/// psi'(u).
[[nodiscard]] inline double slope_of(Loss loss, double u) {
  const double w = weight_of(loss, u), s = u * u;
  switch (loss) {
    case Loss::squares:
      break;
    case Loss::huber:
      return std::abs(u) <= huber_tuning ? 1 : 0;
    case Loss::soft_l1:
      return w * w * w;
    case Loss::cauchy:
      return w * (2 * w - 1);  // (1 - v)/(1 + v)^2 with v = (u/a)^2 and w = 1/(1 + v)
    case Loss::tukey: {
      const double v = s / (tukey_tuning * tukey_tuning);
      return v < 1 ? (1 - v) * (1 - 5 * v) : 0;
    }
  }
  return 1;
}

}  // namespace continuo::studies
