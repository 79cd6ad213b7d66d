// continuo/symbolic/tape/tape.hpp
// Expressions compiled to a list of instructions on numbered registers, which evaluates at once on any machine:
//
//   const Tape tape(graph, derivatives, {.variables = 5, .steady_begin = 4, .steady_end = 5});  // t, x, x', k | m
//   std::vector<double> registers(tape.register_count()), rates(2);
//   ... registers[0..5) = t, the state, the parameters ...
//   tape.prepare<double>(registers);             // after parameters have changed
//   tape.evaluate<double>(registers, rates);     // after t or the state have changed
//
// The registers belong to the caller: a tape is constant and serves any number of threads. Real may be float, double,
// long double, and with tape_run.hpp lanes of them or a type that carries derivatives.
//
// How it is fast: what depends on parameters alone is computed by `prepare` (a division by a parameter becomes a
// multiplication by its reciprocal); a product and the sum it goes into are one instruction; equal operations that
// do not wait for each other are one loop over neighbouring registers, a grid's inner points without their ends; a
// family whose members lie apart (u[1], v[1], u[2], v[2], ...) is first copied to where they are neighbours.
#pragma once
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include <continuo/symbolic/graph/expression.hpp>
#include <continuo/symbolic/graph/table.hpp>
#include <continuo/symbolic/tape/tape_code.hpp>
#include <continuo/symbolic/tape/tape_copy.hpp>

namespace continuo::model {

/// The flat space of variables that a register file begins with.
struct TapeVariables {
  std::uint32_t variables = 0;  // how many
  // Those that change seldom, [begin, end): the parameters. `prepare` must follow each change of theirs.
  std::uint32_t steady_begin = 0, steady_end = 0;
  // Those that a caller may hand over at another place, [begin, end): see `evaluate`.
  std::uint32_t states_begin = 0, states_end = 0;
  // By variable, for as many as there are: members of one family, ascending, have the same number; 0 is alone. They
  // need not lie side by side.
  std::span<const std::uint32_t> families = {};
};

/// Machine code of Tape::evaluate: the registers, the states, the outputs.
using NativeEvaluation = void (*)(double* registers, const double* states, double* outputs);

class Tape {
 public:
  Tape() = default;
  Tape(const Graph& graph, std::span<const NodeId> outputs, TapeVariables variables,
       std::span<const Table> tables = {});

  [[nodiscard]] std::size_t register_count() const { return registers_; }
  [[nodiscard]] std::size_t output_count() const { return output_count_; }

  /// Constants, and what depends on them and on the steady variables alone.
  template <class Real>
  void prepare(std::span<Real> registers) const;

  /// outputs[i] = the i-th expression.
  template <class Real>
  void evaluate(std::span<Real> registers, std::span<Real> outputs) const;

  /// The same with `states` in place of the registers of the states, which it may leave as they are.
  template <class Real>
  void evaluate(std::span<Real> registers, std::span<const Real> states, std::span<Real> outputs) const;
  /// And with output k at places[k], where `copies` = outputs_at(places); nothing else is written.
  template <class Real>
  void evaluate(std::span<Real> registers, std::span<const Real> states, std::span<Real> outputs,
                const tape::Copies& copies) const;
  [[nodiscard]] tape::Copies outputs_at(std::span<const std::uint32_t> places) const;

  /// How the work is laid out: for tests and for the curious.
  struct Size {
    std::size_t prepared = 0;  // instructions of `prepare`
    std::size_t single = 0;    // instructions of `evaluate` on one register each
    std::size_t batches = 0;   // its loops
    std::size_t batched = 0;   // results of those loops
    std::size_t gathered = 0;  // operands of those that do not lie side by side
  };
  [[nodiscard]] Size size() const;
  [[nodiscard]] std::span<const Table> tables() const { return tables_; }
  /// Where the states lie among the registers, [begin, end).
  [[nodiscard]] std::uint32_t states_begin() const { return states_begin_; }
  [[nodiscard]] std::uint32_t states_end() const { return states_end_; }

  /// From now on `evaluate` on doubles calls this function, also in runs that are under way in other threads. It must
  /// compute the same bits; `code` keeps it loaded. Only the first call counts.
  void use_native(NativeEvaluation function, std::shared_ptr<const void> code) const;
  [[nodiscard]] bool is_native() const { return native_->function.load(std::memory_order_acquire) != nullptr; }
  /// `notify` is called, by the thread that evaluates, when that many operations are done, and again after as many as
  /// it returns, all counted from the beginning; 0: not again. To be set before the tape is shared by threads.
  void notify_of_use(std::uint64_t operations, std::function<std::uint64_t(std::uint64_t)> notify) const;
  /// Who evaluates says so, now and then. Whether anybody wants to know more.
  bool count_use(std::uint64_t operations) const;

 private:
  friend class TapeCompiler;
  friend class TapeWriter;
  struct Native {
    std::atomic<NativeEvaluation> function = nullptr;
    std::shared_ptr<const void> code;
    std::atomic<std::uint64_t> operations = 0, wanted = 0;  // done so far; when to notify, 0 never
    std::function<std::uint64_t(std::uint64_t)> notify;
    std::mutex mutex;
  };
  struct Constant {
    std::uint32_t target;
    double value;
  };
  struct Program {
    std::vector<tape::Instruction> instructions;  // the last one is `stop`
    std::vector<tape::Batch> batches;
    std::vector<std::uint32_t> gathered;  // registers of the batches' scattered operands
    tape::Copies copies;                  // variables of families side by side
  };

  template <class Real>
  void run(std::span<Real> registers, std::span<Real> outputs, const tape::Copies& copies) const;
  template <class Real>
  void run(const Program& program, Real* registers) const;
  template <class Real>
  void run_batch(const Program& program, const tape::Batch& batch, Real* registers) const;

  std::size_t registers_ = 0, output_count_ = 0;
  std::vector<Constant> constants_;
  Program preparation_, body_;
  std::shared_ptr<Native> native_ = std::make_shared<Native>();
  std::uint32_t states_begin_ = 0, states_end_ = 0;
  tape::Copies copies_;                 // what lies side by side before `body_`
  std::uint32_t copied_from_ = 0;       // where they are counted from: states_begin_, if only states are copied
  bool reads_only_copies_ = false;      // of the states
  std::vector<std::uint32_t> outputs_;  // registers
  tape::Copies many_outputs_;           // registers to outputs in loops, where there are that many
  std::vector<Table> tables_;
};

extern template void Tape::prepare(std::span<float>) const;
extern template void Tape::prepare(std::span<double>) const;
extern template void Tape::prepare(std::span<long double>) const;
extern template void Tape::evaluate(std::span<double>, std::span<const double>, std::span<double>) const;
extern template void Tape::evaluate(std::span<double>, std::span<const double>, std::span<double>,
                                    const tape::Copies&) const;
extern template void Tape::evaluate(std::span<float>, std::span<float>) const;
extern template void Tape::evaluate(std::span<double>, std::span<double>) const;
extern template void Tape::evaluate(std::span<long double>, std::span<long double>) const;

}  // namespace continuo::model
