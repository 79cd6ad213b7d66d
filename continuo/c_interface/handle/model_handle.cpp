// Keeps what went wrong with a handle, and copies numbers to its caller.
#include <algorithm>

#include <fmt/format.h>

#include <continuo/c_interface/handle/model_handle.hpp>

namespace continuo::c {

int fail(continuo_model& model, int code, std::string message, std::string hint) {
  model.error = {.message = std::move(message), .code = {}, .hint = std::move(hint)};
  return code;
}

int fail(continuo_model& model, int code, const std::vector<model::Diagnostic>& diagnostics) {
  const model::Source source(model.source_name, model.text);
  Error error{.message = render(diagnostics, source), .code = {}, .hint = {}};
  for (const model::Diagnostic& diagnostic : diagnostics) {
    if (diagnostic.severity != model::Severity::error) continue;
    const model::Place place = source.place(diagnostic.span.begin);
    error.code = diagnostic.code, error.hint = diagnostic.help;
    error.line = place.line, error.column = place.column;
    break;
  }
  model.error = std::move(error);
  return code;
}

int copy(continuo_model& model, std::span<const double> numbers, double* buffer, std::size_t count,
         std::string_view what) {
  if (count != numbers.size() || (!buffer && count > 0)) {
    return fail(
        model, CONTINUO_MISUSE,
        fmt::format("the buffer has room for {} numbers, and {} has {}", buffer ? count : 0, what, numbers.size()));
  }
  std::ranges::copy(numbers, buffer);
  return CONTINUO_OK;
}

}  // namespace continuo::c
