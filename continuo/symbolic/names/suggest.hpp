// continuo/symbolic/names/suggest.hpp
// "Did you mean": the known word nearest to a wrong one.
//
//   suggest("temprature", {"temperature", "pressure"});    // "temperature"
//   did_you_mean("temprature", names);                     // "did you mean `temperature`?", or "" where none is near
#pragma once
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace continuo::model {

/// Insertions, deletions, replacements and swaps of neighbours that make `b` of `a` (Damerau and Levenshtein,
/// the restricted form); letters of another case count as equal only for the ranking in `suggest`.
[[nodiscard]] std::size_t edit_distance(std::string_view a, std::string_view b);

/// The nearest candidate within a third of the word's length, but at least one edit; the first of equals.
[[nodiscard]] std::optional<std::string> suggest(std::string_view word, std::span<const std::string> candidates);
[[nodiscard]] std::optional<std::string> suggest(std::string_view word, std::span<const std::string_view> candidates);

/// The same as a line of help.
[[nodiscard]] std::string did_you_mean(std::string_view word, std::span<const std::string> candidates);
[[nodiscard]] std::string did_you_mean(std::string_view word, std::span<const std::string_view> candidates);

}  // namespace continuo::model
