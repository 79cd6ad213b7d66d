// The manual pages of the command, for man, from the declarations that the command itself is parsed by.
#pragma once
#include <string>
#include <string_view>

#include <apps/continuo/options/verb_facts.hpp>

namespace continuo::app {

/// continuo.1: all verbs, the exit codes.
std::string manual_of(const CLI::App& app, std::string_view version);

/// continuo-VERB.1: synopsis, examples, arguments, options, exit codes.
std::string manual_of(const VerbFacts& facts, std::string_view version);

}  // namespace continuo::app
