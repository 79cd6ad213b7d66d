// The methods that a caller may name for a model: those of solve/catalogue.hpp, or the ways of moving bodies.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include <continuo/language/model.hpp>
#include <continuo/runs/kind.hpp>

namespace continuo::runs {

/// A method that a model can be run by.
struct Method {
  std::string name;
  std::string title;           // for people
  int order = 0;               // the greatest; 0: of bodies, whose methods have none
  bool implicit = false;       //
  bool chooses_steps = false;  // by a tolerance; else it takes the step that it is given
};

/// Those that fit the model.
[[nodiscard]] std::vector<Method> methods_for(const model::Model& model);

/// All names of methods for models of this kind; whether one fits a model its plan says.
[[nodiscard]] std::vector<std::string> method_names(const Kind& kind);

/// Whether the method is one of bodies that moves them from collision to collision, so that there is no step to give.
[[nodiscard]] bool has_no_step(const Kind& kind, std::string_view method);

/// The order that the method keeps in steps of a fixed size; 0 where there is none.
[[nodiscard]] int order_of_fixed_steps(const model::Model& model, std::string_view method);

/// What others are compared with: the exact motion of bodies, or the fast one where only that moves them; a pair of
/// high order, or where equations are stiff or algebraic, a method for such.
[[nodiscard]] std::string_view reference_method(const model::Model& model, bool stiff);

}  // namespace continuo::runs
