// Joints between bodies by name, or between a body and the world.
#pragma once
#include <array>
#include <optional>
#include <string_view>
#include <vector>

#include <continuo/language/check/expressions/expressions.hpp>
#include <continuo/language/check/world/world_numbers.hpp>

namespace continuo::model::detail {

class Joints {
 public:
  /// `states`: where the bodies begin.
  Joints(Expressions& expressions, WorldAtWork& work, const std::vector<State>& states)
      : expressions_(expressions),
        report_(expressions.report),
        graph_(expressions.workspace.graph),
        text_(expressions.workspace.declared.world),
        work_(work),
        states_(states),
        numbers_(expressions, work) {}

  /// After the bodies, and what fixes them.
  void make();
  /// After the equations: they may stand in the speeds of motors, and in the targets of pulls.
  void make_drives();

 private:
  [[nodiscard]] std::optional<JointDescription> connected(const JointText& text, Scope& scope);
  [[nodiscard]] bool can_move(const JointDescription& joint, const JointText& text);
  void place(JointDescription& joint, const JointText& text, Scope& scope);
  void place_ends(JointDescription& joint, const JointText& text, Scope& scope);
  void read_axes(JointDescription& joint, const JointText& text, Scope& scope);
  void read_limits(JointDescription& joint, const JointText& text, Scope& scope);
  void read_spring(JointDescription& joint, const JointText& text, Scope& scope);
  void read_motor(JointDescription& joint, const JointText& text, Scope& scope);
  void read_pull(JointDescription& joint, const JointText& text, Scope& scope);
  void read_strength(JointDescription& joint, const JointText& text, Scope& scope);
  [[nodiscard]] NodePoint start_of(std::size_t body) const;
  [[nodiscard]] Measured pure() const;
  [[nodiscard]] Measured coordinate(std::string_view kind) const;
  [[nodiscard]] Measured force() const;

  Expressions& expressions_;
  Report& report_;
  Graph& graph_;
  const WorldText& text_;
  WorldAtWork& work_;
  const std::vector<State>& states_;
  WorldNumbers numbers_;
};

}  // namespace continuo::model::detail
