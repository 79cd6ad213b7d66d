// Finds parameters and states by their names on the command line, and refuses unsuitable options.
#include <algorithm>

#include <apps/continuo/studies/influences.hpp>
#include <apps/continuo/terminal/terminal.hpp>
#include <fmt/format.h>

#include <continuo/runs/kind.hpp>
#include <continuo/symbolic/names/suggest.hpp>

namespace continuo::app {

void refuse_methods(CLI::App& verb) {
  const std::string why = verb.get_name() +
                          " integrates derivatives along with the motion and chooses the method and the steps itself; "
                          "--tol says how exact";
  refuse_option(verb, "--method", why);
  refuse_option(verb, "--step", why);
}

void say_step_has_no_part(const Prepared& prepared) {
  const model::RunSettings& run = prepared.program->model.run;
  if (run.step && runs::kind_of(prepared.program->model).has_exact_derivatives)
    say(
        fmt::format("{}: a fixed step is not possible here: derivatives are integrated together with the motion, in "
                    "steps chosen for both",
                    place_text(prepared, run.span)));
}

std::string no_such(const std::string& kind, const std::string& name, const std::vector<std::string>& names) {
  if (std::ranges::all_of(names, &std::string::empty))
    return fmt::format("there is no {} `{}`, and no other", kind, name);
  const std::string near = model::did_you_mean(name, names);
  return fmt::format("there is no {} `{}`; {}", kind, name,
                     near.empty() ? fmt::format("there are {}", fmt::join(names, ", ")) : near);
}

std::optional<std::vector<studies::Influence>> influences_named(const model::Model& model,
                                                                const std::vector<std::string>& parameters,
                                                                const std::vector<std::string>& initial) {
  using Kind = studies::Influence::Kind;
  std::vector<studies::Influence> influences;
  const auto add = [&](Kind kind, const std::string& name) {
    const bool is_parameter = kind == Kind::parameter;
    const std::size_t i = is_parameter ? model::find_parameter(model, name) : model::find_state(model, name);
    if (i != model::npos) {
      const bool is_new = std::ranges::none_of(
          influences, [&](const studies::Influence& one) { return one.kind == kind && one.index == i; });
      if (is_new) influences.push_back({kind, i});
      if (!is_new) say(fmt::format("`{}` is named twice", name_of(model, studies::Influence{kind, i})));
      return is_new;
    }
    std::vector<std::string> names;
    for (const model::Parameter& known : model.parameters)
      if (is_parameter) names.push_back(known.name);
    for (const model::State& known : model.states)
      if (!is_parameter) names.push_back(known.column);
    say(no_such(is_parameter ? "parameter" : "state", name, names));
    return false;
  };
  for (const std::string& name : parameters)
    if (!add(Kind::parameter, name)) return std::nullopt;
  for (const std::string& name : initial)
    if (!add(Kind::initial, name)) return std::nullopt;
  if (!influences.empty()) return influences;
  say("name parameters by --param k,c or states by --initial x; `continuo info FILE` lists them");
  return std::nullopt;
}

}  // namespace continuo::app
