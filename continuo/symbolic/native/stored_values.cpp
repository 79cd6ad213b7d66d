// Weighs the work of computing a value again, and follows who holds which register.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include <continuo/symbolic/native/stored_values.hpp>

namespace continuo::model {

namespace {

using tape::Code;

// An expression that takes more is hard to read and to compile.
constexpr std::uint32_t most_leaves = 48, most_work = 400;
// In additions: less than a number costs that goes through memory. So many numbers are not all in the cache.
constexpr std::uint32_t less_than_memory = 8;
constexpr std::size_t more_than_cache = 10'000;

std::uint32_t work_of(Code code) {
  switch (code) {
    case Code::divide:
    case Code::square_root:
    case Code::hypotenuse:
      return 6;
    case Code::minimum:
    case Code::maximum:
    case Code::absolute:
    case Code::floor:
    case Code::ceiling:
    case Code::logical_not:
    case Code::sign:
      return 1;
    default:
      if (code < Code::square_root || (code >= Code::select_less && code <= Code::select)) return 1;
      if (code >= Code::less && code <= Code::logical_or) return 1;
      return 40;
  }
}

class Storage {
 public:
  explicit Storage(const TapeValues& values)
      : values_(values), stored_(values.size(), 0), is_large_(batched() > more_than_cache) {}

  std::vector<char> choose() {
    count_readers();
    weigh();
    while (!is_held_until_read()) {
    }
    return std::move(stored_);
  }

 private:
  struct Weight {
    std::uint32_t work = 0, leaves = 0;
  };

  std::size_t batched() const {
    std::size_t count = 0;
    for (std::size_t n = 0; n < values_.instructions(); ++n)
      if (values_.is_batch(n)) count += values_.first(n + 1) - values_.first(n);
    return count;
  }

  void count_readers() {
    readers_.assign(values_.size(), 0);
    const auto read = [&](ValueRef ref) {
      if (!values_.is_value(ref)) return;
      char& readers = readers_[values_.number(ref)];
      if (readers < 2) ++readers;
    };
    for (std::size_t v = 0; v < values_.size(); ++v) {
      const std::span<const ValueRef> operands = values_.operands(v);
      for (std::size_t k = 0; k < operands.size(); ++k)
        if (std::ranges::find(operands.first(k), operands[k]) == operands.begin() + static_cast<std::ptrdiff_t>(k))
          read(operands[k]);
    }
    for (const ValueRef output : values_.outputs()) read(output);
  }

  bool is_stored(ValueRef ref) const { return stored_[values_.number(ref)] != 0; }
  bool is_expanded(ValueRef ref) const { return values_.is_value(ref) && !is_stored(ref); }

  void weigh() {
    std::vector<Weight> weights(values_.size());
    for (std::size_t v = 0; v < values_.size(); ++v) {
      const std::uint32_t own = work_of(values_.code(v));
      Weight weight{.work = own};
      for (const ValueRef operand : values_.operands(v)) {
        if (!is_expanded(operand)) {
          ++weight.leaves;
          continue;
        }
        weight.work += weights[values_.number(operand)].work;
        weight.leaves += weights[values_.number(operand)].leaves;
      }
      if (weight.work > most_work || weight.leaves > most_leaves) {
        for (const ValueRef operand : values_.operands(v))
          if (values_.is_value(operand)) stored_[values_.number(operand)] = 1;
        weight = {own, static_cast<std::uint32_t>(values_.operands(v).size())};
      }
      weights[v] = weight;
      const bool again = is_large_ && values_.is_batch(values_.instruction(v)) && weight.work <= less_than_memory;
      if (readers_[v] > 1 && !again) stored_[v] = 1;
    }
  }

  /// Stores one value more for each that is read after its register was taken. Whether there was none.
  bool is_held_until_read() {
    holder_.assign(values_.registers(), nobody);
    bool all = true;
    for (std::size_t n = 0; n < values_.instructions(); ++n) {
      const std::size_t begin = values_.first(n), end = values_.first(n + 1);
      if (values_.is_batch(n))
        for (std::size_t v = begin; v < end; ++v)
          if (stored_[v] != 0) holder_[values_.place(v)] = static_cast<std::uint32_t>(v);
      for (std::size_t v = begin; v < end; ++v)
        if (stored_[v] != 0 && !reads_what_is_held(v)) all = false;
    }
    for (const ValueRef output : values_.outputs())
      if (is_expanded(output) && !reads_what_is_held(values_.number(output))) all = false;
    return all;
  }

  bool reads_what_is_held(std::size_t value) {
    bool all = true;
    for (const ValueRef operand : values_.operands(value)) {
      if (!values_.is_value(operand)) continue;
      const std::size_t read = values_.number(operand);
      if (stored_[read] == 0) {
        all = reads_what_is_held(read) && all;
      } else if (values_.is_batch(values_.instruction(read)) && holder_[values_.place(read)] != read) {
        stored_[value] = 1;
        all = false;
      }
    }
    return all;
  }

  static constexpr std::uint32_t nobody = std::numeric_limits<std::uint32_t>::max();
  const TapeValues& values_;
  std::vector<char> stored_, readers_;  // by value; readers up to two
  std::vector<std::uint32_t> holder_;   // by register, while the instructions are followed
  bool is_large_;
};

}  // namespace

std::vector<char> values_to_store(const TapeValues& values) {
  return Storage(values).choose();
}

}  // namespace continuo::model
