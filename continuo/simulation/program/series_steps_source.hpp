// Whole steps of a Taylor series written as C, many in one call: the state at their ends, the measure of their errors
// and the choice of their sizes, around the function `coefficients` that gives the series (series_source.hpp).
//
// The operations are those of TaylorSeries and StepControl in the same order, so the bits are the same. A step that is
// not simply accepted, and one that may have a root of a guard in it, is left to them as if it had not been made.
#pragma once
#include <cstddef>
#include <string>
#include <string_view>

namespace continuo::model {

/// The steps of a call, with memory for all that is needed; see SeriesSteps. The text has the same struct.
struct NativeSeriesSteps {
  double *rows, *scratch;  // of the program of series; series_scratch(components) numbers
  double *x, *rest, *now, *next;
  double t, scale, size, carried;
  double limit, longest, until, forward;
  const double *rtol, *atol;
  long long rtol_each, atol_each;  // 0: one for all, 1: one for each component
  double terms[2], greatest_factor, safety;
  double* times;
  const double* numbers;  // that the guards read; null: they are not watched
  long long most, made;
};

/// The function `take_steps(struct series_steps *)` for so many components and this order, at least 4. `guards` is the
/// function `may_have_root` of guard_source.hpp, empty where no guards are watched.
[[nodiscard]] std::string series_steps_source(std::size_t components, std::size_t order, std::string_view guards);

/// How many numbers the steps keep beside the series.
[[nodiscard]] constexpr std::size_t series_scratch(std::size_t components) {
  constexpr std::size_t arrays = 6, width = 4;
  return arrays * (components + width - 1) / width * width + arrays * width;
}

}  // namespace continuo::model
