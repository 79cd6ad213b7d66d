// The plots that a model asks for, and the states where it asks for none.
#include <continuo/language/world.hpp>
#include <continuo/results/plot_request.hpp>

namespace continuo::results {
namespace {

constexpr std::size_t most_default_curves = 8;

bool is_of_fixed_body(const model::Model& model, std::size_t state) {
  if (!model.world || state >= model.world->body_states()) return false;
  return model.world->bodies[state / model::WorldDescription::states_of_body(model.world->dimension)].fixed;
}

}  // namespace

std::vector<PlotRequest> plot_requests(const model::Model& model) {
  std::vector<PlotRequest> requests;
  for (const model::Plot& plot : model.plots) requests.push_back({.plot = plot});
  return requests;
}

std::vector<std::size_t> states_to_plot(const model::Model& model) {
  std::vector<std::size_t> states;
  for (std::size_t i = 0; i < model.states.size() && states.size() < most_default_curves; ++i) {
    if (!is_of_fixed_body(model, i)) states.push_back(i);
  }
  return states;
}

}  // namespace continuo::results
