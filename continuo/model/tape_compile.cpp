// continuo/model/tape_compile.cpp
// From selected operations to a tape: order, batches and registers.
#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <utility>

#include <continuo/model/tape.hpp>
#include <continuo/model/tape_select.hpp>
#include <continuo/model/tape_steady.hpp>

namespace continuo::model {

namespace {

using tape::Batch, tape::Code, tape::Instruction, tape::Operand, tape::Selected;

/// From this many equal operations on, a loop over them is cheaper than as many instructions (measured by
/// bench/tape: a loop costs about as much as eight of them to begin).
constexpr std::size_t smallest_batch = 12;

/// The free registers as intervals; the lowest that fits is taken, which keeps the file small and in the cache.
class Registers {
 public:
  explicit Registers(std::uint32_t first) : end_(first), size_(first) {}

  std::uint32_t take(std::uint32_t count) {
    for (auto i = free_.begin(); i != free_.end(); ++i) {
      if (i->second < count) continue;
      const auto [begin, length] = *i;
      free_.erase(i);
      if (length > count) free_.emplace(begin + count, length - count);
      return begin;
    }
    const std::uint32_t begin = end_;
    end_ += count;
    size_ = std::max(size_, end_);
    return begin;
  }

  void give_back(std::uint32_t one) {
    std::uint32_t length = 1;
    auto next = free_.lower_bound(one);
    if (next != free_.end() && next->first == one + 1) {
      length += next->second;
      next = free_.erase(next);
    }
    if (next != free_.begin()) {
      const auto before = std::prev(next);
      if (before->first + before->second == one) {
        before->second += length;
        return;
      }
    }
    free_.emplace_hint(next, one, length);
  }

  std::uint32_t size() const { return size_; }

 private:
  std::uint32_t end_, size_;
  std::map<std::uint32_t, std::uint32_t> free_;  // begin and length
};

}  // namespace

class TapeCompiler {
 public:
  TapeCompiler(const tape::Prepared& prepared, const TapeVariables& variables)
      : graph_(prepared.graph),
        registers_(variables.variables),
        place_(graph_.size(), nowhere),
        last_use_(graph_.size(), 0) {
    for (std::uint32_t i = 0; i < graph_.size(); ++i) {
      if (graph_[NodeId{i}].op == Op::variable) place_[i] = graph_[NodeId{i}].number;
    }
    selected_ = tape::select_operations(prepared);
    for (const NodeId output : prepared.outputs) last_use_[output.index] = kept;
  }

  Tape compile(std::span<const NodeId> outputs) {
    place_constants(outputs);
    std::vector<Selected> steady, moving;
    for (const Selected& s : selected_) (s.steady ? steady : moving).push_back(s);
    // What is prepared stays where it is until the next preparation.
    for (const Selected& s : steady) last_use_[s.result.index] = kept;
    emit(tape_.preparation_, steady);
    emit(tape_.body_, moving);
    for (const NodeId output : outputs) tape_.outputs_.push_back(place_[output.index]);
    tape_.registers_ = registers_.size();
    return std::move(tape_);
  }

 private:
  static constexpr std::uint32_t nowhere = std::numeric_limits<std::uint32_t>::max();
  static constexpr std::size_t kept = std::numeric_limits<std::size_t>::max();
  using Groups = std::vector<std::vector<std::size_t>>;

  void place_constant(NodeId id) {
    if (graph_[id].op != Op::constant || place_[id.index] != nowhere) return;
    place_[id.index] = registers_.take(1);
    last_use_[id.index] = kept;
    tape_.constants_.push_back({place_[id.index], graph_[id].value});
  }

  void place_constants(std::span<const NodeId> outputs) {
    for (const Selected& s : selected_) {
      for (std::size_t k = 0; k < operands(s.code); ++k) place_constant(s.operand[k]);
    }
    for (const NodeId output : outputs) place_constant(output);
  }

  /// Operations that do not wait for each other and do the same stand together; large groups of them become batches.
  Groups groups_of(const std::vector<Selected>& operations) const {
    std::vector<std::uint32_t> level(graph_.size(), 0);
    std::map<std::pair<std::uint32_t, Code>, std::vector<std::size_t>> by_level;
    for (std::size_t i = 0; i < operations.size(); ++i) {
      const Selected& s = operations[i];
      std::uint32_t mine = 1;
      for (std::size_t k = 0; k < operands(s.code); ++k) mine = std::max(mine, level[s.operand[k].index] + 1);
      level[s.result.index] = mine;
      by_level[{mine, s.code}].push_back(i);
    }
    Groups groups;
    for (auto& [key, members] : by_level) {
      const bool batched = members.size() >= smallest_batch && key.second < Code::interpolate;
      if (batched) {
        groups.push_back(std::move(members));
      } else {
        for (const std::size_t i : members) groups.push_back({i});
      }
    }
    return groups;
  }

