// continuo/language/check/products.hpp
// Where the products of the passes stand in the model.
#pragma once
#include <continuo/language/check/declarations/parameters.hpp>
#include <continuo/language/check/declarations/quantities.hpp>
#include <continuo/language/check/equations/equations.hpp>
#include <continuo/language/check/equations/reduction.hpp>
#include <continuo/language/check/events/events.hpp>
#include <continuo/language/check/states/initial_values.hpp>

namespace continuo::model::detail {

/// Its name, heading and text; all else is empty.
[[nodiscard]] Model empty_model(const ast::Model& tree, const Source& source);

void store(const TimeUnit& found, Model& model);
/// Modes and tables.
void store(const Declarations& declared, Model& model);
void store(Parameters made, Model& model);
void store(BoundaryProblem made, Model& model);
/// From here on highest derivatives may stand in every expression: the workspace knows them.
void store(SolvedEquations made, Model& model, Workspace& workspace);
void store(PairedStates made, Model& model);
void store(Quantities made, Model& model);
void store(EventList made, Model& model);

}  // namespace continuo::model::detail
