// The functions of registers/vector_power.hpp on four numbers at once, in a source of their own: it is compiled for
// processors that the other tests do without.
#pragma once

namespace continuo::wide_functions {

inline constexpr int width = 4;

/// Whether this processor has the instructions.
[[nodiscard]] bool available();
void powers(const double* x, const double* y, double* result);
void sines(const double* x, double* result);
void cosines(const double* x, double* result);

}  // namespace continuo::wide_functions
