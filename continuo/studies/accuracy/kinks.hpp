// Where a motion passes places at which the equations jump or bend: a step across one has not the order of its method.
//
//   for (const Kink& kink : kinks_along(*program, run)) fmt::print("{} at {}\n", kink.text, kink.first);
#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include <continuo/simulation/program/model_program.hpp>
#include <continuo/simulation/run.hpp>

namespace continuo::studies {

struct Kink {
  std::size_t state;  // in whose equation it stands
  std::string text;   // "sign(v)"
  bool jumps;         // else the equation bends
  std::size_t times;  // how often it is passed, as the rows of the run show it
  double first;       // when it is passed first, to the distance between two rows
};
/// Of the equations of every mode; one that stands in several is told once. Cost: an evaluation for each row.
[[nodiscard]] std::vector<Kink> kinks_along(const model::ModelProgram& program, const model::Run& run);

}  // namespace continuo::studies
