// Follows the registers of a tape from instruction to instruction.
#include <algorithm>
#include <numeric>

#include <continuo/symbolic/native/tape_values.hpp>

namespace continuo::model {

using tape::Batch, tape::Code, tape::Instruction, tape::Operand;

TapeValues::TapeValues(const TapeBody& body) : body_(body), holds_(body.registers) {
  std::iota(holds_.begin(), holds_.end(), ValueRef{0});
  read_copies();
  std::size_t values = 0;
  for (const Instruction& i : body_.instructions) values += i.code == Code::batch ? body_.batches[i.a].count : 1;
  instruction_.reserve(values);
  for (const Instruction& i : body_.instructions) {
    first_.push_back(instruction_.size());
    first_operand_.push_back(operands_.size());
    i.code == Code::batch ? read(body_.batches[i.a]) : read(i);
  }
  first_.push_back(instruction_.size());
  for (const std::uint32_t place : body_.outputs) outputs_.push_back(holds_[place]);
  holds_ = {};
}

/// A copy of a variable is the variable.
void TapeValues::read_copies() {
  const auto copy = [&](std::uint32_t from, std::uint32_t to) { holds_[to] = from + body_.copied_from; };
  for (const tape::Place& place : body_.copies.alone) copy(place.from, place.to);
  for (const tape::Copy& many : body_.copies.regular)
    for (std::uint32_t k = 0; k < many.count; ++k)
      copy(many.from_begin + k * many.from_step, many.to_begin + k * many.to_step);
  for (const tape::Turns& turns : body_.copies.joined)
    for (std::uint32_t k = 0; k < turns.count; ++k) {
      copy(turns.first + k, turns.together + 2 * k);
      copy(turns.second + k, turns.together + 2 * k + 1);
    }
  for (const tape::Turns& turns : body_.copies.parted)
    for (std::uint32_t k = 0; k < turns.count; ++k) {
      copy(turns.together + 2 * k, turns.first + k);
      copy(turns.together + 2 * k + 1, turns.second + k);
    }
}

void TapeValues::read(const Instruction& i) {
  const std::uint32_t places[] = {i.a, i.b, i.c, i.d};
  const std::size_t count = is_table(i.code) ? 1 : tape::operands(i.code);
  for (std::size_t k = 0; k < count; ++k) operands_.push_back(holds_[places[k]]);
  holds_[i.result] = ref(instruction_.size());
  instruction_.push_back(static_cast<std::uint32_t>(first_.size() - 1));
}

void TapeValues::read(const Batch& batch) {
  const std::size_t count = tape::operands(batch.code);
  for (std::uint32_t m = 0; m < batch.count; ++m) {
    for (std::size_t k = 0; k < count; ++k) {
      const Operand& operand = batch.operand[k];
      const bool gathered = operand.layout == Operand::Layout::gathered;
      const std::uint32_t ahead = operand.layout == Operand::Layout::one ? 0 : m;
      operands_.push_back(holds_[gathered ? body_.gathered[operand.begin + ahead] : operand.begin + ahead]);
    }
  }
  for (std::uint32_t m = 0; m < batch.count; ++m) {
    holds_[batch.result + m] = ref(instruction_.size());
    instruction_.push_back(static_cast<std::uint32_t>(first_.size() - 1));
  }
}

Code TapeValues::code(std::size_t value) const {
  const Instruction& i = body_.instructions[instruction_[value]];
  return i.code == Code::batch ? body_.batches[i.a].code : i.code;
}

std::span<const ValueRef> TapeValues::operands(std::size_t value) const {
  const std::size_t n = instruction_[value];
  const Code own = code(value);
  const std::size_t count = is_table(own) ? 1 : tape::operands(own);
  return std::span(operands_).subspan(first_operand_[n] + (value - first_[n]) * count, count);
}

std::uint32_t TapeValues::place(std::size_t value) const {
  const std::size_t n = instruction_[value];
  const Instruction& i = body_.instructions[n];
  if (i.code != Code::batch) return i.result;
  return body_.batches[i.a].result + static_cast<std::uint32_t>(value - first_[n]);
}

}  // namespace continuo::model
