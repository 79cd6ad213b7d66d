// continuo/symbolic/tape/tape_compile.cpp
// From selected operations to a tape: order, batches and registers.
#include <algorithm>
#include <array>
#include <iterator>
#include <map>
#include <numeric>
#include <utility>

#include <continuo/symbolic/tape/tape.hpp>
#include <continuo/symbolic/tape/tape_copy.hpp>
#include <continuo/symbolic/tape/tape_group.hpp>
#include <continuo/symbolic/tape/tape_select.hpp>
#include <continuo/symbolic/tape/tape_steady.hpp>

namespace continuo::model {

namespace {

using tape::Batch, tape::Code, tape::Group, tape::Instruction, tape::Operand, tape::Place, tape::Places, tape::Selected,
    tape::Stretch;

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

/// from[k] to place(k).
template <class PlaceOf>
tape::Copies copies_to(std::span<const std::uint32_t> from, PlaceOf&& place) {
  std::vector<Place> places;
  for (std::size_t k = 0; k < from.size(); ++k) places.push_back({.from = from[k], .to = place(k)});
  std::ranges::sort(places);
  return tape::regular_copies(places);
}

}  // namespace

class TapeCompiler {
 public:
  TapeCompiler(const tape::Prepared& prepared, const TapeVariables& variables)
      : graph_(prepared.graph),
        registers_(variables.variables),
        place_(graph_.size(), nowhere),
        last_use_(graph_.size(), 0),
        colour_(graph_.size(), 0) {
    for (std::uint32_t i = 0; i < graph_.size(); ++i) {
      if (graph_[NodeId{i}].op == Op::variable) place_[i] = graph_[NodeId{i}].number;
    }
    selected_ = tape::select_operations(prepared);
    std::vector<Place> copied;
    for (const Family& family : families_of(prepared, variables.families)) place_family(family, copied);
    copy_states(variables, std::move(copied));
    for (const NodeId output : prepared.outputs) last_use_[output.index] = kept;
  }

  Tape compile(std::span<const NodeId> outputs) {
    place_constants(outputs);
    std::vector<Selected> steady;  // few: the others stay where they are
    std::ranges::copy_if(selected_, std::back_inserter(steady), &Selected::steady);
    std::erase_if(selected_, [](const Selected& s) { return s.steady; });
    // What is prepared stays where it is until the next preparation.
    for (const Selected& s : steady) last_use_[s.result.index] = kept;
    emit(tape_.preparation_, steady);
    for (const Selected& s : steady) colour_[s.result.index] = 0;  // a number like any constant
    emit(tape_.body_, selected_);
    place_outputs(outputs);
    tape_.registers_ = registers_.size();
    return std::move(tape_);
  }

 private:
  struct Member {
    const Selected* operation;
    Places places;
  };
  static constexpr std::uint32_t nowhere = std::numeric_limits<std::uint32_t>::max();
  static constexpr std::size_t kept = std::numeric_limits<std::size_t>::max();

  /// Variables of one family, the nodes that are read, ascending.
  using Family = std::vector<NodeId>;

  std::vector<Family> families_of(const tape::Prepared& prepared, std::span<const std::uint32_t> numbers) const {
    std::map<std::uint32_t, Family> families;
    for (std::uint32_t i = 0; i < graph_.size(); ++i) {
      const Node& node = graph_[NodeId{i}];
      if (node.op != Op::variable || prepared.steady[i]) continue;  // `prepare` reads those where they are
      if (node.number >= numbers.size() || numbers[node.number] == 0) continue;
      families[numbers[node.number]].push_back(NodeId{i});
    }
    std::vector<Family> large;
    for (auto& [number, members] : families) {
      if (members.size() < tape::smallest_batch) continue;
      std::ranges::sort(members, {}, [&](NodeId id) { return graph_[id].number; });
      large.push_back(std::move(members));
    }
    return large;
  }

  /// A family that does not lie side by side, and is read more than once, is copied to where it does: at the price of
  /// reading it once from where it lies.
  void place_family(const Family& family, std::vector<Place>& copied) {
    const tape::Colour mine = ++colours_;
    for (const NodeId id : family) colour_[id.index] = mine;
    std::size_t reads = 0;
    for (const Selected& s : selected_) {
      for (std::size_t k = 0; k < operands(s.code); ++k) reads += colour_[s.operand[k].index] == mine;
    }
    const std::uint32_t first = place_[family.front().index], last = place_[family.back().index];
    const bool contiguous = last - first + 1 == family.size();
    if (contiguous || reads < 2 * family.size()) return;
    std::uint32_t next = registers_.take(static_cast<std::uint32_t>(family.size()));
    for (const NodeId id : family) {
      copied.push_back({.from = place_[id.index], .to = next});
      place_[id.index] = next++;
    }
  }

  /// Where nobody reads a state but by its copy, states need not be among the registers at all.
  void copy_states(const TapeVariables& variables, std::vector<Place> copied) {
    const auto is_state = [&](std::uint32_t i) { return i >= variables.states_begin && i < variables.states_end; };
    tape_.states_begin_ = variables.states_begin;
    tape_.states_end_ = variables.states_end;
    if (std::ranges::all_of(copied, is_state, &Place::from)) {
      tape_.copied_from_ = variables.states_begin;
      tape_.reads_only_copies_ = true;
    }
    for (std::uint32_t i = 0; i < graph_.size(); ++i) {
      const Node& node = graph_[NodeId{i}];
      if (node.op == Op::variable && is_state(node.number) && place_[i] == node.number)
        tape_.reads_only_copies_ = false;
    }
    std::ranges::sort(copied);
    for (Place& place : copied) place.from -= tape_.copied_from_;
    tape_.copies_ = tape::regular_copies(copied);
  }

