// What may follow on a command line that is being typed: for the completion of shells (completions/).
#pragma once
#include <span>
#include <string>
#include <vector>

#include <CLI/App.hpp>

namespace continuo::app {

/// The first word by which a shell asks: `continuo --complete run spring.sim --me`. The last word is the one that is
/// being typed, and may be empty.
inline constexpr std::string_view completion_request = "--complete";

/// Words that may stand in its place: verbs, options, methods, codes; parameters, states and modes of the model that is
/// named before. A line `:files` asks the shell for names of files, `:files .sim` for models and folders.
std::vector<std::string> completions(const CLI::App& app, std::span<char* const> words);

}  // namespace continuo::app
