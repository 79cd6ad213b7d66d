// Messages as text: the excerpt of the source with its marks, label and help.
#include <algorithm>
#include <numeric>
#include <utility>

#include <fmt/format.h>

#include <continuo/language/text/diagnostic.hpp>
#include <continuo/language/text/unicode.hpp>

namespace continuo::model {

namespace {

struct Paint {
  std::string_view kind, frame, bold, end;
};

Paint paint_for(Severity severity, bool color) {
  if (!color) return {};
  constexpr std::string_view red = "\x1b[1;31m", yellow = "\x1b[1;33m", cyan = "\x1b[1;36m", blue = "\x1b[1;34m";
  const std::string_view kind = severity == Severity::error ? red : severity == Severity::warning ? yellow : cyan;
  return {kind, blue, "\x1b[1m", "\x1b[0m"};
}

std::string_view word(Severity severity) {
  switch (severity) {
    case Severity::error:
      return "error";
    case Severity::warning:
      return "warning";
    case Severity::note:
      break;
  }
  return "note";
}

/// The character as it is shown in one column: a tab as a blank, anything unprintable as U+FFFD.
std::string shown_as(std::string_view line, std::size_t at, CodePoint c) {
  if (c.value == '\t') return " ";
  if (c.size == 0 || c.value < 0x20 || (c.value >= 0x7F && c.value < 0xA0)) return "\xEF\xBF\xBD";
  return std::string(line.substr(at, c.size));
}

struct Excerpt {
  std::string line;
  std::size_t indent = 0;  // blanks before the carets
  std::size_t carets = 1;
};

/// The part of the line round columns [first, last) (from 0) that fits into a terminal. A line may be megabytes long.
Excerpt cut(std::string_view line, std::size_t first, std::size_t last) {
  constexpr std::size_t widest = 100, before = 40;
  std::size_t begin = 0;  // the column at which the excerpt begins
  if (first > before) {
    std::size_t columns = 0;
    for (std::size_t at = 0; at < line.size() && columns <= first + widest; ++columns)
      at += std::max<std::size_t>(decode(line, at).size, 1);
    if (columns > widest) begin = first - before;
  }
  std::size_t at = 0;
  for (std::size_t column = 0; column < begin; ++column) at += std::max<std::size_t>(decode(line, at).size, 1);
  Excerpt excerpt;
  if (begin > 0) excerpt.line = "...";
  std::size_t end = begin;
  excerpt.indent = first - begin + excerpt.line.size();
  for (; at < line.size() && end < begin + widest; ++end) {
    const CodePoint c = decode(line, at);
    excerpt.line += shown_as(line, at, c);
    at += std::max<std::size_t>(c.size, 1);
  }
  if (at < line.size()) excerpt.line += "...";
  excerpt.carets = std::max(std::min(last, end), first + 1) - first;
  return excerpt;
}

void append_line(std::string& out, const Source& source, Span span, std::string_view label, char mark,
                 std::size_t gutter, std::string_view frame, std::string_view accent, std::string_view end) {
  const Place begin = source.place(span.begin), stop = source.place(span.end);
  const std::string_view line = source.line(begin.line);
  const std::size_t first = static_cast<std::size_t>(begin.column - 1);
  const std::size_t last = begin.line == stop.line ? static_cast<std::size_t>(stop.column - 1) : line.size();
  const Excerpt excerpt = cut(line, first, last);
  out +=
      fmt::format("{}{:>{}} |{}{}{}\n", frame, begin.line, gutter, end, excerpt.line.empty() ? "" : " ", excerpt.line);
  out += fmt::format("{}{:>{}} |{} {:>{}}{}{}", frame, "", gutter, end, "", excerpt.indent, accent,
                     std::string(excerpt.carets, mark));
  if (!label.empty()) out += fmt::format(" {}", label);
  out += fmt::format("{}\n", end);
}

void append_help(std::string& out, std::string_view help, std::size_t gutter, const Paint& paint) {
  std::string_view head = "= help: ";
  for (std::size_t i = 0; i <= help.size();) {
    const std::size_t end = std::min(help.find('\n', i), help.size());
    out += fmt::format("{}{:>{}} {}{}{}\n", paint.frame, "", gutter, head, paint.end, help.substr(i, end - i));
    head = "        ";
    i = end + 1;
  }
}

std::size_t gutter_width(const Diagnostic& diagnostic, const Source& source) {
  int line = source.place(diagnostic.span.begin).line;
  for (const Related& related : diagnostic.related) line = std::max(line, source.place(related.span.begin).line);
  return std::max<std::size_t>(3, std::to_string(line).size());
}

std::vector<std::size_t> order_of_places(std::span<const Diagnostic> diagnostics) {
  std::vector<std::size_t> order(diagnostics.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::pair(diagnostics[a].span.begin, a) < std::pair(diagnostics[b].span.begin, b);
  });
  return order;
}

}  // namespace

Diagnostic error(std::string code, Span span, std::string message, std::string label, std::string help) {
  return {std::move(code), Severity::error, span, std::move(message), std::move(label), std::move(help)};
}

Diagnostic warning(std::string code, Span span, std::string message, std::string label, std::string help) {
  return {std::move(code), Severity::warning, span, std::move(message), std::move(label), std::move(help)};
}

bool has_errors(std::span<const Diagnostic> diagnostics) {
  return std::any_of(diagnostics.begin(), diagnostics.end(),
                     [](const Diagnostic& d) { return d.severity == Severity::error; });
}

void sort_by_place(std::vector<Diagnostic>& diagnostics) {
  std::vector<Diagnostic> sorted;
  sorted.reserve(diagnostics.size());
  for (const std::size_t i : order_of_places(diagnostics)) sorted.push_back(std::move(diagnostics[i]));
  diagnostics = std::move(sorted);
}

std::string render(const Diagnostic& diagnostic, const Source& source, const RenderOptions& options) {
  const Paint paint = paint_for(diagnostic.severity, options.color);
  const Place place = source.place(diagnostic.span.begin);
  const std::size_t gutter = gutter_width(diagnostic, source);
  std::string out = fmt::format("{}{}[{}]{}{}: {}{}\n", paint.kind, word(diagnostic.severity), diagnostic.code,
                                paint.end, paint.bold, diagnostic.message, paint.end);
  out += fmt::format("{} -->{} {}:{}:{}\n", paint.frame, paint.end, source.name(), place.line, place.column);
  append_line(out, source, diagnostic.span, diagnostic.label, '^', gutter, paint.frame, paint.kind, paint.end);
  for (const Related& related : diagnostic.related)
    append_line(out, source, related.span, related.label, '-', gutter, paint.frame, paint.frame, paint.end);
  if (!diagnostic.help.empty()) append_help(out, diagnostic.help, gutter, paint);
  return out;
}

std::string render(std::span<const Diagnostic> diagnostics, const Source& source, const RenderOptions& options) {
  const std::vector<std::size_t> order = order_of_places(diagnostics);
  std::string out;
  const std::size_t shown = std::min(order.size(), options.most_shown);
  for (std::size_t i = 0; i < shown; ++i) {
    if (i > 0) out += '\n';
    out += render(diagnostics[order[i]], source, options);
  }
  if (shown < order.size()) out += fmt::format("\n... and {} more\n", order.size() - shown);
  return out;
}

}  // namespace continuo::model
