// continuo/language/check/equations/equation_counts.hpp
// The messages where there are not as many equations as highest derivatives, or where an equation determines none of
// them.
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <continuo/language/check/equations/equations_at_work.hpp>
#include <continuo/language/check/expressions/expressions.hpp>

namespace continuo::model::detail {

class EquationCounts {
 public:
  explicit EquationCounts(const Workspace& workspace)
      : declared_(workspace.declared), layout_(workspace.layout), report_(workspace.report) {}

  /// The equation of this index holds these variables and no highest derivative.
  void report_empty_equation(ModeAtWork& work, std::size_t index, const std::vector<std::uint32_t>& variables) const;
  void report_surplus(const ModeAtWork& work, const std::vector<std::size_t>& members,
                      const std::vector<std::uint32_t>& open) const;
  void report_missing(const ModeAtWork& work) const;
  [[nodiscard]] std::vector<std::string> highest_names(std::span<const std::uint32_t> bases) const;

 private:
  void report_without_equation(std::uint32_t base) const;

  const Declarations& declared_;
  const Layout& layout_;
  Report& report_;
};

}  // namespace continuo::model::detail
