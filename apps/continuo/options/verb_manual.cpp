// Writes the declarations of the command and its verbs as pages of troff, with the macros of man(7).
#include <algorithm>
#include <cctype>
#include <span>
#include <vector>

#include <apps/continuo/options/verb_manual.hpp>
#include <fmt/format.h>

namespace continuo::app {
namespace {

/// Text as it is: no dash becomes a hyphen, and no line begins with what troff takes for a request.
std::string plain(std::string_view text) {
  std::string escaped;
  bool line_begins = true;
  for (const char c : text) {
    if (line_begins && (c == '.' || c == '\'')) escaped += "\\&";
    line_begins = c == '\n';
    if (c == '\\')
      escaped += "\\e";
    else if (c == '-')
      escaped += "\\-";
    else if (c == '\'')
      escaped += "\\(aq";
    else if (c == '`')
      escaped += "\\(ga";
    else if (c == '^')
      escaped += "\\(ha";
    else if (c == '~')
      escaped += "\\(ti";
    else
      escaped += c;
  }
  return escaped;
}

std::string capitals(std::string text) {
  std::ranges::transform(text, text.begin(),
                         [](char c) { return static_cast<char>(std::toupper(static_cast<unsigned char>(c))); });
  return text;
}

std::string head_of(const std::string& page, std::string_view purpose, std::string_view version) {
  return fmt::format(".TH {} 1 \"\" \"continuo {}\" \"Continuo\"\n.SH NAME\n{} \\- {}\n", capitals(plain(page)),
                     version, plain(page), plain(purpose));
}

std::string code_block(std::string_view text) {
  return fmt::format(".nf\n{}.fi\n", plain(text));
}

std::string bold(const std::vector<std::string>& names) {
  std::vector<std::string> each;
  for (const std::string& name : names) each.push_back(fmt::format("\\fB{}\\fR", plain(name)));
  return fmt::format("{}", fmt::join(each, ", "));
}

std::string entry_of(const OptionFacts& option) {
  std::string text =
      fmt::format(".TP\n{}{}\n{}.", bold(option.names),
                  option.value.empty() ? "" : fmt::format(" \\fI{}\\fR", plain(option.value)), plain(option.meaning));
  if (option.required) text += " Required.";
  if (option.repeated) text += " May be repeated.";
  if (!option.needs.empty()) text += fmt::format(" Needs {}.", bold(option.needs));
  if (!option.excludes.empty()) text += fmt::format(" Not together with {}.", bold(option.excludes));
  return text + "\n";
}

std::string section_of(std::string_view heading, const std::vector<OptionFacts>& options) {
  if (options.empty()) return {};
  std::string text = fmt::format(".SH {}\n", heading);
  for (const OptionFacts& option : options) text += entry_of(option);
  return text;
}

std::string section_of(std::span<const ExitCode> codes) {
  std::string text = ".SH EXIT STATUS\n";
  for (const ExitCode code : codes)
    text += fmt::format(".TP\n\\fB{}\\fR\n{}\n", static_cast<int>(code), plain(meaning(code)));
  return text;
}

}  // namespace

std::string manual_of(const CLI::App& app, std::string_view version) {
  std::string text = head_of("continuo", "simulates continuous systems", version);
  text += fmt::format(".SH SYNOPSIS\n\\fBcontinuo\\fR \\fIverb\\fR [arguments] [options]\n.SH DESCRIPTION\n{}\n.PP\n",
                      plain(app.get_description()));
  text +=
      "Data go to standard output, messages to standard error. With \\fB\\-\\-json\\fR, every verb prints one object "
      "on standard output, whatever happens. A model, a table or a recording is read from standard input where its "
      "name is \\fB\\-\\fR.\n.SH VERBS\n";
  for (const CLI::App* verb : app.get_subcommands([](const CLI::App*) { return true; }))
    text += fmt::format(".TP\n\\fB{}\\fR\n{}. See \\fBcontinuo\\-{}\\fR(1).\n", plain(verb->get_name()),
                        plain(verb->get_description()), plain(verb->get_name()));
  return text + section_of(all_exit_codes());
}

std::string manual_of(const VerbFacts& facts, std::string_view version) {
  return head_of("continuo-" + facts.name, facts.purpose, version) +
         fmt::format(".SH SYNOPSIS\n\\fB{}\\fR\n.SH EXAMPLES\n", plain(facts.synopsis)) + code_block(facts.examples) +
         section_of("ARGUMENTS", facts.arguments) + section_of("OPTIONS", facts.options) +
         section_of(facts.exit_codes) + ".SH SEE ALSO\n\\fBcontinuo\\fR(1)\n";
}

}  // namespace continuo::app
