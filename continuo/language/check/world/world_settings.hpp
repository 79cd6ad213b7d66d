// continuo/language/check/world/world_settings.hpp
// Gravity, attraction, drag, the material, how surfaces combine, the mode, and groups that ignore each other.
#pragma once
#include <continuo/language/check/expressions/expressions.hpp>
#include <continuo/language/check/world/world_numbers.hpp>

namespace continuo::model::detail {

class WorldSettings {
 public:
  WorldSettings(Expressions& expressions, WorldAtWork& work)
      : expressions_(expressions),
        report_(expressions.report),
        graph_(expressions.workspace.graph),
        text_(expressions.workspace.declared.world),
        work_(work),
        numbers_(expressions, work) {}

  /// Before the bodies: they build upon these.
  void make();
  /// After them: what is rigid is moved by the fast motion, unless the mode is named. E264 where its integrator does
  /// not fit.
  void settle_mode();

 private:
  void read(const ast::WorldSetting& setting, Scope& scope);
  [[nodiscard]] bool stands_twice(const ast::WorldSetting& setting);
  void read_attraction(const ast::WorldSetting& setting, Scope& scope);
  void read_drag(const ast::WorldSetting& setting, Scope& scope);
  void read_combinations(const ast::WorldSetting& setting);
  void read_mode(const ast::WorldSetting& setting, Scope& scope);
  void read_integrator(const ast::Expression& text);
  void read_ignore(const ast::WorldIgnore& ignore);

  Expressions& expressions_;
  Report& report_;
  Graph& graph_;
  const WorldText& text_;
  WorldAtWork& work_;
  WorldNumbers numbers_;
};

}  // namespace continuo::model::detail
