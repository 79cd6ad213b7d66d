// continuo/language/describe.hpp
// What Continuo made of a model, for people: the system of first order, units, events, the experiment.
//
//   fmt::print("{}", describe(model));
#pragma once
#include <cstddef>
#include <string>

#include <continuo/language/model.hpp>

namespace continuo::model {

/// How much of a model is listed.
struct DescribeOptions {
  std::size_t most_listed = 24;          // of each kind; the rest is counted
  std::size_t longest_expression = 200;  // characters
};

/// The text that `continuo info` prints.
[[nodiscard]] std::string describe(const Model& model, const DescribeOptions& options = {});

}  // namespace continuo::model
