// continuo/language/check/expressions/definition_values.hpp
// What params, inputs, lets, outputs and energies are, each found when it is first asked for.
#pragma once
#include <cstddef>
#include <vector>

#include <continuo/language/check/names/scope.hpp>

namespace continuo::model::detail {

struct Workspace;

class DefinitionValues {
 public:
  explicit DefinitionValues(Workspace& workspace) : workspace_(workspace) {}

  /// What the name stands for: of a parameter or an input its variable.
  Value value(std::size_t definition, const ast::Name& name, const Scope& outer);
  /// What it is in a constant: of a parameter its value. It then decides what the model is made of.
  [[nodiscard]] Value constant(std::size_t definition, const ast::Name& name, const Scope& outer);

  /// As written; after `value`.
  [[nodiscard]] const Value& written(std::size_t definition) { return entry(definition).value; }
  /// Decides the size of a family, so that it cannot change later.
  [[nodiscard]] bool is_structural(std::size_t definition) { return entry(definition).structural; }
  /// The value of one that decides the size of a family: nothing where it does not.
  [[nodiscard]] std::optional<NodeId> structural_value(std::size_t definition);
  /// Parameters, each after those it needs.
  [[nodiscard]] const std::vector<std::size_t>& evaluation_order() const { return evaluation_order_; }

 private:
  struct Entry {
    Progress progress = Progress::untouched, constant_progress = Progress::untouched;
    Value value{}, constant{};
    std::vector<std::uint32_t> highest{};  // highest derivatives in `value`, as indices of bases
    bool structural = false;
  };

  [[nodiscard]] Entry& entry(std::size_t definition);
  void find(std::size_t definition, const Scope& outer);
  void find_constant(std::size_t definition, const Scope& outer);
  [[nodiscard]] Value finished(std::size_t definition, Value value);
  [[nodiscard]] Value circular(std::size_t definition, Span span) const;

  Workspace& workspace_;
  std::vector<Entry> entries_;
  std::vector<std::size_t> busy_;  // being found, for the names of a circle
  std::vector<std::size_t> evaluation_order_;
};

}  // namespace continuo::model::detail
