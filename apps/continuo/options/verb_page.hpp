// apps/continuo/options/verb_page.hpp
// The pages of the reference about the command, as Markdown, from the declarations that the command itself is parsed
// by.
#pragma once
#include <string>
#include <string_view>

#include <apps/continuo/options/command_line.hpp>

namespace continuo::app {

/// Null where the command has no such verb.
const Verb* find_verb(const CLI::App& app, std::string_view name);

/// All verbs, each with a link to its page, and the exit codes.
std::string verbs_page(const CLI::App& app);

/// Synopsis, examples, arguments, options and exit codes of a verb. A comment `<!-- json: COMMAND -->` names each
/// command whose output shows the layout of --json; docs/site inserts the layout there.
std::string verb_page(const Verb& verb);

}  // namespace continuo::app
