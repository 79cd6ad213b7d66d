// continuo/language/check/expressions/repair.hpp
// What may have been meant by a term whose unit does not fit.
#pragma once
#include <string>

#include <continuo/language/check/names/scope.hpp>

namespace continuo::model::detail {

class Expressions;

/// The term with one prime more or less somewhere, if that has the unit that is wanted: "did you mean x' ?". Empty
/// where nothing fits, in constants, and in trials.
[[nodiscard]] std::string repair(Expressions& expressions, const Term& term, const Measured& wanted,
                                 const Scope& scope);

}  // namespace continuo::model::detail