  void emit(Tape::Program& program, const std::vector<Selected>& operations) {
    const Groups groups = groups_of(operations);
    for (std::size_t g = 0; g < groups.size(); ++g) {
      for (const std::size_t i : groups[g]) {
        for (std::size_t k = 0; k < operands(operations[i].code); ++k) {
          std::size_t& last = last_use_[operations[i].operand[k].index];
          if (last != kept) last = g;
        }
      }
    }
    for (std::size_t g = 0; g < groups.size(); ++g) {
      if (groups[g].size() == 1) {
        emit_single(program, operations[groups[g].front()], g);
      } else {
        emit_batch(program, operations, groups[g], g);
      }
    }
    program.instructions.emplace_back(Code::stop);
  }

  std::uint32_t place(const Selected& s, std::size_t k) const {
    return k < operands(s.code) ? place_[s.operand[k].index] : 0;
  }

  void release(const Selected& s, std::size_t group) {
    for (std::size_t k = 0; k < operands(s.code); ++k) {
      const NodeId id = s.operand[k];
      if (last_use_[id.index] != group || arity(graph_[id].op) == 0) continue;
      registers_.give_back(place_[id.index]);
      last_use_[id.index] = kept;  // given back once, even if it is read twice
    }
  }

  void emit_single(Tape::Program& program, const Selected& s, std::size_t group) {
    Instruction i(s.code);
    i.a = place(s, 0), i.b = place(s, 1), i.c = place(s, 2), i.d = place(s, 3);
    if (s.code == Code::interpolate || s.code == Code::interpolate_slope) i.b = s.table;
    release(s, group);  // before the result is placed: it may take an operand's register
    i.result = place_[s.result.index] = registers_.take(1);
    program.instructions.push_back(i);
  }

  void emit_batch(Tape::Program& program, const std::vector<Selected>& operations, std::vector<std::size_t> members,
                  std::size_t group) {
    const auto key = [&](std::size_t i) {
      const Selected& s = operations[i];
      return std::array{place(s, 0), place(s, 1), place(s, 2), place(s, 3)};
    };
    std::ranges::sort(members, {}, key);
    const auto count = static_cast<std::uint32_t>(members.size());
    Batch batch{.code = operations[members.front()].code, .result = registers_.take(count), .count = count};
    for (std::size_t k = 0; k < operands(batch.code); ++k) {
      batch.operand[k] = layout(program, members, [&](std::size_t i) { return place(operations[i], k); });
    }
    for (std::uint32_t m = 0; m < count; ++m) place_[operations[members[m]].result.index] = batch.result + m;
    for (const std::size_t i : members) release(operations[i], group);
    const auto number = static_cast<std::uint32_t>(program.batches.size());
    program.batches.push_back(batch);
    program.instructions.emplace_back(Code::batch).a = number;
  }

  static Operand layout(Tape::Program& program, const std::vector<std::size_t>& members, auto&& place_of) {
    const std::uint32_t first = place_of(members.front());
    bool one = true, contiguous = true;
    for (std::uint32_t m = 0; m < members.size(); ++m) {
      one = one && place_of(members[m]) == first;
      contiguous = contiguous && place_of(members[m]) == first + m;
    }
    if (one) return {Operand::Layout::one, first};
    if (contiguous) return {Operand::Layout::contiguous, first};
    const auto begin = static_cast<std::uint32_t>(program.gathered.size());
    for (const std::size_t i : members) program.gathered.push_back(place_of(i));
    return {Operand::Layout::gathered, begin};
  }

  const Graph& graph_;
  Registers registers_;
  std::vector<std::uint32_t> place_;   // register of each node
  std::vector<std::size_t> last_use_;  // the group that reads it last
  std::vector<Selected> selected_;
  Tape tape_;
};

Tape::Tape(const Graph& graph, std::span<const NodeId> outputs, TapeVariables variables,
           std::span<const Table> tables) {
  const tape::Prepared prepared = tape::gather_steady_factors(graph, outputs, [&](std::uint32_t variable) {
    return variable >= variables.steady_begin && variable < variables.steady_end;
  });
  *this = TapeCompiler(prepared, variables).compile(prepared.outputs);
  tables_.assign(tables.begin(), tables.end());
}

}  // namespace continuo::model
