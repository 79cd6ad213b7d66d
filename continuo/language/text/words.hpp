// continuo/language/text/words.hpp
// The words of the language: what cannot be a name, and the functions that can be called.
#pragma once
#include <array>
#include <span>
#include <string_view>

namespace continuo::model {

/// Words that begin a statement.
[[nodiscard]] std::span<const std::string_view> statement_words();
/// Words that begin an action of an event.
[[nodiscard]] std::span<const std::string_view> action_words();

/// Words that cannot be names. `t` and `pi` are names with a meaning and not among them.
[[nodiscard]] bool is_reserved(std::string_view word);

/// `sin`, `max`, `interp`, ...: `sin(0) = 1` is an equation, `h(0) = 1` an initial value.
[[nodiscard]] bool is_function(std::string_view name);

/// `combine restitution minimum`: how the numbers of two surfaces become those of their contact.
inline constexpr std::array<std::string_view, 5> combinations{"average", "minimum", "maximum", "product",
                                                              "geometric_mean"};

/// `hinge door to frame`: the kinds of joints, by the words that begin them. A rope is a distance with an upper limit.
inline constexpr std::array<std::string_view, 10> joint_kinds{"hinge", "slider", "weld",      "ball", "distance",
                                                              "rope",  "wheel",  "universal", "gear", "pull"};

}  // namespace continuo::model
