// continuo/language/check/names/report.cpp
// Messages are kept once per place and code, and sorted by place.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <continuo/language/check/names/report.hpp>

namespace continuo::model::detail {

namespace {
constexpr std::size_t longest_quote = 60;
constexpr std::size_t most_reported = 1000;
}  // namespace

std::string with_primes(std::string_view name, int primes) {
  return std::string(name) + std::string(static_cast<std::size_t>(std::max(primes, 0)), '\'');
}

std::string listed(const std::vector<std::string>& names) {
  constexpr std::size_t most = 5;
  std::string text;
  const std::size_t shown = names.size() > most + 1 ? most : names.size();
  for (std::size_t i = 0; i < shown; ++i) {
    if (i > 0) text += i + 1 == names.size() ? " and " : ", ";
    text += "`" + names[i] + "`";
  }
  if (shown < names.size()) text += fmt::format(" and {} more", names.size() - shown);
  return text;
}

std::string not_finite(double value) {
  return std::isnan(value) ? "this is not a number" : fmt::format("this is {}", value);
}

std::string unit_text(const Measured& measured) {
  if (!measured.is_known()) return "without unit";
  const std::string text = to_text(measured.unit);
  return text == "1" ? "a pure number" : text;
}

std::string unit_or_nothing(const Measured& measured) {
  return measured.is_known() ? to_text(measured.unit) : std::string();
}

Report Report::silent() const {
  Report other(source_, files_);
  other.silent_ = true;
  return other;
}

Diagnostic* Report::fail(const char* code, Span span, std::string message, std::string label, std::string help) {
  if (silent_) return nullptr;
  ++errors_;
  if (diagnostics_.size() >= most_reported || !reported_.insert({code, span.begin, span.end}).second) return nullptr;
  diagnostics_.push_back(error(code, span, std::move(message), std::move(label), std::move(help)));
  return &diagnostics_.back();
}

void Report::warn(const char* code, Span span, std::string message, std::string label, std::string help) {
  if (silent_ || !reported_.insert({code, span.begin, span.end}).second) return;
  diagnostics_.push_back(warning(code, span, std::move(message), std::move(label), std::move(help)));
}

std::vector<Diagnostic> Report::take() {
  std::ranges::sort(diagnostics_, {}, [](const Diagnostic& d) { return std::tie(d.span.begin, d.span.end, d.code); });
  return std::move(diagnostics_);
}

std::string Report::quote(Span span) const {
  std::string text;
  for (const char c : source_.slice(span)) {
    const bool space = c == ' ' || c == '\n' || c == '\t' || c == '\r';
    if (space && (text.empty() || text.back() == ' ')) continue;
    text += space ? ' ' : c;
  }
  if (text.size() > longest_quote) text = text.substr(0, longest_quote - 3) + "...";
  return "`" + text + "`";
}

}  // namespace continuo::model::detail
