// continuo/language/check/expressions/world_expressions.cpp
// Equations of bodies are refused: forces move them.
#include <fmt/format.h>

#include <continuo/language/check/expressions/world_expressions.hpp>
#include <continuo/language/syntax/format.hpp>

namespace continuo::model::detail {

void refuse_equation_of_body(const ast::Name& name, Report& report) {
  const bool world = name.text == "world";
  ast::Name body = name;
  body.primes = 0;
  body.member.clear();
  report.fail(
      "E226", name.span, world ? "the world is only looked at" : fmt::format("`{}` is moved by forces", to_text(body)),
      fmt::format("`{}` has no equation", to_text(name)),
      world ? "" : fmt::format("write force on {} = (..., ...), or torque on {} = ...", to_text(body), to_text(body)));
}

}  // namespace continuo::model::detail
