// What people write on a blackboard or in another language, and what is written here instead: for the help of messages.
#pragma once
#include <optional>
#include <string>
#include <string_view>

#include <continuo/language/text/source.hpp>

namespace continuo::model {

/// "help: x' = -2*x": after a colon the line of the span with other text in its place, without the blanks around it and
/// without its comment. The help alone where the line is long.
[[nodiscard]] std::string with_corrected_line(std::string help, const Source& source, Span span,
                                              std::string_view instead);

/// A derivative by the time at the beginning of a text, dx/dt, d2x/dt2, d^2x/dt^2, d²x/dt²: `primed` is x''.
struct WrittenDerivative {
  std::string primed;
  std::size_t size;  // bytes of the text
};
[[nodiscard]] std::optional<WrittenDerivative> derivative_by_time(std::string_view text);

/// x' for a name that stands for a derivative: x_dot, xdot, xddot, dxdt, or a letter with one or two dots above it.
[[nodiscard]] std::optional<std::string> derivative_in_name(std::string_view name);

/// A number with commas around one of its bytes: the decimal sign of some languages, or the thousands of others. Empty
/// where there is none.
[[nodiscard]] std::string help_with_commas(const Source& source, std::uint32_t at);

/// What may be meant by the name behind a number without a sign between them: a unit, a power of ten, digits in groups.
[[nodiscard]] std::string help_after_number(const Source& source, Span number, std::string_view word);

}  // namespace continuo::model
