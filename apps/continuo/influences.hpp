// Parameters and states by the names that a command line gives.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include <continuo/studies/influence.hpp>

namespace continuo::app {

/// Says which name is unknown, or that there are none.
std::optional<std::vector<studies::Influence>> influences_named(const model::Model& model,
                                                                const std::vector<std::string>& parameters,
                                                                const std::vector<std::string>& initial);

/// "there is no ...; did you mean `k`?", or all the names there are.
std::string no_such(const std::string& kind, const std::string& name, const std::vector<std::string>& names);

}  // namespace continuo::app
