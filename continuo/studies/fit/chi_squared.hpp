// The chi-squared distribution: whether residuals are as large as the deviations given for them allow.
#pragma once

namespace continuo::studies {

/// P(X >= x) with `degrees` > 0 of freedom: 0.3173 for 1 and one degree.
[[nodiscard]] double chi_squared_tail(double x, double degrees);

}  // namespace continuo::studies
