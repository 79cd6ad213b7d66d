// What is said of orbits, however they were found.
#pragma once
#include <complex>
#include <string>
#include <vector>

#include <apps/continuo/terminal/exit_codes.hpp>

#include <continuo/language/model.hpp>
#include <continuo/solve/outcome.hpp>

namespace continuo::app {

/// Of an orbit of a system with a conserved quantity.
inline constexpr std::string_view one_of_a_family =
    "one of a family: a quantity is conserved, and each of its values has an orbit";
/// "19.07836957 s"
std::string with_time_unit(double t, const model::Model& model);
/// "multipliers 1, -0.5 + 0.3 i, ..."
std::string multipliers_text(const std::vector<std::complex<double>>& multipliers);
/// "  x from -1 to 1", a line for each state.
/// Of what turns over: " in which phi advances by 1 turn"; empty where the orbit comes back to where it was.
std::string advance_text(const model::Model& model, const std::vector<double>& advance);
std::string extents_text(const model::Model& model, const std::vector<double>& low, const std::vector<double>& high);
/// ",x min,x max,...,multiplier 1 re,multiplier 1 im,..." and the end of the line: the last columns of a table of
/// orbits.
std::string orbit_columns(const model::Model& model, std::size_t multipliers);
/// Says why a study has come to nothing.
ExitCode failed_exit(const Outcome<double>& outcome);

}  // namespace continuo::app