  void place_outputs(std::span<const NodeId> outputs) {
    tape_.output_count_ = outputs.size();
    for (const NodeId output : outputs) tape_.outputs_.push_back(place_[output.index]);
    tape_.many_outputs_ = copies_to(tape_.outputs_, [](std::size_t k) { return static_cast<std::uint32_t>(k); });
    if (tape_.many_outputs_.loops() == 0) tape_.many_outputs_ = {};
  }

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

  void emit(Tape::Program& program, std::span<const Selected> operations) {
    const std::vector<Group> groups = groups_of(operations, colour_);
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
        emit_group(program, operations, groups[g], g);
      }
    }
    program.instructions.emplace_back(Code::stop);
  }

  Places places_of(const Selected& s) const {
    Places places{};
    for (std::size_t k = 0; k < operands(s.code); ++k) places[k] = place_[s.operand[k].index];
    return places;
  }

  static std::vector<Places> places_of(std::span<const Member> members) {
    std::vector<Places> places;
    for (const Member& member : members) places.push_back(member.places);
    return places;
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
    const Member member{&s, places_of(s)};
    release(s, group);  // before the result is placed: it may take an operand's register
    place_[s.result.index] = registers_.take(1);
    emit_instruction(program, member, place_[s.result.index]);
  }

  static void emit_instruction(Tape::Program& program, const Member& member, std::uint32_t result) {
    Instruction i(member.operation->code);
    i.a = member.places[0], i.b = member.places[1], i.c = member.places[2], i.d = member.places[3];
    if (i.code == Code::interpolate || i.code == Code::interpolate_slope) i.b = member.operation->table;
    i.result = result;
    program.instructions.push_back(i);
  }

  /// The results of a group lie side by side, whatever it is made of.
  void emit_group(Tape::Program& program, std::span<const Selected> operations, const Group& group,
                  std::size_t number) {
    const std::vector<Member> members = in_order(operations, group);
    const std::uint32_t results = registers_.take(static_cast<std::uint32_t>(members.size()));
    for (const Stretch& stretch : tape::stretches(places_of(members))) {
      const std::span part = std::span(members).subspan(stretch.begin, stretch.end - stretch.begin);
      const std::uint32_t result = results + static_cast<std::uint32_t>(stretch.begin);
      if (part.size() >= tape::smallest_batch) {
        emit_batch(program, part, result);
      } else {
        for (std::uint32_t m = 0; m < part.size(); ++m) emit_instruction(program, part[m], result + m);
      }
    }
    for (std::uint32_t m = 0; m < members.size(); ++m) place_[members[m].operation->result.index] = results + m;
    for (const Member& member : members) release(*member.operation, number);
  }

  /// Ordered by the place of one operand, then by those after it: the operand by which most of it needs no gathering.
  std::vector<Member> in_order(std::span<const Selected> operations, const Group& group) const {
    std::vector<Member> members, best;
    for (const std::size_t i : group) members.push_back({&operations[i], places_of(operations[i])});
    std::size_t fewest = kept;
    const std::size_t count = operands(operations[group.front()].code);
    for (std::size_t by = 0; by < count && fewest > 1; ++by) {
      std::ranges::sort(members, [&](const Member& a, const Member& b) {
        for (std::size_t i = by; i < by + count; ++i) {
          const std::size_t k = i < count ? i : i - count;
          if (a.places[k] != b.places[k]) return a.places[k] < b.places[k];
        }
        return a.operation->result.index < b.operation->result.index;
      });
      if (const std::size_t breaks = tape::breaks(places_of(members)); breaks < fewest) {
        fewest = breaks;
        best = members;
      }
    }
    return best;
  }

  void emit_batch(Tape::Program& program, std::span<const Member> members, std::uint32_t result) {
    Batch batch{
        .code = members.front().operation->code, .result = result, .count = static_cast<std::uint32_t>(members.size())};
    for (std::size_t k = 0; k < operands(batch.code); ++k) batch.operand[k] = layout(program, members, k);
    const auto number = static_cast<std::uint32_t>(program.batches.size());
    program.batches.push_back(batch);
    program.instructions.emplace_back(Code::batch).a = number;
  }

  static Operand layout(Tape::Program& program, std::span<const Member> members, std::size_t k) {
    const std::uint32_t first = members.front().places[k];
    bool one = true, contiguous = true;
    for (std::uint32_t m = 0; m < members.size(); ++m) {
      one = one && members[m].places[k] == first;
      contiguous = contiguous && members[m].places[k] == first + m;
    }
    if (one) return {Operand::Layout::one, first};
    if (contiguous) return {Operand::Layout::contiguous, first};
    const auto begin = static_cast<std::uint32_t>(program.gathered.size());
    for (const Member& member : members) program.gathered.push_back(member.places[k]);
    return {Operand::Layout::gathered, begin};
  }

  const Graph& graph_;
  Registers registers_;
  std::vector<std::uint32_t> place_;   // register of each node
  std::vector<std::size_t> last_use_;  // the group that reads it last
  std::vector<tape::Colour> colour_;   // by node: 0 or a family, of results how they come about
  tape::Colour colours_ = 0;
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

tape::Copies Tape::outputs_at(std::span<const std::uint32_t> places) const {
  return copies_to(outputs_, [&](std::size_t k) { return places[k]; });
}

}  // namespace continuo::model
