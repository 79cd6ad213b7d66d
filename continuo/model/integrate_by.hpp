// continuo/model/integrate_by.hpp
// The body of begin_integration_by; included only by the integrate_*.cpp.
#pragma once
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <continuo/model/stepping.hpp>
#include <continuo/solve/integrator.hpp>

namespace continuo::model {

template <class Method>
class SteppingBy final : public Stepping {
 public:
  SteppingBy(Integration integration, Interval<double> interval) {
    begin(std::move(integration.system), std::move(integration.x0), interval, std::move(integration.options),
          std::move(integration.events));
  }

  bool advance(StepWatcher& watcher) override {
    Forward forward{*this, watcher};
    return integrator_->advance(forward);
  }
  double t() const override { return integrator_->t(); }
  const X& x() const override { return integrator_->x(); }
  void at(double t, X& x) override { integrator_->at(t, x); }
  const ModelSystem& system() const override { return integrator_->system(); }
  const ModelEvents& events() const override { return integrator_->events(); }
  const Outcome<double>& outcome() const override { return integrator_->outcome(); }
  Statistics statistics() const override { return sum(past_, integrator_->statistics()); }
  void extend_to(double to) override { integrator_->extend_to(to); }

  void go_on(const Instant& instant, std::span<const double> variables, std::span<const std::size_t> held) override {
    past_ = statistics();
    ModelSystem system = integrator_->system();
    system.set_all(variables);
    system.go(instant.mode);
    system.hold({held.begin(), held.end()});
    ModelEvents events(system.program(), variables, integrator_->events().begin());
    events.resume(instant.t, instant.stops);
    Options<X> options = integrator_->options();
    const Interval<double> interval{instant.t, integrator_->interval().to};
    begin(std::move(system), instant.x, interval, std::move(options), std::move(events));
  }

 private:
  using Integrating = Integrator<ModelSystem, X, Method, ModelEvents>;

  struct Forward {
    SteppingBy& run;
    StepWatcher& watcher;
    void stretch(Integrating&, double, double to) { watcher.stretch(run, to); }
    void happening(Integrating&, const Happening<X>& now) { watcher.happening(run, now); }
  };

  void begin(ModelSystem system, X x0, Interval<double> interval, Options<X> options, ModelEvents events) {
    integrator_.emplace(std::move(system), std::move(x0), interval, Method{}, std::move(options), std::move(events));
  }

  Statistics past_;  // of integrators before this one
  std::optional<Integrating> integrator_;
};

template <class Method>
std::unique_ptr<Stepping> begin_integration_by(Integration integration, Interval<double> interval) {
  return std::make_unique<SteppingBy<Method>>(std::move(integration), interval);
}

}  // namespace continuo::model
