// The numbers that a tape computes, each with what it is computed from, whatever registers they pass through.
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <continuo/symbolic/tape/tape_code.hpp>
#include <continuo/symbolic/tape/tape_copy.hpp>

namespace continuo::model {

/// What a tape evaluates.
struct TapeBody {
  std::size_t registers = 0;
  std::span<const tape::Instruction> instructions;  // without `stop`
  std::span<const tape::Batch> batches;
  std::span<const std::uint32_t> gathered;
  const tape::Copies& copies;
  std::uint32_t copied_from = 0;
  std::span<const std::uint32_t> outputs;
};

/// A number: a register that the tape does not write (a variable, a constant, what is prepared), or a value, which is
/// numbered in order of computation from registers() on.
using ValueRef = std::uint32_t;

class TapeValues {
 public:
  explicit TapeValues(const TapeBody& body);

  [[nodiscard]] std::size_t registers() const { return body_.registers; }
  [[nodiscard]] std::size_t size() const { return instruction_.size(); }
  [[nodiscard]] bool is_value(ValueRef ref) const { return ref >= body_.registers; }
  [[nodiscard]] ValueRef ref(std::size_t value) const { return static_cast<ValueRef>(body_.registers + value); }
  [[nodiscard]] std::size_t number(ValueRef ref) const { return ref - body_.registers; }

  [[nodiscard]] std::size_t instructions() const { return body_.instructions.size(); }
  /// Values of one instruction: [first(n), first(n + 1)).
  [[nodiscard]] std::size_t first(std::size_t instruction) const { return first_[instruction]; }
  [[nodiscard]] std::size_t instruction(std::size_t value) const { return instruction_[value]; }
  /// Whether the instruction is one of many equal ones, whose results lie side by side.
  [[nodiscard]] bool is_batch(std::size_t instruction) const {
    return body_.instructions[instruction].code == tape::Code::batch;
  }

  [[nodiscard]] tape::Code code(std::size_t value) const;
  [[nodiscard]] std::uint32_t table(std::size_t value) const { return body_.instructions[instruction_[value]].b; }
  [[nodiscard]] std::span<const ValueRef> operands(std::size_t value) const;
  /// The register that the tape puts it in.
  [[nodiscard]] std::uint32_t place(std::size_t value) const;
  [[nodiscard]] std::span<const ValueRef> outputs() const { return outputs_; }

 private:
  void read_copies();
  void read(const tape::Instruction& instruction);
  void read(const tape::Batch& batch);

  TapeBody body_;
  std::vector<ValueRef> holds_;             // by register, while the tape is read
  std::vector<std::size_t> first_;          // by instruction, and the end
  std::vector<std::size_t> first_operand_;  // by instruction
  std::vector<std::uint32_t> instruction_;  // by value
  std::vector<ValueRef> operands_, outputs_;
};

[[nodiscard]] constexpr bool is_table(tape::Code code) {
  return code == tape::Code::interpolate || code == tape::Code::interpolate_slope;
}

}  // namespace continuo::model
