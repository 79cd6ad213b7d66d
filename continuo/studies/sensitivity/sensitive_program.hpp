// A model with its sensitivities S = dx/dp as further components: every derivative that a run of them needs, exact, by
// the model's graph, compiled once. Internal to sensitivity.
//
// Between events S' = df/dx S + df/dp. At an event at time tau(p), where x jumps from x- to A(t, x-, p) and f from f-
// to f+, differentiating x+(tau(p), p) = A(tau(p), x-(tau(p), p), p) gives
//
//   S+ = dA/dx (S- + f- tau') + dA/dt tau' + dA/dp - f+ tau'
//
// and g(tau, x-(tau, p), p) = 0 gives tau' = -(dg/dx S- + dg/dp) / (dg/dx f- + dg/dt). I. A. Hiskens, M. A. Pai,
// "Trajectory sensitivity analysis of hybrid systems", IEEE Trans. Circuits Syst. I 47 (2000), eq. 34-41. The same
// holds at a surface z(t, x, p) = 0 where the equations jump, with A = x and g = z.
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <continuo/numerics/sparse_pattern.hpp>
#include <continuo/simulation/program/model_program.hpp>
#include <continuo/studies/sensitivity/influence.hpp>
#include <continuo/symbolic/graph/derivative.hpp>

namespace continuo::studies::detail {

/// Where the outputs of a tape hold an expression v of t, x and the parameters: its value, dv/dx S + dv/dp for each
/// influence, dv/dt, and the dv/dx that are not zero everywhere.
struct Variation {
  std::size_t value, along, by_time, by_state;
  std::vector<std::uint32_t> states;  // which ones by_state, by_state + 1, ... are of
};

/// An action that moves the state. The mode is the model's own run's.
struct SensitiveAction {
  enum class Kind { assign, branch };
  Kind kind = Kind::assign;
  Variation value{};          // of assign
  std::size_t condition = 0;  // of branch: an output
  std::size_t target = 0;     // of assign: the state
  std::vector<SensitiveAction> then{}, otherwise{};
};

/// An event of the model, in the order of its text.
struct SensitiveEvent {
  std::shared_ptr<const model::Tape> tape;  // of everything below
  std::optional<Variation> guard{};
  std::vector<SensitiveAction> actions{};
  /// A scheduled time is first + k period: the derivatives of both by each influence.
  std::vector<model::NodeId> first{}, period{};
};

/// Of one mode, the surfaces where its equations jump or bend, by switch (simulation/program/switches.hpp).
struct SensitiveSurfaces {
  std::shared_ptr<const model::Tape> tape;
  std::vector<Variation> surface;
  /// How fast the motion goes towards the upper side of each, a = dz/dt + dz/dx f, then da/dx S + da/dp by influence.
  std::shared_ptr<const model::Tape> approach;
};

class SensitiveProgram {
 public:
  /// `overrides`: parameters that follow from no other, whatever the text says.
  SensitiveProgram(std::shared_ptr<const model::ModelProgram> program, std::vector<Influence> influences,
                   const model::Overrides& overrides, bool start_is_given);

  [[nodiscard]] const model::ModelProgram& program() const { return *program_; }
  [[nodiscard]] const std::shared_ptr<const model::ModelProgram>& shared_program() const { return program_; }
  [[nodiscard]] const std::vector<Influence>& influences() const { return influences_; }
  [[nodiscard]] std::size_t size() const { return n_; }
  [[nodiscard]] std::size_t count() const { return influences_.size(); }
  /// The component of the wide state that is d x[i] / d influence k.
  [[nodiscard]] std::size_t place(std::size_t i, std::size_t k) const { return n_ * (1 + k) + i; }
  /// "d x / d k"
  [[nodiscard]] const std::string& name(std::size_t component) const { return names_[component]; }

  /// x' and S' of a mode, with its switches held.
  [[nodiscard]] const std::shared_ptr<const model::Tape>& rates(std::size_t mode) const { return rates_[mode]; }
  [[nodiscard]] const SensitiveSurfaces& surfaces(std::size_t mode) const { return surfaces_[mode]; }
  [[nodiscard]] const std::vector<SensitiveEvent>& events() const { return events_; }
  /// Where the registers of S begin in the flat space of these tapes: behind those of the switches.
  [[nodiscard]] std::uint32_t registers_of_s() const {
    return program_->model.layout.size + program_->switch_variables;
  }

  /// Entries of d(x', S')/d(x, S) in every mode, and of d(x', S')/dt.
  struct Entries {
    std::vector<MatrixPlace> places;
    std::shared_ptr<const model::Tape> tape;
  };
  struct Jacobians {
    SparsePattern pattern;
    std::vector<Entries> by_state, by_time;  // by mode
  };
  /// Made at the first call: only stiff methods ask.
  [[nodiscard]] const Jacobians& jacobians() const;

  /// S at the start, where the model has one; `rates` is x' there.
  [[nodiscard]] std::vector<double> start(const std::vector<double>& variables, const std::vector<double>& rates) const;
  /// A tape of each quantity q of the model and dq/dx S + dq/dp by every influence, one after the other.
  [[nodiscard]] std::shared_ptr<const model::Tape> along(const std::vector<model::NodeId>& quantities) const;
  /// A tape of one quantity q, dq/dx S + dq/dp by every influence, then dq/dv of each of these variables.
  [[nodiscard]] std::shared_ptr<const model::Tape> along(model::NodeId quantity,
                                                         std::span<const std::uint32_t> by) const;
  /// d/dp by every influence of a number that depends on parameters alone.
  [[nodiscard]] std::vector<double> moves_of(model::NodeId constant, const std::vector<double>& variables) const;
  /// Numbers that depend on parameters alone.
  [[nodiscard]] std::vector<double> evaluate(const std::vector<model::NodeId>& nodes,
                                             const std::vector<double>& variables) const;

 private:
  void differentiate_parameters(const model::Overrides& overrides);
  [[nodiscard]] model::NodeId by_parameters(model::Graph& graph, model::NodeId node, std::size_t k) const;
  [[nodiscard]] model::NodeId variation(model::Graph& graph, model::NodeId node, std::size_t k) const;
  [[nodiscard]] Variation variation_of(model::NodeId node, std::vector<model::NodeId>& outputs);
  [[nodiscard]] std::vector<SensitiveAction> actions_of(const model::Block& block, std::vector<model::NodeId>& outputs);
  void add_equations();
  void add_start();
  [[nodiscard]] SensitiveSurfaces surfaces_of(const model::SwitchedEquations& equations);
  void add_events();

  std::shared_ptr<const model::ModelProgram> program_;
  std::vector<Influence> influences_;
  std::size_t n_;
  model::ModelProgram own_;  // with the graph in which the derivatives are nodes, and registers for S
  std::vector<std::string> names_;
  std::vector<std::vector<std::pair<std::uint32_t, model::NodeId>>>
      parameters_;  // d parameter / d influence, by influence
  std::vector<model::NodeId> start_, start_time_;
  std::vector<std::vector<model::NodeId>> rate_nodes_;
  std::vector<std::shared_ptr<const model::Tape>> rates_;
  std::vector<SensitiveSurfaces> surfaces_;
  std::vector<SensitiveEvent> events_;
  mutable std::unique_ptr<Jacobians> jacobians_;
};

}  // namespace continuo::studies::detail
