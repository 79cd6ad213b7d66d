// continuo/language/check/expressions/lookup.hpp
// What a name stands for.
#pragma once
#include <cstddef>
#include <string>
#include <vector>

#include <continuo/language/check/names/scope.hpp>

namespace continuo::model::detail {

class Expressions;
class Operations;
class Report;
struct Symbol;
struct Workspace;

class Lookup {
 public:
  explicit Lookup(Expressions& expressions);

  [[nodiscard]] Value lookup(const ast::Name& name, Scope& scope) const;
  /// Of the variable of this index; its highest derivative is noted in the scope.
  [[nodiscard]] Value derivative(const ast::Name& name, std::size_t base, Scope& scope) const;
  /// Of the highest derivative of the variable of this index.
  [[nodiscard]] Measured highest_unit(std::size_t base, const Scope& scope) const;
  /// Of `energy` and of the world; its node is not valid where there is none.
  [[nodiscard]] Value total_energy(Span span, Scope& scope) const;
  /// The kinetic and the potential energy of the world; empty without bodies.
  [[nodiscard]] std::vector<NodeId> world_energies() const;
  /// E222: what stands in a constant changes with time.
  [[nodiscard]] Value not_constant(Span span, const std::string& name, const Scope& scope) const;
  /// `undeclared`: what to do about it where the name is not like any other.
  Value unknown_name(const ast::Name& name, const std::string& key, std::string undeclared = {}) const;

 private:
  [[nodiscard]] Value of_symbol(const ast::Name& name, const Symbol* symbol, const std::string& key,
                                Scope& scope) const;
  [[nodiscard]] bool is_outside_of_family(const ast::Name& name) const;
  [[nodiscard]] Value builtin(const ast::Name& name, const std::string& key, Scope& scope) const;
  [[nodiscard]] Value without_time(const ast::Name& name, const Scope& scope) const;
  [[nodiscard]] Value not_a_value(const ast::Name& name) const;
  [[nodiscard]] std::string blackboard_help(const ast::Name& name) const;
  [[nodiscard]] std::size_t first_world_measure() const;  // of the kinetic energy, among the states

  Expressions& expressions_;
  Workspace& workspace_;
  Report& report_;
  const Operations& operations_;
};

}  // namespace continuo::model::detail
