// continuo/language/check/names/report.hpp
// Where all passes put their messages, and the words that these share.
#pragma once
#include <cstdint>
#include <set>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include <continuo/language/check/names/file_reach.hpp>
#include <continuo/language/text/diagnostic.hpp>
#include <continuo/language/text/source.hpp>
#include <continuo/symbolic/units/unit_check.hpp>

namespace continuo::model::detail {

/// Keeps one message per place and code: the members of a family share their text.
class Report {
 public:
  explicit Report(const Source& source, FileReach files = FileReach::anywhere) : source_(source), files_(files) {}
  /// Drops every message: for trying what may have been meant.
  [[nodiscard]] Report silent() const;
  [[nodiscard]] bool is_silent() const { return silent_; }

  /// Null where it was said already.
  Diagnostic* fail(const char* code, Span span, std::string message, std::string label = {}, std::string help = {});
  void warn(const char* code, Span span, std::string message, std::string label = {}, std::string help = {});
  [[nodiscard]] bool was_reported(const char* code, Span span) const {
    return reported_.contains({code, span.begin, span.end});
  }
  /// How often something was wrong, repetitions included.
  [[nodiscard]] std::size_t errors() const { return errors_; }
  /// In order of place; empties the report.
  [[nodiscard]] std::vector<Diagnostic> take();

  [[nodiscard]] std::string_view slice(Span span) const { return source_.slice(span); }
  [[nodiscard]] std::string quote(Span span) const;  // `text`, cut off where it is long
  [[nodiscard]] const Source& source() const { return source_; }
  /// Which files the text may have read, and messages quote.
  [[nodiscard]] FileReach files() const { return files_; }

 private:
  const Source& source_;
  FileReach files_;
  bool silent_ = false;
  std::vector<Diagnostic> diagnostics_{};
  std::set<std::tuple<std::string, std::uint32_t, std::uint32_t>> reported_{};
  std::size_t errors_ = 0;
};

/// "x''".
[[nodiscard]] std::string with_primes(std::string_view name, int primes);
/// `a`, `b` and `c`; after five: and 7 more.
[[nodiscard]] std::string listed(const std::vector<std::string>& names);
/// "this is inf".
[[nodiscard]] std::string not_finite(double value);
/// "m/s", "a pure number", "without unit".
[[nodiscard]] std::string unit_text(const Measured& measured);
/// "m/s", empty where no unit is known: as a model keeps it.
[[nodiscard]] std::string unit_or_nothing(const Measured& measured);

}  // namespace continuo::model::detail
