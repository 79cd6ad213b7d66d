// Methods by name for models of each kind.
#include <algorithm>

#include <continuo/language/world_methods.hpp>
#include <continuo/runs/methods.hpp>
#include <continuo/solve/catalogue.hpp>

namespace continuo::runs {

std::vector<Method> methods_for(const model::Model& model) {
  const Kind kind = kind_of(model);
  std::vector<Method> methods;
  if (kind.solver == Solver::world) {
    for (const std::string& name : model::world_methods(*model.world, model))
      methods.push_back({.name = name, .title = name, .chooses_steps = has_no_step(kind, name)});
    return methods;
  }
  for (const MethodInfo& info : method_catalogue()) {
    if (info.second_order && !model.all_paired) continue;
    if (!info.implicit && model.needs_dae_solver()) continue;
    std::string title(info.name);
    std::ranges::replace(title, '_', ' ');
    methods.push_back({.name = std::string(info.name),
                       .title = std::move(title),
                       .order = info.order,
                       .implicit = info.implicit,
                       .chooses_steps = info.error_order > 0});
  }
  return methods;
}

std::vector<std::string> method_names(const Kind& kind) {
  if (kind.solver == Solver::world) return model::world_methods();
  std::vector<std::string> names;
  for (const MethodInfo& method : method_catalogue()) names.emplace_back(method.name);
  return names;
}

bool has_no_step(const Kind& kind, std::string_view method) {
  return kind.solver == Solver::world && (method == "exact" || method == "dop853");
}

int order_of_fixed_steps(const model::Model& model, std::string_view method) {
  // `fast` is the integrator that the world names.
  const bool is_fast = kind_of(model).solver == Solver::world && method == "fast";
  const MethodInfo* info = find_method(is_fast ? std::string_view(model.world->mode.integrator) : method);
  return info == nullptr ? 0 : info->order_of_fixed_steps;
}

std::string_view reference_method(const model::Model& model, bool stiff) {
  if (kind_of(model).solver == Solver::world) return model.world->is_moved_fast() ? "fast" : "exact";
  if (!stiff && !model.needs_dae_solver()) return "verner9";
  return find_method("radau") != nullptr ? "radau" : "bdf";
}

}  // namespace continuo::runs
