// continuo/language/check/equations/algebraic.hpp
// Unknowns and the equations `0 = ...` that determine them: they join the states, behind them, and their equations must
// be able to determine them (index 1).
#pragma once
#include <continuo/language/check/names/report.hpp>
#include <continuo/language/model.hpp>

namespace continuo::model::detail {

/// Of a model without errors.
void append_unknowns(Model& model, Report& report);

}  // namespace continuo::model::detail
