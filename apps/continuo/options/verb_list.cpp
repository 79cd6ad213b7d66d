// Decides which program of the command has the verb of a command line.
#include <algorithm>
#include <cstddef>
#include <span>
#include <string_view>

#include <apps/continuo/options/verb_list.hpp>

namespace continuo::app {
namespace {

const ListedVerb* verb_called(std::string_view word) {
  for (const ListedVerb& verb : all_verbs)
    if (verb.name == word) return &verb;
  return nullptr;
}

}  // namespace

Program program_for(int argc, char** argv) {
  const auto words = std::span(argv, static_cast<std::size_t>(argc)).subspan(argc > 0 ? 1 : 0);
  const auto verb = std::ranges::find_if(words, [](const char* word) { return verb_called(word) != nullptr; });
  if (verb == words.end()) return Program::command;
  const auto any_behind = [&](auto is_wanted) {
    return std::any_of(verb + 1, words.end(), is_wanted) ? Program::studies : Program::command;
  };
  const std::string_view name = *verb;
  if (name == "help") {
    return any_behind([](const char* word) {
      const ListedVerb* other = verb_called(word);
      return other != nullptr && other->program == Program::studies;
    });
  }
  if (name == "run") {
    return any_behind([](const char* word) {
      return std::string_view(word).starts_with("--family") || std::string_view(word).starts_with("--sweep-run");
    });
  }
  return verb_called(name)->program;
}

}  // namespace continuo::app
