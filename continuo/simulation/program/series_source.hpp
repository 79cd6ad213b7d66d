// The series of a solution written as C: the operations of a SeriesProgram in the same order, to the same bits.
//
//   const std::string text = series_source(program, derivatives, 17);
//   // void evaluate(double *w, double *x, double scale, struct series_steps *steps): w are the program's rows, with
//   // those of order 0 filled in; x gets the coefficients of the solution
//
// For one order, which is a number in the text. Of small programs every term of every sum is written out; of others the
// sums are loops, over members in vectors. Tables are not written.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include <continuo/methods/taylor_series/series_program.hpp>
#include <continuo/simulation/program/series_steps_source.hpp>

namespace continuo::model {

/// Machine code of `expand_solution`, from the states and the time in row 0 on: coefficients[k n + i] of order k from 1
/// on. Where `steps` is not null, machine code of those, and the other arguments are not read.
using NativeSeries = void (*)(double* rows, double* coefficients, double scale, NativeSeriesSteps* steps);

/// The text of a NativeSeries named `evaluate`. Register 0 is the time, the states follow it, and `derivatives` are
/// theirs; of an order below 4 there are no steps. `guards` is that of series_steps_source.
[[nodiscard]] std::string series_source(const SeriesProgram<double>& program,
                                        std::span<const std::uint32_t> derivatives, std::size_t order,
                                        std::string_view guards = {});

/// Whether the text can be written, and stays of a size that a compiler takes in seconds.
[[nodiscard]] bool is_worth_compiling(const SeriesProgram<double>& program);

}  // namespace continuo::model
