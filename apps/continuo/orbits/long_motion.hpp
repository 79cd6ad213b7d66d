// What a long motion shows that does not come back: its passes through a plane, and how fast neighbours part.
#pragma once
#include <string>

#include <apps/continuo/studies/studied_model.hpp>
#include <apps/continuo/terminal/exit_codes.hpp>

namespace continuo::app {

struct LongMotion {
  double settle = 0, duration = 0, tolerance = 1e-9;
  bool whole = false;  // with all that happens in the model; else by the equations of one mode alone
  bool json = false;
  std::string out{}, plot{};  // of a section: its table, its picture; empty where none is wanted
};

ExitCode show_exponents(const Studied& studied, const LongMotion& motion);

/// `section`: "x=0.5", the plane that the motion passes upwards.
ExitCode show_section(const Studied& studied, const std::string& section, const LongMotion& motion);

}  // namespace continuo::app
