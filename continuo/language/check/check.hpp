// continuo/language/check/check.hpp
// From the syntax tree to the checked model: names, orders, families, units, equations solved for their highest
// derivatives, events and the experiment.
//
//   ParseResult parsed = parse(source);
//   Checked checked = check(parsed.model, source);
//   if (!checked.model) std::cerr << render(checked.diagnostics, source);
//
// The codes are in codes.hpp; every message marks the place in the text that has to be corrected.
#pragma once
#include <optional>
#include <vector>

#include <continuo/language/check/check_options.hpp>
#include <continuo/language/check/names/file_reach.hpp>
#include <continuo/language/model.hpp>
#include <continuo/language/syntax/ast.hpp>
#include <continuo/language/text/diagnostic.hpp>
#include <continuo/language/text/source.hpp>

namespace continuo::model {

struct Checked {
  std::optional<Model> model;           // there iff no diagnostic is an error
  std::vector<Diagnostic> diagnostics;  // in order of place
};

[[nodiscard]] Checked check(const ast::Model& tree, const Source& source, const CheckOptions& options = {},
                            FileReach files = FileReach::anywhere);

}  // namespace continuo::model
