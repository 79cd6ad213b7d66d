// continuo/language/check/check_options.hpp
// Options of the check, apart from the syntax tree that it reads.
#pragma once
#include <continuo/language/model.hpp>

namespace continuo::model {

/// Options of `check` and `load`.
struct CheckOptions {
  /// Parameters by name, as if the text had these values. The only way to change one that decides the size of a
  /// family (`Parameter::structural`). Names that are no parameter are reported with E210.
  Overrides overrides = {};
};

}  // namespace continuo::model
