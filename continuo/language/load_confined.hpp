// continuo/language/load_confined.hpp
// A model's text that somebody has sent over a network: its author must not read the files of this computer.
#pragma once
#include <string>

#include <continuo/language/load.hpp>

namespace continuo::model {

/// As `load`, but files of tables and inputs are read from the folder of the model and below it only, and messages
/// quote nothing of them. A name that leads elsewhere (`..`, an absolute path), links, devices and pipes are refused.
[[nodiscard]] Loaded load_confined(const std::string& path, const CheckOptions& options = {});
/// The same for a text that is in memory already.
[[nodiscard]] Loaded load_confined(Source source, const CheckOptions& options = {});

}  // namespace continuo::model
