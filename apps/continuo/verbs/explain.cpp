// continuo explain CODE: more about a message.
#include <memory>
#include <string>
#include <vector>

#include <apps/continuo/options/command_line.hpp>
#include <apps/continuo/options/verb_list.hpp>
#include <apps/continuo/terminal/answer.hpp>
#include <apps/continuo/terminal/terminal.hpp>
#include <apps/continuo/verbs.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <continuo/language/text/codes.hpp>
#include <continuo/symbolic/names/suggest.hpp>

namespace continuo::app {
namespace {

struct ExplainRequest {
  std::string code;
  bool json = false;
};

std::vector<model::Code> all_codes() {
  std::vector<model::Code> codes;
  for (const auto family : {model::syntax_codes(), model::check_codes(), model::numerical_codes()}) {
    codes.insert(codes.end(), family.begin(), family.end());
  }
  return codes;
}

void answer_with(const std::vector<model::Code>& codes) {
  auto list = nlohmann::ordered_json::array();
  for (const model::Code& code : codes)
    list.push_back({{"code", code.code}, {"title", code.title}, {"explanation", code.explanation}});
  answer("continuo.explain/1", {{"codes", list}});
}

ExitCode list(bool json) {
  if (json) {
    answer_with(all_codes());
  } else {
    for (const model::Code& code : all_codes()) print(fmt::format("{}  {}\n", code.code, code.title));
  }
  return done;
}

ExitCode explain(const std::string& wanted, bool json) {
  if (const model::Code* code = model::find_code(wanted)) {
    if (json) {
      answer_with({*code});
    } else {
      print(fmt::format("{}: {}\n\n{}\n", code->code, code->title, code->explanation));
    }
    return done;
  }
  std::vector<std::string_view> names;
  for (const model::Code& code : all_codes()) names.push_back(code.code);
  const std::string hint = model::did_you_mean(wanted, names);
  say(fmt::format("there is no message {}; {}", wanted, hint.empty() ? "`continuo explain` lists them" : hint));
  return usage;
}

}  // namespace

void add_explain(CLI::App& app, ExitCode& exit) {
  static constexpr std::string_view examples =
      "  continuo explain E201     its meaning, an example, a remedy\n"
      "  continuo explain          all codes\n";
  Verb* verb = add_verb(app, listed("explain"), examples, {});
  verb->json_examples = {"continuo explain E201 --json"};
  auto request = std::make_shared<ExplainRequest>();
  verb->add_option("code", request->code, "The code of the message, E201")->type_name("");
  verb->add_flag("--json", request->json, "The codes and their explanations as one JSON object");
  verb->callback(
      [&exit, request] { exit = request->code.empty() ? list(request->json) : explain(request->code, request->json); });
}

}  // namespace continuo::app
