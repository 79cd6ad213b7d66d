// A model and its sensitivities as a System and a source of events: what `solve` integrates. The state is x, then the
// columns of S. Internal to sensitivity.
#pragma once
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <continuo/model/model_events.hpp>
#include <continuo/model/model_system.hpp>
#include <continuo/studies/sensitive_program.hpp>

namespace continuo::studies::detail {

/// A tape of a SensitiveProgram with registers of its own.
class WideEvaluation {
 public:
  WideEvaluation(std::shared_ptr<const model::Tape> tape, const SensitiveProgram& program,
                 std::span<const double> variables);

  void operator()(double t, std::span<const double> wide, std::span<double> outputs);
  std::vector<double> operator()(double t, std::span<const double> wide);
  void set(std::uint32_t variable, double value);

 private:
  std::shared_ptr<const model::Tape> tape_;
  std::uint32_t states_, further_;
  std::size_t n_;
  std::vector<double> registers_;
};

class SensitiveSystem {
 public:
  using X = std::vector<double>;

  SensitiveSystem(std::shared_ptr<const SensitiveProgram> program, std::span<const double> variables);

  void operator()(double t, const X& x, X& dxdt) { rates_[mode()](t, x, dxdt); }
  std::size_t mode() const { return plain_.mode(); }
  const SensitiveProgram& program() const { return *program_; }
  model::ModelSystem& plain() { return plain_; }
  const model::ModelSystem& plain() const { return plain_; }
  /// The rates in any mode.
  void rates(std::size_t mode, double t, const X& x, X& dxdt) { rates_[mode](t, x, dxdt); }
  /// What is compiled of event i of the model, in the order of the text.
  std::vector<double> event(std::size_t i, double t, const X& x) { return events_[i](t, x); }
  /// An input that has stepped.
  void set(std::uint32_t variable, double value);
  std::span<const double> variables() const { return variables_; }

  std::string_view component_name(std::size_t i) const { return program_->name(i); }
  const SparsePattern& jacobian_pattern() { return program_->jacobians().pattern; }
  void jacobian_values(double t, const X& x, std::span<double> values);
  void jacobian(double t, const X& x, std::span<double> rows);
  void time_derivative(double t, const X& x, X& dfdt);
  bool has_mass() const { return plain_.has_mass(); }
  double mass(std::size_t i) const { return plain_.mass(i % program_->size()); }

 private:
  struct Jacobian {
    std::vector<WideEvaluation> by_state, by_time;
    std::vector<std::vector<std::size_t>> entry;  // by mode: where in the pattern each place is
  };
  Jacobian& derivatives();

  std::shared_ptr<const SensitiveProgram> program_;
  model::ModelSystem plain_;
  std::vector<double> variables_;
  std::vector<WideEvaluation> rates_, events_;
  std::optional<Jacobian> jacobian_;
};

/// An event as it happened.
struct SensitiveHappening {
  std::size_t event;  // of the model, in the order of the text
  double t;
  std::vector<double> time_moves{};  // dt/dp
};

class SensitiveEvents {
 public:
  using X = SensitiveSystem::X;

  SensitiveEvents(const SensitiveProgram& program, std::span<const double> variables, double from);

  std::size_t size() const { return plain_.size(); }
  std::string_view name(std::size_t i) const { return plain_.name(i); }
  Direction direction(std::size_t i) const { return plain_.direction(i); }
  bool is_guard(std::size_t i) const { return plain_.is_guard(i); }
  bool can_assign(std::size_t i) const { return plain_.can_assign(i); }
  bool is_condition(std::size_t i) const { return plain_.is_condition(i); }
  bool active(const SensitiveSystem& system, std::size_t i) const { return plain_.active(system.plain(), i); }
  double next_time(std::size_t i, double t, bool inclusive) const { return plain_.next_time(i, t, inclusive); }
  void guards(SensitiveSystem& system, double t, const X& x, std::span<double> values);
  EventResponse fire(SensitiveSystem& system, std::size_t fired, double t, const X& before, X& x);

  std::span<const SensitiveHappening> happened() const { return happened_; }
  bool is_declared(std::size_t i) const { return plain_.is_declared(i); }
  /// Why the motion has no derivative; empty where it has.
  const std::string& problem() const { return problem_; }

 private:
  struct Jump;
  bool set_off_by_jump(SensitiveSystem& system, std::size_t fired, double t, const X& before);
  std::vector<double> time_moves(std::size_t event, std::span<const double> values, double t,
                                 std::span<const double> rates);
  void perform(const std::vector<SensitiveAction>& actions, std::span<const double> values,
               std::span<const double> rates, std::span<const double> moves, Jump& jump) const;

  model::ModelEvents plain_;
  std::size_t inputs_, n_, count_;
  struct Schedule {
    double first = 0, period = 0;
    std::vector<double> first_moves{}, period_moves{};
  };
  std::vector<std::optional<Schedule>> schedules_;  // by event of the model
  const SensitiveProgram* program_;
  X x_;  // of the model alone
  std::vector<SensitiveHappening> happened_;
  bool last_changed_ = false;
  double last_t_;
  X last_before_, last_after_;
  std::vector<double> last_moves_;
  std::string problem_;
};

static_assert(EventSource<SensitiveEvents, SensitiveSystem, SensitiveSystem::X>);

}  // namespace continuo::studies::detail
