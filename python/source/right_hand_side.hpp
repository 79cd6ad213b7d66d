// The equations of a model as functions of C, for the solvers: dx/dt = f(t, x), and df/dx row by row.
//
//   const RightHandSide f(load_equations(text, "lorenz.sim", NativeUse::automatic));
//   solve with RightHandSide::derivative and &f, from any number of threads at once
//
// The numbers of the parameters are fixed when it is made; another set of them is another RightHandSide, which shares
// the tapes and the machine code.
#pragma once
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include <continuo/numerics/sparse_pattern.hpp>
#include <continuo/simulation/native.hpp>
#include <continuo/simulation/program/evaluation.hpp>
#include <continuo/simulation/program/model_system.hpp>

namespace continuo::python {

/// Initial values that the text does not state are zero. A text that gives no right-hand side throws
/// std::invalid_argument with the messages, as the command shows them.
[[nodiscard]] std::shared_ptr<const model::ModelProgram> load_equations(const std::string& text,
                                                                        const std::string& path, model::NativeUse use);

class RightHandSide {
 public:
  /// Parameters and inputs by name; unknown names throw std::invalid_argument.
  RightHandSide(std::shared_ptr<const model::ModelProgram> program, const model::Overrides& parameters);

  [[nodiscard]] std::size_t size() const { return program_->model.states.size(); }
  [[nodiscard]] const model::Model& model() const { return program_->model; }
  [[nodiscard]] const std::shared_ptr<const model::ModelProgram>& program() const { return program_; }
  /// The flat variables: the value of each parameter is at its `variable`.
  [[nodiscard]] const std::vector<double>& variables() const { return variables_; }

  void evaluate(double t, const double* x, double* dxdt) const;
  void jacobian(double t, const double* x, double* rows) const;
  /// Where df/dx may differ from zero, whatever the parameters. The first call differentiates the equations.
  [[nodiscard]] SparsePattern jacobian_pattern() const;
  /// The entries of df/dx in the order of the pattern.
  void jacobian_values(double t, const double* x, double* values) const;

  /// The same for those who call through pointers; `user` is the RightHandSide. Out of memory, the result is NaN.
  static void derivative(double t, const double* x, double* dxdt, void* user) noexcept;
  static void jacobian_rows(double t, const double* x, double* rows, void* user) noexcept;
  static void jacobian_entries(double t, const double* x, double* values, void* user) noexcept;

 private:
  /// What one thread computes with.
  struct Workspace {
    model::Evaluation derivatives;
    std::unique_ptr<model::ModelSystem> system;  // of the Jacobian, once it is wanted
    std::vector<double> x;
  };
  [[nodiscard]] Workspace& workspace() const;
  [[nodiscard]] Workspace& workspace_of_thread() const;
  [[nodiscard]] model::ModelSystem& differentiated(Workspace& mine) const;

  std::shared_ptr<const model::ModelProgram> program_;
  std::vector<double> variables_;
  std::uint64_t number_;  // of all that were ever made: by it a thread knows its workspace again
  mutable std::mutex mutex_;
  mutable std::map<std::thread::id, std::unique_ptr<Workspace>> workspaces_;
  mutable std::unique_ptr<model::ModelSystem> differentiated_;  // copied by each workspace
};

}  // namespace continuo::python
