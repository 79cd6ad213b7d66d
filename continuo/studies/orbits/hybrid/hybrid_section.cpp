// Passes of a model's motion through a plane, with all that happens on the way.
#include <optional>

#include <continuo/studies/orbits/hybrid/section_passes.hpp>
#include <continuo/studies/periodic_orbit.hpp>
#include <continuo/studies/support/hybrid_run.hpp>

namespace continuo::studies {

Section poincare_section(const std::shared_ptr<const model::ModelProgram>& program, const model::Experiment& experiment,
                         std::size_t component, const SectionOptions& options) {
  Section section;
  model::Experiment exact = exactly(*program, experiment, options.rtol);
  exact.interrupt = options.interrupt;
  std::optional<model::Plan> plan = plan_of(*program, exact, section.outcome);
  if (!plan) return section;
  const double from = plan->from + options.settle, end = from + options.duration;
  plan->to = end;
  HybridRun run(program, *plan, exact);
  detail::SectionPasses passes(component, options.level, from, run.x(), section.points);
  run.on_stretch = [&](double begin, double to, const HybridRun::At& at) {
    passes.piece(begin, to, at);
    if (options.progress) options.progress(to - plan->from);
  };
  run.on_jump = [&](double t, const HybridRun::X& before, const HybridRun::X& after) { passes.jump(t, before, after); };
  static_cast<void>(run.advance_to(end));
  section.outcome = run.outcome();
  return section;
}

}  // namespace continuo::studies
