// The search for the nearest known word by edit distance.
#include <algorithm>
#include <cctype>
#include <string>
#include <vector>

#include <continuo/symbolic/names/suggest.hpp>

namespace continuo::model {

namespace {

std::string lower(std::string_view text) {
  std::string result(text);
  std::transform(result.begin(), result.end(), result.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return result;
}

template <class Texts>
std::optional<std::string> nearest(std::string_view word, const Texts& candidates) {
  constexpr std::size_t longest_word = 64;  // beyond it nobody mistyped one of our names
  if (word.empty() || word.size() > longest_word) return std::nullopt;
  const std::string wanted = lower(word);
  std::optional<std::string> best;
  std::size_t best_distance = std::max<std::size_t>(1, word.size() / 3) + 1;
  for (std::string_view candidate : candidates) {
    if (candidate == word || candidate.empty()) continue;
    if (candidate.size() > word.size() + best_distance) continue;
    // A single letter is no misspelling of another one: `x` for `y` would be a guess.
    if (word.size() == 1 && lower(candidate) != wanted) continue;
    const std::size_t distance = edit_distance(wanted, lower(candidate));
    if (distance < best_distance && distance < candidate.size()) {
      best_distance = distance;
      best = std::string(candidate);
    }
  }
  return best;
}

template <class Texts>
std::string as_help(std::string_view word, const Texts& candidates) {
  const auto found = nearest(word, candidates);
  return found ? "did you mean `" + *found + "`?" : std::string{};
}

}  // namespace

std::size_t edit_distance(std::string_view a, std::string_view b) {
  // Three rows of the dynamic programme: two before, before, this one.
  std::vector<std::size_t> two_before(b.size() + 1), before(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    two_before.swap(before);
    before.swap(row);
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = before[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      row[j] = std::min({before[j] + 1, row[j - 1] + 1, replaced});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        row[j] = std::min(row[j], two_before[j - 2] + 1);
    }
  }
  return row[b.size()];
}

std::optional<std::string> suggest(std::string_view word, std::span<const std::string> candidates) {
  return nearest(word, candidates);
}
std::optional<std::string> suggest(std::string_view word, std::span<const std::string_view> candidates) {
  return nearest(word, candidates);
}
std::string did_you_mean(std::string_view word, std::span<const std::string> candidates) {
  return as_help(word, candidates);
}
std::string did_you_mean(std::string_view word, std::span<const std::string_view> candidates) {
  return as_help(word, candidates);
}

}  // namespace continuo::model
