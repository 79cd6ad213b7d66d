// continuo/language/check/equations/equation_counts.cpp
// As many equations as there are highest derivatives, each with something to say: the messages where that fails.
#include <algorithm>

#include <fmt/format.h>

#include <continuo/language/check/names/checker.hpp>
#include <continuo/symbolic/names/suggest.hpp>

namespace continuo::model::detail {

std::vector<std::string> Checker::highest_names(const std::vector<std::uint32_t>& bases) const {
  std::vector<std::string> names;
  for (const std::uint32_t base : bases) names.push_back(with_primes(bases_[base].name, bases_[base].order));
  return names;
}

void Checker::report_empty_equation(ModeAtWork& work, std::size_t index, const std::vector<std::uint32_t>& variables) {
  const EquationAtWork& equation = work.equations[index];
  const std::size_t mode = work.mode;
  for (const std::uint32_t variable : variables) {
    const std::size_t state = variable - model_.layout.states;
    if (variable < model_.layout.states || state >= model_.states.size()) continue;
    const std::size_t of = base_of_state(state);
    const Base& base = bases_[of];
    if (model_.modes.size() > 1 && model_.states[state].primes > 0) {
      work.by[of] = index;  // said here: the mode lacks it
      fail("E234", equation.span,
           fmt::format("mode `{}` must define `{}` as the other modes do", model_.modes[mode].name,
                       with_primes(base.name, base.order)),
           fmt::format("this holds no `{}`", with_primes(base.name, base.order)),
           fmt::format("write {} = ... here, and set {} in the event that leads into this mode",
                       with_primes(base.name, base.order), model_.states[state].column));
      return;
    }
  }
  fail("E233", equation.span, "this equation determines nothing",
       "it holds neither a highest derivative nor an unknown",
       "to name an expression write let NAME = ...; for an algebraic variable declare unknown NAME = guess");
}

void Checker::report_surplus(const ModeAtWork& work, const std::vector<std::size_t>& members,
                             const std::vector<std::uint32_t>& open) {
  const EquationAtWork& surplus = work.equations[members.back()];
  const std::vector<std::string> names = highest_names(surplus.holds);
  const std::string where = model_.modes.size() > 1 ? fmt::format(" in mode `{}`", model_.modes[work.mode].name) : "";
  auto* said =
      fail("E231", surplus.span,
           fmt::format("{} {} one equation too many{}", listed(names), names.size() == 1 ? "has" : "have", where),
           "this one");
  if (!said) return;
  for (const std::uint32_t base : surplus.holds) {
    if (work.by[base] != npos) said->related.push_back({work.equations[work.by[base]].span, "determined here already"});
  }
  for (std::size_t i = 0; i + 1 < members.size() && !open.empty(); ++i) {
    said->related.push_back({work.equations[members[i]].span, "together with this"});
  }
}

void Checker::report_missing(const ModeAtWork& work) {
  const bool modes = model_.modes.size() > 1;
  const std::string& mode = model_.modes[work.mode].name;
  for (const auto& group : work.undetermined) {
    const std::vector<std::string> names = highest_names(group.open);
    fail("E230", work.equations[group.members.front()].span,
         fmt::format("{} need {} equations", listed(names), names.size()),
         fmt::format("here {} {}", group.members.size() == 1 ? "is" : "are", group.members.size()));
  }
  for (std::uint32_t b = 0; b < bases_.size(); ++b) {
    if (work.by[b] != npos) continue;
    const std::string name = with_primes(bases_[b].name, bases_[b].order);
    if (modes) {
      fail(without_equation_.contains(b) ? "E230" : "E234", model_.modes[work.mode].span,
           fmt::format("mode `{}` says nothing about `{}`", mode, name), "every mode defines the same states",
           fmt::format("add {} = ... to this mode", name));
    } else {
      report_without_equation(b);
    }
  }
}

/// A name with an initial value only: often a slip of the pen.
void Checker::report_without_equation(std::uint32_t index) {
  const Base& base = bases_[index];
  if (lost_.contains(base.family)) return;
  const std::string name = with_primes(base.name, base.order);
  if (!without_equation_.contains(index)) {
    fail("E230", base.span, fmt::format("there is no equation for `{}`", name), {}, fmt::format("add {} = ...", name));
    return;
  }
  std::vector<std::string> others;
  for (std::uint32_t i = 0; i < bases_.size(); ++i) {
    if (!without_equation_.contains(i)) others.push_back(bases_[i].name);
  }
  const std::string near = did_you_mean(base.name, others);
  fail("E230", base.span, fmt::format("`{}` has an initial value but no equation", base.name), {},
       near.empty() ? fmt::format("add {} = ...", name) : near);
}

}  // namespace continuo::model::detail
