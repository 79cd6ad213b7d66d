// A checked model as JSON: what `continuo info` says of it, for programs.
#pragma once
#include <nlohmann/json_fwd.hpp>

#include <continuo/language/model.hpp>

namespace continuo::app {

/// Names, values and units of all that the model declares; expressions as text, cut off after 2000 characters.
nlohmann::ordered_json model_json(const model::Model& model);

}  // namespace continuo::app
