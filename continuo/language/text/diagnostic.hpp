// continuo/language/text/diagnostic.hpp
// The diagnostics of a model, and how they are shown.
//
//   Diagnostic d = error("E201", span, "units do not match", "`F - k*x` is N, `c*x` is N*s", "did you mean c*x' ?");
//   std::string text = render(d, source);   // the block with the line and its carets
//   std::string json = to_json(d, source);  // the same object for programs
//
// Every code has its entry in codes.hpp, which `continuo explain E201` prints.
#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <continuo/language/text/source.hpp>

namespace continuo::model {

enum class Severity { error, warning, note };

/// A second place that belongs to the message: "first defined here".
struct Related {
  Span span;
  std::string label;
};

struct Diagnostic {
  std::string code;  // "E201"; looked up in codes.hpp
  Severity severity = Severity::error;
  Span span;                          // what the carets stand under
  std::string message;                // one short sentence without a full stop: what is wrong
  std::string label;                  // beside the carets: what stands there; may be empty
  std::string help;                   // the fix; may be empty
  std::vector<Related> related = {};  // shown below the line, in order
};

[[nodiscard]] Diagnostic error(std::string code, Span span, std::string message, std::string label = {},
                               std::string help = {});
[[nodiscard]] Diagnostic warning(std::string code, Span span, std::string message, std::string label = {},
                                 std::string help = {});

[[nodiscard]] bool has_errors(std::span<const Diagnostic> diagnostics);

/// In order of place; those at one place stay in order.
void sort_by_place(std::vector<Diagnostic>& diagnostics);

struct RenderOptions {
  bool color = false;           // ANSI colours, for a terminal
  std::size_t most_shown = 20;  // the rest is counted in a last line
};

/// One diagnostic as a block of lines that ends with a line end.
[[nodiscard]] std::string render(const Diagnostic& diagnostic, const Source& source, const RenderOptions& options = {});
/// All of them, an empty line between two, in order of place.
[[nodiscard]] std::string render(std::span<const Diagnostic> diagnostics, const Source& source,
                                 const RenderOptions& options = {});

/// {"code", "severity", "message", "label", "help", "file", "line", "column", "end_line", "end_column", "related"}.
[[nodiscard]] std::string to_json(const Diagnostic& diagnostic, const Source& source);
/// The array of them.
[[nodiscard]] std::string to_json(std::span<const Diagnostic> diagnostics, const Source& source);

}  // namespace continuo::model
