// continuo/language/check/equations/equation_counts.cpp
// E230, E231, E233 and E234: too few equations, too many, or some that determine nothing.
#include <algorithm>

#include <fmt/format.h>

#include <continuo/language/check/equations/equation_counts.hpp>
#include <continuo/symbolic/names/suggest.hpp>

namespace continuo::model::detail {

std::vector<std::string> EquationCounts::highest_names(std::span<const std::uint32_t> bases) const {
  std::vector<std::string> names;
  for (const std::uint32_t base : bases)
    names.push_back(with_primes(declared_.bases[base].name, declared_.bases[base].order));
  return names;
}

void EquationCounts::report_empty_equation(ModeAtWork& work, std::size_t index,
                                           const std::vector<std::uint32_t>& variables) const {
  const EquationAtWork& equation = work.equations[index];
  const std::size_t mode = work.mode;
  for (const std::uint32_t variable : variables) {
    const std::size_t state = variable - layout_.states;
    if (variable < layout_.states || variable >= layout_.unknowns) continue;
    const std::size_t of = declared_.base_index_of_state(state);
    const Base& base = declared_.bases[of];
    if (declared_.has_modes() && state > base.first) {
      work.by[of] = index;  // said here: the mode lacks it
      report_.fail("E234", equation.span,
                   fmt::format("mode `{}` must define `{}` as the other modes do", declared_.modes[mode].name,
                               with_primes(base.name, base.order)),
                   fmt::format("this holds no `{}`", with_primes(base.name, base.order)),
                   fmt::format("write {} = ... here, and set {} in the event that leads into this mode",
                               with_primes(base.name, base.order),
                               with_primes(base.name, static_cast<int>(state - base.first))));
      return;
    }
  }
  report_.fail("E233", equation.span, "this equation determines nothing",
               "it holds neither a highest derivative nor an unknown",
               "to name an expression write let NAME = ...; for an algebraic variable declare unknown NAME = guess");
}

void EquationCounts::report_surplus(const ModeAtWork& work, const std::vector<std::size_t>& members,
                                    const std::vector<std::uint32_t>& open) const {
  const EquationAtWork& surplus = work.equations[members.back()];
  const std::vector<std::string> names = highest_names(work.held_by(surplus));
  const std::string where = declared_.has_modes() ? fmt::format(" in mode `{}`", declared_.modes[work.mode].name) : "";
  auto* said = report_.fail(
      "E231", surplus.span,
      fmt::format("{} {} one equation too many{}", listed(names), names.size() == 1 ? "has" : "have", where),
      "this one");
  if (!said) return;
  for (const std::uint32_t base : work.held_by(surplus)) {
    if (work.by[base] != npos) said->related.push_back({work.equations[work.by[base]].span, "determined here already"});
  }
  for (std::size_t i = 0; i + 1 < members.size() && !open.empty(); ++i) {
    said->related.push_back({work.equations[members[i]].span, "together with this"});
  }
}

void EquationCounts::report_missing(const ModeAtWork& work) const {
  const bool modes = declared_.has_modes();
  const std::string& mode = declared_.modes[work.mode].name;
  for (const auto& group : work.undetermined) {
    const std::vector<std::string> names = highest_names(group.open);
    report_.fail("E230", work.equations[group.members.front()].span,
                 fmt::format("{} need {} equations", listed(names), names.size()),
                 fmt::format("here {} {}", group.members.size() == 1 ? "is" : "are", group.members.size()));
  }
  for (std::uint32_t b = 0; b < declared_.bases.size(); ++b) {
    if (work.by[b] != npos) continue;
    const std::string name = with_primes(declared_.bases[b].name, declared_.bases[b].order);
    if (modes) {
      report_.fail(!declared_.bases[b].has_equation ? "E230" : "E234", declared_.modes[work.mode].span,
                   fmt::format("mode `{}` says nothing about `{}`", mode, name), "every mode defines the same states",
                   fmt::format("add {} = ... to this mode", name));
    } else {
      report_without_equation(b);
    }
  }
}

/// A name with an initial value only: often a slip of the pen.
void EquationCounts::report_without_equation(std::uint32_t index) const {
  const Base& base = declared_.bases[index];
  if (declared_.symbols.is_lost(base.family)) return;
  const std::string name = with_primes(base.name, base.order);
  if (declared_.bases[index].has_equation) {
    report_.fail("E230", base.span, fmt::format("there is no equation for `{}`", name), {},
                 fmt::format("add {} = ...", name));
    return;
  }
  std::vector<std::string> others;
  for (std::uint32_t i = 0; i < declared_.bases.size(); ++i) {
    if (declared_.bases[i].has_equation) others.push_back(declared_.bases[i].name);
  }
  const std::string near = did_you_mean(base.name, others);
  report_.fail("E230", base.span, fmt::format("`{}` has an initial value but no equation", base.name), {},
               near.empty() ? fmt::format("add {} = ...", name) : near);
}

}  // namespace continuo::model::detail
