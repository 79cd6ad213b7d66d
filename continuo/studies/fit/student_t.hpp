// Student's t distribution: how wide an interval must be when its deviation was estimated from few numbers.
#pragma once

namespace continuo::studies {

/// P(T <= t) with `degrees` > 0 of freedom. NaN for others.
[[nodiscard]] double student_t_probability(double t, double degrees);

/// The t with P(|T| <= t) = `confidence`, between 0 and 1: 12.7062 for 0.95 and one degree, 1.95996 for many.
[[nodiscard]] double student_t_quantile(double confidence, double degrees);

}  // namespace continuo::studies
